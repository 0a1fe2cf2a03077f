// Machine: the virtual mill or a controller on a serial port. Nothing moves without a click; Stop and Esc always work.
import { signal } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect } from "preact/hooks";
import { JogPanel } from "./jog_panel";
import { MacroPanel } from "./macro_panel";
import { prepare } from "./machine";
import { OverridePanel } from "./override_panel";
import { PathPanel } from "./path_panel";
import { PortPanel } from "./port_panel";
import { Readout } from "./readout";
import { RunPanel, StopButton } from "./run_panel";
import { Wizards } from "./wizards";

const kPanels = [
  { id: "run", name: "Cut", panel: RunPanel }, { id: "jog", name: "Jog", panel: JogPanel }, { id: "zero", name: "Zero", panel: Wizards },
  { id: "rates", name: "Rates", panel: OverridePanel }, { id: "macros", name: "Macros", panel: MacroPanel },
];
const shown = signal("run");

export function MachineStep(): JSX.Element {
  useEffect(prepare, []);
  const { id, panel: Panel } = kPanels.find((p) => p.id === shown.value) ?? kPanels[0];
  return <div class="machine">
    <div class="machine-side">
      <Readout />
      <PortPanel />
      <div class="choice" role="group" aria-label="Panel">{kPanels.map((p) => <button key={p.id} type="button" aria-pressed={p.id === id} onClick={() => { shown.value = p.id; }}>{p.name}</button>)}</div>
      <Panel />
      <div class="stop-bar"><StopButton /></div>
    </div>
    <PathPanel />
  </div>;
}
