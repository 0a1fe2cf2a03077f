// The program: run, hold, stop; from a line, and after a lost link.
import { signal } from "@preact/signals";
import type { JSX } from "preact";
import { figure, fixed } from "../elements";
import { checkedRun } from "../studio/check_step";
import { isStale, kinds, planned, project } from "../studio/store";
import { crcOf } from "./cut_record";
import { forgetLeft, goOn, goTheWay, hold, holdsOnSilence, isBusy, isOpen, left, lookAtLine, now, resume, runProgram, running, stop, wayBack } from "./machine";

interface Choice { name: string; text: () => string; holds: boolean }

const chosen = signal(""), fromLine = signal("");
/** The program for which Run was clicked though its bounds are not known to hold: the second click runs it. */
const warned = signal("");

function holdsOf(name: string): boolean {
  const run = checkedRun.value;
  return !isStale.value && run?.program.name === name && run.facts.verification?.broken.length === 0 && run.facts.run.errors.length === 0;
}

// Programs of the plan, and those that lie in the project.
function choices(): Choice[] {
  const made = (planned.value?.programs ?? []).map(({ name, gcode }) => ({ name, text: () => new TextDecoder().decode(gcode), holds: holdsOf(name) }));
  const given = [...project.value.files].filter(([name]) => kinds.program.test(name)).map(([name, bytes]) => ({ name, text: () => new TextDecoder().decode(bytes), holds: false }));
  return [...made, ...given];
}

export const choice = (): Choice | undefined => choices().find(({ name }) => name === chosen.value) ?? choices().at(0);

/** True if it may begin: its bounds hold, or this is the second click. */
function confirmed(program: Choice): boolean {
  const sure = program.holds || warned.value === program.name;
  warned.value = sure ? "" : program.name;
  return sure;
}

async function run(): Promise<void> {
  const program = choice();
  if (program && !isBusy.value && confirmed(program)) await runProgram(program.name, program.text());
}

async function look(): Promise<void> {
  const program = choice(), line = Number(fromLine.value);
  if (program && line >= 1) await lookAtLine(program.name, program.text(), line);
}

// The question before a program begins amid itself.
function Way(): JSX.Element | null {
  const found = wayBack.value;
  if (!found) return null;
  const { way } = found, [x, y, z] = way.point;
  return <div class="card" role="alert">
    <p>{[`The program goes on at line ${way.line}. `, way.tool > 0 ? `Tool T${way.tool} must be in the spindle. ` : "",
      `The tool goes up to Z ${fixed(way.travel_z, 3)} and over X ${fixed(x, 3)} Y ${fixed(y, 3)}`, way.spindle > 0 ? `, the spindle turns at ${figure(way.spindle, 5)}` : "",
      way.plunges ? `, then down to Z ${fixed(z, 3)} at ${figure(way.plunge_feed, 5)} mm/min.` : "."].join("")}</p>
    <div class="machine-buttons">
      <button type="button" class="primary" disabled={now.value.state !== "Idle"} onClick={() => void goTheWay()}>{`Go on at line ${way.line}`}</button>
      <button type="button" onClick={() => { wayBack.value = null; }}>Not now</button>
    </div>
  </div>;
}

function Lost(): JSX.Element | null {
  const { run: at, link } = now.value;
  if (at?.phase !== "lost" || wayBack.value) return null;
  if (link !== "open") return <p class="note">Plug the cable in and connect again: the program goes on from there.</p>;
  if (at.canContinue) {
    return <div class="card" role="alert"><p>The controller still knows the program: it goes on, and each line is cut once.</p>
      <button type="button" class="primary" onClick={() => void goOn()}>Go on</button></div>;
  }
  return <div class="card" role="alert"><p>{`The controller no longer knows the program. The tool had reached line ${at.executed}.`}</p>
    <button type="button" disabled={!isOpen.value || !running.value} onClick={() => {
      if (running.value) void lookAtLine(running.value.name, running.value.text, Math.max(at.executed, 1));
    }}>{`Show the way to line ${at.executed}`}</button></div>;
}

// After a page that was closed amid a cut.
function Left(): JSX.Element | null {
  const record = left.value, program = choices().find(({ name, text }) => name === record?.name && crcOf(text()) === record.crc);
  if (!record || now.value.run || wayBack.value || !program) return null;
  return <div class="card" role="alert">
    <p>{`The page was closed amid ${program.name}: the tool had reached line ${record.line}.${isOpen.value ? "" : " Connect the machine to go on there."}`}</p>
    <div class="machine-buttons">
      <button type="button" disabled={!isOpen.value} onClick={() => {
        chosen.value = program.name;
        void lookAtLine(program.name, program.text(), record.line);
      }}>{`Show the way to line ${record.line}`}</button>
      <button type="button" onClick={forgetLeft}>Forget it</button>
    </div>
  </div>;
}

function FromLine(): JSX.Element {
  return <details><summary>From a line</summary>
    <div class="row"><label class="line">Line <input type="number" min={1} step={1} value={fromLine.value} onInput={(event) => { fromLine.value = event.currentTarget.value; }} /></label>
      <button type="button" disabled={isBusy.value || !isOpen.value || !choice() || !(Number(fromLine.value) >= 1)} onClick={() => void look()}>Show the way</button></div>
    <p class="note">The controller is reset for it. Nothing moves before you have seen the way.</p>
  </details>;
}

export function RunPanel(): JSX.Element {
  const list = choices(), program = choice(), busy = isBusy.value, isWarned = warned.value !== "" && warned.value === program?.name;
  const held = now.value.state === "Hold" || now.value.state === "Door", { link } = now.value;
  return <section aria-label="Program">
    <label class="line">Program <select value={program?.name ?? ""} disabled={busy || list.length === 0} onChange={(event) => { chosen.value = event.currentTarget.value; }}>
      {list.length === 0 ? <option value="">none yet: plan one, or drop a program</option> : list.map(({ name }) => <option key={name} value={name}>{name}</option>)}</select></label>
    <div class="machine-buttons">
      <button type="button" class="primary" disabled={busy || !program || (link !== "none" && !isOpen.value)} onClick={() => void run()}>{isWarned ? "Run all the same" : "Run"}</button>
      <button type="button" disabled={link !== "open"} onClick={held ? resume : hold}>{held ? "Resume" : "Hold"}</button>
    </div>
    {isWarned ? <p class="fault" role="alert">It is not checked that the bounds of this program hold. Run again to run it all the same.</p> : null}
    <Lost />
    <Left />
    <Way />
    <FromLine />
    <label class="line check-line"><input type="checkbox" checked={holdsOnSilence.value} onChange={(event) => { holdsOnSilence.value = event.currentTarget.checked; }} />
      The machine holds when this page falls silent</label>
  </section>;
}

export const StopButton = (): JSX.Element => <button type="button" class="stop" disabled={now.value.link === "none"} onClick={stop} title="Esc">{now.value.stopping ? "Stop at once" : "Stop"}</button>;
