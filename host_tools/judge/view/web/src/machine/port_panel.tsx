// Which machine: the virtual mill in this page, or a controller on a serial port.
import type { JSX } from "preact";
import { hasCore } from "../core/run_program";
import { baud, connectMill, connectSerial, disconnect, hasSerial, isBusy, mill, now, rate, setRate } from "./machine";

const kRates = [1, 10, 60, 300];
const kBauds = [9600, 57600, 115200, 230400, 250000, 460800, 921600];

const Rate = (): JSX.Element => <label class="line">Time <select value={String(rate.value)} onChange={(event) => { setRate(Number(event.currentTarget.value)); }}>
  {kRates.map((r) => <option key={r} value={String(r)}>{r === 1 ? "as on a machine" : `cuts ${r} times as fast`}</option>)}</select></label>;

function Opened(): JSX.Element {
  return <div class="row port">
    <button type="button" disabled={isBusy.value} title={isBusy.value ? "Stop the program first" : ""} onClick={disconnect}>Disconnect</button>
    {mill.value ? <Rate /> : null}
  </div>;
}

export function PortPanel(): JSX.Element {
  const { link } = now.value, without = [hasCore ? "" : "This build of cusp has no virtual mill.", hasSerial ? "" : "This browser has no WebSerial: Chromium, Chrome, Edge and Opera have."];
  if (link === "open" || link === "opening") return <Opened />;
  return <section aria-label="Connect">
    <div class="machine-buttons">
      {hasCore ? <button type="button" onClick={() => void connectMill()}>Virtual mill</button> : null}
      {hasSerial ? <button type="button" onClick={() => void connectSerial()}>Serial port …</button> : null}
    </div>
    <div class="row">
      {hasSerial ? <label class="line">Baud <select value={String(baud.value)} onChange={(event) => { baud.value = Number(event.currentTarget.value); }}>
        {kBauds.map((b) => <option key={b} value={String(b)}>{String(b)}</option>)}</select></label> : null}
      {hasCore ? <Rate /> : null}
    </div>
    <p class="note">{[hasCore ? "The virtual mill is the controller's firmware in this page: it holds, resets and answers as a board does. Esc stops it." : "", ...without].join(" ").trim()}</p>
  </section>;
}
