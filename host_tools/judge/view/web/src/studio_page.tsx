// The studio: five steps from a part to a machine, one bar, nothing modal. Provides `window.cusp` for scripts and tests.
import { signal } from "@preact/signals";
import { render } from "preact";
import type { JSX } from "preact";
import { useEffect } from "preact/hooks";
import { loopbackEngine } from "./engine/loopback_engine";
import { holdsEngine, WasmEngine } from "./engine/wasm_engine";
import { frameButtons } from "./frame";
import { shown } from "./project/toml_values";
import { tablesOf } from "./project/project";
import { checkedRun, CheckStep, openView, plan } from "./studio/check_step";
import { newProject, saveProjectFile, takeFiles } from "./studio/files";
import { keepAwake } from "./machine/keep_awake";
import { mill, now as machineNow, stop } from "./machine/machine";
import { MachineStep } from "./machine/machine_step";
import { OperationsStep } from "./studio/operations_step";
import { PartStep } from "./studio/part_step";
import { Stage } from "./studio/stage";
import { StockStep } from "./studio/stock_step";
import { checked, engineText, history, job, keys, planned, project, said, start, work } from "./studio/store";

const steps = [
  { id: "part", name: "Part", step: PartStep }, { id: "stock", name: "Stock", step: StockStep },
  { id: "operations", name: "Operations", step: OperationsStep }, { id: "check", name: "Check", step: CheckStep },
  { id: "machine", name: "Machine", step: MachineStep },
];
const idNow = () => steps.find(({ id }) => `#${id}` === window.location.hash)?.id ?? "part";

const server = loopbackEngine();
const step = signal(idNow()), look = signal(0);
const [themed, rights] = frameButtons(() => {
  look.value += 1;
  openView.value?.restyle();
});

// The mark beside a step's name: what is done, and what is wrong.
function markOf(id: string): string {
  if (id === "part") return project.value.files.size > 0 ? "✓" : "";
  if (id === "operations") return checked.value.faults.length > 0 || job.value.fault ? "!" : checked.value.setups.length > 0 ? "✓" : "";
  if (id === "check") return checkedRun.value ? (checkedRun.value.facts.verification?.broken.length === 0 ? "✓" : "!") : "";
  return "";
}

function Head(): JSX.Element {
  return <header class="studio-head">
    <h1><span class="brand">cusp</span> studio</h1>
    <nav aria-label="Steps">{steps.map(({ id, name }, k) => <a key={id} href={`#${id}`} aria-current={step.value === id ? "step" : undefined}>
      <span class="step-number">{k + 1}</span>{name}<span class={`mark ${markOf(id) === "!" ? "broken" : "holds"}`}>{markOf(id)}</span></a>)}</nav>
    <span class="space" />
    <button type="button" disabled={!history.canUndo.value} onClick={() => history.undo()} title="Undo (Ctrl+Z)">Undo</button>
    <button type="button" disabled={!history.canRedo.value} onClick={() => history.redo()} title="Redo (Ctrl+Shift+Z)">Redo</button>
    <details class="menu"><summary>Project</summary><div ref={(host) => { if (host && !host.contains(themed)) host.append(themed, rights); }}>
      <button type="button" onClick={newProject}>New</button>
      <button type="button" disabled={project.value.job === "" && project.value.files.size === 0} onClick={saveProjectFile}>Save as zip</button>
    </div></details>
  </header>;
}

function Foot(): JSX.Element {
  const at = work.value;
  return <footer class="studio-foot">
    {at ? <div class="work" role="status"><strong>{at.title}</strong><progress max={1} value={at.share} aria-label={at.title} /><span>{`${Math.round(100 * at.share)} % ${at.text}`}</span>
      <button type="button" onClick={at.cancel}>Cancel</button></div>
      : <p class={said.value?.bad ? "said broken" : "said"} role={said.value?.bad ? "alert" : "status"}>{said.value?.text ?? ""}</p>}
    <span class="space" />
    <span class="note">{engineText.value}</span>
  </footer>;
}

function App(): JSX.Element {
  const at = steps.find(({ id }) => id === step.value) ?? steps[0], withStage = step.value !== "check" && step.value !== "machine";
  useEffect(() => { document.title = `${at.name} – cusp studio`; });
  return <>
    <Head />
    <main class={withStage ? "with-stage" : "whole"}>
      <section class="step" aria-label={at.name} key={at.id} tabIndex={withStage ? 0 : undefined}><at.step /></section>
      {withStage ? <Stage themed={look.value % 2 === 1} /> : null}
    </main>
    <Foot />
    <datalist id="files-of-project">{[...project.value.files.keys()].map((name) => <option key={name} value={name} />)}</datalist>
    <datalist id="tools-of-project">{tablesOf(job.value.values, "tool").map((tool, k) => <option key={k} value={shown(tool.number ?? tool.name ?? k + 1)} />)}</datalist>
  </>;
}

const isEdited = (target: EventTarget | null): boolean => target instanceof HTMLElement && /^(INPUT|TEXTAREA|SELECT)$/.test(target.tagName);

function listen(): void {
  window.addEventListener("hashchange", () => { step.value = idNow(); });
  document.addEventListener("keydown", (event) => {
    if (event.key === "Escape") stop();
    if (!(event.ctrlKey || event.metaKey) || isEdited(event.target)) return;
    const key = event.key.toLowerCase();
    if (key === "z" && !event.shiftKey) history.undo();
    else if (key === "y" || key === "z") history.redo();
    else return;
    event.preventDefault();
  });
  document.addEventListener("dragover", (event) => { event.preventDefault(); document.body.classList.add("dropping"); });
  document.addEventListener("dragleave", () => document.body.classList.remove("dropping"));
  document.addEventListener("drop", (event) => {
    event.preventDefault();
    document.body.classList.remove("dropping");
    void takeFiles([...event.dataTransfer?.files ?? []]);
  });
  keepAwake();
}

document.body.classList.add("studio");
listen();
render(<App />, document.getElementById("app")!);
if (server) void server.stayOpen().catch(() => { engineText.value = "cusp studio has ended: start it again"; });
const ready = start(server ?? (holdsEngine ? new WasmEngine() : null));
Object.assign(window, {
  cusp: {
    ready,
    take: takeFiles, plan,
    state: () => ({
      step: step.value, job: project.value.job, files: [...project.value.files.keys()], faults: checked.value.faults,
      programs: planned.value?.programs.map(({ name, gcode }) => ({ name, bytes: gcode.length })) ?? [],
      checked: checkedRun.value?.facts.facts ?? null, machine: machineNow.value, mill: mill.value, strategies: keys.value?.strategies.map(({ name }) => name) ?? [],
    }),
  },
});
