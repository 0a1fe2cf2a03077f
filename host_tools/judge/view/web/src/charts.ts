// Charts over time: each axis' velocity, acceleration and jerk relative to their limits, the speed along the path, and the
// tool's engagement where it is known.
import uPlot from "uplot";
import { axisColours } from "./colours";
import { element, swatch } from "./elements";
import { kBucket, kBucketStep, kEngagementChannel, kSpeedChannel } from "./run_data";
import type { Timeline } from "./timeline";

const kTitle = 16;  // px above a plot, as page.css has it

interface Panel { title: string; unit: string; channels: number[]; scale: (channel: number) => number; top: number; limit?: number }

// Steps of the axis of time: none below a set point's millisecond, which is what the labels show.
const kSeconds = [0, 1, 2, 3, 4, 5, 6, 7].flatMap((e) => [1, 2, 5].map((f) => f * 10 ** e / 1000));

export class Charts {
  private readonly plots: uPlot[] = [];
  private readonly marks: HTMLElement[] = [];
  private from: number;
  private to: number;
  private filling = false;

  constructor(private readonly host: HTMLElement, private readonly timeline: Timeline, private dark: boolean) {
    this.from = timeline.timeOf(0);
    this.to = timeline.timeOf(timeline.run.ticks - 1);
    document.documentElement.style.setProperty("--chart-rows", String(this.panels().length));
    this.build();
    timeline.onChange(() => this.showCursor());
    new ResizeObserver(() => this.resize()).observe(host);
  }

  set look(dark: boolean) {
    if (dark === this.dark) return;
    this.dark = dark;
    this.build();
  }

  private panels(): Panel[] {
    const { limits } = this.timeline.facts;
    const share = (limit: number[]) => (channel: number) => 100 / limit[channel % 3];
    return [
      { title: "Velocity", unit: "% of limit", channels: [0, 1, 2], scale: share(limits.velocity), top: 112 },
      { title: "Acceleration", unit: "% of limit", channels: [3, 4, 5], scale: share(limits.acceleration), top: 112 },
      { title: "Jerk", unit: "% of limit", channels: [6, 7, 8], scale: share(limits.jerk), top: 112 },
      { title: "Feed", unit: "mm/min", channels: [kSpeedChannel], scale: () => 60, top: 0 },
      ...this.timeline.run.engagement ? [{ title: "Engagement", unit: "degrees", channels: [kEngagementChannel], scale: () => 1, top: 0,
        limit: this.timeline.facts.verification?.engagement?.limit_deg ?? undefined }] : [],
    ];
  }

  private build(): void {
    for (const plot of this.plots.splice(0)) plot.destroy();
    this.marks.length = 0;
    this.host.replaceChildren();
    const colours = axisColours(this.dark), text = this.dark ? "#b9c0c9" : "#48505a", grid = this.dark ? "#2a3038" : "#dde2e8";
    const panels = this.panels();
    panels.forEach((panel, k) => {
      const box = element("div", { class: "chart", role: "img", "aria-label": `${panel.title}, ${panel.unit}, over time in seconds` });
      const title = element("div", { class: "chart-title" }, element("span", {}, panel.title, " ", element("small", {}, panel.unit)));
      if (k === 0) {
        "XYZ".split("").forEach((axis, c) => title.append(element("span", { class: "axis-key" }, swatch(colours[c]), axis)));
      }
      box.append(title);
      this.host.append(box);
      const last = k === panels.length - 1;
      const axis = { stroke: text, grid: { stroke: grid, width: 1 }, ticks: { show: false }, font: "11px system-ui, sans-serif" };
      const plot = new uPlot({
        ...this.sizeOf(last), legend: { show: false }, padding: [2, 22, last ? 0 : 5, 0],
        cursor: { drag: { x: true, y: false, setScale: false }, y: false, points: { show: false } },
        scales: {
          x: { time: false, auto: false, range: () => [this.from, this.to] },
          y: { range: (_u: uPlot, _low: number, high: number): [number, number] => [0, panel.top || Math.max(high * 1.08, 1)] },
        },
        axes: [
          { ...axis, show: last, size: last ? 24 : 0, incrs: kSeconds, values: (_u: uPlot, at: number[]) => at.map((v) => `${+v.toFixed(3)} s`) },
          { ...axis, size: 44, gap: 2, ...(panel.top ? { splits: () => [0, 50, 100] } : { space: 20 }) },
        ],
        series: [{}, ...panel.channels.map((channel) => ({
          stroke: panel.channels.length > 1 ? colours[channel % 3] : (this.dark ? "#d0d6dd" : "#39424d"), width: 1, points: { show: false },
        })), ...panel.limit ? [{ stroke: text, width: 1, dash: [4, 4], points: { show: false } }] : []],
        hooks: { setSelect: [(u: uPlot) => this.select(u)] },
      }, [[], ...panel.channels.map(() => []), ...panel.limit ? [[]] : []] as unknown as uPlot.AlignedData, box);
      const mark = element("div", { class: "chart-cursor" });
      plot.over.append(mark);
      this.marks.push(mark);
      let downAt = 0;
      plot.over.addEventListener("pointerdown", (event) => { downAt = event.clientX; });
      plot.over.addEventListener("pointerup", (event) => {
        if (Math.abs(event.clientX - downAt) < 4) this.timeline.seekTick(this.timeline.tickOf(plot.posToVal(event.offsetX, "x")));
      });
      plot.over.addEventListener("dblclick", () => this.zoomOut());
      this.plots.push(plot);
    });
    this.fill();
  }

  private sizeOf(last: boolean): { width: number; height: number } {
    const box = this.host.getBoundingClientRect(), rows = this.panels().length;
    const each = Math.max(Math.floor((box.height - 26) / rows) - kTitle, 30);
    return { width: Math.max(Math.floor(box.width), 120), height: each + (last ? 24 : 0) };
  }

  private resize(): void {
    this.plots.forEach((plot, k) => plot.setSize(this.sizeOf(k === this.plots.length - 1)));
    this.fill();
  }

  private select(u: uPlot): void {
    if (u.select.width < 4 || this.filling) return;
    const from = u.posToVal(u.select.left, "x"), to = u.posToVal(u.select.left + u.select.width, "x");
    u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
    this.show(from, to);
  }

  show(from: number, to: number): void {
    const least = 0.02, first = this.timeline.timeOf(0), last = this.timeline.timeOf(this.timeline.run.ticks - 1);
    const width = Math.min(Math.max(to - from, least), Math.max(last - first, least));
    this.from = Math.min(Math.max(from, first), Math.max(last - width, first));
    this.to = this.from + width;
    this.fill();
  }
  zoomOut(): void {
    this.from = this.timeline.timeOf(0);
    this.to = this.timeline.timeOf(this.timeline.run.ticks - 1);
    this.fill();
  }
  // Zooms around the cursor.
  zoom(factor: number): void {
    const at = this.timeline.timeOf(this.timeline.tick), half = (this.to - this.from) / factor / 2;
    this.show(at - half, at + half);
  }

  // Fills the charts with the greatest values of visible buckets, about one for each pixel.
  private fill(): void {
    if (this.plots.length === 0) return;
    const { run } = this.timeline;
    const first = this.timeline.tickOf(this.from), end = this.timeline.tickOf(this.to) + 1;
    const wanted = Math.max((end - first) / Math.max(this.plots[0].bbox.width / devicePixelRatio, 100), 1);
    let level = -1, size = 1;
    for (let k = 0, s = kBucket; k < run.peaks.length && s <= wanted; ++k, s *= kBucketStep) [level, size] = [k, s];
    const times: number[] = [];
    const low = Math.floor(first / size), high = Math.ceil(end / size), each = Math.max(Math.floor(wanted / size), 1);
    for (let k = low; k < high; k += each) times.push(this.timeline.timeOf(Math.min((k + each / 2) * size - (size > 1 ? 0 : 0.5), run.ticks - 1)));
    this.filling = true;
    this.panels().forEach((panel, p) => {
      const rows = panel.channels.map((channel) => {
        const scale = panel.scale(channel), out: number[] = [];
        for (let k = low; k < high; k += each) {
          let most = 0;
          for (let i = k; i < Math.min(k + each, high); ++i) most = Math.max(most, level < 0 ? this.exact(channel, i) : run.peaks[level][channel][i] ?? 0);
          out.push(most * scale);
        }
        return out;
      });
      const { limit } = panel, most = limit ? Math.max(limit * 1.3 / 1.08, ...rows[0]) : Math.max(...rows[0], 1);
      this.plots[p].setData([times, ...rows, ...limit ? [times.map(() => limit)] : []], false);
      this.plots[p].batch(() => {
        this.plots[p].setScale("x", { min: this.from, max: this.to });
        this.plots[p].setScale("y", { min: 0, max: panel.top || most * 1.08 });
      });
    });
    this.filling = false;
    this.showCursor();
  }

  // The absolute value of a tick.
  private exact(channel: number, tick: number): number {
    const { axes, ticks } = this.timeline.run;
    if (tick < 0 || tick >= ticks) return 0;
    const at = (axis: number, back: number) => axes[axis][Math.max(tick - back, 0)];
    if (channel === kEngagementChannel) return this.timeline.run.engagement?.[Math.floor(tick / kBucket)] ?? 0;
    if (channel === kSpeedChannel) return Math.hypot(at(0, 0) - at(0, 1), at(1, 0) - at(1, 1), at(2, 0) - at(2, 1)) * 1e-3;
    const axis = channel % 3;
    if (channel < 3) return Math.abs(at(axis, 0) - at(axis, 1)) * 1e-3;
    if (channel < 6) return Math.abs(at(axis, 0) - 2 * at(axis, 1) + at(axis, 2));
    return Math.abs(at(axis, 0) - 3 * at(axis, 1) + 3 * at(axis, 2) - at(axis, 3)) * 1e3;
  }

  private showCursor(): void {
    const t = this.timeline.timeOf(this.timeline.tick);
    this.plots.forEach((plot, k) => {
      const x = plot.valToPos(t, "x"), inside = t >= this.from && t <= this.to && Number.isFinite(x);
      this.marks[k].style.transform = `translateX(${inside ? x : -10}px)`;
    });
  }
}
