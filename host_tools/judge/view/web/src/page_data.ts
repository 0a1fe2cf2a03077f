// Facts and data of a run: those that stand in the page, and the worker that unpacks any.
import workerText from "worker:./unpack_worker.ts";
import type { PageFacts, Run } from "./run_data";
import type { Block, UnpackAnswer, UnpackRequest } from "./unpack_worker";

// Facts precede the script.
export function pageFacts(): PageFacts {
  return JSON.parse(document.getElementById("facts")!.textContent) as PageFacts;
}

// Removes a block of data from the page, so that its text can be freed, and returns it.
export function takeBlock(name: string): string {
  const block = document.getElementById("data-" + name);
  const text = block?.textContent ?? "";
  block?.remove();
  return text;
}

// Resolves when the document is complete.
export function documentRead(): Promise<void> {
  return new Promise((done) => {
    if (document.readyState === "loading") document.addEventListener("DOMContentLoaded", () => done());
    else done();
  });
}

// Unpacks the run. `blocks` is asked for each block, by its name, once `ready` has resolved. `begun` is called when the worker
// has the data: a worker starts only while this thread is free.
export async function loadRun(facts: PageFacts, blocks: (name: string) => Block, begun: () => void, ready: Promise<void> = Promise.resolve()): Promise<Run> {
  const address = URL.createObjectURL(new Blob([workerText], { type: "text/javascript" }));
  const worker = new Worker(address);  // it starts while the document may still be being read
  try {
    await ready;
    const request: UnpackRequest = {
      samples: blocks("samples"), lines: blocks("lines"), path: blocks("path"), program: blocks("program"),
      rapid: blocks("rapid"), stock: blocks("stock"), left: blocks("left"), engagement: blocks("engagement"),
      limits: [facts.limits.velocity, facts.limits.acceleration, facts.limits.jerk],
      farthest: facts.farthest_nm,
    };
    return await new Promise<Run>((done, fail) => {
      worker.onmessage = (event: MessageEvent<UnpackAnswer>) => {
        if ("begun" in event.data) begun();
        else if ("run" in event.data) done(event.data.run);
        else fail(new Error("the data of this page are damaged: " + event.data.failed));
      };
      worker.onerror = (event) => fail(new Error("the data of this page can't be read: " + event.message));
      worker.postMessage(request);
    });
  } finally {
    worker.terminate();
    URL.revokeObjectURL(address);
  }
}
