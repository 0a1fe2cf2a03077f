// The npm package: from parts to verified G-code, in node and in browsers. Each function blocks the thread while it works:
// pages call it in a worker.
import createEngine from "engine-module";
import { Engine, type Answer, type CallOptions, type Fault, type Files, type ModuleMaker } from "./engine";

export { Engine, EngineError, type Answer, type CallOptions, type Fault, type Files, type Progress } from "./engine";

/** Figures by the names of docs/stats.md, in mm, degrees and s. */
export type Stats = Record<string, unknown>;

export interface KeyTable {
  version: string;
  threads: number;
  /** True if STEP, IGES and BREP can be read. */
  cad: boolean;
  /** Of a job, draft-07; each key has `description`, `x-kind`, `x-default`. */
  schema: Record<string, unknown>;
  strategies: { name: string; help: string; one_line: boolean; pocket: boolean; surfaces: boolean; keys: string[] }[];
  posts: string[];
}

export interface PartInfo {
  files: Stats[];
  text: string;
  /** Nine numbers a triangle, mm: x, y, z of its corners. */
  facets: { file: string; triangles: number; corners: Float32Array }[];
}

export interface SuggestOptions extends CallOptions {
  scallop?: number;
  boundary?: string;
  islands?: string[];
  inch?: boolean;
  tolerance?: number;
  max_depth?: number;
  allowance?: number;
  feed?: number;
  plunge_feed?: number;
  spindle?: number;
  stock_top?: number;
  clearance?: number;
  scale?: number;
  up?: string;
  rotate?: number[];
  origin?: "corner" | "centre" | "top";
  move?: number[];
  roughing?: boolean;
  strategy?: string;
  moves?: "lines" | "arcs" | "nurbs";
  post?: string;
}

export interface Program {
  name: string;
  setup: string;
  gcode: string;
  summary: string;
  warnings: string[];
  stats: Stats;
}

export interface PlanOptions extends CallOptions {
  /** Of the job, for messages and the program's first comment: "job.toml". */
  name?: string;
  /** Of the program: "part.ngc"; set-ups add their names. */
  program?: string;
  post?: string;
  blend?: number;
  /** The numbers of the operations to plan; all without it. */
  only?: number[];
}

export interface VerifyOptions extends CallOptions {
  name?: string;
  /** Programs that were cut before, by their names in `files`. */
  after?: string[];
  engagement?: boolean;
  max_engagement?: number;
  grid?: number;
  step?: number;
}

export interface Verification {
  holds: boolean;
  /** Each bound that does not hold, in words. */
  broken: string[];
  text: string;
  stats: Stats;
}

export interface SimulateOptions extends CallOptions {
  /** `$N=v`, one a line. */
  settings?: string;
  dialect?: "cusp" | "grbl";
}

export interface Run {
  good: boolean;
  faults: { line: number; text: string }[];
  /** edges_crc32 among them: that of `cusp sim` and of the controller. */
  stats: Stats;
}

export interface JobCheck {
  faults: Fault[];
  warnings: { text: string }[];
  setups: Record<string, unknown>[];
}

const PROGRAM = "program.ngc";
let shared: Promise<Engine> | null = null;

async function wasm(): Promise<ArrayBuffer | Uint8Array> {
  const url = new URL("./engine.wasm", import.meta.url);
  if (url.protocol !== "file:") return (await fetch(url)).arrayBuffer();
  const { readFile } = await import("node:fs/promises");
  return readFile(url);
}

/** An instance of one's own, whose memory ends with it. `bytes`: engine.wasm, where it does not lie beside the script. */
export async function newEngine(bytes?: ArrayBuffer | Uint8Array): Promise<Engine> {
  return Engine.create(createEngine as ModuleMaker, bytes ?? await wasm());
}

async function call(name: string, args: object, files: Files, options: CallOptions): Promise<Answer> {
  if (shared && !(await shared).isAlive) shared = null;
  shared ??= newEngine();
  return (await shared).call(name, args, files, options);
}

// The options that are arguments.
function given<Options extends CallOptions>(options: Options): Omit<Options, keyof CallOptions> {
  const { progress: _progress, signal: _signal, ...rest } = options;
  return rest;
}

function textOf(answer: Answer, block: string): string {
  return new TextDecoder().decode(answer.blocks.get(block));
}

/** Every key of a job, by which forms can be made. */
export async function keys(): Promise<KeyTable> {
  return (await call("keys", {}, {}, {})).result as KeyTable;
}

/** The content of part files, as `cusp info` says it. */
export async function describe(parts: string[], files: Files, options: CallOptions & { units?: "mm" | "inch"; tolerance?: number } = {}): Promise<PartInfo> {
  const answer = await call("describe", { files: parts, ...given(options) }, files, options);
  const result = answer.result as { files: Stats[]; text: string; facets: { file: string; triangles: number; block: string }[] };
  const facets = result.facets.map(({ file, triangles, block }) => ({ file, triangles, corners: new Float32Array(answer.blocks.get(block)!.buffer) }));
  return { files: result.files, text: result.text, facets };
}

/** A job for parts and tools ("ball:6", the last finishes), as the one-line call of `cusp plan` chooses it. */
export async function suggest(parts: string[], tools: string[], files: Files, options: SuggestOptions = {}): Promise<{ job: string; said: string[] }> {
  return (await call("suggest", { parts, tools, ...given(options) }, files, options)).result as { job: string; said: string[] };
}

/** Reads a job without planning. */
export async function check(job: string, files: Files, options: CallOptions & { name?: string } = {}): Promise<JobCheck> {
  return (await call("check", { job, ...given(options) }, files, options)).result as JobCheck;
}

/** Plans a job (TOML): a program for each set-up, the bytes of `cusp plan`. */
export async function plan(job: string, files: Files, options: PlanOptions = {}): Promise<Program[]> {
  const answer = await call("plan", { job, ...given(options) }, files, options);
  const { programs } = answer.result as { programs: (Omit<Program, "gcode"> & { block: string })[] };
  return programs.map(({ block, ...program }) => ({ ...program, gcode: textOf(answer, block) }));
}

function withProgram(files: Files, gcode: string): Files {
  const all = new Map(files instanceof Map ? files : Object.entries(files)) as Map<string, Uint8Array | string>;
  return all.set(PROGRAM, gcode);
}

/** Cuts the stock of the job in memory and judges what is left, as `cusp verify`. */
export async function verify(job: string, gcode: string, files: Files, options: VerifyOptions = {}): Promise<Verification> {
  const args = { job, program: PROGRAM, ...given(options) };
  return (await call("verify", args, withProgram(files, gcode), options)).result as Verification;
}

/** Runs a program through the firmware's core, as `cusp sim`. */
export async function simulate(gcode: string, options: SimulateOptions = {}): Promise<Run> {
  return (await call("run", { program: PROGRAM, page: false, ...given(options) }, withProgram({}, gcode), options)).result as Run;
}

/** Replaces runs of short lines by arcs and lines within the tolerance, mm. */
export async function fit(gcode: string, tolerance: number, options: CallOptions = {}): Promise<{ gcode: string; stats: Stats }> {
  const answer = await call("fit", { program: PROGRAM, tolerance }, withProgram({}, gcode), options);
  return { gcode: textOf(answer, "gcode"), stats: (answer.result as { stats: Stats }).stats };
}
