// Where the machine is and what it does, in words; alarms and waits with what to do.
import type { JSX } from "preact";
import { duration, figure, fixed, inOrder } from "../elements";
import { codes } from "../studio/store";
import { commands, isBusy, isOpen, mayMove, now, resetNow, running } from "./machine";
import { alarmText, endText, stateText, waitText } from "./words";

const kAxes = ["X", "Y", "Z", "A"];

// A line as the program has it, with the comment that stands before it.
function rawLine(line: number): string {
  const all = (running.value?.text.split("\n") ?? []).slice(Math.max(line - 4, 0), line).map((text) => text.trim()), own = all.pop() ?? "";
  const comment = all.reverse().find((text) => /^[(;]/.test(text)) ?? "";
  return inOrder([own, comment].filter((text) => text !== "").join(" ").slice(0, 200));
}

function tone(): string {
  const { link, state, run } = now.value;
  if (link === "lost" || state === "Alarm" || run?.phase === "fault") return "fault";
  return state === "Hold" || state === "Door" ? "hold" : isBusy.value || state === "Jog" || state === "Home" ? "run" : "";
}

// Where only these work.
function AlarmButtons(): JSX.Element | null {
  if (now.value.state !== "Alarm" && now.value.state !== "Sleep") return null;
  return <div class="machine-buttons">
    {now.value.settings[22] ? <button type="button" class="primary" disabled={!isOpen.value} onClick={() => void commands("$H")}>Home</button> : null}
    <button type="button" disabled={!isOpen.value} onClick={() => void commands("$X")}>Unlock</button>
    <button type="button" onClick={resetNow}>Reset</button>
  </div>;
}

const kAccessories: [RegExp, string][] = [[/[SC]/, "turning"], [/F/, "flood"], [/M/, "mist"]];

function linkText(): string {
  const { checked, resent, refused, port, version } = now.value;
  const kind = checked === null ? "" : checked ? "; each line is numbered and checked, and cut exactly once" : "; plain Grbl: lost bytes are not always noticed";
  const bad = resent + refused > 0 ? `; a noisy line: ${resent} lines sent again, ${refused} reports not shown` : "";
  return `${port}${version ? ` (${version})` : ""}${kind}${bad}`;
}

export function Readout(): JSX.Element {
  const n = now.value, { run } = n, alarm = alarmText(n, codes.value), wait = waitText(n, rawLine), end = endText(n, codes.value);
  const on = kAccessories.filter(([letter]) => letter.test(n.accessories)).map(([, word]) => `, ${word}`).join("");
  return <section class="dro" aria-label="Position and state">
    <p class={`mill-state ${tone()}`} role="status">{stateText(n)}</p>
    {alarm ? <p class="fault" role="alert">{alarm}</p> : null}
    {wait ? <p class="wait" role="alert">{wait}</p> : null}
    {end ? <p class={run?.phase === "done" ? "note" : "fault"} role="status">{end}</p> : null}
    <AlarmButtons />
    <table><thead><tr><th scope="col">Axis</th><th scope="col">Work, mm</th><th scope="col">Machine</th><th scope="col">Zero</th></tr></thead>
      <tbody>{kAxes.slice(0, n.machine.length).map((axis, k) => <tr key={axis}><th scope="row">{axis === "A" ? "A, deg" : axis}</th><td class="place">{fixed(n.work[k]!, 3)}</td><td>{fixed(n.machine[k]!, 3)}</td>
        <td><button type="button" disabled={!mayMove.value} title={`Work zero of ${axis} is here`} onClick={() => void commands(`G10L20P0${axis}0`)}>{`${axis} = 0`}</button></td></tr>)}</tbody></table>
    <p class="note">{`${figure(n.feed, 4)} mm/min, spindle ${figure(n.spindle, 5)}${on}${n.pins ? `, inputs ${n.pins}` : ""}`}</p>
    {run ? <><p class="note">{`Line ${run.at || run.line}; ${run.answered} of ${run.lines} lines taken; ${duration(run.seconds)}`}</p>
      <progress max={1} value={run.fraction} aria-label="How far the program is" /></> : null}
    {n.link === "open" ? <p class="note">{linkText()}</p> : null}
  </section>;
}
