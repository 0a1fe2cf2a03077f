// The machine as the page knows it, and what can be asked of it. Nothing here acts by itself: each function is a person's click.
import { computed, signal } from "@preact/signals";
import { coreModule, hasCore } from "../core/run_program";
import { textOf } from "../engine/engine";
import type { Way } from "../engine/engine";
import { browserSerial } from "../port/serial_port";
import type { BrowserSerialPort } from "../port/serial_port";
import type { MillPicture } from "../sender/messages";
import type { ProgramLine } from "../sender/program_run";
import { Sender } from "../sender/sender";
import { atRest, type Snapshot } from "../sender/snapshot";
import { codes, engineCall, say } from "../studio/store";
import { crcOf, dropRecord, keepRecord, keptRecord } from "./cut_record";
import { errorText } from "./words";

export const now = signal<Snapshot>(atRest);
export const mill = signal<MillPicture | null>(null);
export const rate = signal(1);
export const baud = signal(115200);
/** The program on the machine. */
export const running = signal<{ name: string; text: string } | null>(null);
/** Set where the controller knows $791 and it is 0: the machine holds when this page falls silent. */
export const holdsOnSilence = signal(true);

export const isOpen = computed(() => now.value.link === "open" && now.value.ready);
export const isBusy = computed(() => now.value.run?.phase === "run");
/** Things that were asked for and are not done: nothing else is begun meanwhile. Stop works always. */
const acting = signal(0);
export const mayMove = computed(() => isOpen.value && !isBusy.value && acting.value === 0 && ["Idle", "Jog"].includes(now.value.state));
export const hasSerial = browserSerial() !== null;

const kPlate = -20;          // mm under the virtual mill's tool: a plate to try probing on
const kSilence = 3000;       // ms of $791
const kReadyLimit = 15_000;  // ms
const kKeep = 1000;          // ms between records of a cut

let sender: Sender | null = null;
const watchers = new Set<() => void>();

function theSender(): Sender {
  sender ??= new Sender((news, picture) => {
    [now.value, mill.value] = [news, picture];
    for (const watcher of [...watchers]) watcher();
  }, (why) => {
    now.value = { ...now.value, link: "lost", why };
    say(why, true);
  });
  return sender;
}

/** Starts the worker that sends, so that it is there when a port is opened. */
export const prepare = (): void => { theSender(); };

/** Resolves once it holds, rejects after so many ms. */
export function until(holds: () => boolean, ms: number, what: string): Promise<void> {
  return new Promise((done, fail) => {
    const end = (act: () => void): void => {
      clearTimeout(timer);
      watchers.delete(watcher);
      act();
    };
    const watcher = (): void => { if (holds()) end(done); };
    const timer = window.setTimeout(() => { end(() => { fail(new Error(what)); }); }, ms);
    watchers.add(watcher);
    watcher();
  });
}

/** Says what went wrong. True if nothing did. */
export async function tried(act: () => Promise<unknown>): Promise<boolean> {
  acting.value += 1;
  try {
    await act();
    return true;
  } catch (reason) {
    say(textOf(reason), true);
    return false;
  } finally {
    acting.value -= 1;
  }
}

export const connectMill = (): Promise<boolean> => tried(async () => {
  if (!hasCore) throw new Error("this build of cusp has no virtual mill");
  theSender().tell({ kind: "mill", module: await coreModule(), settings: "", plate: kPlate, rate: rate.value });
});

/** Asks the person for a port, and opens it. */
export const connectSerial = (): Promise<boolean> => tried(async () => {
  const serial = browserSerial();
  if (!serial) throw new Error("this browser has no WebSerial: Chromium, Chrome, Edge and Opera have");
  let port: BrowserSerialPort;
  try {
    port = await serial.requestPort();
  } catch (reason) {
    if (reason instanceof DOMException && reason.name === "NotFoundError") return;  // the person chose none
    throw reason;
  }
  const index = (await serial.getPorts()).indexOf(port), { usbVendorId, usbProductId } = port.getInfo?.() ?? {};
  const hex = (n: number): string => n.toString(16).padStart(4, "0");
  const name = usbVendorId === undefined ? "the serial port" : `the serial port ${hex(usbVendorId)}:${hex(usbProductId ?? 0)}`;
  theSender().openSerial(port, Math.max(index, 0), name, baud.value);
});

export const disconnect = (): void => { sender?.tell({ kind: "close" }); };

export function setRate(value: number): void {
  rate.value = value;
  sender?.tell({ kind: "rate", rate: value });
}

// The lines that go to the controller, as the planners' engine reads the program.
async function linesOf(name: string, text: string, from: object): Promise<{ lines: ProgramLine[]; way: Way | null }> {
  const files = new Map([[name, new TextEncoder().encode(text)]]);
  const { result, blocks } = await engineCall("send", { program: name, numbers: now.value.checked !== true, ...from }, files);
  const lines = new TextDecoder().decode(blocks.get(result.block)).split("\n").filter((line) => line !== "").map((line) => {
    const tab = line.indexOf("\t");
    return { line: Number(line.slice(0, tab)), text: line.slice(tab + 1) };
  });
  return { lines, way: result.way ?? null };
}

async function begin(lines: ProgramLine[], program: { name: string; text: string }): Promise<void> {
  if (holdsOnSilence.value && now.value.settings[791] === 0) await command(`$791=${kSilence}`);
  await theSender().begin(lines);
  running.value = program;
  await recordCut(program);
}

/** The record of a cut that a closed page left; null: none. */
export const left = signal(keptRecord());
export function forgetLeft(): void {
  left.value = null;
  dropRecord();
}

// Keeps the line that the tool has reached, until the program has ended.
async function recordCut({ name, text }: { name: string; text: string }): Promise<void> {
  const { start, startPlace } = await theSender().facts(), crc = crcOf(text);
  left.value = null;
  let before = 0;
  const watch = (): void => {
    const { run } = now.value, at = performance.now();
    if (run?.phase === "done") dropRecord();
    else if (run && (at - before >= kKeep || run.phase !== "run")) {
      before = at;
      keepRecord({ name, crc, line: Math.max(run.executed, 1), start, startPlace });
    }
    if (run?.phase !== "run") watchers.delete(watch);
  };
  watchers.add(watch);
}

/** The program from its beginning. Where nothing is connected, it runs on the virtual mill. */
export const runProgram = (name: string, text: string): Promise<boolean> => tried(async () => {
  if (now.value.link === "none") await connectMill();
  await until(() => isOpen.value, kReadyLimit, "the machine is not ready");
  await begin((await linesOf(name, text, {})).lines, { name, text });
});

/** The way to a line of the program, for a person to look at. The controller is reset for it: it is in its first state then. */
export const wayBack = signal<{ way: Way; lines: ProgramLine[]; name: string; text: string } | null>(null);

export const lookAtLine = (name: string, text: string, line: number): Promise<boolean> => tried(async () => {
  const own = theSender(), isSame = running.value?.name === name && running.value.text === text, before = await own.facts();
  own.tell({ kind: "forget" });
  own.tell({ kind: "reset" });
  await until(() => !isOpen.value, 2000, "the controller was not reset").catch(() => undefined);
  await until(() => isOpen.value, kReadyLimit, "the machine is not ready");
  if (now.value.state === "Alarm") throw new Error(now.value.settings[22] ? "Home the machine first." : "Unlock the machine first, once you know where it is.");
  const { now: listing, place } = await own.facts(), record = left.value?.name === name && left.value.crc === crcOf(text) ? left.value : null;
  const begun = isSame && before.start.length > 0 ? before : record ?? { start: listing, startPlace: place };
  const from = { line, start: begun.start, start_place: begun.startPlace, now: listing, place };
  const { lines, way } = await linesOf(name, text, from);
  wayBack.value = way ? { way, lines, name, text } : null;
});

export const goTheWay = (): Promise<boolean> => {
  const found = wayBack.value;
  wayBack.value = null;
  return tried(async () => { if (found) await begin(found.lines, found); });
};

/** After a lost link: each line is executed once. */
export const goOn = (): Promise<boolean> => tried(() => theSender().goOn());

/** A line to the controller, and what it lists. Rejects with its error in words. */
export async function command(text: string): Promise<string[]> {
  const { error, lines } = await theSender().command(text);
  if (error > 0) throw new Error(`${text}: ${errorText(error, codes.value)}`);
  return lines;
}

/** Several lines, up to the first that is refused. True if all were taken. */
export const commands = (...lines: string[]): Promise<boolean> => tried(async () => {
  for (const line of lines) await command(line);
  await theSender().refresh();
});

export const refresh = (): Promise<null> => theSender().refresh();
export const realtime = (byte: number): void => { sender?.tell({ kind: "realtime", byte }); };
export const hold = (): void => { sender?.tell({ kind: "hold" }); };
export const resume = (): void => { sender?.tell({ kind: "resume" }); };
export const resetNow = (): void => { sender?.tell({ kind: "reset" }); };
/** Works at any time, from any step: holds, then resets; a second time resets at once. */
export const stop = (): void => { sender?.tell({ kind: "stop" }); };

export const jogStep = (direction: number[], distance: number, feed: number): void => { sender?.tell({ kind: "jogStep", direction, distance, feed }); };
let keeping = 0;
/** Jogs until jogEnd(); the machine stops by itself where this page falls silent. */
export function jogBegin(direction: number[], feed: number): void {
  jogEnd();
  sender?.tell({ kind: "jogBegin", direction, feed });
  keeping = window.setInterval(() => { sender?.tell({ kind: "jogKeep" }); }, 80);
}
export function jogEnd(): void {
  if (keeping === 0) return;
  clearInterval(keeping);
  keeping = 0;
  sender?.tell({ kind: "jogEnd" });
}
