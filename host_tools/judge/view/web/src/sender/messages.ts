// Messages between the page and the worker that sends.
import type { Outcome } from "./dialogue";
import type { ProgramLine } from "./program_run";
import type { Snapshot } from "./snapshot";
import type { Place } from "./status_report";

/** Facts from which the planners resume a program. */
export interface ResumeFacts { start: string[]; startPlace: Place; now: string[]; place: Place }

export type ToSender =
  | { kind: "mill"; module: WebAssembly.Module; settings: string; plate: number | null; rate: number }
  /** The port of that place in the browser's list, or its streams where the worker has none. */
  | { kind: "serial"; index: number; name: string; baud: number }
  | { kind: "streams"; readable: ReadableStream<Uint8Array>; writable: WritableStream<Uint8Array>; name: string }
  | { kind: "close" }
  | { kind: "rate"; rate: number }
  | { kind: "begin"; id: number; lines: ProgramLine[] }
  | { kind: "goOn"; id: number }
  | { kind: "command"; id: number; text: string }
  | { kind: "refresh"; id: number }
  | { kind: "facts"; id: number }
  | { kind: "realtime"; byte: number }
  | { kind: "hold" | "resume" | "stop" | "reset" | "forget" }
  | { kind: "jogStep"; direction: number[]; distance: number; feed: number }
  | { kind: "jogBegin"; direction: number[]; feed: number }
  | { kind: "jogKeep" | "jogEnd" };

/** Of the virtual mill alone: what its iron did. */
export interface MillPicture { edges: string; at: Place }

export type FromSender =
  | { kind: "news"; now: Snapshot; mill: MillPicture | null }
  | { kind: "done"; id: number; outcome: Outcome | ResumeFacts | null; refusal: string }
  /** The worker has no such port: the page opens it, and gives its streams. */
  | { kind: "wantsStreams" }
  /** The worker has left the streams. */
  | { kind: "closed" };
