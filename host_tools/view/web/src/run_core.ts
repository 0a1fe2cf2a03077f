// The firmware's own core, run in the page.
export { runProgram as runCore } from "./core/run_program";
export type { RunResult } from "./core/core";
