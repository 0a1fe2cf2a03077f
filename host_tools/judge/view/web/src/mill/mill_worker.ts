// The virtual mill: the firmware's core in real time, or faster. Hold, resume and reset are the controller's own bytes.
import { Core } from "../core/core";
import type { MillReport, MillState, ToMill } from "./messages";

const kBeat = 20;           // ms between slices of the run
const kReports = 5;         // beats between reports
const kMostAtOnce = 4000;   // ticks of a slice: the mill falls behind rather than be deaf

const scope = self as unknown as { onmessage: (event: MessageEvent<ToMill>) => void; postMessage(report: MillReport): void };

let core: Core | null = null, state: MillState = "idle", rate = 1, due = 0, before = 0, beats = 0, timer = 0;
let at: [number, number, number] = [0, 0, 0], speed = 0;

function report(): void {
  const { fraction, line, simulated_s } = core!.progress(), done = state === "ended" || state === "stopped" || state === "fault";
  const result = done ? core!.result() : null;
  scope.postMessage({ state, at, speed: state === "run" ? speed : 0, line, seconds: simulated_s, fraction, text: result?.errors.at(0)?.text ?? "", edges: result?.edges_crc32 ?? "" });
}

function end(): void {
  clearInterval(timer);
  const { errors } = core!.result();
  if (state !== "stopped") state = errors.length > 0 ? "fault" : "ended";
  report();
}

function beat(): void {
  const now = performance.now();
  due = Math.min(due + (now - before) * rate, kMostAtOnce);
  before = now;
  const ticks = Math.floor(due), goesOn = ticks === 0 || core!.advance(ticks);
  due -= ticks;
  const points = core!.setPoints(), last = points.length - 4;
  if (last >= 0) {
    const next: typeof at = [points[last], points[last + 1], points[last + 2]];
    const first = last >= 4 ? [points[last - 4], points[last - 3], points[last - 2]] : at;
    speed = Math.hypot(next[0] - first[0], next[1] - first[1], next[2] - first[2]) * (last >= 4 ? 1000 : 1000 / Math.max(ticks, 1));
    at = next;
  }
  if (!goesOn) end();
  else if (++beats % kReports === 0) report();
}

scope.onmessage = ({ data }) => {
  if (data.kind === "start") {
    core = new Core(data.module);
    [rate, state, due, before] = [data.rate, "run", 0, performance.now()];
    if (!core.begin(data.text, data.settings, true)) {
      state = "fault";
      report();
      return;
    }
    timer = setInterval(beat, kBeat);
  } else if (!core || state === "ended" || state === "fault" || state === "stopped") return;
  else if (data.kind === "rate") rate = data.rate;
  else if (data.kind === "hold" && state === "run") {
    core.hold();
    state = "hold";
  } else if (data.kind === "resume" && state === "hold") {
    core.resume();
    state = "run";
  } else if (data.kind === "stop") {
    core.reset();
    state = "stopped";
  }
};
