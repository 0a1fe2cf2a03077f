// Zero, probe and tool length: a few fields, what will happen in words, one click.
import { signal, useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { fixed } from "../elements";
import { say } from "../studio/store";
import { command, commands, mayMove, now, refresh, tried } from "./machine";
import { leave, restore, touch } from "./probing";
import type { Touch } from "./probing";

const kSystems = ["G54", "G55", "G56", "G57", "G58", "G59"];
const fields = { plate: signal(10), most: signal(20), fast: signal(100), slow: signal(25), tip: signal(6), away: signal(5), from: signal("X+") };
/** The machine's Z where the first tool touched; null: not measured since the page was loaded. */
const reference = signal<number | null>(null);

function Field({ label, of, least, most }: { label: string; of: { value: number }; least: number; most: number }): JSX.Element {
  const typing = useSignal<string | null>(null);
  return <label class="line">{label} <input type="number" min={least} max={most} step="any" value={typing.value ?? of.value} onInput={(event) => { typing.value = event.currentTarget.value; }} onChange={(event) => {
    const typed = Number(event.currentTarget.value);
    typing.value = null;
    of.value = Number.isFinite(typed) ? Math.min(Math.max(typed, least), most) : of.value;
    event.currentTarget.value = String(of.value);
  }} /></label>;
}

const downwards = (): Touch => ({ axis: 2, sign: -1, most: fields.most.value, fast: fields.fast.value, slow: fields.slow.value });

/** Probes, then does what is asked at the place; leaves by so many mm. */
const probe = (at: Touch, then: (place: number) => Promise<unknown>): Promise<boolean> => tried(async () => {
  const before = now.value.modal;
  try {
    const place = await touch(at);
    await then(place);
    await leave(at, fields.away.value, before);
  } catch (reason) {
    if (now.value.state === "Idle") await restore(before).catch(() => undefined);
    throw reason;
  }
  await refresh();
});

const probeHeight = (): Promise<boolean> => probe(downwards(), () => command(`G10L20P0Z${fields.plate.value}`));

function probeSide(): Promise<boolean> {
  const axis = fields.from.value.startsWith("X") ? 0 : 1, sign = fields.from.value.endsWith("+") ? 1 : -1;
  // The tip's centre is half its width before the side.
  return probe({ ...downwards(), axis, sign }, () => command(`G10L20P0${"XY"[axis]}${(-sign * fields.tip.value / 2).toFixed(3)}`));
}

const measureFirst = (): Promise<boolean> => probe(downwards(), (place) => {
  reference.value = place;
  say("The first tool is measured: set work zero with it.");
  return command("G49");
});
const measureNext = (): Promise<boolean> => probe(downwards(), (place) => {
  const length = place - (reference.value ?? place);
  say(`The tool is ${fixed(Math.abs(length), 3)} mm ${length < 0 ? "shorter" : "longer"} than the first.`);
  return command(`G43.1Z${length.toFixed(3)}`);
});

function Zero(): JSX.Element {
  const off = !mayMove.value, system = now.value.modal.find((word) => kSystems.includes(word)) ?? "G54";
  return <section aria-label="Zero">
    <label class="line">Work system <select value={system} disabled={off} onChange={(event) => void commands(event.currentTarget.value)}>{kSystems.map((s) => <option key={s} value={s}>{s}</option>)}</select></label>
    <div class="machine-buttons">
      <button type="button" disabled={off} onClick={() => void commands("G10L20P0X0Y0")}>X Y zero here</button>
      <button type="button" disabled={off} onClick={() => void commands("G10L20P0X0Y0Z0")}>All zero here</button>
      <button type="button" disabled={off} title="At the height where the tool is" onClick={() => void commands("G90G0X0Y0")}>Go to X0 Y0</button>
      {now.value.settings[22] ? <button type="button" disabled={off} onClick={() => void commands("$H")}>Home</button> : null}
    </div>
    <p class="note">"Go to X0 Y0" moves at the height where the tool is: raise it first.</p>
  </section>;
}

function Probe(): JSX.Element {
  const off = !mayMove.value, isOn = now.value.pins.includes("P");
  return <section aria-label="Probe">
    <h2>Probe</h2>
    <p class={isOn ? "fault" : "note"}>{isOn ? "The probe is closed now: lift it off first." : "The probe is open. Close it by hand once: this line then says so."}</p>
    <div class="fields"><Field label="Plate, mm thick" of={fields.plate} least={0} most={100} /><Field label="At most, mm" of={fields.most} least={1} most={200} />
      <Field label="Fast, mm/min" of={fields.fast} least={1} most={2000} /><Field label="Slow, mm/min" of={fields.slow} least={1} most={500} />
      <Field label="Tip, mm wide" of={fields.tip} least={0} most={50} /><Field label="Then away, mm" of={fields.away} least={0.5} most={50} /></div>
    <div class="machine-buttons"><button type="button" class="primary" disabled={off || isOn} onClick={() => void probeHeight()}>Probe Z</button></div>
    <p class="note">{`Down at most ${fields.most.value} mm to the plate; its top becomes Z ${fields.plate.value}.`}</p>
    <div class="row"><label class="line">Towards <select value={fields.from.value} onChange={(event) => { fields.from.value = event.currentTarget.value; }}>{["X+", "X-", "Y+", "Y-"].map((d) => <option key={d} value={d}>{d}</option>)}</select></label>
      <button type="button" disabled={off || isOn} onClick={() => void probeSide()}>{`Probe side in ${fields.from.value}`}</button></div>
    <p class="note">{`The side becomes ${fields.from.value.slice(0, 1)} 0, with a tip ${fields.tip.value} mm wide.`}</p>
  </section>;
}

function Length(): JSX.Element {
  const off = !mayMove.value, way = now.value.settings[341];
  return <section aria-label="Tool length">
    <h2>Tool length</h2>
    <p class="note">Over a plate or setter: measure the first tool, set work zero, and after each change measure again. A length lasts until a reset.</p>
    <div class="machine-buttons"><button type="button" disabled={off} onClick={() => void measureFirst()}>Measure first tool</button>
      <button type="button" disabled={off || reference.value === null} onClick={() => void measureNext()}>Measure this tool</button></div>
    {way === undefined ? null : <><p class="note">{way === 3 ? "M6 measures each tool at the setter under G59.3." : "M6 can measure by itself, on a homed machine: jog the longest tool a little above the setter, then"}</p>
      <div class="machine-buttons"><button type="button" disabled={off || !now.value.settings[22]} title={now.value.settings[22] ? "" : "Needs homing ($22=1)"} onClick={() => void commands("G10L20P9X0Y0Z0", "$341=3")}>The setter is here</button></div></>}
  </section>;
}

export const Wizards = (): JSX.Element => <><Zero /><Probe /><Length /></>;
