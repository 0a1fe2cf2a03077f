// A program on its way through a dialogue: what is sent, answered and executed, and how it ends.
import type { Dialogue } from "./dialogue";
import { CheckedWindow } from "./checked_window";
import { ExecutedLine } from "./executed_line";
import type { Sent } from "./line_window";
import type { StatusReport } from "./status_report";

/** line: of the file, from 1; 0: of the way to the line at which a program is resumed. */
export interface ProgramLine { line: number; text: string }

/** lost: the link, or the controller was reset: it may be resumed. */
export type RunPhase = "run" | "done" | "stopped" | "fault" | "lost";

/** Seconds of the G4 of a line, for how long its answer may take. */
const dwellOf = (text: string): number => /G0*4(?![\d.])/i.test(text) ? Number(/P([\d.]+)/i.exec(text)?.[1] ?? 0) : 0;

/** M0, M1 or M6 of a line: what it waits for. */
export const pauseOf = (text: string): "stop" | "tool" | null => /M0*6(?![\d.])/i.test(text) ? "tool" : /M0*[01](?![\d.])/i.test(text) ? "stop" : null;
export const toolOf = (text: string): number | null => /T(\d+)/i.exec(text) ? Number(/T(\d+)/i.exec(text)![1]) : null;

export class ProgramRun {
  phase: RunPhase = "run";
  /** The answer or the alarm that ended it; 0: none. */
  error = 0;
  /** Why it is lost. */
  text = "";
  /** The line that was answered last, and that of the error. */
  line = 0;
  answered = 0;
  /** The line that the path has reached, as far as reports name it. */
  at = 0;
  readonly executed: ExecutedLine;
  /** The tool of the last T word that was answered. */
  tool: number | null = null;
  private next = 0;
  private restReports = 0;
  private readonly began: number;
  private ended = 0;

  constructor(private dialogue: Dialogue, readonly lines: readonly ProgramLine[]) {
    this.executed = new ExecutedLine(lines.find(({ line }) => line > 0)?.line ?? 0);
    this.began = dialogue.port.now();
    dialogue.dwell = 1000 * lines.reduce((most, { text }) => Math.max(most, dwellOf(text)), 0);
  }

  get fraction(): number { return this.phase === "done" ? 1 : this.answered / Math.max(1, this.lines.length); }
  get seconds(): number { return ((this.ended || this.dialogue.port.now()) - this.began) / 1000; }

  /** Adds lines as long as there is room. */
  feed(): void {
    if (this.phase !== "run") return;
    while (this.next < this.lines.length && this.dialogue.window.hasRoom()) {
      const { line, text } = this.lines[this.next++];
      this.dialogue.add({ text, line });
      this.dialogue.flush();
    }
  }

  takeAnswer(sent: Sent, error: number): void {
    if (this.phase !== "run" || this.answered >= this.next || sent.text !== this.lines[this.answered].text) return;
    this.answered += 1;
    this.tool = toolOf(sent.text) ?? this.tool;
    if (sent.line > 0) {
      this.line = sent.line;
      this.executed.answered(sent.line);
    }
    this.restReports = 0;
    if (error > 0) this.end("fault", error);
  }

  takeReport(report: StatusReport): void {
    if (this.phase !== "run") return;
    const { window } = this.dialogue, named = report.line ?? 0;
    const line = window instanceof CheckedWindow && named > 0 ? window.fileLine(named) : named;
    if (line > 0) this.at = line;
    this.executed.reported(line, (report.feed ?? 0) > 0, report.blocks, this.dialogue.port.now());
    // The second of two reports at rest was asked for after the last answer.
    this.restReports = this.answered === this.lines.length && report.state === "Idle" ? this.restReports + 1 : 0;
    if (this.restReports >= 2) this.end("done");
  }

  /** The command at which the machine waits: M0, or a change of tool, which may be a T word and an M0 in the next line. */
  get pause(): { kind: "stop" | "tool"; line: number; text: string } | null {
    const isNext = this.next > this.answered && pauseOf(this.lines[this.answered].text) !== null, index = isNext ? this.answered : this.answered - 1;
    const { text, line } = this.lines.at(Math.max(index, 0)) ?? { text: "", line: 0 }, kind = pauseOf(text), before = this.lines.at(Math.max(index - 1, 0))?.text ?? "";
    if (!kind) return null;
    const names = kind === "stop" && toolOf(before) !== null && !/[XYZ]/i.test(before);
    return { kind: names ? "tool" : kind, line, text: names ? `${before} ${text}` : text };
  }

  end(phase: RunPhase, error = 0, text = ""): void {
    if (this.phase !== "run") return;
    this.ended = this.dialogue.port.now();
    [this.phase, this.error, this.text] = [phase, error, text];
  }

  /** True if the controller may still expect what was sent: its lines are numbered. */
  get mayContinue(): boolean { return this.phase === "lost" && this.dialogue.window instanceof CheckedWindow; }

  /** Goes on after a new plug: each line is executed once, as the controller names the one that it expects. */
  continueOn(dialogue: Dialogue): void {
    const { window, facts } = this.dialogue;
    if (!(window instanceof CheckedWindow)) throw new Error("its lines were not numbered");
    this.dialogue = dialogue;
    [this.phase, this.text, this.ended, this.restReports] = ["run", "", 0, 0];
    dialogue.takeOver(window, facts);
    this.feed();
  }
}
