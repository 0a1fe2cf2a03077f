// A gamepad jogs as far as its sticks are pushed; let go, it stops. Any of its buttons stops the machine.
import { jogBegin, jogEnd, mayMove, stop } from "./machine";

const kDead = 0.25;      // of a stick's way that does nothing
const kSteps = 5;        // of speed, so that a trembling hand is no new jog

/** Signed share of the speed, 0 in the middle. */
export function deflection(value: number): number {
  const size = Math.abs(value);
  return size < kDead ? 0 : Math.sign(value) * Math.ceil((size - kDead) / (1 - kDead) * kSteps) / kSteps;
}

/** Polls until the function that it returns is called. feedFor: mm/min along a direction. */
export function startGamepad(feedFor: (direction: readonly number[]) => number): () => void {
  let before = "0,0,0";
  const timer = window.setInterval(() => {
    const pad = navigator.getGamepads().find((found) => found?.connected);
    if (pad?.buttons.some(({ pressed }) => pressed)) stop();
    const [x = 0, y = 0, , z = 0] = pad?.axes ?? [], direction = [deflection(x), -deflection(y), -deflection(z)], now = direction.join();
    if (now === before) return;
    before = now;
    const size = Math.min(1, Math.hypot(...direction));
    if (size === 0 || !mayMove.value) jogEnd();
    else jogBegin(direction, feedFor(direction) * size);
  }, 50);
  return () => {
    clearInterval(timer);
    jogEnd();
  };
}
