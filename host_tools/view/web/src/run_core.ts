// The firmware's own core, run in the page.

export interface RunResult {
  duration_s: number; steps: [number, number, number]; end_mpos_mm: [number, number, number];
  errors: { line: number; code: number; text: string }[]; edges_crc32: string;
}

export const runCore: (text: string, settings: string) => Promise<RunResult> =
  () => Promise.reject(new Error("this page was built without the firmware's core"));
