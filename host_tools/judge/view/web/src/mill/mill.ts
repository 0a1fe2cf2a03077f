// The page's side of the virtual mill.
import script from "worker:./mill_worker.ts";
import { coreModule } from "../core/run_program";
import type { MillReport, ToMill } from "./messages";

export class Mill {
  private readonly worker: Worker;

  constructor(report: (now: MillReport) => void, failed: (why: string) => void) {
    const address = URL.createObjectURL(new Blob([script], { type: "text/javascript" }));
    this.worker = new Worker(address);
    URL.revokeObjectURL(address);
    this.worker.onmessage = (event: MessageEvent<MillReport>) => report(event.data);
    this.worker.onerror = (event) => failed(event.message);
  }

  private tell(message: ToMill): void { this.worker.postMessage(message); }

  async start(text: string, settings: string, rate: number): Promise<void> {
    this.tell({ kind: "start", module: await coreModule(), text, settings, rate });
  }
  hold(): void { this.tell({ kind: "hold" }); }
  resume(): void { this.tell({ kind: "resume" }); }
  stop(): void { this.tell({ kind: "stop" }); }
  rate(rate: number): void { this.tell({ kind: "rate", rate }); }
  close(): void { this.worker.terminate(); }
}
