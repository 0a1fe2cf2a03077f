// A cut outlives its page's being hidden, and asks before the page is closed. Lines go out from a worker, which is not slowed; the
// screen stays on; and where the page falls silent after all, the controller holds ($791).
import { effect, signal } from "@preact/signals";
import { isBusy } from "./machine";

interface Lock { released: boolean; release(): Promise<void> }
interface WakeLock { request(kind: "screen"): Promise<Lock> }

/** The browser keeps the screen on. */
export const isAwake = signal(false);

let lock: Lock | null = null, asking = false;

async function keepScreenOn(): Promise<void> {
  const wakeLock = (navigator as { wakeLock?: WakeLock }).wakeLock;
  if (!wakeLock || asking || document.hidden || (lock && !lock.released)) return;
  asking = true;
  lock = await wakeLock.request("screen").catch(() => null);
  asking = false;
  if (lock && !isBusy.value) letScreenGo();
  isAwake.value = lock !== null;
}

function letScreenGo(): void {
  void lock?.release().catch(() => undefined);
  lock = null;
  isAwake.value = false;
}

export function keepAwake(): void {
  effect(() => {
    if (isBusy.value) void keepScreenOn();
    else letScreenGo();
  });
  // The browser takes the lock from a hidden page.
  document.addEventListener("visibilitychange", () => { if (isBusy.value) void keepScreenOn(); });
  window.addEventListener("beforeunload", (event) => { if (isBusy.value) event.preventDefault(); });
}
