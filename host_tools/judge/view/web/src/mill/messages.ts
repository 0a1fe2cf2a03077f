// Messages between the page and the worker that is the virtual mill.

export type MillState = "idle" | "run" | "hold" | "ended" | "stopped" | "fault";

export type ToMill =
  | { kind: "start"; module: WebAssembly.Module; text: string; settings: string; rate: number }
  | { kind: "hold" } | { kind: "resume" } | { kind: "stop" }
  | { kind: "rate"; rate: number };

/** What the mill reports ten times a second. Positions are the machine's, mm. */
export interface MillReport { state: MillState; at: [number, number, number]; speed: number; line: number; seconds: number; fraction: number; text: string; edges: string }
