// Machine: the virtual mill, which is the firmware itself in this page. Nothing moves without a click.
import { effect, signal, useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { drawProgram, hasCore } from "../core/run_program";
import { duration, figure, fixed } from "../elements";
import { isDark } from "../frame";
import { isAbort, textOf } from "../engine/engine";
import { Mill } from "../mill/mill";
import type { MillReport, MillState } from "../mill/messages";
import { PathView } from "../playground/path_view";
import { checkedRun } from "./check_step";
import { planned, project, say, kinds, isStale } from "./store";

const rates = [1, 10, 60, 300];
const atRest: MillReport = { state: "idle", at: [0, 0, 0], speed: 0, line: 0, seconds: 0, fraction: 0, text: "", edges: "" };
const words: Record<MillState, string> = { idle: "At rest", run: "Running", hold: "Held", ended: "Ended", stopped: "Stopped: the controller was reset", fault: "Fault" };

export const now = signal(atRest);
const rate = signal(1), chosen = signal("");
let mill: Mill | null = null;

const running = () => now.value.state === "run" || now.value.state === "hold";

interface Choice { name: string; text: () => string; holds: boolean }

// Programs of the plan, and those that lie in the project.
function choices(): Choice[] {
  const made = (planned.value?.programs ?? []).map(({ name, gcode }) => ({ name, text: () => new TextDecoder().decode(gcode), holds: holdsOf(name) }));
  const given = [...project.value.files].filter(([name]) => kinds.program.test(name)).map(([name, bytes]) => ({ name, text: () => new TextDecoder().decode(bytes), holds: true }));
  return [...made, ...given];
}

function holdsOf(name: string): boolean {
  const run = checkedRun.value;
  return !isStale.value && run?.program.name === name && run.facts.verification?.broken.length === 0 && run.facts.run.errors.length === 0;
}

const choice = (): Choice | undefined => choices().find(({ name }) => name === chosen.value) ?? choices().at(0);

/** True once Run was clicked for a program whose bounds are not known to hold: the second click runs it. */
const warned = signal("");

async function run(): Promise<void> {
  const program = choice();
  if (!program || running()) return;
  if (!program.holds && warned.value !== program.name) {
    warned.value = program.name;
    return;
  }
  warned.value = "";
  mill?.close();
  mill = new Mill((report) => { now.value = report; }, (why) => {
    now.value = { ...now.value, state: "fault", text: why };
  });
  now.value = { ...atRest, state: "run" };
  try {
    await mill.start(program.text(), "", rate.value);
  } catch (reason) {
    now.value = { ...atRest, state: "fault", text: textOf(reason) };
    say(textOf(reason), true);
  }
}

/** Works at any time, from any step. */
export function stopMill(): void {
  if (running()) mill?.stop();
}

function holdOrResume(): void {
  const held = now.value.state === "hold";
  if (held) mill?.resume();
  else mill?.hold();
  now.value = { ...now.value, state: held ? "run" : "hold" };
}

function Readout(): JSX.Element {
  const { at, speed, line, seconds, fraction, state, text } = now.value;
  return <div class="dro">
    <p class={`mill-state ${state}`} role="status">{words[state]}{text ? `: ${text}` : ""}</p>
    <dl>{["X", "Y", "Z"].flatMap((axis, k) => [<dt key={axis}>{axis}</dt>, <dd key={`${axis}v`}>{fixed(at[k], 3)}<small> mm</small></dd>])}</dl>
    <p class="note">{`${figure(60 * speed, 4)} mm/min, line ${line}, ${duration(seconds)}`}</p>
    <progress max={1} value={fraction} aria-label="How far the program is" />
  </div>;
}

// The path of the whole program, and where the tool is on it.
function Path(): JSX.Element {
  const host = useRef<HTMLDivElement>(null), note = useSignal("");
  useEffect(() => {
    const view = new PathView(host.current!, isDark);
    let stop = new AbortController();
    const ends = [effect(() => {
      const program = choice();
      stop.abort();
      stop = new AbortController();
      if (!program || !hasCore) return;
      note.value = "Running the program through for its path …";
      const progress = ({ fraction }: { fraction: number }) => { note.value = `Running the program through for its path: ${Math.round(100 * fraction)} %`; };
      drawProgram(program.text(), "", { signal: stop.signal, progress }).then(({ path }) => {
        note.value = "";
        view.show(path);
        view.look3d();
      }, (reason: unknown) => { if (!isAbort(reason)) note.value = textOf(reason); });
    }), effect(() => view.mark(now.value.state === "idle" ? null : now.value.at))];
    return () => {
      stop.abort();
      for (const end of ends) end();
    };
  }, []);
  return <div class="stage" ref={host}>{note.value ? <p class="stage-note">{note.value}</p> : null}</div>;
}

export function MachineStep(): JSX.Element {
  const list = choices(), program = choice(), busy = running();
  if (!hasCore) return <p class="note machine-note">This build of cusp has no virtual mill: build it with the packages for WebAssembly.</p>;
  return <div class="machine">
    <div class="machine-side">
      <Readout />
      <div class="machine-buttons">
        <button type="button" class="primary" disabled={busy || !program} onClick={() => void run()}>{warned.value && warned.value === program?.name ? "Run all the same" : "Run"}</button>
        <button type="button" disabled={!busy} onClick={holdOrResume}>{now.value.state === "hold" ? "Resume" : "Hold"}</button>
        <button type="button" class="stop" disabled={!busy} onClick={stopMill}>Stop</button>
      </div>
      {warned.value && warned.value === program?.name ? <p class="fault" role="alert">It is not checked that the bounds of this program hold. Run again to run it all the same.</p> : null}
      <label class="line">Program <select value={program?.name ?? ""} disabled={busy || list.length === 0} onChange={(event) => { chosen.value = event.currentTarget.value; }}>
        {list.length === 0 ? <option value="">none yet: plan one, or drop a program</option> : list.map(({ name }) => <option key={name} value={name}>{name}</option>)}</select></label>
      <label class="line">Time <select value={String(rate.value)} onChange={(event) => {
        rate.value = Number(event.currentTarget.value);
        mill?.rate(rate.value);
      }}>{rates.map((r) => <option key={r} value={String(r)}>{r === 1 ? "as on a machine" : `${r} times as fast`}</option>)}</select></label>
      <p class="note">The virtual mill is the controller's firmware in this page: it holds, resets and answers as a board does. Esc stops it.</p>
    </div>
    <Path />
  </div>;
}
