// The page's side of the worker that sends.
import script from "worker:./sender_worker.ts";
import type { FromSender, MillPicture, ResumeFacts, ToSender } from "./messages";
import type { Outcome } from "./dialogue";
import type { ProgramLine } from "./program_run";
import type { Snapshot } from "./snapshot";
import { openSerial } from "../port/serial_port";
import type { BrowserSerialPort } from "../port/serial_port";

export class Sender {
  private readonly worker: Worker;
  private readonly waiting = new Map<number, { done: (outcome: never) => void; fail: (reason: Error) => void }>();
  private ids = 0;
  /** The port that the worker could not find: this page opens it. */
  private port: { port: BrowserSerialPort; name: string; baud: number } | null = null;

  constructor(private readonly news: (now: Snapshot, mill: MillPicture | null) => void, private readonly failed: (why: string) => void) {
    const address = URL.createObjectURL(new Blob([script], { type: "text/javascript" }));
    this.worker = new Worker(address, { name: "sender" });
    URL.revokeObjectURL(address);
    this.worker.onmessage = ({ data }: MessageEvent<FromSender>) => { this.take(data); };
    this.worker.onerror = (event) => failed(event.message);
  }

  tell(message: ToSender, moved: Transferable[] = []): void { this.worker.postMessage(message, moved); }

  /** index: of the port among those that the browser lists. */
  openSerial(port: BrowserSerialPort, index: number, name: string, baud: number): void {
    this.port = { port, name, baud };
    this.tell({ kind: "serial", index, name, baud });
  }

  begin(lines: ProgramLine[]): Promise<null> { return this.ask((id) => ({ kind: "begin", id, lines })); }
  goOn(): Promise<null> { return this.ask((id) => ({ kind: "goOn", id })); }
  command(text: string): Promise<Outcome> { return this.ask((id) => ({ kind: "command", id, text })); }
  refresh(): Promise<null> { return this.ask((id) => ({ kind: "refresh", id })); }
  facts(): Promise<ResumeFacts> { return this.ask((id) => ({ kind: "facts", id })); }

  private ask<T>(message: (id: number) => ToSender): Promise<T> {
    return new Promise<T>((done, fail) => {
      const id = ++this.ids;
      this.waiting.set(id, { done, fail });
      this.tell(message(id));
    });
  }

  private take(message: FromSender): void {
    if (message.kind === "news") this.news(message.now, message.mill);
    else if (message.kind === "wantsStreams") void this.giveStreams();
    else if (message.kind === "closed") void this.port?.port.close().catch(() => undefined);
    else {
      const asked = this.waiting.get(message.id);
      this.waiting.delete(message.id);
      if (message.refusal) asked?.fail(new Error(message.refusal));
      else asked?.done(message.outcome as never);
    }
  }

  private async giveStreams(): Promise<void> {
    if (!this.port) return;
    const { port, name, baud } = this.port;
    try {
      await openSerial(port, baud);
      const { readable, writable } = port;
      if (readable && writable) this.tell({ kind: "streams", readable, writable, name }, [readable, writable]);
    } catch (reason) {
      this.failed(reason instanceof Error ? reason.message : String(reason));
    }
  }
}
