// Decodes the page's data to arrays: the counterpart of host_tools/judge/view/byte_text.hpp, sample_blocks.hpp and path_vertices.hpp.
import { inflate } from "./inflate";
import { kBucket, kBucketStep, kChannels, kEngagementChannel, kSpeedChannel } from "./run_data";
import type { Axis, LeftMap, Run, Stock, Triple } from "./run_data";

// Seven bits in each character, the highest first.
export function bytesOfText(text: string): Uint8Array {
  const out = new Uint8Array(Math.floor(text.length * 7 / 8));
  let held = 0, bits = 0, at = 0;
  for (let k = 0; k < text.length && at < out.length; ++k) {
    held = (held << 7 | text.charCodeAt(k) & 127) & 0x3fff;
    bits += 7;
    if (bits >= 8) {
      bits -= 8;
      out[at++] = held >> bits & 255;
    }
  }
  return out;
}

export class Reader {
  private at = 0;
  private readonly view: DataView;
  constructor(private readonly bytes: Uint8Array) {
    this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  }
  u8(): number { return this.bytes[this.at++]; }
  u32(): number { this.at += 4; return this.view.getUint32(this.at - 4, true); }
  f64(): number { this.at += 8; return this.view.getFloat64(this.at - 8, true); }
  varint(): number {
    let value = 0, scale = 1, byte: number;
    do {
      byte = this.bytes[this.at++];
      value += (byte & 127) * scale;
      scale *= 128;
    } while (byte > 127);
    return value;
  }
  take(count: number): Uint8Array { this.at += count; return this.bytes.subarray(this.at - count, this.at); }
  rest(): Uint8Array { return this.bytes.subarray(this.at); }
}

const zigzag = (value: number) => value % 2 ? -(value + 1) / 2 : value / 2;

export interface Samples { ticks: number; origin: Triple; axes: [Axis, Axis, Axis] }

// Stretches of a block that repeat earlier ticks: [ticks before it without repetition, its ticks, distance in ticks].
function readRepetitions(reader: Reader): Triple[] {
  return Array.from({ length: reader.varint() }, () => [reader.varint(), reader.varint(), reader.varint()]);
}

// Third differences from `depth` byte planes of `count` values that start at `at`.
function thirds(planes: Uint8Array, at: number, depth: number, count: number): Int32Array | Float64Array {
  const out = depth < 4 ? new Int32Array(count) : new Float64Array(count);
  for (let plane = 0, scale = 1; plane < depth; ++plane, scale *= 256) {
    for (let k = 0, from = at + plane * count; k < count; ++k) out[k] += planes[from + k] * scale;
  }
  if (out instanceof Int32Array) for (let k = 0; k < count; ++k) out[k] = out[k] >> 1 ^ -(out[k] & 1);
  else for (let k = 0; k < count; ++k) out[k] = zigzag(out[k]);
  return out;
}

// Sums third differences up to the places of ticks begin to end; repeated ticks take the differences of earlier ones.
function sumThirds(out: Axis, begin: number, end: number, start: Triple, third: Int32Array | Float64Array, repetitions: Triple[]): void {
  let [place, velocity, acceleration] = start;
  const placeAt = (tick: number) => out[Math.max(tick, 0)];
  out[begin] = place;
  for (let r = 0, tick = begin + 1, k = 0; r <= repetitions.length; ++r) {
    const [before, repeated, ago] = r < repetitions.length ? repetitions[r] : [end - tick, 0, 0];
    for (const to = tick + before; tick < to; ++tick, ++k) {
      acceleration += third[k];
      velocity += acceleration;
      place += velocity;
      out[tick] = place;
    }
    // Before the first tick nothing moves.
    for (const to = tick + repeated; tick < to; ++tick) {
      const at = tick - ago;
      acceleration += at >= 3 ? out[at] - out[at - 3] + 3 * (out[at - 2] - out[at - 1])
        : placeAt(at) - placeAt(at - 3) + 3 * (placeAt(at - 2) - placeAt(at - 1));
      velocity += acceleration;
      place += velocity;
      out[tick] = place;
    }
  }
}

export async function unpackSamples(bytes: Uint8Array, farthest: number): Promise<Samples> {
  const reader = new Reader(bytes);
  const ticks = reader.u32(), block = reader.u32();
  const make = () => farthest < 2 ** 31 ? new Int32Array(ticks) : new Float64Array(ticks);
  const axes: [Axis, Axis, Axis] = [make(), make(), make()];
  const origin: Triple = [0, 0, 0];
  for (let begin = 0; begin < ticks; begin += block) {
    const end = Math.min(ticks, begin + block);
    const seeds = [0, 1, 2].map(() => [reader.f64(), reader.f64(), reader.f64(), reader.u8()]);
    const packed = new Reader(await inflate(reader.take(reader.u32())));
    const repetitions = readRepetitions(packed), planes = packed.rest();
    const count = repetitions.reduce((left, [, repeated]) => left - repeated, end - begin - 1);
    for (let axis = 0, at = 0; axis < 3; ++axis) {
      const [place, velocity, acceleration, depth] = seeds[axis];
      if (begin === 0) origin[axis] = place;
      sumThirds(axes[axis], begin, end, [place - origin[axis], velocity, acceleration], thirds(planes, at, depth, count), repetitions);
      at += depth * count;
    }
  }
  return { ticks, origin, axes };
}

export function unpackLineRuns(bytes: Uint8Array): Pick<Run, "runStart" | "runLine"> {
  const reader = new Reader(bytes), count = reader.u32();
  const runStart = new Uint32Array(count + 1), runLine = new Uint32Array(count);
  for (let k = 0, line = 0; k < count; ++k) {
    runStart[k + 1] = runStart[k] + reader.varint();
    line += zigzag(reader.varint());
    runLine[k] = line;
  }
  return { runStart, runLine };
}

export function unpackPath(bytes: Uint8Array): Pick<Run, "vertexTick" | "vertexLevel" | "vertexDeviation"> {
  const reader = new Reader(bytes), count = reader.u32();
  const vertexTick = new Uint32Array(count);
  for (let k = 0, tick = 0; k < count; ++k) vertexTick[k] = tick += reader.varint();
  const vertexLevel = reader.take(count).slice(), deviations = reader.take(2 * count);
  const vertexDeviation = new Float32Array(count);
  for (let k = 0; k < count; ++k) vertexDeviation[k] = (deviations[2 * k] + 256 * deviations[2 * k + 1]) * 1e-5;
  return { vertexTick, vertexLevel, vertexDeviation };
}

// Lines end with \n, the last one too.
export function lineStarts(program: Uint8Array): Uint32Array {
  let count = 0;
  for (const byte of program) count += byte === 10 ? 1 : 0;
  const out = new Uint32Array(count + 1);
  for (let k = 0, line = 0; k < program.length; ++k) if (program[k] === 10) out[++line] = k + 1;
  return out;
}

// Peaks of all channels, and the values that colour the vertices of the path.
export function measure(samples: Samples, vertexTick: Uint32Array, limits: Triple[], engagement: Uint8Array | null) {
  const { ticks, axes } = samples;
  const peaks: Float32Array[][] = [];
  const make = (count: number) => Array.from({ length: kChannels }, () => new Float32Array(count));
  const level = make(Math.ceil(ticks / kBucket));
  peaks.push(level);
  const vertexSpeed = new Float32Array(vertexTick.length), vertexShare = new Float32Array(vertexTick.length);
  for (let axis = 0; axis < 3; ++axis) {
    const places = axes[axis], velocities = level[axis], accelerations = level[3 + axis], jerks = level[6 + axis];
    // fractions of the limits for a nanometre per tick, tick^2, tick^3
    const ofV = 1e-3 / limits[0][axis], ofA = 1 / limits[1][axis], ofJ = 1e3 / limits[2][axis];
    let place = places[0], velocity = 0, acceleration = 0, vertex = 0, share = 0;
    // Stretches that end at a vertex or with a bucket: the loop inside only finds maxima.
    for (let k = 0; k < ticks;) {
      const bucket = k / kBucket | 0, atVertex = vertexTick[vertex] + 1;
      const end = Math.min((bucket + 1) * kBucket, ticks, vertex < vertexTick.length ? atVertex : ticks);
      let v = 0, a = 0, j = 0;
      for (; k < end; ++k) {
        const nextVelocity = places[k] - place, nextAcceleration = nextVelocity - velocity;
        const speed = Math.abs(nextVelocity), push = Math.abs(nextAcceleration), jerk = Math.abs(nextAcceleration - acceleration);
        if (speed > v) v = speed;
        if (push > a) a = push;
        if (jerk > j) j = jerk;
        place = places[k]; velocity = nextVelocity; acceleration = nextAcceleration;
      }
      velocities[bucket] = Math.max(velocities[bucket], v * 1e-3);
      accelerations[bucket] = Math.max(accelerations[bucket], a);
      jerks[bucket] = Math.max(jerks[bucket], j * 1e3);
      share = Math.max(share, v * ofV, a * ofA, j * ofJ);
      if (k >= atVertex) {
        vertexShare[vertex] = Math.max(vertexShare[vertex], share);
        ++vertex;
        share = 0;
      }
    }
  }
  const [x, y, z] = axes, speeds = level[kSpeedChannel];
  const squareAt = (k: number) => (x[k] - x[k - 1]) ** 2 + (y[k] - y[k - 1]) ** 2 + (z[k] - z[k - 1]) ** 2;
  for (let k = 1, bucket = 0; k < ticks; ++bucket) {
    let square = 0;
    for (const end = Math.min((bucket + 1) * kBucket, ticks); k < end; ++k) {
      const next = squareAt(k);
      if (next > square) square = next;
    }
    speeds[bucket] = Math.sqrt(square) * 1e-3;
  }
  for (let vertex = 0; vertex < vertexTick.length; ++vertex) {
    if (vertexTick[vertex] > 0) vertexSpeed[vertex] = Math.sqrt(squareAt(vertexTick[vertex])) * 1e-3;
  }
  if (engagement) level[kEngagementChannel].set(engagement);
  while (peaks[peaks.length - 1][0].length > 512) {
    const fine = peaks[peaks.length - 1], coarse = make(Math.ceil(fine[0].length / kBucketStep));
    for (let c = 0; c < kChannels; ++c) {
      for (let k = 0; k < fine[c].length; ++k) {
        const at = k / kBucketStep | 0;
        if (fine[c][k] > coarse[c][at]) coarse[c][at] = fine[c][k];
      }
    }
    peaks.push(coarse);
  }
  return { peaks, vertexSpeed, vertexShare };
}

const joined = (planes: Uint8Array, at: number, count: number, k: number) => planes[at + k] + 256 * planes[at + count + k];

export async function unpackStock(bytes: Uint8Array): Promise<Stock> {
  const reader = new Reader(bytes);
  const nx = reader.u32(), ny = reader.u32(), count = reader.u32();
  const [x0, y0, pitch, low, high] = [0, 0, 0, 0, 0].map(() => reader.f64());
  const frameTicks = new Float64Array(count - 1).map(() => reader.f64());
  const planes = await inflate(reader.rest()), size = nx * ny;
  const frames = [new Uint16Array(size).fill(high > low ? 65535 : 0)];
  for (let f = 1; f < count; ++f) {
    const next = frames[f - 1].slice(), at = (f - 1) * 2 * size;
    for (let k = 0; k < size; ++k) next[k] -= planes[at + k] + 256 * planes[at + size + k];
    frames.push(next);
  }
  return { nx, ny, x0, y0, pitch, low, high, frameTicks, frames };
}

export async function unpackLeft(bytes: Uint8Array, size: number): Promise<LeftMap> {
  const reader = new Reader(bytes), low = reader.f64(), high = reader.f64();
  const planes = await inflate(reader.rest());
  const part = new Float32Array(size), left = new Float32Array(size);
  for (let k = 0; k < size; ++k) {
    const z = joined(planes, 0, size, k), over = joined(planes, 2 * size, size, k) << 16 >> 16;
    part[k] = z === 65535 ? NaN : low + (high - low) * z / 65534;
    left[k] = over === -32768 ? NaN : over === 32767 ? Infinity : over * 1e-4;
  }
  return { part, left };
}
