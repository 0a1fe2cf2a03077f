// The npm package: simulate(text, settings) on the core, in node and in browsers.
import { Core, POINT_FIELDS, type Progress, type RunResult, type SettingEntry, type Settings } from "../web/src/core/core";

export type { Progress, RunError, RunResult, SettingEntry, Settings } from "../web/src/core/core";

export interface SimulateOptions {
  /** Called some ten times a second. */
  progress?: (progress: Progress) => void;
  /** Aborting it stops the run: the promise is rejected with its reason. */
  signal?: AbortSignal;
  /** Called with the set points of some hundred servo ticks, POINT_FIELDS numbers each: x, y, z in mm, line. */
  setPoints?: (points: Float64Array) => void;
}

export { POINT_FIELDS };

const SLICE = 500;
const BETWEEN_REPORTS_MS = 100;

let compiled: Promise<WebAssembly.Module> | null = null;

async function compile(): Promise<WebAssembly.Module> {
  const url = new URL("./cusp_core.wasm", import.meta.url);
  if (url.protocol !== "file:") return WebAssembly.compile(await (await fetch(url)).arrayBuffer());
  const { readFile } = await import("node:fs/promises");
  return WebAssembly.compile(await readFile(url));
}

async function newCore(): Promise<Core> {
  compiled ??= compile();
  return new Core(await compiled);
}

/** The settings of the firmware, with their defaults and ranges. */
export async function settingTable(): Promise<SettingEntry[]> {
  return (await newCore()).settings();
}

/**
 * Runs a program through the firmware, faster than real time, and measures it, as `cusp sim` does.
 *
 * Refused settings and lines are in `errors` of the result. The event loop is not blocked.
 */
export async function simulate(text: string, settings: Settings = "", options: SimulateOptions = {}): Promise<RunResult> {
  const core = await newCore();
  options.signal?.throwIfAborted();
  let reportedAt = performance.now();
  let goesOn = core.begin(text, settings, options.setPoints !== undefined);
  while (goesOn) {
    goesOn = core.advance(SLICE);
    options.setPoints?.(core.setPoints());
    if (performance.now() - reportedAt > BETWEEN_REPORTS_MS) {
      options.progress?.(core.progress());
      await new Promise((resolve) => { setTimeout(resolve, 0); });
      options.signal?.throwIfAborted();
      reportedAt = performance.now();
    }
  }
  return core.result();
}
