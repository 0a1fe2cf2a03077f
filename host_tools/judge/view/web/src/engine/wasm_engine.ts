// The engine in the page itself: planners in WebAssembly, in a worker that a cancelled call ends.
import script from "worker:./engine_worker.ts";
import packed from "engine-wasm";
import { inflate } from "../inflate";
import { resultOf } from "./engine";
import type { Answer, AnswerLine, Calls, CallOptions, Engine, EngineFacts, FileSet } from "./engine";
import type { FromEngineWorker, ToEngineWorker } from "./engine_messages";

// Settles as `before` does; rejects as soon as the signal is given.
function waited(before: Promise<void>, signal?: AbortSignal): Promise<void> {
  return new Promise((resolve, reject) => {
    const abort = (): void => reject(new DOMException("cancelled", "AbortError"));
    if (signal?.aborted) abort();
    signal?.addEventListener("abort", abort, { once: true });
    void before.then(() => {
      signal?.removeEventListener("abort", abort);
      resolve();
    });
  });
}

/** True in pages that hold the planners. */
export const holdsEngine = packed !== "";

export class WasmEngine implements Engine {
  private worker: Worker | null = null;
  private module: Promise<WebAssembly.Module> | null = null;
  private turn: Promise<void> = Promise.resolve();  // of the next call: the worker answers one at a time

  private compiled(): Promise<WebAssembly.Module> {
    this.module ??= inflate(Uint8Array.from(atob(packed), (character) => character.charCodeAt(0)))
      .then((bytes) => WebAssembly.compile(bytes as BufferSource));
    return this.module;
  }

  async facts(): Promise<EngineFacts> {
    const { result } = await this.call("keys", {}, new Map());
    return { kind: "wasm", threads: 1, version: result.version };
  }

  private end(): void {
    this.worker?.terminate();
    this.worker = null;
  }

  private async started(): Promise<Worker> {
    if (this.worker) return this.worker;
    const address = URL.createObjectURL(new Blob([script], { type: "text/javascript" }));
    const worker = new Worker(address);
    URL.revokeObjectURL(address);
    worker.postMessage({ module: await this.compiled() } satisfies ToEngineWorker);
    this.worker = worker;
    return worker;
  }

  async call<K extends keyof Calls>(name: K, args: Calls[K]["args"], files: FileSet, options: CallOptions = {}): Promise<Answer<Calls[K]["result"]>> {
    const before = this.turn;
    let end = (): void => undefined;
    const mine = new Promise<void>((resolve) => { end = resolve; });
    this.turn = before.then(() => mine);
    try {
      await waited(before, options.signal);
      return await this.answered(name, args, files, options);
    } finally {
      end();
    }
  }

  private async answered<K extends keyof Calls>(name: K, args: Calls[K]["args"], files: FileSet, options: CallOptions): Promise<Answer<Calls[K]["result"]>> {
    const worker = await this.started(), { signal, progress } = options;
    return new Promise((resolve, reject) => {
      const abort = (): void => {
        this.end();
        reject(new DOMException("cancelled", "AbortError"));
      };
      if (signal?.aborted) {
        abort();
        return;
      }
      signal?.addEventListener("abort", abort, { once: true });
      const done = (): void => signal?.removeEventListener("abort", abort);
      worker.onmessage = ({ data }: MessageEvent<FromEngineWorker>) => {
        if ("share" in data) {
          progress?.(data.share, data.text);
          return;
        }
        done();
        if (data.ended) this.end();
        try {
          resolve({ result: resultOf(JSON.parse(data.answer) as AnswerLine<Calls[K]["result"]>), blocks: new Map(data.blocks) });
        } catch (reason) {
          reject(reason instanceof Error ? reason : new Error(String(reason)));
        }
      };
      worker.onerror = (event) => {
        done();
        this.end();
        reject(new Error(`the planners ended: ${event.message}`));
      };
      worker.postMessage({ name, args, files: [...files] } satisfies ToEngineWorker);
    });
  }
}
