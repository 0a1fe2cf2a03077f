// Checked lines: numbered and with a CRC, each executed once and in order on any serial line. The controller refuses a line that is
// damaged, lost or repeated, and names the one that it expects. host_tools/controller/stream/checked_window.hpp is the same in C++.
import { checkedLine, checkedText } from "./crc32";
import type { LineWindow, Sent, Verdict } from "./line_window";

const kMostLines = 64;
const kDry = 40;                // ms: longer than the delay of answers to lines that are sent
const kFirstPatience = 100;     // ms
const kMostPatience = 1600;     // shorter than the silence after which the controller stops checking
const kGrowth = 16;             // bytes
const kMostPlain = 4;           // in a row

interface Numbered { number: number; wire: string; sent: Sent }

export class CheckedWindow implements LineWindow {
  private capacity: number;
  private room: number;           // bytes of it in use: fewer on a bad line
  private underWay = 0;           // line ends without an answer so far
  private lines: Numbered[] = [];
  private sent = 0;               // of lines, on the wire
  private bytes = 0;
  private nextNumber = 1;
  private readonly fileLines = new Map<number, number>();
  /** Of empty lines on their way: the number that each answer names if nothing was lost before it. */
  private asks: number[] = [];
  private draining = false;
  private syncing = false;        // nothing goes out until the controller has named the line that it expects
  private quietSince = 0;
  private patience = kFirstPatience;
  private plain = 0;
  /** The controller answers no line now: it is not asked either, so that its buffer is not filled by that. */
  held = false;
  /** Lines that went out again. */
  resent = 0;

  /** capacity: of the controller's buffer; half of it is used, as a line may be in flight twice. */
  constructor(capacity: number) { this.capacity = this.room = Math.floor(capacity / 2); }

  get waiting(): readonly Sent[] { return this.lines.map(({ sent }) => sent); }
  /** Plain answers come although checked ones are due: the controller no longer checks lines. */
  get lapsed(): boolean { return this.plain >= kMostPlain; }
  get expected(): number { return this.lines.at(0)?.number ?? this.nextNumber; }

  /** The controller's buffer is known. */
  widen(capacity: number): void { this.capacity = this.room = Math.floor(capacity / 2); }

  hasRoom(): boolean { return this.lines.length < kMostLines; }

  add(sent: Sent): void {
    const number = this.nextNumber++;
    this.lines.push({ number, wire: `${checkedLine(number, sent.text)}\n`, sent });
    if (sent.line > 0) this.fileLines.set(number, sent.line);
    this.fileLines.delete(number - 4096);
  }

  /** The file's line of a number that a report names; 0: none is known. */
  fileLine(number: number): number { return this.fileLines.get(number) ?? 0; }

  next(now: number): string | null {
    if (this.syncing) return !this.held && now - this.quietSince >= this.patience ? this.ask(now) : null;
    if (this.draining && (this.underWay === 0 || now - this.quietSince >= kDry)) {
      this.draining = false;
      this.rewind(now);
    }
    if (this.sent > 0 && !this.draining && !this.held && (this.underWay === 0 || now - this.quietSince >= this.patience)) return this.ask(now);
    if (this.draining || this.sent === this.lines.length) return null;
    const { wire } = this.lines[this.sent];
    if (this.sent > 0 && this.bytes + wire.length > this.room) return null;
    if (this.sent === 0) this.quietSince = now;
    this.sent += 1;
    this.underWay += 1;
    this.bytes += wire.length;
    return wire;
  }

  /** An empty line: its answer names the number that is expected. */
  ask(now: number): string {
    this.patience = Math.min(2 * this.patience, kMostPatience);
    this.quietSince = now;
    this.underWay += 1;
    this.asks.push(this.sent > 0 ? this.lines[this.sent - 1].number + 1 : this.expected);
    return "\n";
  }

  /** After a new plug: what the controller still holds is answered before the empty line that this returns. */
  reconnect(now: number): string {
    this.draining = false;
    this.syncing = true;
    this.patience = kFirstPatience;
    this.rewind(now);
    return this.ask(now);
  }

  take(text: string, now: number): Verdict | null {
    const answer = checkedText(text), found = answer === null ? null : /^(ok|error:(\d+)|resend) N(\d+)$/.exec(answer);
    if (answer === null) this.countDamaged(text);
    if (!found) return null;
    const number = Number(found[3]);
    if (number === 0 || number > this.nextNumber) return null;
    this.quietSince = now;
    this.patience = kFirstPatience;
    this.plain = 0;
    this.underWay = Math.max(0, this.underWay - 1);
    if (found[1] === "resend") {
      const done = this.finishBefore(number);
      const asked = this.asks.indexOf(number);
      this.syncing = false;
      if (asked >= 0) this.asks.splice(0, asked + 1);
      else if (this.sent > 0 && !this.draining) {
        this.draining = true;
        this.room = Math.floor(this.room / 2);
      }
      return { done, error: 0 };
    }
    this.room = Math.min(this.capacity, this.room + kGrowth);
    return { done: this.finishBefore(number + 1), error: Number(found[2] || 0) };
  }

  private finishBefore(number: number): Sent[] {
    const done: Sent[] = [];
    for (; this.lines.length > 0 && this.lines[0].number < number; this.lines.shift()) {
      done.push(this.lines[0].sent);
      if (this.sent === 0) continue;
      this.sent -= 1;
      this.bytes -= this.lines[0].wire.length;
    }
    return done;
  }

  private rewind(now: number): void {
    this.resent += this.sent;
    [this.sent, this.bytes, this.underWay, this.quietSince, this.asks] = [0, 0, 0, now, []];
  }

  // Neither a report nor a message: a damaged answer.
  private countDamaged(text: string): void {
    if (text === "" || text.startsWith("<") || text.startsWith("[")) return;
    this.underWay = Math.max(0, this.underWay - 1);
    if (text === "error:11") return;  // of bytes that were lost
    this.plain = /^(ok|error:\d{1,2})$/.test(text) ? this.plain + 1 : 0;
  }
}
