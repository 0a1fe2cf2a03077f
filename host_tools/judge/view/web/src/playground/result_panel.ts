// The figures of a run, and maxima with their limits.
import type { RunResult } from "../core/core";
import { duration, element, figure, metres } from "../elements";
import type { Limits } from "./profile_charts";

const AXES = ["X", "Y", "Z"];

function facts(result: RunResult): HTMLElement {
  const { moves } = result;
  const rows: [string, string][] = [
    ["Time in motion", duration(result.duration_s)], ["Time in all", duration(result.total_s)], ["Length", metres(result.length_mm)],
    ["Lines", String(result.lines)], ["Moves", `${moves.rapid} rapid, ${moves.line} line, ${moves.arc} arc, ${moves.nurbs} NURBS`],
    ["End", `X ${figure(result.end_mpos_mm[0], 6)}  Y ${figure(result.end_mpos_mm[1], 6)}  Z ${figure(result.end_mpos_mm[2], 6)} mm`],
    ["Steps", result.steps.join(", ")], ["Checksum of edges", result.edges_crc32],
  ];
  return element("dl", {}, ...rows.flatMap(([name, value]) => [element("dt", {}, name), element("dd", {}, value)]));
}

function shares(title: string, unit: string, values: number[], limits: number[]): HTMLElement[] {
  return values.map((value, k) => {
    const share = value / limits[k], bar = element("div");
    bar.style.width = `${Math.min(100, 100 * share)}%`;
    return element("tr", {}, element("th", { scope: "row" }, `${AXES[k]} ${title}`), element("td", {}, `${figure(value)} ${unit}`),
      element("td", { class: "share" }, `${(100 * share).toFixed(0)} %`, element("div", { class: "bar" }, bar)));
  });
}

export function resultPanel(result: RunResult, limits: Limits): HTMLElement[] {
  const head = element("thead", {}, element("tr", {}, ...["Greatest", "value", "of limit"].map((t) => element("th", { scope: "col" }, t))));
  return [
    element("section", {}, element("h2", {}, "Run"), facts(result)),
    element("section", {}, element("h2", {}, "Maxima against limits"), element("table", {}, head, element("tbody", {},
      ...shares("velocity", "mm/s", result.max_velocity, limits.velocity),
      ...shares("acceleration", "mm/s²", result.max_acceleration, limits.acceleration),
      ...shares("jerk", "mm/s³", result.max_jerk, limits.jerk))),
      element("p", { class: "note" }, "Set points are whole nanometres: that adds up to 0.001 mm/s, 2 mm/s² and 4000 mm/s³.")),
  ];
}
