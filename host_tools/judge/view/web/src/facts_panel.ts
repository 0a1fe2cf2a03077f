// The figures of a run: time, maxima and limits, bounds, the worst points, tools, warnings.
import { button, duration, element, figure, fixed, metres } from "./elements";
import type { Content } from "./elements";
import type { PageFacts, Triple, WorstPlace } from "./run_data";

export interface FactsActions { toPlace: (place: WorstPlace) => void; toLine: (line: number) => void }

function section(title: string, ...content: Content[]): HTMLElement {
  return element("section", {}, element("h2", {}, title), ...content);
}

function rowsOf(rows: [string, Content][]): HTMLElement {
  return element("dl", {}, ...rows.flatMap(([name, value]) => [element("dt", {}, name), element("dd", {}, value)]));
}

function table(head: string[], rows: Content[][]): HTMLElement {
  const cell = (content: Content, k: number) => k === 0 ? element("th", { scope: "row" }, content) : element("td", {}, content);
  return element("table", {},
    element("thead", {}, element("tr", {}, ...head.map((text) => element("th", { scope: "col" }, text)))),
    element("tbody", {}, ...rows.map((row) => element("tr", {}, ...row.map(cell)))));
}

// A value above a bar of its ratio to the limit. What the rounding of set points adds is no more than the limit.
function share(value: number, limit: number, rounding: number): HTMLElement {
  const rounded = value > limit && value - limit <= rounding;
  const part = rounded ? 1 : value / limit, out = element("div", { class: "share" }, figure(rounded ? limit : value, 4));
  const bar = element("div", { class: "bar" }), full = element("div");
  full.style.width = `${Math.min(part, 1) * 100}%`;
  bar.append(full);
  out.append(bar);
  out.title = rounded ? `100 % of ${figure(limit, 6)}, within rounding: ${figure(value, 6)}` : `${figure(100 * part, 4)} % of ${figure(limit, 6)}`;
  return out;
}

function limitRows(facts: PageFacts): Content[][] {
  const row = (name: string, unit: string, values: Triple, limits: Triple, rounding: number): Content[] =>
    [element("span", {}, name, " ", element("small", {}, unit)), ...values.map((v, k) => share(v, limits[k], rounding))];
  const { facts: f, limits } = facts;
  return [
    row("Velocity", "mm/s", f.max_velocity, limits.velocity, 0.001),
    row("Acceleration", "mm/s²", f.max_acceleration, limits.acceleration, 2),
    row("Jerk", "mm/s³", f.max_jerk, limits.jerk, 4000),
  ];
}

function boundRows(facts: PageFacts): Content[][] {
  const v = facts.verification!, judged = 5e-4, rows: Content[][] = [];
  const add = (name: string, value: number | null, bound: number, unit = "mm", spare = 0) => {
    if (value === null) return;
    const holds = value <= bound + spare;
    const scale = unit === "%" ? 100 : 1;
    rows.push([name, `${figure(value * scale, 3)} ${unit}`, `${figure(bound * scale, 3)} ${unit}`,
      element("span", { class: holds ? "holds" : "broken" }, holds ? "holds" : "broken")]);
  };
  add("Gouge, floor", v.gouge_max_mm, v.floor_tolerance, "mm", judged);
  add("Gouge, ball", v.ball_gouge_max_mm, v.floor_tolerance, "mm", judged);
  add("Gouge, walls", v.wall_gouge_max_mm, v.plan_tolerance, "mm", judged);
  add("Rapid in stock", v.rapid_cut_max_mm, v.rapid_cut_bound_mm);
  if (v.scallop_bound_mm !== null) {
    add("Scallop (99 %)", v.scallop_p99_mm, v.scallop_bound_mm);
    add("Over scallop", v.uncovered_share, v.uncovered_bound, "%");
  }
  // No bound of the job: where it is over, the page says on how much of the way.
  const { limit_deg: limit = null, limited_max_deg: most = null, over_mm: over = null } = v.engagement ?? {};
  if (limit !== null && most !== null) {
    rows.push(["Engagement", `${figure(most, 3)} °`, `${figure(limit, 3)} °`,
      over ? `${figure(over, 2)} mm over` : element("span", { class: "holds" }, "holds")]);
  }
  return rows;
}

function warnings(facts: PageFacts, actions: FactsActions): Content[] {
  const { run, reading } = facts, out: Content[] = [];
  const say = (text: string, line = 0) => {
    const to = line > 0 ? [button(`Line ${line}`, "Go to this line", () => actions.toLine(line)), " "] : [];
    out.push(element("li", {}, ...to, text));
  };
  for (const error of run.errors) say(`${error.code > 0 ? `error ${error.code}: ` : ""}${error.text}: the run ends here`, error.line);
  const reportedLines = new Set(run.errors.map((error) => error.line));
  for (const line of reading.refused.slice(0, 50)) if (!reportedLines.has(line.line)) say(`refused, error ${line.code}: ${line.text}`, line.line);
  if (reading.refused_count > 50) say(`${reading.refused_count} lines are refused in all`);
  if (facts.not_verified) say(`The part is not verified: ${facts.not_verified}`);
  for (const broken of facts.verification?.broken ?? []) say(broken);
  if (run.stopped) say("The run was stopped before its end");
  return out;
}

export function factsPanel(facts: PageFacts, actions: FactsActions): HTMLElement[] {
  const { facts: f, run } = facts, out: HTMLElement[] = [];
  const warned = warnings(facts, actions);
  if (warned.length > 0) out.push(section("Warnings", element("ul", { class: "warnings" }, ...warned)));
  if (facts.verification) out.push(section("Bounds of the job, as cut", table(["Bound", "Measured", "Allowed", "Verdict"], boundRows(facts))));
  const farthest = run.max_deviation_line > 0
    ? element("span", {}, `${figure(run.max_deviation_mm * 1000, 3)} µm `, button(`line ${run.max_deviation_line}`, "Go to this line", () => actions.toLine(run.max_deviation_line)))
    : `${figure(run.max_deviation_mm * 1000, 3)} µm`;
  out.push(section("Run", rowsOf([
    ["Time in motion", duration(f.duration_s)],
    ["Length", metres(f.length_mm)],
    ["Moves", `${f.moves}`],
    ["Rapid, line, arc, NURBS", `${run.rapids}, ${run.lines_moved}, ${run.arcs}, ${run.nurbs}`],
    ["Set points, 1 ms", `${f.ticks}`],
    ["Pauses, resumed at once", `${run.pauses}`],
    ["Greatest deviation", farthest],
  ])));
  const limits = section("Greatest, against limits", table(["Axis", "X", "Y", "Z"], limitRows(facts)));
  limits.append(element("p", { class: "note" }, "Set points are whole nanometres: 0.001 mm/s, 2 mm/s² and 4000 mm/s³ are rounding, and not shown over a limit."));
  out.push(limits);
  if (facts.verification) {
    const worst = f.worst ?? [];
    const places = worst.map((place) => {
      const label = element("span", { class: "kind kind-" + place.kind }, { gouge: "gouge", left: "left", uncut: "uncut" }[place.kind]);
      const item = button("", "Show this place", () => actions.toPlace(place));
      item.append(label, element("span", { class: "number" }, `${figure(place.mm, 3)} mm`),
        element("span", { class: "number at" }, place.at.map((c) => fixed(c, 1)).join("  ")));
      return element("li", {}, item);
    });
    out.push(section("Worst places", worst.length > 0 ? element("ol", { class: "worst" }, ...places) : element("p", {}, "None: nothing is gouged or left.")));
  }
  if (facts.tools.length > 0) {
    out.push(section("Tools", table(["Tool", "Shape", "Time", "Cut", "Deepest"], facts.tools.map((tool) => [
      tool.number > 0 ? `T${tool.number}` : "T–",
      tool.shape ? `${tool.shape} ${figure(2 * tool.radius!)}${tool.shape === "bull" ? ` r${figure(tool.corner_radius!)}` : ""} mm${tool.tip_angle ? `, ${figure(tool.tip_angle * 180 / Math.PI)}°` : ""}` : "not known",
      duration(tool.time_s),
      tool.cut_length_mm === undefined ? "–" : metres(tool.cut_length_mm),
      tool.cut_depth_max_mm === undefined ? "–" : `${figure(tool.cut_depth_max_mm, 3)} mm`,
    ]))));
  }
  if (facts.reading.header.length > 0) {
    out.push(section("Comments at the start", element("pre", { class: "header-comments", tabindex: "0" }, facts.reading.header.join("\n"))));
  }
  return out;
}
