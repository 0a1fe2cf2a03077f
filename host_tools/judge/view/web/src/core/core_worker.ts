// The worker: runs one program on the core and posts progress and result. A trap of the module is posted and ends it.
import { Core } from "./core";
import { PathSketch } from "./path_sketch";
import type { FromWorker, ToWorker } from "./messages";

// Servo ticks of one call of advance(): some milliseconds of work.
const SLICE = 500;
const BETWEEN_REPORTS_MS = 100;

const scope = self as unknown as {
  onmessage: (event: MessageEvent<ToWorker>) => void;
  postMessage(message: FromWorker, transfer?: Transferable[]): void;
};

function run({ module, text, settings, withPath }: ToWorker) {
  const core = new Core(module);
  const sketch = new PathSketch();
  let reportedAt = performance.now();
  let goesOn = core.begin(text, settings, withPath);
  if (withPath) sketch.add(core.setPoints());
  while (goesOn) {
    goesOn = core.advance(SLICE);
    if (withPath) sketch.add(core.setPoints());
    if (performance.now() - reportedAt > BETWEEN_REPORTS_MS) {
      reportedAt = performance.now();
      scope.postMessage({ kind: "progress", progress: core.progress() });
    }
  }
  const path = withPath ? sketch.points() : null;
  const profile = withPath ? core.profile() : null;
  const transfer = [path, profile].flatMap((a) => (a ? [a.buffer] : []));
  scope.postMessage({ kind: "done", result: core.result(), path, profile }, transfer);
}

scope.onmessage = (event) => {
  try {
    run(event.data);
  } catch (fault) {
    scope.postMessage({ kind: "failed", reason: String(fault) });
  }
};
