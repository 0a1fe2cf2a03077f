// The playground: runs a program with settings on the firmware's core; provides `window.cusp.run`.
import firstProgram from "../first.ngc";
import type { Settings } from "./core/core";
import { drawProgram, hasCore, runProgram, settingTable } from "./core/run_program";
import { button, duration, element, inOrder } from "./elements";
import { frameButtons, isDark, place } from "./frame";
import { PathView } from "./playground/path_view";
import { ProfileCharts, type Limits } from "./playground/profile_charts";
import { ProgramPanel } from "./playground/program_panel";
import { resultPanel } from "./playground/result_panel";
import { SettingsPanel } from "./playground/settings_panel";

const parts = { program: place("program", "Program"), stage: place("stage", "Path"), facts: place("facts", "Result and settings"), charts: place("charts", "Charts") };
const name = element("h1", {}, "cusp playground");
const state = element("span", { class: "run-state", role: "status" });
const bar = element("progress", { max: "1", value: "0", "aria-label": "How far the run is" });
const result = element("div", { class: "result" });

interface Editor { program: ProgramPanel; settings: SettingsPanel; path: PathView; charts: ProfileCharts; run: HTMLButtonElement; stop: HTMLButtonElement }

let running: AbortController | null = null;
let last: { profile: Float64Array; limits: Limits } | null = null;

function limitsOf(settings: SettingsPanel): Limits {
  const axes = (first: number, scale = 1) => [0, 1, 2].map((k) => settings.value(first + k) * scale);
  return { velocity: axes(110, 1 / 60), acceleration: axes(120), jerk: axes(800) };
}

async function run(editor: Editor): Promise<void> {
  running?.abort();
  const mine = running = new AbortController(), started = performance.now();
  editor.run.disabled = true;
  editor.stop.disabled = false;
  bar.hidden = false;
  bar.value = 0;
  state.textContent = "running …";
  try {
    const limits = limitsOf(editor.settings);
    const drawn = await drawProgram(editor.program.text, editor.settings.text(), {
      signal: mine.signal,
      progress: (p) => { bar.value = p.fraction; state.textContent = `line ${p.line}, ${duration(p.simulated_s)} of the mill`; },
    });
    last = { profile: drawn.profile, limits };
    editor.path.show(drawn.path);
    editor.charts.show(drawn.profile, limits);
    editor.program.show(drawn.result.errors);
    result.replaceChildren(...resultPanel(drawn.result, limits));
    const faults = drawn.result.errors.length;
    state.textContent = `${duration(drawn.result.duration_s)} in motion, run in ${((performance.now() - started) / 1000).toFixed(2)} s` + (faults ? ": ends early" : "");
    state.classList.toggle("broken", faults > 0);
  } catch (reason) {
    if (running !== mine) return;
    state.textContent = mine.signal.aborted ? "stopped" : reason instanceof Error ? reason.message : String(reason);
    state.classList.toggle("broken", !mine.signal.aborted);
  } finally {
    if (running === mine) {
      editor.run.disabled = false;
      editor.stop.disabled = true;
      bar.hidden = true;
      running = null;
    }
  }
}

async function open(file: File, editor: Editor): Promise<void> {
  const text = await file.text();
  if (/^\s*(?:[;#(].*\s+)*\$\d+\s*=/.test(text.slice(0, 4000))) {
    state.textContent = `${editor.settings.take(text)} settings from ${file.name}`;
    return;
  }
  name.textContent = inOrder(file.name);
  document.title = `${inOrder(file.name)} – cusp playground`;
  editor.program.text = text;
  await run(editor);
}

function listen(editor: Editor, picker: HTMLInputElement): void {
  picker.addEventListener("change", () => {
    const file = picker.files?.[0];
    picker.value = "";
    if (file) void open(file, editor);
  });
  document.addEventListener("dragover", (event) => { event.preventDefault(); document.body.classList.add("dropping"); });
  document.addEventListener("dragleave", () => document.body.classList.remove("dropping"));
  document.addEventListener("drop", (event) => {
    event.preventDefault();
    document.body.classList.remove("dropping");
    const file = event.dataTransfer?.files[0];
    if (file) void open(file, editor);
  });
  document.addEventListener("keydown", (event) => {
    if (event.key === "Enter" && (event.ctrlKey || event.metaKey)) void run(editor);
    if (event.key === "Escape") running?.abort();
  });
}

function header(editor: () => Editor, picker: HTMLInputElement): { bar: HTMLElement; run: HTMLButtonElement; stop: HTMLButtonElement } {
  const start = button("Run", "Run (Ctrl+Enter)", () => void run(editor())), stop = button("Stop", "Stop (Esc)", () => running?.abort());
  start.classList.add("primary");
  stop.disabled = true;
  const common = frameButtons(() => {
    if (!last) return;
    editor().path.redraw();
    editor().charts.show(last.profile, last.limits);
  });
  const bars = element("header", {}, name, button("Open …", "Open a program or settings; they may be dropped, too", () => picker.click()), start, stop, bar, state,
    element("span", { class: "space" }), ...common);
  return { bar: bars, run: start, stop };
}

async function build(): Promise<void> {
  document.body.classList.add("playground");
  const picker = element("input", { type: "file", accept: ".ngc,.nc,.gcode,.tap,.cnc,.txt,.settings", hidden: "", "aria-label": "File to open" });
  bar.hidden = true;
  const editor = {} as Editor;
  const head = header(() => editor, picker);
  document.getElementById("app")!.append(head.bar, element("main", {}, parts.program, parts.stage, parts.facts, parts.charts), picker);
  if (!hasCore) state.textContent = "this page was built without the core: install the WebAssembly packages and build cusp again";
  parts.facts.tabIndex = 0;
  const settings = new SettingsPanel(await settingTable(), () => void run(editor));
  Object.assign(editor, {
    program: new ProgramPanel(parts.program, firstProgram), settings, path: new PathView(parts.stage, isDark),
    charts: new ProfileCharts(parts.charts, isDark), run: head.run, stop: head.stop,
  });
  parts.facts.append(result, settings.host);
  listen(editor, picker);
  await run(editor);
}

const ready = build();
ready.catch(() => undefined);
Object.assign(window, { cusp: { ready, run: (text: string, settings: Settings = "") => runProgram(text, settings) } });
