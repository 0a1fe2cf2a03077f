// The page of one run: creates its parts, and provides `window.cusp`.
import { applyColouring, colourings } from "./colouring";
import type { Colouring } from "./colouring";
import { Charts } from "./charts";
import { keyHelp, listenToKeys, readout, sceneTools, transport } from "./controls";
import type { Choices } from "./controls";
import { button, duration, element, inOrder, metres } from "./elements";
import { dialog, frameButtons, isDark, place } from "./frame";
import { factsPanel } from "./facts_panel";
import type { RunResult } from "./core/core";
import { runProgram } from "./core/run_program";
import { loadRun, pageFacts } from "./page_data";
import { ProgramList } from "./program_list";
import type { MainFacts, Triple, WorstPlace } from "./run_data";
import { rendererOn, warmUp } from "./renderer";
import { Scene } from "./scene";
import { Timeline } from "./timeline";
import type { RunState } from "./timeline";

interface Cusp {
  ready: Promise<void>; facts: MainFacts;
  seek: (t_s: number) => Promise<void>; state: () => RunState;
  linesAt: (line: number) => [number, number] | null;
  project: (at: Triple) => [number, number]; lineAt: (px: number, py: number) => number | null;
  show: (name: string) => void; run: (text: string, settings: string) => Promise<RunResult>;
}
declare global {
  interface Window { cusp: Cusp }
}

const facts = pageFacts();
const parts = {
  facts: place("facts", "Facts"), stage: place("stage", "Scene"), program: place("program", "Program"),
  transport: place("transport", "Time"), charts: place("charts", "Charts"),
};
const status = element("div", { class: "status", role: "status" }, "Unpacking the run …");
const later: { line: (line: number) => void; place: (place: WorstPlace) => void } = { line: () => undefined, place: () => undefined };

const restyle: (() => void)[] = [];

function frame(): { help: () => void } {
  // Charts come later and must not move the rest.
  document.documentElement.style.setProperty("--chart-rows", facts.verification?.engagement ? "5" : "4");
  document.title = `${inOrder(facts.program)} – cusp view`;
  const keys = dialog("Keys", element("dl", { class: "keys" }, ...keyHelp.flatMap(([key, what]) => [element("dt", {}, key), element("dd", {}, what)])));
  const [themed, rights] = frameButtons(() => { for (const act of restyle) act(); });
  const good = facts.run.errors.length === 0 && facts.reading.refused_count === 0 && !facts.not_verified;
  const broken = facts.verification?.broken.length ?? 0;
  const verdict = !good ? "ends early or has refused lines" : !facts.verification ? "runs to its end" : broken > 0 ? "bounds are broken" : "all bounds hold";
  document.getElementById("app")!.append(
    element("header", {},
      element("h1", {}, facts.program),
      element("span", { class: good && broken === 0 ? "verdict holds" : "verdict broken" }, verdict),
      element("span", { class: "summary" }, `${duration(facts.facts.duration_s)} · ${metres(facts.facts.length_mm)} · ${facts.facts.moves} moves`),
      element("span", { class: "space" }),
      themed, button("Keys", "Keys (?)", () => keys.showModal()), rights),
    element("main", {}, parts.facts, parts.stage, parts.program, parts.transport, parts.charts));
  parts.facts.tabIndex = 0;
  parts.facts.append(...factsPanel(facts, { toLine: (line) => later.line(line), toPlace: (at) => later.place(at) }));
  parts.stage.append(status);
  return { help: () => keys.showModal() };
}

function fail(reason: unknown): never {
  status.textContent = reason instanceof Error ? reason.message : String(reason);
  status.classList.add("failed");
  throw reason;
}

// Null without WebGL, with the reason shown in the page.
function rendererOr(canvas: HTMLCanvasElement): ReturnType<typeof rendererOn> | null {
  try {
    return rendererOn(canvas);
  } catch (error) {
    status.textContent = `No picture: ${error instanceof Error ? error.message : String(error)}`;
    return null;
  }
}

async function open(help: () => void): Promise<void> {
  const canvas = element("canvas", { role: "img", "aria-label": "Path, stock and tool of the run", tabindex: "0" });
  let renderer = null as ReturnType<typeof rendererOr>;
  const run = await loadRun(facts, () => {
    canvas.style.visibility = "hidden";  // black until the first frame
    parts.stage.prepend(canvas);
    renderer = rendererOr(canvas);
    if (renderer) warmUp(renderer, facts.verification !== undefined);
  });
  if (run.ticks === 0) throw new Error("the run has no set point");
  const timeline = new Timeline(run, facts);
  const scene = renderer ? new Scene(renderer, timeline) : null;
  const goTo = (line: number) => {
    timeline.play(false);
    const ticks = timeline.ticksOfLine(line);
    if (ticks) timeline.seekTick(ticks[1]);
    return ticks !== null;
  };
  const list = element("div", { class: "program-list", role: "listbox", tabindex: "0", "aria-label": "Lines of the program" });
  parts.program.append(list);
  const program = new ProgramList(list, timeline, goTo);
  const charts = new Charts(parts.charts, timeline, isDark());
  parts.transport.append(...transport(timeline));
  parts.stage.append(readout(timeline));
  restyle.push(() => { charts.look = isDark(); });

  const choices: Choices = { colouring: run.left ? "height" : "speed", safe: true };
  const legend = element("div", { class: "legend" });
  let sync: () => void = () => undefined;
  const recolour = () => {
    if (scene) legend.replaceChildren(...applyColouring(choices.colouring, timeline, scene, { dark: isDark(), safe: choices.safe }));
    sync();
  };
  if (scene) {
    const tools = sceneTools(scene, timeline, choices, recolour);
    sync = tools.sync;
    parts.stage.append(tools.bar, legend);
  }
  restyle.push(recolour);
  recolour();
  listenToKeys(timeline, scene, charts, () => {
    choices.colouring = colourings[(colourings.indexOf(choices.colouring) + 1) % colourings.length];
    recolour();
  }, help);

  const tickAt = (px: number, py: number) => scene?.path.tickAt(px, py, 5, scene.toPixels()) ?? null;
  if (scene) pickOn(canvas, timeline, tickAt);
  later.line = (line) => {
    goTo(line);
    program.scrollTo(line);
  };
  later.place = (at) => {
    choices.colouring = "left";
    recolour();
    scene?.flyTo(at.at);
  };
  Object.assign(window.cusp, {
    seek: async (t_s: number) => {
      timeline.seekTick(timeline.tickOf(t_s));
      await scene?.whenDrawn();
    },
    state: () => timeline.state(),
    linesAt: (line: number) => timeline.ticksOfLine(line)?.map((tick) => timeline.timeOf(tick)) ?? null,
    project: (at: Triple) => scene ? scene.toPixels()(at).slice(0, 2) : [NaN, NaN],
    lineAt: (px: number, py: number) => {
      const tick = tickAt(px, py);
      return tick === null ? null : timeline.lineOf(tick);
    },
    show: (name: string) => {
      if (!colourings.includes(name as Colouring)) throw new RangeError(`no colouring "${name}": there are ${colourings.join(", ")}`);
      choices.colouring = name as Colouring;
      recolour();
    },
  });
  if (!scene) throw new Error(status.textContent);
  canvas.style.visibility = "";
  const still = location.hash === "#still";
  await scene.whenDrawn(!still);
  status.remove();
  if (still) document.documentElement.classList.add("still");
}

// A click on the path moves the cursor there; a drag turns the scene.
function pickOn(canvas: HTMLCanvasElement, timeline: Timeline, tickAt: (px: number, py: number) => number | null): void {
  let down: [number, number] = [0, 0];
  canvas.addEventListener("pointerdown", (event) => { down = [event.clientX, event.clientY]; });
  canvas.addEventListener("pointerup", (event) => {
    if (event.button !== 0 || Math.hypot(event.clientX - down[0], event.clientY - down[1]) > 3) return;
    const tick = tickAt(event.pageX, event.pageY);
    if (tick === null) return;
    timeline.play(false);
    timeline.seekTick(tick);
  });
}

const { help } = frame();
const early = () => { throw new Error("await cusp.ready first"); };
window.cusp = {
  ready: Promise.resolve(), facts: facts.facts, seek: early, state: early, linesAt: early, project: early, lineAt: early, show: early, run: (text, settings) => runProgram(text, settings),
};
window.cusp.ready = open(help).catch(fail);
window.cusp.ready.catch(() => undefined);
