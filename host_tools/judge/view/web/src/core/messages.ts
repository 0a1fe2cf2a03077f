// Messages between page and worker.
import type { Profile, Progress, RunResult, Settings } from "./core";

export interface ToWorker {
  module: WebAssembly.Module;
  text: string;
  settings: Settings;
  /** True if path and profile are requested. */
  withPath: boolean;
}

export type FromWorker =
  | { kind: "progress"; progress: Progress }
  | { kind: "done"; result: RunResult; path: Float64Array | null; profile: Profile | null }
  | { kind: "failed"; reason: string };
