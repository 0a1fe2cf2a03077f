// Speed over time, and each axis' velocity, acceleration and jerk relative to their limits.
import uPlot from "uplot";
import { axisColours } from "../colours";
import { PROFILE_FIELDS, type Profile } from "../core/core";
import { element, swatch } from "../elements";

/** Limits of the three axes: mm/s, mm/s², mm/s³. */
export interface Limits { velocity: number[]; acceleration: number[]; jerk: number[] }

interface Panel { title: string; first: number; limits: number[] }

export class ProfileCharts {
  private plots: uPlot[] = [];

  constructor(private readonly host: HTMLElement, private readonly isDark: () => boolean) {
    new ResizeObserver(() => {
      for (const plot of this.plots) plot.setSize(this.size());
    }).observe(host);
  }

  show(profile: Profile, limits: Limits): void {
    for (const plot of this.plots.splice(0)) plot.destroy();
    this.host.replaceChildren();
    const count = profile.length / PROFILE_FIELDS, column = (k: number) => Float64Array.from({ length: count }, (_, i) => profile[PROFILE_FIELDS * i + k]);
    if (count === 0) return;
    const time = column(PROFILE_FIELDS - 1);
    const share = (k: number, limit: number) => column(k).map((v) => 100 * v / limit);
    this.add("Speed, mm/s", [["along the path", column(0)]], time, 0);
    const panels: Panel[] = [
      { title: "Velocity, % of limit", first: 1, limits: limits.velocity }, { title: "Acceleration, % of limit", first: 4, limits: limits.acceleration },
      { title: "Jerk, % of limit", first: 7, limits: limits.jerk },
    ];
    for (const { title, first, limits: of } of panels) {
      this.add(title, ["X", "Y", "Z"].map((axis, k) => [axis, share(first + k, of[k])]), time, 100);
    }
  }

  private size() {
    return { width: Math.max(120, this.host.clientWidth - 4), height: Math.max(70, Math.floor(this.host.clientHeight / 4) - 2) };
  }

  private add(title: string, series: [string, Float64Array][], time: Float64Array, top: number): void {
    const dark = this.isDark(), text = dark ? "#b9c0c9" : "#48505a", grid = dark ? "#2a3038" : "#dde2e8";
    const colours = series.length === 1 ? [text] : axisColours(dark);
    const key = series.length === 1 ? [] : series.map(([name], k) => element("span", { class: "axis-key" }, swatch(colours[k]), name));
    const box = element("div", { class: "chart", role: "img", "aria-label": `${title}, over time in seconds` }, element("div", { class: "chart-title" }, title, ...key));
    this.host.append(box);
    const axis = { stroke: text, grid: { stroke: grid, width: 1 }, ticks: { show: false }, font: "11px system-ui, sans-serif" };
    this.plots.push(new uPlot({
      ...this.size(), legend: { show: false }, padding: [4, 8, 0, 0], cursor: { y: false, sync: { key: "profile" } },
      scales: { x: { time: false }, y: { range: (_plot, _low, high) => [0, Math.max(top, high) * 1.08 || 1] } },
      axes: [{ ...axis, size: 20, values: (_plot, ticks) => ticks.map((t) => `${t} s`) }, { ...axis, size: 44 }],
      series: [{}, ...series.map(([label], k) => ({ label, stroke: colours[k], width: 1.2, points: { show: false } }))],
    }, [time, ...series.map(([, values]) => values)], box));
  }
}
