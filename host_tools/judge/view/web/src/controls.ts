// Controls of the page: play and scrubber, keys, and the visibility of objects.
import { button, duration, element, figure, fixed } from "./elements";
import { colouringNames, colourings } from "./colouring";
import type { Colouring } from "./colouring";
import { viewNames } from "./scene";
import type { Scene, Shown } from "./scene";
import type { Charts } from "./charts";
import type { Timeline } from "./timeline";

const rates = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];

export function transport(timeline: Timeline): HTMLElement[] {
  const play = button("▶", "Play or pause (space)", () => timeline.play(!timeline.playing));
  play.className = "play";
  const rate = element("select", { "aria-label": "Speed of playing" }, ...rates.map((r) => element("option", { value: String(r) }, `${r}×`)));
  timeline.rate = rates.find((r) => r * 45 >= timeline.run.ticks / 1000) ?? rates[rates.length - 1];
  rate.value = String(timeline.rate);
  rate.addEventListener("change", () => { timeline.rate = Number(rate.value); });
  const last = timeline.run.ticks - 1;
  const scrubber = element("input", {
    type: "range", min: "0", max: String(last), step: String(Math.max(1, Math.round(last / 2000))), "aria-label": "Time in the run",
  });
  scrubber.addEventListener("input", () => timeline.seekTick(Number(scrubber.value)));
  const time = element("output", { class: "time number" });
  const show = () => {
    play.textContent = timeline.playing ? "❚❚" : "▶";
    play.setAttribute("aria-label", timeline.playing ? "Pause" : "Play");
    if (Number(scrubber.value) !== timeline.tick) scrubber.value = String(timeline.tick);
    scrubber.setAttribute("aria-valuetext", duration(timeline.timeOf(timeline.tick)));
    time.textContent = `${timeline.timeOf(timeline.tick).toFixed(3)} s`;
  };
  timeline.onChange(show);
  show();
  return [play, rate, scrubber, time];
}

// Position, line, speed and tool at the cursor.
export function readout(timeline: Timeline): HTMLElement {
  const out = element("div", { class: "readout" });
  const names = ["X", "Y", "Z", "Feed", "Line", "Tool", ...timeline.run.engagement ? ["Engagement"] : []];
  const cells = names.map((name) => {
    const value = element("span", { class: "number" });
    out.append(element("span", { class: "name" }, name), value);
    return value;
  });
  const show = () => {
    const state = timeline.state();
    state.position_mm.forEach((value, k) => { cells[k].textContent = `${fixed(value, 3)} mm`; });
    cells[3].textContent = `${figure(60 * Math.hypot(...state.velocity), 4)} mm/min`;
    cells[4].textContent = state.line > 0 ? String(state.line) : "–";
    cells[5].textContent = state.tool > 0 ? `T${state.tool}` : "–";
    if (state.engagement_deg !== undefined) cells[6].textContent = `${state.engagement_deg}°`;
  };
  timeline.onChange(show);
  show();
  return out;
}

export interface Choices { colouring: Colouring; safe: boolean }

// Colouring, views, and visible objects.
export function sceneTools(scene: Scene, timeline: Timeline, choices: Choices, changed: () => void): { bar: HTMLElement; sync: () => void } {
  const colour = element("select", { "aria-label": "Colours show" },
    ...colourings.map((name) => element("option", { value: name }, colouringNames[name])));
  colour.addEventListener("change", () => {
    choices.colouring = colour.value as Colouring;
    changed();
  });
  const safe = element("input", { type: "checkbox", id: "safe-colours" });
  safe.addEventListener("change", () => {
    choices.safe = safe.checked;
    changed();
  });
  const view = element("select", { "aria-label": "View from" }, element("option", { value: "" }, "View"),
    ...viewNames.map((name, k) => element("option", { value: String(k) }, `${k + 1} ${name}`)));
  view.addEventListener("change", () => {
    if (view.value) scene.view(Number(view.value));
    view.value = "";
  });
  const names: [keyof Shown, string][] = [["path", "Path"], ["rapids", "Rapids"], ["tool", "Tool"]];
  if (timeline.run.stock) names.unshift(["stock", "Stock"], ["part", "Part"]);
  const boxes = names.map(([key, name]) => {
    const box = element("input", { type: "checkbox", id: "show-" + key });
    box.addEventListener("change", () => {
      scene.shown[key] = box.checked;
      scene.ask();
    });
    return { key, box, label: element("label", { for: "show-" + key }, box, name) };
  });
  const safeLabel = element("label", { for: "safe-colours", title: "Scale of what is left: for the colour-blind, or blue, green, red" }, safe, "Safe colours");
  const sync = () => {
    colour.value = choices.colouring;
    safe.checked = choices.safe;
    safeLabel.hidden = choices.colouring !== "left";
    for (const { key, box } of boxes) box.checked = scene.shown[key];
  };
  sync();
  return { bar: element("div", { class: "scene-tools" }, colour, view, ...boxes.map((b) => b.label), safeLabel), sync };
}

// Keys of the whole page, except those that a focused control handles.
export function listenToKeys(timeline: Timeline, scene: Scene | null, charts: Charts, nextColouring: () => void, help: () => void, signal: AbortSignal): void {
  const toLine = (step: 1 | -1) => {
    const line = timeline.neighbourLine(timeline.lineOf(timeline.tick), step), ticks = line === null ? null : timeline.ticksOfLine(line);
    if (ticks) timeline.seekTick(ticks[1]);
  };
  const step = (sign: number, fine: boolean) => timeline.seekTick(timeline.tick + sign * (fine ? 1 : Math.max(Math.round(100 * timeline.rate), 1)));
  const keys: Record<string, (event: KeyboardEvent) => void> = {
    " ": () => timeline.play(!timeline.playing),
    ArrowLeft: (e) => step(-1, e.shiftKey), ArrowRight: (e) => step(1, e.shiftKey),
    ArrowUp: () => toLine(-1), ArrowDown: () => toLine(1),
    Home: () => timeline.seekTick(0), End: () => timeline.seekTick(timeline.run.ticks - 1),
    "+": () => scene?.zoom(1.25), "=": () => scene?.zoom(1.25), "-": () => scene?.zoom(0.8), f: () => scene?.fit(),
    a: () => scene?.turn(-0.1, 0), d: () => scene?.turn(0.1, 0), w: () => scene?.turn(0, -0.1), s: () => scene?.turn(0, 0.1),
    "]": () => charts.zoom(2), "[": () => charts.zoom(0.5), "0": () => charts.zoomOut(),
    c: nextColouring, "?": help,
  };
  viewNames.forEach((_, k) => { keys[String(k + 1)] = () => scene?.view(k); });
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const target = event.target as HTMLElement, tag = target.tagName;
    if (tag === "SELECT" || tag === "TEXTAREA" || document.querySelector("dialog[open]")) return;
    if (tag === "BUTTON" && (event.key === " " || event.key === "Enter")) return;
    if (tag === "INPUT" && (event.key === " " && (target as HTMLInputElement).type === "checkbox" || /^(Arrow|Home|End)/.test(event.key))) return;
    if (tag === "INPUT" && !["checkbox", "range"].includes((target as HTMLInputElement).type)) return;
    const act = keys[event.key] as ((event: KeyboardEvent) => void) | undefined;
    if (!act) return;
    event.preventDefault();
    act(event);
  }, { signal });
}

export const keyHelp: [string, string][] = [
  ["Space", "play or pause"], ["← →", "back and forth"], ["Shift ← →", "by one set point"], ["↑ ↓", "line before, line after"],
  ["Home End", "start, end"], ["1 to 7", "views"], ["W A S D", "turn"], ["+ −", "zoom"], ["F", "fit"], ["C", "next colours"],
  ["[ ]", "zoom the charts out, in"], ["0", "charts of the whole run"], ["?", "these keys"],
];
