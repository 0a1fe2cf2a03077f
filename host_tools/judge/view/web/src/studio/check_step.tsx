// Check: plans the job, cuts the program in memory, and says first whether all bounds hold.
import { effect, signal } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { keyHelp } from "../controls";
import { duration, element, figure } from "../elements";
import { dialog } from "../frame";
import { factsPanel } from "../facts_panel";
import { loadRun } from "../page_data";
import type { PageFacts } from "../run_data";
import { openRun } from "../run_view";
import type { RunView } from "../run_view";
import { filesFor } from "../project/project";
import { textOf } from "../engine/engine";
import { download } from "./files";
import { engine, engineCall, isStale, kinds, kJobName, planned, project, work, working } from "./store";
import type { Program } from "./store";

interface CheckedRun { program: Program; facts: PageFacts; blocks: Map<string, Uint8Array> }
/** The program on show, as the firmware runs it and verify cuts it. */
export const checkedRun = signal<CheckedRun | null>(null);
export const openView = signal<RunView | null>(null);

/** "tray.ngc" for a job of tray.step. */
function programName(): string {
  const part = [...project.value.files.keys()].find((name) => kinds.surfaces.test(name) || kinds.drawing.test(name)) ?? "part";
  return `${part.slice(part.lastIndexOf("/") + 1).replace(/\.[^.]*$/, "")}.ngc`;
}

export async function plan(): Promise<void> {
  const { job, files } = project.value, given = filesFor(project.value);
  const answer = await working("Planning", (options) => engineCall("plan", { job, name: kJobName, program: programName() }, given, options));
  if (!answer) return;
  const programs = answer.result.programs.map(({ name, setup, summary, warnings, block }) => ({ name, setup, summary, warnings, gcode: answer.blocks.get(block) ?? new Uint8Array() }));
  planned.value = { job, files, programs };
  checkedRun.value = null;
  if (programs.length > 0) await check(programs[0]);
}

async function check(program: Program): Promise<void> {
  const now = planned.value;
  if (!now) return;
  const before = now.programs.slice(0, now.programs.indexOf(program)), given = new Map(filesFor(now));
  for (const other of [...before, program]) given.set(other.name, other.gcode);
  const args = { program: program.name, job: now.job, name: kJobName, page: true, ...before.length > 0 ? { after: before.map(({ name }) => name) } : {} };
  const answer = await working("Checking", (options) => engineCall("run", args, given, options));
  if (answer?.result.facts) checkedRun.value = { program, facts: answer.result.facts as PageFacts, blocks: answer.blocks };
}

interface Verdict { good: boolean; text: string; more: string }

function verdictOf({ facts }: CheckedRun): Verdict {
  const broken = facts.verification?.broken ?? [], time = duration(facts.facts.duration_s);
  if (facts.run.errors.length > 0) return { good: false, text: "The controller refuses the program", more: facts.run.errors[0].text };
  if (facts.not_verified) return { good: false, text: "The cut is not verified", more: facts.not_verified };
  if (broken.length > 0) return { good: false, text: broken.length === 1 ? "A bound is broken" : `${broken.length} bounds are broken`, more: broken.join("; ") };
  const engagement = facts.verification?.engagement;
  const over = engagement?.over_mm ? `; ${figure(engagement.over_mm, 3)} mm are cut at more than ${figure(engagement.limit_deg ?? 0)}° of engagement` : "";
  return { good: true, text: "All bounds hold", more: `${time} on the machine${over}` };
}

function Headline(): JSX.Element {
  const run = checkedRun.value;
  if (!run) {
    return <div class="headline"><strong>{planned.value ? "Planned" : "Not planned yet"}</strong>
      <span>{planned.value ? "" : "Plan makes the G-code, cuts it in memory, and checks every bound."}</span></div>;
  }
  const verdict = verdictOf(run);
  return <div class={`headline ${verdict.good ? "good" : "bad"}`} role="status">
    <strong>{`${verdict.good ? "✓" : "✗"} ${verdict.text}`}</strong><span>{verdict.more}</span>
    {isStale.value ? <span class="broken">The job has changed since: plan again.</span> : null}
  </div>;
}

function Programs(): JSX.Element | null {
  const programs = planned.value?.programs ?? [];
  return programs.length === 0 ? null : <ul class="programs">{programs.map((program) => <li key={program.name}>
    <button type="button" aria-pressed={checkedRun.value?.program === program} disabled={work.value !== null} onClick={() => void check(program)}>
      {program.setup ? `${program.name} (${program.setup})` : program.name}</button>
    <button type="button" class="primary" onClick={() => download(program.name, new Blob([program.gcode as BlobPart], { type: "text/plain" }))}>{`Download ${program.name}`}</button>
    {program.warnings.length > 0 ? <ul class="warnings">{program.warnings.map((text) => <li key={text}>{text}</li>)}</ul> : null}
  </li>)}</ul>;
}

let keysDialog: HTMLDialogElement | null = null;
function showKeys(): void {
  keysDialog ??= dialog("Keys", element("dl", { class: "keys" }, ...keyHelp.flatMap(([key, what]) => [element("dt", {}, key), element("dd", {}, what)])));
  keysDialog.showModal();
}

// The parts of the run's page, anew for each run.
async function showRun(host: HTMLElement, run: CheckedRun): Promise<RunView> {
  const part = (name: string, label: string) => element("section", { class: name, "aria-label": label });
  const places = { stage: part("stage", "Scene"), program: part("program", "Program"), transport: part("transport", "Time"), charts: part("charts", "Charts") };
  const facts = part("facts", "Facts"), status = element("div", { class: "status", role: "status" }, "Unpacking the run …");
  facts.tabIndex = 0;
  let view = null as RunView | null;
  facts.append(...factsPanel(run.facts, { toLine: (line) => view?.toLine(line), toPlace: (at) => view?.toPlace(at) }));
  places.stage.append(status);
  host.replaceChildren(facts, places.stage, places.program, places.transport, places.charts);
  try {
    view = await openRun(places, run.facts, (begun) => loadRun(run.facts, (name) => run.blocks.get(`data-${name}`) ?? new Uint8Array(), begun), status, showKeys);
  } catch (reason) {
    status.textContent = textOf(reason);
    throw reason;
  }
  await view.drawn();
  if (view.scene) status.remove();
  return view;
}

function Run(): JSX.Element {
  const host = useRef<HTMLDivElement>(null);
  useEffect(() => effect(() => {
    const run = checkedRun.value;
    openView.peek()?.close();
    openView.value = null;
    if (!run || !host.current) {
      host.current?.replaceChildren();
      return;
    }
    showRun(host.current, run).then((view) => {
      if (checkedRun.peek() === run) openView.value = view;
      else view.close();
    }, () => undefined);
  }), []);
  useEffect(() => () => {
    openView.peek()?.close();
    openView.value = null;
  }, []);
  return <div class="run-view" ref={host} hidden={checkedRun.value === null} />;
}

export function CheckStep(): JSX.Element {
  return <div class="check">
    <div class="check-bar">
      <button type="button" class="primary" disabled={work.value !== null || !engine.value || project.value.job === ""} onClick={() => void plan()}>Plan</button>
      <Headline />
      <Programs />
    </div>
    <Run />
  </div>;
}
