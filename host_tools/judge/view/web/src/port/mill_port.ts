// The virtual mill as a port, in real time or faster. Its sender acts between two ticks, as fast as the mill may run.
import type { MillCore } from "./mill_core";
import { kBeat, type Port, type PortEvents } from "./port";

const kMostAtOnce = 4000;   // ticks of a slice: the mill falls behind rather than be deaf

export class MillPort implements Port {
  private events: PortEvents | null = null;
  private ticks = 0;
  private due = 0;
  private before = 0;
  private timer = 0;
  private waiting: Uint8Array[] = [];

  constructor(readonly mill: MillCore, public rate: number) {}

  open(events: PortEvents): Promise<void> {
    this.events = events;
    this.before = performance.now();
    this.timer = self.setInterval(() => { this.slice(); }, kBeat);
    return Promise.resolve();
  }

  write(bytes: Uint8Array): void { this.waiting.push(bytes); }
  now(): number { return this.ticks; }
  begin(): void { this.mill.mark(); }

  close(): Promise<void> {
    clearInterval(this.timer);
    this.events = null;
    return Promise.resolve();
  }

  private slice(): void {
    const now = performance.now();
    this.due = Math.min(this.due + (now - this.before) * this.rate, kMostAtOnce);
    this.before = now;
    for (; this.due >= 1 && this.events; this.due -= 1) {
      this.exchange();
      this.take(this.mill.tick());
      if (++this.ticks % kBeat === 0) this.events.beat();
    }
  }

  // Bytes that the sender writes because of an answer are there before the next tick.
  private exchange(): void {
    for (let bytes = this.waiting.shift(); bytes; bytes = this.waiting.shift()) this.take(this.mill.send(bytes));
  }

  private take(bytes: Uint8Array): void {
    if (bytes.length > 0) this.events?.take(bytes);
  }
}
