// Lines on their way to a controller. Two kinds: characters are counted, as for any Grbl, or lines are numbered and checked.

/** A line, and what its sender knows it by. */
export interface Sent { text: string; /** Of the program's file, from 1; 0: a command. */ line: number; done?: (error: number) => void }

/** error: of the last line; 0: ok. */
export interface Verdict { done: Sent[]; error: number }

export interface LineWindow {
  /** True if another line may be added. */
  hasRoom(): boolean;
  add(line: Sent): void;
  /** The line that goes out next, with its end; null: none now. */
  next(now: number): string | null;
  /** An answer. Null: the text is none, or a damaged one. */
  take(text: string, now: number): Verdict | null;
  /** Lines that are not known to be done, in order. */
  readonly waiting: readonly Sent[];
}

/** Bytes of the receive buffer of a stock Grbl. */
export const kGrblBuffer = 128;

const errorOf = (text: string): number => Number(/^error:(\d{1,3})$/.exec(text)?.[1] ?? 0);

/** Keeps the controller's buffer full without overflow: it answers each line once and in order. */
export class CountedWindow implements LineWindow {
  private readonly lines: Sent[] = [];
  private sent = 0;
  private used = 0;

  constructor(private readonly capacity: number) {}

  get waiting(): readonly Sent[] { return this.lines; }
  hasRoom(): boolean { return this.lines.length === this.sent; }
  add(line: Sent): void { this.lines.push(line); }

  next(): string | null {
    if (this.sent === this.lines.length) return null;
    const wire = `${this.lines[this.sent].text}\n`;
    if (this.sent > 0 && this.used + wire.length > this.capacity) return null;
    this.sent += 1;
    this.used += wire.length;
    return wire;
  }

  take(text: string): Verdict | null {
    const error = errorOf(text);
    if ((text !== "ok" && error === 0) || this.sent === 0) return null;
    const line = this.lines.shift()!;
    this.sent -= 1;
    this.used -= line.text.length + 1;
    return { done: [line], error };
  }
}
