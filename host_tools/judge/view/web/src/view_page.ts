// The page of one run: creates its parts, and provides `window.cusp`.
import { keyHelp } from "./controls";
import { button, duration, element, inOrder, metres } from "./elements";
import { dialog, frameButtons, place } from "./frame";
import { factsPanel } from "./facts_panel";
import type { RunResult } from "./core/core";
import { runProgram } from "./core/run_program";
import { documentRead, loadRun, pageFacts, takeBlock } from "./page_data";
import type { MainFacts, Triple, WorstPlace } from "./run_data";
import { openRun, pixelsOf } from "./run_view";
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

let restyle: () => void = () => undefined;

function frame(): { help: () => void } {
  // Charts come later and must not move the rest.
  document.documentElement.style.setProperty("--chart-rows", facts.verification?.engagement ? "5" : "4");
  document.title = `${inOrder(facts.program)} – cusp view`;
  const keys = dialog("Keys", element("dl", { class: "keys" }, ...keyHelp.flatMap(([key, what]) => [element("dt", {}, key), element("dd", {}, what)])));
  const [themed, rights] = frameButtons(() => restyle());
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

async function open(help: () => void): Promise<void> {
  const view = await openRun(parts, facts, (begun) => loadRun(facts, takeBlock, begun, documentRead()), status, help);
  const { timeline, scene } = view;
  ({ restyle, toLine: later.line, toPlace: later.place } = view);
  Object.assign(window.cusp, {
    seek: async (t_s: number) => {
      timeline.seekTick(timeline.tickOf(t_s));
      await scene?.whenDrawn();
    },
    state: () => timeline.state(),
    linesAt: (line: number) => timeline.ticksOfLine(line)?.map((tick) => timeline.timeOf(tick)) ?? null,
    project: (at: Triple) => pixelsOf(view, at),
    lineAt: (px: number, py: number) => {
      const tick = view.tickAt(px, py);
      return tick === null ? null : timeline.lineOf(tick);
    },
    show: view.show,
  });
  if (!scene) throw new Error(status.textContent);
  const still = location.hash === "#still";
  await view.drawn();
  if (still) await scene.whenDrawn(false);
  status.remove();
  if (still) document.documentElement.classList.add("still");
}

const { help } = frame();
const early = () => { throw new Error("await cusp.ready first"); };
window.cusp = {
  ready: Promise.resolve(), facts: facts.facts, seek: early, state: early, linesAt: early, project: early, lineAt: early, show: early, run: (text, settings) => runProgram(text, settings),
};
window.cusp.ready = open(help).catch(fail);
window.cusp.ready.catch(() => undefined);
