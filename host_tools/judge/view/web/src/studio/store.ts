// State that the steps of the studio share: project, engine, the work at hand, and its results.
import { computed, effect, signal } from "@preact/signals";
import type { Calls, CallOptions, CodeTexts, Engine, Fault, FileSet, Setup } from "../engine/engine";
import { EngineError, isAbort, textOf } from "../engine/engine";
import { placeOfLine } from "../project/job_text";
import type { KeyPlace } from "../project/job_text";
import { filesFor, History, valuesOf } from "../project/project";
import { savedProject, saveProject } from "../project/autosave";
import { KeyTables } from "./keys";

export const history = new History();
export const project = history.now;
export const job = computed(() => valuesOf(project.value.job));
export const inch = computed(() => job.value.values.units === "inch");

export const engine = signal<Engine | null>(null);
export const engineText = signal("");
export const keys = signal<KeyTables | null>(null);
/** Meanings of the controller's codes. */
export const codes = signal<{ errors: CodeTexts; alarms: CodeTexts }>({ errors: {}, alarms: {} });
/** The message of the last action; shown under the steps. */
export const said = signal<{ text: string; bad: boolean } | null>(null);

export interface Work { title: string; text: string; share: number; cancel: () => void }
export const work = signal<Work | null>(null);

/** A triangle soup, nine numbers each, mm. */
export interface Checked { faults: Fault[]; warnings: string[]; setups: Setup[]; facets: Float32Array | null }
export const checked = signal<Checked>({ faults: [], warnings: [], setups: [], facets: null });

export interface Program { name: string; setup: string; summary: string; warnings: string[]; gcode: Uint8Array }
/** The programs of a job, and the project that they were made from. */
export interface Planned { job: string; files: FileSet; programs: Program[] }
export const planned = signal<Planned | null>(null);
export const isStale = computed(() => planned.value !== null && (planned.value.job !== project.value.job || planned.value.files !== project.value.files));

export const kJobName = "job.toml";

export const kinds = {
  surfaces: /\.(step|stp|iges|igs|brep|stl|obj|3mf|png|json)$/i, drawing: /\.(dxf|svg|gbr|ger|gtl|gbl|gko|gm1|drl|xln)$/i, job: /\.toml$/i, zip: /\.zip$/i, program: /\.(ngc|nc|gcode|tap|cnc)$/i,
};

export const say = (text: string, bad = false): void => { said.value = { text, bad }; };

export const floatsOf = (bytes: Uint8Array | undefined): Float32Array | null =>
  bytes ? new Float32Array(bytes.slice().buffer) : null;

/** Runs one piece of work with progress; a second one waits for none: it is refused. Null: it failed or was cancelled. */
export async function working<T>(title: string, act: (options: CallOptions) => Promise<T>): Promise<T | null> {
  if (work.value) return null;
  const stop = new AbortController();
  work.value = { title, text: "", share: 0, cancel: () => stop.abort() };
  said.value = null;
  try {
    return await act({
      signal: stop.signal,
      progress: (share, text) => { if (work.value) work.value = { ...work.value, share, text }; },
    });
  } catch (reason) {
    if (isAbort(reason) || stop.signal.aborted) say(`${title}: cancelled`);
    else {
      say(textOf(reason), true);
      if (reason instanceof EngineError && reason.kind === "input") checked.value = { ...checked.value, faults: [reason.fault] };
    }
    return null;
  } finally {
    work.value = null;
  }
}

export function engineCall<K extends keyof Calls>(name: K, args: Calls[K]["args"], files: FileSet, options?: CallOptions) {
  if (!engine.value) throw new Error(engineText.value || "there are no planners here");
  return engine.value.call(name, args, files, options);
}

/** Where a fault belongs: by its line, or by the table's name and number. */
export function placeOf(fault: Fault): KeyPlace | null {
  const named = /^([a-z]+)(?: (\d+))?/.exec(fault.place ?? "");
  if (named) return { table: named[1], index: named[2] ? Number(named[2]) - 1 : 0, key: fault.key ?? "" };
  const byLine = fault.line && (!fault.file || fault.file === kJobName) ? placeOfLine(project.value.job, fault.line) : null;
  return byLine ? { ...byLine, key: fault.key && byLine.key === "" ? fault.key : byLine.key } : fault.key ? { table: "", index: 0, key: fault.key } : null;
}

export function faultAt(place: KeyPlace): string {
  for (const fault of checked.value.faults) {
    const at = placeOf(fault);
    if (at?.table === place.table && at.index === place.index && at.key === place.key) return fault.text;
  }
  return "";
}

// Reads the job again whenever it has changed, a moment after the last edit.
function checkAfterEdits(): void {
  let stop = new AbortController(), timer = 0;
  effect(() => {
    const { job: text, files } = project.value, ready = engine.value !== null && keys.value !== null;
    stop.abort();
    clearTimeout(timer);
    if (!ready || !/^\s*\[\[?operation/m.test(text)) {
      checked.value = { faults: [], warnings: [], setups: [], facets: null };
      return;
    }
    const mine = stop = new AbortController();
    timer = window.setTimeout(() => void check(mine.signal, { job: text, files }), 350);
  });
}

async function check(signal: AbortSignal, now: { job: string; files: FileSet }): Promise<void> {
  try {
    const { result, blocks } = await engineCall("check", { job: now.job, name: kJobName, facets: true }, filesFor(now), { signal });
    const setups = result.setups ?? [], block = setups.at(0)?.facets?.block;
    checked.value = { faults: result.faults, warnings: result.warnings.map((w) => w.text), setups, facets: floatsOf(block ? blocks.get(block) : undefined) };
  } catch (reason) {
    if (signal.aborted) return;
    const fault = reason instanceof EngineError ? reason.fault : { text: textOf(reason) };
    checked.value = { faults: [fault], warnings: [], setups: [], facets: null };
  }
}

// The project of the last time, and from then on each change a second later.
async function keep(): Promise<void> {
  const last = await savedProject().catch(() => null);
  if (last && project.value.job === "" && project.value.files.size === 0 && (last.job !== "" || last.files.size > 0)) {
    history.change(last);
    say("The project of the last time is open; New begins another.");
  }
  let timer = 0;
  effect(() => {
    const now = project.value;
    clearTimeout(timer);
    timer = window.setTimeout(() => void saveProject(now).catch(() => undefined), 800);
  });
}

/** Connects the studio with its engine. */
export async function start(found: Engine | null): Promise<void> {
  await keep();
  checkAfterEdits();
  if (!found) {
    engineText.value = "This page has no planners of its own: start `cusp studio`, and it opens with them.";
    return;
  }
  try {
    const facts = await found.facts();
    engineText.value = `${facts.version}, ${facts.threads} ${facts.threads === 1 ? "core" : "cores"}`;
    engine.value = found;
    const { result } = await found.call("keys", {}, new Map());
    keys.value = new KeyTables(result);
    codes.value = result;
  } catch (reason) {
    engine.value = null;
    engineText.value = textOf(reason);
    say(textOf(reason), true);
  }
}
