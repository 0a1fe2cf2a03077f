// The firmware's core: the WebAssembly module behind types. Knows neither page nor worker; runs under node, too.

/** An answer that ended a run, or settings that are refused. */
export interface RunError {
  /** What the line is of. */
  in: "program" | "settings";
  /** From 1; 0: no line of it. */
  line: number;
  /** Grbl's; 0 where the fault is not the firmware's. */
  code: number;
  /** As `cusp sim` prints it behind file and line. */
  text: string;
}

/** What a run measured: names and units of `cusp sim --stats`. */
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
  /** Grbl's code; null: none. */
  alarm: number | null;
  /** CRC-32 over all edges of the step and direction lines, eight hex digits. */
  edges_crc32: string;
  errors: RunError[];
}

/** `$N=v`, one a line, as a settings file has them; or the numbers by name: {"$110": 3000}. */
export type Settings = string | Record<string, number>;

/** How far a run is. */
export interface Progress {
  /** Of the program's text, 0 to 1. */
  fraction: number;
  /** Of the program, sent last. */
  line: number;
  simulated_s: number;
}

/** Greatest magnitudes over time: PROFILE_FIELDS numbers a stretch. */
export type Profile = Float64Array;
export const PROFILE_FIELDS = 12;
/** Numbers a set point: x, y, z in mm, line of the program. */
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

/** One instance of the module: one run at a time. After a trap it is of no more use. */
export class Core {
  private readonly exports: Exports;

  constructor(module: WebAssembly.Module) {
    // The C library could write messages to files. There are none: every call is refused.
    const refuse = () => NOT_SUPPORTED;
    const imports = Object.fromEntries(WebAssembly.Module.imports(module).map((i) => [i.name, refuse]));
    this.exports = new WebAssembly.Instance(module, { wasi_snapshot_preview1: imports }).exports as unknown as Exports;
    this.exports._initialize();
  }

  /** Begins a run. False: the settings are refused, see result(). */
  begin(text: string, settings: Settings, withSetPoints: boolean): boolean {
    this.put(settingsText(settings));
    this.exports.cusp_take_settings();
    this.put(text);
    return this.exports.cusp_run_begin(withSetPoints ? 1 : 0) !== 0;
  }

  /** At most so many servo ticks, a millisecond each. Returns whether the run goes on. */
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
