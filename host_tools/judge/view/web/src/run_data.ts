// The data of a run in a page: the figures written by `cusp view`, and the arrays that the worker unpacks.

export type Triple = [number, number, number];

export interface WorstPlace { kind: "gouge" | "left" | "uncut"; mm: number; at: Triple }

// The contract of `window.cusp.facts`; mm and s.
export interface MainFacts {
  duration_s: number; moves: number; ticks: number; length_mm: number;
  max_velocity: Triple; max_acceleration: Triple; max_jerk: Triple;
  gouge_max_mm?: number; scallop_max_mm?: number; worst?: WorstPlace[];
}

export interface ToolFacts {
  number: number; time_s: number;
  shape?: "ball" | "flat" | "bull" | "vee" | "drill" | "taper"; radius?: number; corner_radius?: number;
  tip_angle?: number; tip_radius?: number;  // of a cone: radians, mm
  flute_length?: number; length?: number; shank_diameter?: number; holder?: [number, number][];  // diameter, length; mm
  cut_length_mm?: number; cut_depth_max_mm?: number;
}

export interface RefusedLine { line: number; begin: number; end: number; code: number; text: string }
export interface Section { line: number; tool: number; title: string }

export interface Verification {
  floor_tolerance: number; plan_tolerance: number; scallop_bound_mm: number | null;
  gouge_max_mm: number; ball_gouge_max_mm: number | null; wall_gouge_max_mm: number | null;
  rapid_cut_max_mm: number; rapid_cut_bound_mm: number; scallop_max_mm: number; scallop_p99_mm: number;
  uncovered_share: number; uncovered_bound: number; uncut_share: number; unreachable_share: number;
  cut_depth_max_mm: number; left_volume_mm3: number; broken: string[];
  engagement?: { max_deg: number; limited_max_deg: number | null; line: number; limit_deg: number | null; over_mm: number | null; air_mm: number };
}

// host_tools/judge/view/run_facts.cpp writes it.
export interface PageFacts {
  program: string; job: string | null; start_us: number; farthest_nm: number;
  limits: { velocity: Triple; acceleration: Triple; jerk: Triple };
  facts: MainFacts;
  run: {
    total_s: number; lines: number; rapids: number; lines_moved: number; arcs: number; nurbs: number;
    max_deviation_mm: number; max_deviation_line: number; pauses: number; alarm: number; stopped: boolean;
    errors: { line: number; code: number; text: string }[];
  };
  tools: ToolFacts[];
  reading: { refused: RefusedLine[]; refused_count: number; sections: Section[]; header: string[] };
  not_verified: string;
  verification?: Verification;
}

export type Axis = Int32Array | Float64Array;

// Greatest absolute values in buckets of ticks: kBucket ticks at level 0, kBucketStep times more at each further level.
export const kBucket = 16;
export const kBucketStep = 8;
// Channels: velocity X Y Z, acceleration X Y Z, jerk X Y Z, speed along the path; mm and s. Then the engagement, degrees.
export const kChannels = 11;
export const kSpeedChannel = 9;
export const kEngagementChannel = 10;

export interface Stock {
  nx: number; ny: number; x0: number; y0: number; pitch: number; low: number; high: number;
  frameTicks: Float64Array;  // of frames 1 and on
  frames: Uint16Array[];     // heights in steps of (high - low) / 65535, y within x
}

export interface LeftMap {
  part: Float32Array;  // z, NaN: none
  left: Float32Array;  // mm, NaN: no floor, Infinity: uncut
}

export interface Run {
  ticks: number;
  origin: Triple;             // nm
  axes: [Axis, Axis, Axis];   // nm from the origin, one value for each tick
  runStart: Uint32Array;      // ticks at which the line changes, and the number of ticks
  runLine: Uint32Array;
  vertexTick: Uint32Array;
  vertexLevel: Uint8Array;
  vertexSpeed: Float32Array;  // mm/s
  vertexShare: Float32Array;  // greatest fraction of the axes' limits since the previous vertex
  vertexDeviation: Float32Array;  // mm, likewise
  program: Uint8Array;
  lineStart: Uint32Array;     // byte of line k at k - 1, and the number of bytes
  rapid: Uint8Array;          // of line k at k
  peaks: Float32Array[][];    // [level][channel]
  engagement: Uint8Array | null;  // greatest of each kBucket ticks, degrees
  stock: Stock | null;
  left: LeftMap | null;
}

// The first index in ascending `values` with values[index] > x.
export function upperBound(values: ArrayLike<number>, x: number): number {
  let low = 0, high = values.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (values[middle] > x) high = middle; else low = middle + 1;
  }
  return low;
}
