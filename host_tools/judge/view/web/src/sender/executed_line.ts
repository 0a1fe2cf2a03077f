// The line that the tool has certainly reached. host_tools/controller/stream/executed_line.hpp is the same in C++, with the reasons.

const kLag = 500;      // ms that the tool may be behind the path
const kSurely = 5;     // reports in motion without a line
const kGrblBlocks = 16;

export class ExecutedLine {
  private names = false;
  private unnamed = 0;
  private blocks = kGrblBlocks;
  private reports: { line: number; at: number }[] = [];
  private answeredLines: number[] = [];

  constructor(private readonly begin: number, public line = begin) {}

  /** A report; line: 0: it names none. */
  reported(line: number, moves: boolean, blocks: number | null, now: number): void {
    this.blocks = Math.max(this.blocks, blocks ?? 0);
    if (line === 0) {
      this.unnamed += moves ? 1 : 0;
      return;
    }
    if (!this.names) {
      this.names = true;
      this.line = this.begin;
    }
    for (; this.reports.length > 0 && now - this.reports[0].at >= kLag; this.reports.shift()) this.line = this.reports[0].line;
    // Lines never decrease: a report that did was damaged, or the one before it was.
    while (this.reports.length > 0 && this.reports[this.reports.length - 1].line > line) this.reports.pop();
    if (this.reports.at(-1)?.line !== line) this.reports.push({ line, at: now });
  }

  answered(line: number): void {
    if (this.names) {
      this.answeredLines = [];
      return;
    }
    this.answeredLines.push(line);
    for (; this.answeredLines.length > this.blocks + 1; this.answeredLines.shift()) if (this.unnamed >= kSurely) this.line = this.answeredLines[0];
  }
}
