// The firmware's core: a typed interface to the WebAssembly module, independent of page and worker; also for node.

/** An answer that ended a run, or settings that are refused. */
export interface RunError {
  /** The text to which the line belongs. */
  in: "program" | "settings";
  /** From 1; 0: no line. */
  line: number;
  /** Grbl's error code; 0: not an error of the firmware. */
  code: number;
  /** As `cusp sim` prints it after file and line. */
  text: string;
}

/** The figures of a run: names and units of `cusp sim --stats`. */
export interface RunResult {
  duration_s: number;
  total_s: number;
  lines: number;
  moves: { rapid: number; line: number; arc: number; nurbs: number };
  steps: [number, number, number];
  end_mpos_mm: [number, number, number];
  length_mm: number;
  max_velocity: [number, number, number];
  max_acceleration: [number, number, number];
  max_jerk: [number, number, number];
  pauses: number;
  /** Grbl's alarm code; null: none. */
  alarm: number | null;
  /** CRC-32 of all edges of the step and direction lines, eight hex digits. */
  edges_crc32: string;
  errors: RunError[];
}

/** Lines `$N=v`, as in a settings file; or numbers by name: {"$110": 3000}. */
export type Settings = string | Record<string, number>;

/** Progress of a run. */
export interface Progress {
  /** Fraction of the program's text, 0 to 1. */
  fraction: number;
  /** The line sent last. */
  line: number;
  simulated_s: number;
}

/** Greatest magnitudes over time: PROFILE_FIELDS numbers for each stretch. */
export type Profile = Float64Array;
export const PROFILE_FIELDS = 12;
/** Numbers of a set point: x, y, z in mm, line of the program. */
export const POINT_FIELDS = 4;

/** A setting of the firmware. */
export interface SettingEntry {
  number: number;
  standard: number;
  least: number;
  most: number;
  decimals: number;
}

interface Exports {
  memory: WebAssembly.Memory;
  _initialize(): void;
  cusp_text(size: number): number;
  cusp_take_settings(): void;
  cusp_run_begin(withSetPoints: number): number;
  cusp_run_advance(ticks: number): number;
  cusp_run_fraction(): number;
  cusp_run_line(): number;
  cusp_run_seconds(): number;
  cusp_set_points(): number;
  cusp_set_point_count(): number;
  cusp_profile(): number;
  cusp_profile_count(): number;
  cusp_figures(): number;
  cusp_errors(): number;
  cusp_errors_size(): number;
  cusp_settings(): number;
  cusp_setting_count(): number;
}

const FIGURES = 26;
const NOT_SUPPORTED = 58;

export function settingsText(settings: Settings): string {
  if (typeof settings === "string") return settings;
  return Object.entries(settings).map(([name, value]) => `${name}=${value}\n`).join("");
}

/** A new instance of the module: its functions. File functions that the C library imports refuse every call. */
export function instanceOf(module: WebAssembly.Module): WebAssembly.Exports {
  const refuse = () => NOT_SUPPORTED;
  const imports = Object.fromEntries(WebAssembly.Module.imports(module).map((i) => [i.name, refuse]));
  const exports = new WebAssembly.Instance(module, { wasi_snapshot_preview1: imports }).exports;
  (exports as unknown as { _initialize(): void })._initialize();
  return exports;
}

/** One instance of the module: one run at a time. Unusable after a trap. */
export class Core {
  private readonly exports: Exports;

  constructor(module: WebAssembly.Module) {
    this.exports = instanceOf(module) as unknown as Exports;
  }

  /** Starts a run. False: the settings are refused, see result(). */
  begin(text: string, settings: Settings, withSetPoints: boolean): boolean {
    this.put(settingsText(settings));
    this.exports.cusp_take_settings();
    this.put(text);
    return this.exports.cusp_run_begin(withSetPoints ? 1 : 0) !== 0;
  }

  /** Advances at most so many servo ticks of a millisecond. Returns false at the end of the run. */
  advance(ticks: number): boolean {
    return this.exports.cusp_run_advance(ticks) !== 0;
  }

  progress(): Progress {
    const e = this.exports;
    return { fraction: e.cusp_run_fraction(), line: e.cusp_run_line(), simulated_s: e.cusp_run_seconds() };
  }

  /** The set points of the last advance(): a copy. */
  setPoints(): Float64Array {
    return this.doubles(this.exports.cusp_set_points(), POINT_FIELDS * this.exports.cusp_set_point_count());
  }

  profile(): Profile {
    const count = this.exports.cusp_profile_count();
    return this.doubles(this.exports.cusp_profile(), PROFILE_FIELDS * count);
  }

  settings(): SettingEntry[] {
    const count = this.exports.cusp_setting_count();
    const all = this.doubles(this.exports.cusp_settings(), 5 * count);
    return Array.from({ length: count }, (_, i) => {
      const [number, standard, least, most, decimals] = all.subarray(5 * i, 5 * i + 5) as unknown as
        [number, number, number, number, number];
      return { number, standard, least, most, decimals };
    });
  }

  result(): RunResult {
    const f = this.doubles(this.exports.cusp_figures(), FIGURES);
    const at = (k: number) => f[k] ?? 0;
    const axes = (k: number): [number, number, number] => [at(k), at(k + 1), at(k + 2)];
    return {
      duration_s: at(0), total_s: at(1), lines: at(2),
      moves: { rapid: at(20), line: at(21), arc: at(22), nurbs: at(23) },
      steps: axes(4), end_mpos_mm: axes(7), length_mm: at(10),
      max_velocity: axes(11), max_acceleration: axes(14), max_jerk: axes(17),
      pauses: at(24), alarm: at(25) === 0 ? null : at(25),
      edges_crc32: at(3).toString(16).padStart(8, "0"), errors: this.errors(),
    };
  }

  private errors(): RunError[] {
    const bytes = new Uint8Array(this.exports.memory.buffer, this.exports.cusp_errors(), this.exports.cusp_errors_size());
    return new TextDecoder().decode(bytes.slice()).split("\n").filter((line) => line !== "").map((line) => {
      const [origin, number, code, ...text] = line.split("\t");
      return { in: origin === "s" ? "settings" : "program", line: Number(number), code: Number(code), text: text.join("\t") };
    });
  }

  private put(text: string) {
    const bytes = new TextEncoder().encode(text);
    const place = this.exports.cusp_text(bytes.length);
    new Uint8Array(this.exports.memory.buffer, place, bytes.length).set(bytes);
  }

  private doubles(place: number, count: number): Float64Array {
    return new Float64Array(this.exports.memory.buffer, place, count).slice();
  }
}
