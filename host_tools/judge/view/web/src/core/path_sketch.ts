// The path of a run with few points: a set point is stored where the path leaves the ray from the last stored one.
import { POINT_FIELDS } from "./core";

/** Numbers of a point: x, y, z in mm, line of the program, seconds from the start. */
export const SKETCH_FIELDS = 5;

const SECONDS_PER_TICK = 0.001;

/** Reumann-Witkam simplification, one set point at a time. If there are too many points, every other one is removed. */
export class PathSketch {
  private kept: number[] = [];
  private last: number[] = [];
  private ray: [number, number, number] | null = null;
  private ticks = 0;

  /** The result is within about `tolerance` mm of the path. */
  constructor(private tolerance = 0.01, private readonly mostPoints = 400_000) {}

  add(points: Float64Array) {
    for (let at = 0; at + POINT_FIELDS <= points.length; at += POINT_FIELDS) {
      const point = [points[at], points[at + 1], points[at + 2], points[at + 3], this.ticks * SECONDS_PER_TICK];
      this.ticks += 1;
      this.take(point);
    }
  }

  /** All points, including the last set point. */
  points(): Float64Array {
    const all = new Float64Array(this.kept.length + this.last.length);
    all.set(this.kept);
    all.set(this.last, this.kept.length);
    return all;
  }

  private take(point: number[]) {
    if (this.kept.length === 0) return this.keep(point);
    const [x, y, z] = this.fromLastKept(point);
    const length = Math.hypot(x, y, z);
    if (this.ray === null) {
      if (length > this.tolerance) this.ray = [x / length, y / length, z / length];
    } else {
      const along = x * this.ray[0] + y * this.ray[1] + z * this.ray[2];
      if (Math.sqrt(Math.max(0, length * length - along * along)) > this.tolerance || point[3] !== this.last[3]) {
        this.keep(this.last);
      }
    }
    this.last = point;
  }

  private fromLastKept(point: number[]): [number, number, number] {
    const base = this.kept.length - SKETCH_FIELDS;
    return [point[0] - this.kept[base], point[1] - this.kept[base + 1], point[2] - this.kept[base + 2]];
  }

  private keep(point: number[]) {
    this.kept.push(...point);
    this.ray = null;
    this.last = point;
    if (this.kept.length > this.mostPoints * SKETCH_FIELDS) this.thin();
  }

  private thin() {
    this.tolerance *= 2;
    this.kept = this.kept.filter((_, i) => Math.floor(i / SKETCH_FIELDS) % 2 === 0);
  }
}
