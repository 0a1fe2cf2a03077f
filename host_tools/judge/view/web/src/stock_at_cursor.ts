// The stock at a tick: the last keyframe before it, cut by the tool from there on.
import type { HeightField } from "./height_field";
import { upperBound } from "./run_data";
import type { Stock } from "./run_data";
import type { Timeline } from "./timeline";
import { profileOf, toolAt } from "./tool_shape";

export class StockAtCursor {
  private shown = -1;  // tick; -1: none
  private frame = -1;

  constructor(private readonly timeline: Timeline, private readonly stock: Stock, private readonly field: HeightField, private readonly centreZ: number) {}

  // Updates the field to the cursor.
  update(): void {
    const tick = this.timeline.tick, frame = upperBound(this.stock.frameTicks, tick);
    if (tick === this.shown) return;
    if (frame !== this.frame || tick < this.shown) {
      const heights = this.stock.frames[frame], scale = (this.stock.high - this.stock.low) / 65535;
      for (let k = 0; k < heights.length; ++k) this.field.heights[k] = this.stock.low + heights[k] * scale - this.centreZ;
      this.shown = frame > 0 ? this.stock.frameTicks[frame - 1] : 0;
      this.frame = frame;
    }
    this.cut(this.shown, tick);
    this.shown = tick;
    this.field.changed();
  }

  private cut(from: number, to: number): void {
    const { timeline, stock } = this, spacing = 0.5 * stock.pitch;
    let last = timeline.place(from);
    for (let tick = from; tick <= to; ++tick) {
      const place = timeline.place(tick);
      if (tick < to && Math.hypot(place[0] - last[0], place[1] - last[1], place[2] - last[2]) < spacing) continue;
      last = place;
      if (place[2] < stock.high) this.stamp(place[0], place[1], place[2], tick);
    }
  }

  private stamp(x: number, y: number, z: number, tick: number): void {
    const tool = toolAt(this.timeline, tick);
    if (!tool) return;
    const { nx, ny, x0, y0, pitch } = this.stock, { heights } = this.field, radius = tool.radius;
    const column = (at: number, origin: number, count: number, up: boolean) =>
      Math.min(Math.max(up ? Math.ceil((at - origin) / pitch) : Math.floor((at - origin) / pitch), up ? 0 : -1), up ? count : count - 1);
    const i1 = column(x + radius, x0, nx, false), j1 = column(y + radius, y0, ny, false);
    for (let i = column(x - radius, x0, nx, true); i <= i1; ++i) {
      const dx = x0 + i * pitch - x;
      for (let j = column(y - radius, y0, ny, true); j <= j1; ++j) {
        const dy = y0 + j * pitch - y, away = Math.sqrt(dx * dx + dy * dy);
        if (away > radius) continue;
        const lower = z + profileOf(tool, away) - this.centreZ, k = i * ny + j;
        if (heights[k] > lower) heights[k] = lower;
      }
    }
  }
}
