// A serial port of the browser (WebSerial), by its own object or by its two streams.
import { kBeat, type Port, type PortEvents } from "./port";

/** The parts of the browser's SerialPort that are used. */
export interface BrowserSerialPort {
  readonly readable: ReadableStream<Uint8Array> | null;
  readonly writable: WritableStream<Uint8Array> | null;
  open(options: { baudRate: number; bufferSize?: number }): Promise<void>;
  close(): Promise<void>;
  getInfo?(): { usbVendorId?: number; usbProductId?: number };
  addEventListener?(name: "disconnect", act: () => void): void;
}

export interface BrowserSerial {
  requestPort(options?: object): Promise<BrowserSerialPort>;
  getPorts(): Promise<BrowserSerialPort[]>;
}

export interface Streams { readable: ReadableStream<Uint8Array>; writable: WritableStream<Uint8Array> }

/** None where the browser has no WebSerial. */
export const browserSerial = (): BrowserSerial | null => (navigator as { serial?: BrowserSerial }).serial ?? null;

export const openSerial = (port: BrowserSerialPort, baud: number): Promise<void> => port.open({ baudRate: baud, bufferSize: 4096 });

const kLastBytes = 500;  // ms

const textOf = (reason: unknown): string => reason instanceof Error ? reason.message : String(reason);

export class SerialStreamPort implements Port {
  private events: PortEvents | null = null;
  private reader: ReadableStreamDefaultReader<Uint8Array> | null = null;
  private writer: WritableStreamDefaultWriter<Uint8Array> | null = null;
  private timer = 0;

  /**
   * streams: opens them; closed: after both are released. again: the stream that follows one that broke at a noisy byte; null: the
   * port is gone.
   */
  constructor(private readonly streams: () => Promise<Streams>, private readonly closed: () => Promise<void>,
    private readonly again: () => ReadableStream<Uint8Array> | null = () => null) {}

  async open(events: PortEvents): Promise<void> {
    const { readable, writable } = await this.streams();
    this.events = events;
    this.reader = readable.getReader();
    this.writer = writable.getWriter();
    this.writer.closed.catch((reason: unknown) => { this.lose(textOf(reason)); });
    this.timer = self.setInterval(() => { this.events?.beat(); }, kBeat);
    void this.readOn(this.reader);
  }

  write(bytes: Uint8Array): void {
    this.writer?.write(bytes).catch((reason: unknown) => { this.lose(textOf(reason)); });
  }
  now(): number { return performance.now(); }
  begin(): void { /* a mill of iron has no recorder */ }

  /** The controller can't be reached any more, as the browser says. */
  lose(why: string): void {
    const { events } = this;
    if (!events) return;
    void this.end((writer) => writer.abort());
    events.lost(why);
  }

  /** Bytes already written go out first. */
  async close(): Promise<void> {
    await this.end((writer) => Promise.race([writer.close(), new Promise<void>((done) => { self.setTimeout(done, kLastBytes); })]));
  }

  private async end(release: (writer: WritableStreamDefaultWriter<Uint8Array>) => Promise<void>): Promise<void> {
    clearInterval(this.timer);
    this.events = null;
    const { reader, writer } = this;
    [this.reader, this.writer] = [null, null];
    if (writer) await release(writer).catch(() => undefined);
    await reader?.cancel().catch(() => undefined);
    reader?.releaseLock();
    writer?.releaseLock();
    await this.closed().catch(() => undefined);
  }

  private async readOn(reader: ReadableStreamDefaultReader<Uint8Array>): Promise<void> {
    try {
      for (let part = await reader.read(); !part.done; part = await reader.read()) this.events?.take(part.value);
      this.lose("the port was closed");
    } catch (reason) {
      const next = this.events ? this.again() : null;
      if (!next) {
        this.lose(textOf(reason));
        return;
      }
      reader.releaseLock();
      this.reader = next.getReader();
      void this.readOn(this.reader);
    }
  }
}
