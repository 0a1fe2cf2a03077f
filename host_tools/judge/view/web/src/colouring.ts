// The six colourings of the page: values, scale and legend of each.
import { cssOf, gradientOf, scaleTable } from "./colours";
import type { Look, ScaleName } from "./colours";
import { element, figure, legendBar, swatch } from "./elements";
import type { Scene } from "./scene";
import type { Timeline } from "./timeline";

export const colourings = ["height", "speed", "limits", "deviation", "operation", "left"] as const;
export type Colouring = typeof colourings[number];
export const colouringNames: Record<Colouring, string> = {
  height: "Height", speed: "Speed", limits: "Share of limits", deviation: "Off the path", operation: "Operation", left: "Left and gouged",
};

interface Scale { name: ScaleName; title: string; unit: string; low: number; high: number; value: (vertex: number) => number }

// mm: height of a vertex.
const heightOf = ({ run }: Timeline, vertex: number) => (run.axes[2][run.vertexTick[vertex]] + run.origin[2]) * 1e-6;

// Least and greatest height of the vertices that cut.
function heights(timeline: Timeline, rapid: Uint8Array): [number, number] {
  let low = Infinity, high = -Infinity;
  for (let k = 1; k < rapid.length; ++k) {
    if (rapid[k]) continue;
    const z = heightOf(timeline, k);
    low = Math.min(low, z);
    high = Math.max(high, z);
  }
  return low < high ? [low, high] : [Math.min(low, 0), Math.max(high, 0) + 1e-3];
}

function most(values: Float32Array): number {
  let out = 0;
  for (const value of values) out = Math.max(out, value);
  return out;
}

function scaleOf(colouring: Colouring, timeline: Timeline, rapid: Uint8Array): Scale {
  const { run } = timeline;
  const from0 = (name: ScaleName, title: string, unit: string, values: Float32Array, high: number, factor: number): Scale =>
    ({ name, title, unit, low: 0, high: high * factor, value: (k) => values[k] / (high || 1) });
  switch (colouring) {
    case "speed": return from0("viridis", "Speed", "mm/min", run.vertexSpeed, most(run.vertexSpeed), 60);
    case "limits": return from0("cividis", "Nearest axis limit", "%", run.vertexShare, 1, 100);
    case "deviation": return from0("viridis", "Off the programmed path", "µm", run.vertexDeviation, most(run.vertexDeviation), 1000);
    case "operation": return {
      name: "kinds", title: "Operation", unit: "", low: 0, high: 0,
      value: (k) => timeline.facts.reading.sections.indexOf(timeline.sectionOf(timeline.lineOf(run.vertexTick[k]))) / 255,
    };
    default: {
      const [low, high] = heights(timeline, rapid);
      return { name: "viridis", title: "Height", unit: "mm", low, high, value: (k) => (heightOf(timeline, k) - low) / (high - low) };
    }
  }
}

// Colours path and surfaces; returns the legend.
export function applyColouring(colouring: Colouring, timeline: Timeline, scene: Scene, look: Look): HTMLElement[] {
  const left = colouring === "left", scale = scaleOf(left ? "height" : colouring, timeline, scene.path.rapidVertex);
  scene.dress(scale.name, look, left);
  scene.path.colour(scale.value);
  const bounds = scene.leftBounds();
  if (left) {
    if (!bounds) return [element("div", { class: "legend-title" }, "The stock left is known only with a job")];
    const { gouge, scallop } = bounds;
    return legendBar(gradientOf(scaleTable("left", look)), "Gouged and left, mm",
      [`−${figure(3 * gouge, 2)}`, `−${figure(gouge, 2)}`, "0", figure(scallop, 2), figure(3 * scallop, 2)]);
  }
  const table = scaleTable(scale.name, look);
  if (colouring === "operation") {
    const items = timeline.facts.reading.sections.map((section, k) =>
      element("div", { class: "legend-kind" }, swatch(cssOf(table, Math.min(k, 255))), section.title || "Before the first tool"));
    return [element("div", { class: "legend-title" }, "Operation"), ...items.slice(items.length > 1 ? 1 : 0, 12)];
  }
  const middle = (scale.low + scale.high) / 2, rounding = 1e-3 * (scale.high - scale.low);
  return legendBar(gradientOf(table), `${scale.title}, ${scale.unit}`, [scale.low, middle, scale.high].map((value) => figure(Math.abs(value) < rounding ? 0 : value, 3)));
}
