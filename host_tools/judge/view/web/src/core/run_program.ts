// Runs programs on the core in a worker, with progress and cancellation; ends even if the module traps.
import base64 from "core-wasm";
import script from "worker:./core_worker.ts";
import { Core, type Profile, type Progress, type RunResult, type SettingEntry, type Settings } from "./core";
import type { FromWorker, ToWorker } from "./messages";

export interface RunOptions {
  progress?: (progress: Progress) => void;
  /** Aborting it stops the run: the promise is rejected with an AbortError. */
  signal?: AbortSignal;
}

/** A run with the data that a page draws. */
export interface DrawnRun {
  result: RunResult;
  path: Float64Array;
  profile: Profile;
}

/** True if this page was built with the core. */
export const hasCore = base64 !== "";

let compiled: Promise<WebAssembly.Module> | null = null;

async function compile(): Promise<WebAssembly.Module> {
  if (!hasCore) throw new Error("cusp was built without the WebAssembly packages: this page has no core to run");
  const bytes = Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
  return WebAssembly.compile(bytes);
}

export function coreModule(): Promise<WebAssembly.Module> {
  compiled ??= compile();
  return compiled;
}

/** The settings of the firmware, with their defaults and ranges. */
export async function settingTable(): Promise<SettingEntry[]> {
  return new Core(await coreModule()).settings();
}

interface Outcome {
  result: RunResult;
  path: Float64Array | null;
  profile: Profile | null;
}

async function inWorker(text: string, settings: Settings, withPath: boolean, options: RunOptions): Promise<Outcome> {
  const module = await coreModule();
  options.signal?.throwIfAborted();
  const url = URL.createObjectURL(new Blob([script], { type: "text/javascript" }));
  const worker = new Worker(url);
  URL.revokeObjectURL(url);
  try {
    return await new Promise<Outcome>((resolve, reject) => {
      options.signal?.addEventListener("abort", () => { reject(new DOMException("the run was stopped", "AbortError")); });
      worker.onerror = (event) => { reject(new Error(`the core failed: ${event.message}`)); };
      worker.onmessage = ({ data }: MessageEvent<FromWorker>) => {
        if (data.kind === "progress") options.progress?.(data.progress);
        else if (data.kind === "done") resolve(data);
        else reject(new Error(`the core failed: ${data.reason}`));
      };
      const message: ToWorker = { module, text, settings, withPath };
      worker.postMessage(message);
    });
  } finally {
    worker.terminate();
  }
}

/** The figures of a run, as `window.cusp.run` returns them. */
export async function runProgram(text: string, settings: Settings = "", options: RunOptions = {}): Promise<RunResult> {
  return (await inWorker(text, settings, false, options)).result;
}

/** The figures with path and profile. */
export async function drawProgram(text: string, settings: Settings, options: RunOptions = {}): Promise<DrawnRun> {
  const { result, path, profile } = await inWorker(text, settings, true, options);
  return { result, path: path ?? new Float64Array(), profile: profile ?? new Float64Array() };
}
