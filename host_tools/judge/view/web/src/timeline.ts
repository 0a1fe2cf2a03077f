// Position of the cursor and its listeners: the only state that all parts of the page share.
import { kBucket, upperBound } from "./run_data";
import type { PageFacts, Run, Section, Triple } from "./run_data";

export interface RunState {
  t_s: number; line: number; position_mm: Triple; velocity: Triple; acceleration: Triple; jerk: Triple; tool: number;
  engagement_deg?: number;  // where it is known
}

export class Timeline {
  tick: number;
  playing = false;
  rate = 1;  // seconds of the run a second
  private readonly listeners: (() => void)[] = [];
  private exact = 0;  // tick, while playing
  private lastFrame = 0;
  private intervals: Map<number, [number, number]> | null = null;

  constructor(readonly run: Run, readonly facts: PageFacts) {
    this.tick = run.ticks - 1;
  }

  onChange(listener: () => void): void { this.listeners.push(listener); }
  private tell(): void { for (const listener of this.listeners) listener(); }

  timeOf(tick: number): number { return (this.facts.start_us + tick * 1000) * 1e-6; }
  tickOf(t_s: number): number {
    const tick = Math.round((t_s * 1e6 - this.facts.start_us) / 1000);
    return Math.min(Math.max(Number.isFinite(tick) ? tick : 0, 0), this.run.ticks - 1);
  }

  seekTick(tick: number): void {
    const next = Math.min(Math.max(Math.round(tick), 0), this.run.ticks - 1);
    this.exact = next;
    if (next !== this.tick) {
      this.tick = next;
      this.tell();
    }
  }

  play(on: boolean): void {
    if (on === this.playing) return;
    if (on && this.tick >= this.run.ticks - 1) this.seekTick(0);
    this.playing = on;
    this.exact = this.tick;
    this.lastFrame = performance.now();
    this.tell();
    if (on) requestAnimationFrame((now) => this.frame(now));
  }

  private frame(now: number): void {
    if (!this.playing) return;
    // A delayed frame continues from the last position.
    this.exact += Math.min(now - this.lastFrame, 250) * this.rate;
    this.lastFrame = now;
    const tick = Math.min(Math.floor(this.exact), this.run.ticks - 1), moved = tick !== this.tick;
    this.tick = tick;
    if (tick >= this.run.ticks - 1) this.playing = false;
    if (moved || !this.playing) this.tell();
    if (this.playing) requestAnimationFrame((next) => this.frame(next));
  }

  place(tick: number): Triple {
    const { axes, origin } = this.run;
    return [0, 1, 2].map((c) => (axes[c][tick] + origin[c]) * 1e-6) as Triple;
  }

  lineOf(tick: number): number { return this.run.runLine[upperBound(this.run.runStart, tick) - 1]; }

  sectionOf(line: number): Section {
    const { sections } = this.facts.reading;
    let found = sections[0];
    for (const section of sections) if (section.line <= line) found = section;
    return found;
  }

  state(): RunState {
    const { axes } = this.run, line = this.lineOf(this.tick);
    const at = (c: number, back: number) => axes[c][Math.max(this.tick - back, 0)];
    const each = (value: (c: number) => number) => [0, 1, 2].map(value) as Triple;
    return {
      t_s: this.timeOf(this.tick), line, position_mm: this.place(this.tick),
      velocity: each((c) => (at(c, 0) - at(c, 1)) * 1e-3),
      acceleration: each((c) => at(c, 0) - 2 * at(c, 1) + at(c, 2)),
      jerk: each((c) => (at(c, 0) - 3 * at(c, 1) + 3 * at(c, 2) - at(c, 3)) * 1e3),
      tool: this.sectionOf(line).tool,
      ...this.run.engagement ? { engagement_deg: this.run.engagement[Math.floor(this.tick / kBucket)] } : {},
    };
  }

  // First and last tick of the longest stretch that executes a program line.
  ticksOfLine(line: number): [number, number] | null {
    if (!this.intervals) {
      this.intervals = new Map();
      const { runLine, runStart } = this.run;
      for (let k = 0; k < runLine.length; ++k) {
        const known = this.intervals.get(runLine[k]);
        if (!known || runStart[k + 1] - runStart[k] > known[1] - known[0] + 1) {
          this.intervals.set(runLine[k], [runStart[k], runStart[k + 1] - 1]);
        }
      }
    }
    return line > 0 ? this.intervals.get(line) ?? null : null;
  }

  // The next line with a duration, from `line` in a direction.
  neighbourLine(line: number, step: 1 | -1): number | null {
    const last = this.run.lineStart.length - 1;
    for (let next = line + step; next >= 1 && next <= last; next += step) if (this.ticksOfLine(next)) return next;
    return null;
  }
}
