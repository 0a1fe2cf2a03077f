// Meanings of the machine's states, alarms and waits, and the remedies.
import type { CodeTexts } from "../engine/engine";
import type { Snapshot } from "../sender/snapshot";

export interface Codes { errors: CodeTexts; alarms: CodeTexts }

const kStates: Record<string, string> = {
  Idle: "At rest", Run: "Running", Jog: "Jogging", Alarm: "Alarm", Check: "Check mode: nothing is cut", Home: "Homing", Sleep: "Asleep", Hold: "Held", Door: "The door is open",
};

const kAlarmAdvice: Record<number, string> = {
  1: "Unlock, jog away from the switch, and home again.", 2: "Set the work zero so that the program fits the travel, or move the part.",
  3: "Home the machine, or check its position, before you go on.", 4: "Lift the probe off, and begin again.", 5: "Bring the tool nearer, or allow a longer way.",
  6: "Home again.", 7: "Close the door, and home again.", 8: "Look whether a switch is stuck, then home again.", 9: "Look at switch and cable, then home again.",
  10: "Release the emergency stop, reset, and home again.", 14: "Look at the spindle's drive.", 15: "Home again before anything else.",
  17: "Look at the drives; reset once the fault is cleared, then home.",
};

const kDoor: Record<number, string> = { 0: "The door is closed: Resume goes on", 1: "The door is open: close it", 2: "The door was opened: stopping", 3: "Spindle and coolant come back" };

/** The state as its headline. */
export function stateText(now: Snapshot): string {
  if (now.link === "none") return "No machine is connected";
  if (now.link === "opening") return `Waiting for ${now.port} to answer …`;
  if (now.link === "lost") return `The link is lost: ${now.why}`;
  if (now.stopping) return "Stopping";
  if (now.state === "Door") return kDoor[now.substate] ?? kStates.Door;
  if (now.state === "Hold" && now.substate === 1) return "Slowing to a hold";
  return kStates[now.state] ?? now.state;
}

const codeText = (kind: string, code: number, texts: CodeTexts): string => `${kind} ${code}${texts[code] ? `: ${texts[code]}` : ""}`;
export const errorText = (code: number, { errors }: Codes): string => codeText("error", code, errors);

/** An alarm in words, with what to do; "" where there is none. */
export function alarmText(now: Snapshot, { alarms }: Codes): string {
  if (now.state !== "Alarm") return "";
  if (now.alarm === 0) return `The machine is locked. ${now.settings[22] ? "Home it, or unlock it if you know where it is." : "Unlock it once you know where it is."}`;
  return `${codeText("Alarm", now.alarm, alarms)}. ${kAlarmAdvice[now.alarm] ?? "Look at the machine before you unlock it."}`;
}

function toolText(now: Snapshot, text: string, where: string): string {
  const tool = /T(\d+)/i.exec(text)?.[1], way = now.settings[341];
  const then = !/M0*6/i.test(text) ? "Fit it at the length of the one before: its length is not measured." : way === 3 ? "Resume then measures it at the tool setter." : way === 1 || way === 2 ? "Its length is not measured: G43 in the program must allow for it." :
    "Fit it at the length of the one before: it is not measured ($341=3 does that, at a tool setter).";
  return `Change to ${tool ? `tool T${tool}` : "the next tool"}, at ${where}. ${now.spindle > 0 ? "The spindle may still turn: look first. " : ""}${then} Then Resume.`;
}

/** Why a program waits, and what to do; "" where it does not. raw: text of a line of the program. */
export function waitText(now: Snapshot, raw: (line: number) => string): string {
  const { pause, messages } = now;
  if (now.run?.phase !== "run") return "";
  if (now.state === "Door") return `${kDoor[now.substate] ?? kStates.Door}.`;
  if (now.state !== "Hold" || now.substate === 1) return "";
  if (now.held) return "Held by you: Resume goes on from here.";
  if (!pause) return `The machine holds by itself${messages.length > 0 ? `: ${messages[messages.length - 1]}` : ", or by its button"}. Resume goes on from here.`;
  const where = `line ${pause.line}: ${raw(pause.line) || pause.text}`;
  return pause.kind === "tool" ? toolText(now, pause.text, where) : `The program waits for you at ${where}. Do what it asks for, then Resume.`;
}

/** How the program ended; "" while there is none, or it runs. */
export function endText({ run }: Snapshot, codes: Codes): string {
  switch (run?.phase) {
    case "done": return "The program has ended.";
    case "stopped": return `Stopped at line ${run.executed}.`;
    case "lost": return `The program was cut off at line ${run.executed}: ${run.text}.`;
    case "fault":
      if (run.text === "alarm") return `The program ended at line ${run.executed} by an alarm.`;
      return run.error > 0 ? `Line ${run.line}: ${errorText(run.error, codes)}. The machine was stopped.` : `${run.text}.`;
    default: return "";
  }
}
