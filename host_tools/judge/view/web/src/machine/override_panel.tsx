// Overrides of feed, rapids and spindle, and what else acts at once.
import type { JSX } from "preact";
import { isOpen, now, realtime } from "./machine";

interface Row { name: string; at: number; buttons: [string, number, string][] }
const kRows: Row[] = [
  { name: "Feed", at: 0, buttons: [["−10", 0x92, "ten less"], ["−1", 0x94, "one less"], ["100 %", 0x90, "as programmed"], ["+1", 0x93, "one more"], ["+10", 0x91, "ten more"]] },
  { name: "Rapids", at: 1, buttons: [["25 %", 0x97, "a quarter"], ["50 %", 0x96, "half"], ["100 %", 0x95, "full"]] },
  { name: "Spindle", at: 2, buttons: [["−10", 0x9B, "ten less"], ["−1", 0x9D, "one less"], ["100 %", 0x99, "as programmed"], ["+1", 0x9C, "one more"], ["+10", 0x9A, "ten more"]] },
];

export function OverridePanel(): JSX.Element {
  const off = now.value.link !== "open";
  return <section aria-label="Overrides">
    {kRows.map(({ name, at, buttons }) => <div key={name} role="group" aria-label={name}>
      <p class="note">{`${name} ${now.value.overrides[at]} %`}</p>
      <div class="choice">{buttons.map(([label, byte, what]) => <button key={label} type="button" disabled={off} title={`${name}: ${what}`} onClick={() => { realtime(byte); }}>{label}</button>)}</div>
    </div>)}
    <div class="machine-buttons">
      <button type="button" disabled={off} onClick={() => { realtime(0xA0); }}>Flood</button>
      <button type="button" disabled={off} onClick={() => { realtime(0xA1); }}>Mist</button>
      <button type="button" disabled={off || now.value.state !== "Hold"} title="In a hold" onClick={() => { realtime(0x9E); }}>Spindle off or on</button>
    </div>
    {isOpen.value ? null : <p class="note">No machine is ready.</p>}
  </section>;
}
