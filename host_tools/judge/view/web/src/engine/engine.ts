// The engine's calls as the page makes them, whoever answers: planners beside the server, or in the page.

/** Files of a job in memory: the path as the job spells it, and its bytes. */
export type FileSet = ReadonlyMap<string, Uint8Array>;

/** A fault in parts, as far as they are known. `place`: the table, such as "operation 2 (drill)"; "": the top of the job. */
export interface Fault { text: string; file?: string; line?: number; place?: string; key?: string; value?: string; limit?: string }

export interface EngineFacts { kind: "native" | "wasm"; threads: number; version: string }

export interface PlannedProgram { name: string; setup: string; block: string; summary: string; warnings: string[] }

export interface PlacedTool { number: number; name: string; shape: string; radius: number; corner_radius: number }

/** Null: as the part has it. */
export interface Stock { x: [number, number] | null; y: [number, number] | null; top: number; bottom: number | null }

export interface Setup {
  name: string; stock: Stock;
  tools: PlacedTool[]; operations: { number: number; strategy: string; tool: number }[]; facets?: { triangles: number; block: string };
}

/** An option of a suggestion; `type` is its value in words, or a unit: LENGTH, FEED, RPM, DEGREES. */
export interface SuggestKey { name: string; kind: "number" | "text" | "numbers" | "texts"; type: string; help: string; choices: string[]; use: "any" | "surfaces" | "drawings" }
export interface StrategyFacts { name: string; help: string; one_line: boolean; is_pocket: boolean; surfaces: boolean; keys: string[] }

/** Texts of Grbl's codes, by their numbers. */
export type CodeTexts = Record<string, string>;

/** How a program is resumed: places in its coordinates, mm. */
export interface Way { line: number; tool: number; point: [number, number, number]; travel_z: number; plunges: boolean; plunge_feed: number; spindle: number }

/** Arguments and results of each call; host_tools/cam/engine/engine.hpp describes them. Lengths are in mm. */
export interface Calls {
  keys: { args: Record<string, never>; result: { version: string; threads: number; cad: boolean; schema: unknown; strategies: StrategyFacts[]; suggest: SuggestKey[]; posts: string[]; errors: CodeTexts; alarms: CodeTexts } };
  describe: {
    args: { files: string[]; units?: string; facets?: boolean };
    result: { text: string; facets?: { file: string; triangles: number; block: string }[] };
  };
  suggest: { args: Record<string, unknown>; result: { job: string; said: string[] } };
  check: { args: { job: string; name: string; facets?: boolean }; result: { faults: Fault[]; warnings: { text: string }[]; setups?: Setup[] } };
  plan: { args: { job: string; name: string; program: string }; result: { programs: PlannedProgram[]; warnings: string[] } };
  run: {
    args: { program: string; settings?: string; job?: string; name?: string; after?: string[]; page: boolean };
    result: { good: boolean; facts?: unknown; verdict?: string; faults: { line: number; text: string }[] };
  };
  send: {
    args: { program: string; numbers: boolean; line?: number; safe_z?: number; start?: string[]; start_place?: number[]; now?: string[]; place?: number[] };
    result: { lines: number; block: string; way?: Way };
  };
}

export interface Answer<R> { result: R; blocks: Map<string, Uint8Array> }

export interface CallOptions {
  /** The share, 0 to 1, of the piece of work that `text` names. */
  progress?: (share: number, text: string) => void;
  /** Aborting it ends the call: the promise is rejected with an AbortError. */
  signal?: AbortSignal;
}

export interface Engine {
  facts(): Promise<EngineFacts>;
  /** Rejects with an EngineError where the call has no result. */
  call<K extends keyof Calls>(name: K, args: Calls[K]["args"], files: FileSet, options?: CallOptions): Promise<Answer<Calls[K]["result"]>>;
}

export type ErrorKind = "input" | "cancelled" | "memory" | "internal";

export class EngineError extends Error {
  constructor(readonly kind: ErrorKind, readonly fault: Fault) {
    super(fault.text);
  }
}

/** The answer of an engine, as JSON. */
export type AnswerLine<R> = { ok: true; result: R } | { ok: false; error: Fault & { kind: ErrorKind } };

export function resultOf<R>(answer: AnswerLine<R>): R {
  if (answer.ok) return answer.result;
  const { kind, ...fault } = answer.error;
  throw new EngineError(kind, fault);
}

export const isAbort = (reason: unknown): boolean => reason instanceof DOMException && reason.name === "AbortError";
export const textOf = (reason: unknown): string => reason instanceof Error ? reason.message : String(reason);
