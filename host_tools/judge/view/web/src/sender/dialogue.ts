// The dialogue with a controller: lines and their answers, status reports, realtime bytes, checked lines where the controller has them.
import { CheckedWindow } from "./checked_window";
import { ControllerFacts } from "./controller_facts";
import { checkedLine, checkedText } from "./crc32";
import { LineReader } from "./line_reader";
import { CountedWindow, kGrblBuffer } from "./line_window";
import { Votes } from "./listing";
import type { LineWindow, Sent, Verdict } from "./line_window";
import { ReportFilter, statusReport } from "./status_report";
import type { StatusReport } from "./status_report";
import type { Port } from "../port/port";

export interface DialogueEvents {
  report: (report: StatusReport) => void;
  /** A line was answered, in order. */
  answered: (sent: Sent, error: number) => void;
  alarm: (code: number) => void;
  /** The text of a [MSG:...]. */
  message: (text: string) => void;
  /** The controller has started anew: what it had is lost. */
  restarted: () => void;
  /** The controller's facts are known; lines may be sent. */
  ready: () => void;
  beat: () => void;
  lost: (why: string) => void;
}

/** error: 0: ok. */
export interface Outcome { error: number; lines: string[] }

export const kReset = 0x18, kHold = 0x21, kResume = 0x7E, kJogCancel = 0x85, kDoor = 0x84;

const kAskEach = 200;        // ms between status requests
const kSilence = 5000;       // ms without a line, though reports are asked for
const kAnswer = 30_000;      // ms that a controller at rest may owe an answer
const kKeepChecks = 1000;    // ms at rest after which an empty line keeps the checks on
const kMostListings = 16;
const kRestful = new Set(["Idle", "Alarm", "Check"]);
const kSilent = new Set(["", "Hold", "Door", "Sleep", "Home"]);   // no line is answered
const kPlainReports = 5;     // in a row: the controller no longer checks lines

export class Dialogue {
  window: LineWindow = new CountedWindow(kGrblBuffer);
  /** Null: not known yet. */
  checked: boolean | null = null;
  facts = new ControllerFacts();
  ready = false;
  last: StatusReport | null = null;
  /** Reports that were damaged, and not shown. */
  refused = 0;
  /** ms of dwell that the program may hold the answers back. */
  dwell = 0;

  private readonly reader = new LineReader((line) => { this.takeLine(line); });
  private readonly filter = new ReportFilter();
  private readonly sleepers: { due: number; wake: () => void }[] = [];
  private listing: string[] | null = null;
  private checksumsSeen = false;
  private plainReports = 0;
  private heard = 0;
  private asked = 0;
  private wrote = 0;
  private answeredAt = 0;
  private reportedAt = 0;
  private plainAnswer: string | null = null;
  private preparing = false;
  private starts = 0;
  private ended = false;

  constructor(readonly port: Port, private readonly events: DialogueEvents) {}

  async open(): Promise<void> {
    this.heard = this.answeredAt = this.port.now();
    await this.port.open({
      take: (bytes) => { this.reader.put(bytes); this.flush(); },
      beat: () => { this.beat(); },
      lost: (why) => { this.lose(why); },
    });
    this.heard = this.answeredAt = this.port.now();
  }

  async close(): Promise<void> {
    this.ended = true;
    await this.port.close();
  }

  /** At rest, as a fresh report says, and nothing is under way. */
  get rests(): boolean {
    return this.state === "Idle" && this.window.waiting.length === 0 && this.port.now() - this.reportedAt < 2 * kAskEach + 100;
  }
  get state(): string { return this.last?.state ?? ""; }
  get resent(): number { return this.window instanceof CheckedWindow ? this.window.resent : 0; }

  /** A byte that acts at once; on checked lines it counts at its third repetition. Stops are always sent so. */
  realtime(byte: number): void {
    const surely = this.checked !== false || byte === kReset || byte === kHold || byte === kJogCancel || byte === kDoor;
    this.put(new Uint8Array(surely ? 3 : 1).fill(byte));
  }

  /** Adds a line; it goes out as soon as there is room. */
  add(sent: Sent): void {
    if (this.window.waiting.length === 0) this.answeredAt = this.port.now();
    this.window.add(sent);
  }

  /** A command and what was listed before its answer. Rejects where the controller starts anew, or is lost. */
  command(text: string): Promise<Outcome> {
    return new Promise((done, fail) => {
      const listing: string[] = [];
      this.listing = listing;
      this.failures.add(fail);
      this.add({ text, line: 0, done: (error) => {
        this.failures.delete(fail);
        if (this.listing === listing) this.listing = null;
        done({ error, lines: listing });
      } });
      this.flush();
    });
  }
  private readonly failures = new Set<(reason: Error) => void>();

  /** The lines that a command lists, as no lost byte has changed them: on a checked line it is asked until its answers agree. */
  async listingOf(command: string): Promise<string[]> {
    const votes = new Votes();
    for (let time = 0; time < kMostListings && !votes.agree; ++time) {
      votes.add((await this.command(command)).lines);
      if (!this.checked) break;
    }
    return votes.lines();
  }

  /** Sends all that may go out now. */
  flush(): void {
    const now = this.port.now();
    for (let wire = this.window.next(now); wire !== null && !this.ended; wire = this.window.next(now)) this.putText(wire);
  }

  /** Lines that an unplugged controller still expects, by the window of the time before. */
  takeOver(window: CheckedWindow, facts: ControllerFacts): void {
    this.putText(window.reconnect(this.port.now()));
    this.answeredAt = this.port.now();
    this.window = window;
    this.facts = facts;
    this.checked = this.ready = true;
  }

  /** True if the controller checks lines although this dialogue has not asked for it: it was not reset since. */
  get stillChecks(): boolean { return this.checksumsSeen && !this.ready; }
  /** Whether the controller is to be asked for its facts as soon as it rests. */
  mayPrepare = true;

  private put(bytes: Uint8Array): void { this.port.write(bytes); }

  private putText(text: string): void {
    this.wrote = this.port.now();
    this.put(new TextEncoder().encode(text));
  }

  private sleep(ms: number): Promise<void> {
    return new Promise((wake) => { this.sleepers.push({ due: this.port.now() + ms, wake }); });
  }

  private beat(): void {
    const now = this.port.now();
    if (now - this.asked >= kAskEach) {
      this.asked = now;
      this.put(new Uint8Array([0x3F]));
    }
    for (let k = this.sleepers.length - 1; k >= 0; --k) if (this.sleepers[k].due <= now) this.sleepers.splice(k, 1)[0].wake();
    if (!kSilent.has(this.state) && now - this.wrote >= kKeepChecks) {
      if (this.checked && this.ready && this.window.waiting.length === 0) this.add({ text: "", line: 0 });
      else if (this.stillChecks && !this.mayPrepare) this.putText("\n");
    }
    this.flush();
    this.events.beat();
    if (now - this.heard > kSilence) this.lose(this.last ? `nothing was heard for ${kSilence / 1000} s` : `no controller answers within ${kSilence / 1000} s`);
    else if (this.state === "Idle" && this.window.waiting.length > 0 && now - this.answeredAt > kAnswer + 1.5 * this.dwell) {
      this.lose(`the controller is at rest and has not answered for ${Math.round((now - this.answeredAt) / 1000)} s: an answer was lost`);
    }
  }

  private lose(why: string): void {
    if (this.ended) return;
    void this.close();
    this.fail(why);
    this.events.lost(why);
  }

  private fail(why: string): void {
    const all = [...this.failures];
    this.failures.clear();
    this.listing = null;
    for (const fail of all) fail(new Error(why));
  }

  private takeLine(line: string): void {
    if (this.ended) return;
    this.heard = this.port.now();
    if (line.startsWith("<")) this.takeReport(line);
    else if (!this.takeAnswer(line)) this.takeText(line);
  }

  // Once a report had a checksum, one without is none.
  private takeReport(line: string): void {
    const text = line.endsWith(">") ? line : checkedText(line), isChecked = text !== line;
    const report = text === null || (this.checked && this.checksumsSeen && !isChecked) ? null : statusReport(text);
    if (report && isChecked) this.checksumsSeen = true;
    this.plainReports = isChecked || !text || statusReport(text) === null ? 0 : this.plainReports + 1;
    if (this.checked && this.checksumsSeen && this.plainReports >= kPlainReports && this.window.waiting.length === 0) this.beginAnew();
    if (!report || (!isChecked && !this.filter.accept(report, this.port.now()))) {
      if (!report || this.last) this.refused += 1;
      return;
    }
    if (isChecked) this.filter.accept(report, this.port.now());
    else if (!this.checked) this.checksumsSeen = false;
    [this.last, this.reportedAt] = [report, this.port.now()];
    if (this.window instanceof CheckedWindow) this.window.held = kSilent.has(report.state);
    this.events.report(report);
    if (!this.ready && !this.preparing && this.mayPrepare && kRestful.has(report.state)) void this.prepare();
  }

  private takeAnswer(line: string): boolean {
    const isPlain = /^(ok|error:\d{1,3})$/.test(line);
    if (isPlain && this.plainAnswer === "") this.plainAnswer = line;
    if (!this.checked && line.startsWith("resend ")) {
      const number = /^resend N(\d+)$/.exec(checkedText(line) ?? "")?.[1];
      if (number && this.preparing) this.putText(`${checkedLine(Number(number), "$CRC=0")}\n`);
      return true;
    }
    const verdict = this.window.take(line, this.port.now());
    if (this.window instanceof CheckedWindow && this.window.lapsed) this.lose("the controller has stopped checking lines: it was reset from elsewhere");
    else if (verdict) this.takeVerdict(verdict);
    return verdict !== null || isPlain;
  }

  private takeVerdict({ done, error }: Verdict): void {
    this.answeredAt = this.port.now();
    for (const sent of done) {
      const own = sent === done.at(-1) ? error : 0;
      sent.done?.(own);
      this.events.answered(sent, own);
    }
  }

  private takeText(line: string): void {
    const alarm = /^ALARM:(\d{1,3})$/.exec(line)?.[1], message = /^\[MSG:(.*)\]$/.exec(line)?.[1];
    if (line.startsWith("Grbl") || /^\S+ \d.* \['\$' for help\]$/.test(line)) this.restart();
    else if (alarm) this.events.alarm(Number(alarm));
    else if (message !== undefined) this.events.message(message);
    else this.listing?.push(line);
  }

  private restart(): void {
    this.beginAnew();
    this.fail("the controller was reset");
    this.events.restarted();
  }

  private beginAnew(): void {
    this.window = new CountedWindow(kGrblBuffer);
    this.checked = null;
    this.starts += 1;
    this.ready = this.preparing = this.checksumsSeen = false;
  }

  // Checked lines, settings, offsets; anew after each reset.
  private async prepare(): Promise<void> {
    this.preparing = true;
    const { starts } = this;
    try {
      await this.switchChecks();
      if (starts !== this.starts) return;
      const facts = new ControllerFacts();
      for (const command of ["$I", "$$", "$G", "$#"]) facts.take(await this.listingOf(command));
      this.facts = facts;
      const { buffer } = facts;
      if (this.window.waiting.length === 0 && buffer > kGrblBuffer) {
        if (this.window instanceof CheckedWindow) this.window.widen(buffer);
        else this.window = new CountedWindow(buffer);
      }
      this.ready = true;
      this.events.ready();
    } catch {
      // The next report begins again.
    }
    if (starts === this.starts) this.preparing = false;
  }

  // $CRC=1 is not protected itself: damaged it is refused, or not answered at all. A controller that has no checks says so three times.
  private async switchChecks(): Promise<void> {
    const { starts } = this;
    for (let attempt = 0, refusals = 0; attempt < 12 && refusals < 3; ++attempt) {
      if (starts !== this.starts) return;
      this.plainAnswer = "";
      this.putText("$CRC=1\n");
      await this.sleep(300);
      const answer: string | null = this.plainAnswer;
      this.plainAnswer = null;
      if (starts !== this.starts) return;
      if (answer === "ok") {
        this.window = new CheckedWindow(kGrblBuffer);
        this.checked = true;
        return;
      }
      if (answer) refusals += 1;
    }
    if (starts !== this.starts) return;
    this.window = new CountedWindow(kGrblBuffer);
    this.checked = false;
  }
}
