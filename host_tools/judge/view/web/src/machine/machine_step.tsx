// Machine: the virtual mill or a controller on a serial port. Nothing moves without a click; Stop and Esc always work.
import type { JSX } from "preact";
import { useEffect } from "preact/hooks";
import { prepare } from "./machine";
import { PathPanel } from "./path_panel";
import { PortPanel } from "./port_panel";
import { Readout } from "./readout";
import { RunPanel, StopButton } from "./run_panel";

export function MachineStep(): JSX.Element {
  useEffect(prepare, []);
  return <div class="machine">
    <div class="machine-side">
      <Readout />
      <PortPanel />
      <RunPanel />
      <div class="stop-bar"><StopButton /></div>
    </div>
    <PathPanel />
  </div>;
}
