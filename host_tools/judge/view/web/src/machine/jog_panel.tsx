// Jogging by buttons, keys and a gamepad. Keys and gamepad are off until they are clicked on, and off again where the page is left.
import { signal } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect } from "preact/hooks";
import { startGamepad } from "./gamepad";
import { jogBegin, jogEnd, jogStep, mayMove, now } from "./machine";

const kSteps = [0.01, 0.1, 1, 10];
/** mm; 0: for as long as the button is held. */
const step = signal(1), feed = signal(1000);
export const keysJog = signal(false), gamepadJogs = signal(false);

const kKeys: Record<string, number[]> = {
  ArrowLeft: [-1, 0, 0], ArrowRight: [1, 0, 0], ArrowDown: [0, -1, 0], ArrowUp: [0, 1, 0], PageDown: [0, 0, -1], PageUp: [0, 0, 1],
};
const kPad: [string, string, number[]][] = [
  ["↖", "X minus, Y plus", [-1, 1, 0]], ["Y+", "Y plus", [0, 1, 0]], ["↗", "X plus, Y plus", [1, 1, 0]], ["Z+", "Z plus", [0, 0, 1]],
  ["X−", "X minus", [-1, 0, 0]], ["", "", []], ["X+", "X plus", [1, 0, 0]], ["", "", []],
  ["↙", "X minus, Y minus", [-1, -1, 0]], ["Y−", "Y minus", [0, -1, 0]], ["↘", "X plus, Y minus", [1, -1, 0]], ["Z−", "Z minus", [0, 0, -1]],
];

/** The feed, at most what the axes allow. */
const feedFor = (direction: readonly number[]): number => {
  const most = direction.flatMap((d, k) => d === 0 ? [] : [now.value.settings[110 + k] ?? Infinity]);
  return Math.max(1, Math.min(feed.value, ...most));
};
const begin = (direction: number[]): void => { if (mayMove.value) jogBegin(direction, feedFor(direction)); };
const one = (direction: number[]): void => { if (mayMove.value) jogStep(direction, step.value || 0.1, feedFor(direction)); };

function JogButton({ label, name, direction }: { label: string; name: string; direction: number[] }): JSX.Element {
  const held = step.value === 0;
  return <button type="button" aria-label={`Jog ${name}`} disabled={!mayMove.value}
    onPointerDown={(event) => {
      if (!held || event.button !== 0) return;
      event.currentTarget.setPointerCapture(event.pointerId);
      begin(direction);
    }}
    onPointerUp={jogEnd} onPointerCancel={jogEnd} onLostPointerCapture={jogEnd} onContextMenu={(event) => { event.preventDefault(); }}
    onClick={(event) => { if (!held || event.detail === 0) one(direction); }}>{label}</button>;
}

const isEdited = (target: EventTarget | null): boolean => target instanceof HTMLElement && /^(INPUT|TEXTAREA|SELECT)$/.test(target.tagName);

// One key jogs at a time: another one, or its release, ends it.
function listen(): () => void {
  let pressed = "";
  const end = (): void => {
    pressed = "";
    jogEnd();
  };
  const leave = (): void => {
    end();
    keysJog.value = gamepadJogs.value = false;
  };
  const down = (event: KeyboardEvent): void => {
    if (!keysJog.value || !(event.key in kKeys) || isEdited(event.target) || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    if (event.repeat || pressed === event.key) return;
    const direction = kKeys[event.key];
    end();
    if (step.value > 0) one(direction);
    else {
      pressed = event.key;
      begin(direction);
    }
  };
  const up = (event: KeyboardEvent): void => { if (event.key === pressed) end(); };
  const hide = (): void => { if (document.hidden) leave(); };
  window.addEventListener("keydown", down);
  window.addEventListener("keyup", up);
  window.addEventListener("blur", leave);
  document.addEventListener("visibilitychange", hide);
  return () => {
    leave();
    window.removeEventListener("keydown", down);
    window.removeEventListener("keyup", up);
    window.removeEventListener("blur", leave);
    document.removeEventListener("visibilitychange", hide);
  };
}

export function JogPanel(): JSX.Element {
  useEffect(listen, []);
  useEffect(() => gamepadJogs.value ? startGamepad(feedFor) : undefined, [gamepadJogs.value]);
  return <section aria-label="Jog">
    <div class="choice" role="group" aria-label="Jog by">{[...kSteps, 0].map((s) => <button key={s} type="button" aria-pressed={step.value === s} onClick={() => { step.value = s; }}>{s === 0 ? "while held" : `${s} mm`}</button>)}</div>
    <div class="jog-pad">{kPad.map(([label, name, direction], k) => label === "" ? <span key={k} /> : <JogButton key={k} label={label} name={name} direction={direction} />)}</div>
    <label class="line">Feed, mm/min <input type="number" min={1} max={20000} value={feed.value} onInput={(event) => { feed.value = Math.max(1, Number(event.currentTarget.value) || 1); }} /></label>
    <label class="line check-line"><input type="checkbox" checked={keysJog.value} onChange={(event) => { keysJog.value = event.currentTarget.checked; event.currentTarget.blur(); }} />
      Arrow keys, Page Up and Page Down jog</label>
    <label class="line check-line"><input type="checkbox" checked={gamepadJogs.value} onChange={(event) => { gamepadJogs.value = event.currentTarget.checked; }} />
      A gamepad jogs: left stick X and Y, right stick Z; any button stops</label>
  </section>;
}
