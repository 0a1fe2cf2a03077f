// The program beside the scene: only visible lines are in the document; the line at the cursor is marked.
import { element, inOrder } from "./elements";
import type { RefusedLine } from "./run_data";
import type { Timeline } from "./timeline";

const kRow = 18;            // px, as page.css has it
const kTallest = 8_000_000;  // px that all browsers can scroll

export class ProgramList {
  private readonly lines: number;
  private readonly spacer = element("div", { role: "presentation" });
  private readonly rows = element("div", { class: "program-rows", role: "presentation" });
  private readonly refused = new Map<number, RefusedLine>();
  private readonly decoder = new TextDecoder();
  private marked = 0;
  private asked = false;
  private inSight = true;  // the marked line, when last drawn

  constructor(private readonly host: HTMLElement, private readonly timeline: Timeline, private readonly pick: (line: number) => void) {
    this.lines = timeline.run.lineStart.length - 1;
    const { reading, run } = timeline.facts;
    for (const line of reading.refused) this.refused.set(line.line, line);
    for (const error of run.errors) {
      if (!this.refused.has(error.line)) this.refused.set(error.line, { ...error, begin: 0, end: 0 });
    }
    this.spacer.style.height = `${this.height}px`;
    host.append(this.spacer, this.rows);
    host.addEventListener("scroll", () => this.ask());
    host.addEventListener("click", (event) => {
      const row = (event.target as HTMLElement).closest<HTMLElement>("[data-line]");
      if (row) this.pick(Number(row.dataset.line));
    });
    new ResizeObserver(() => {
      if (this.inSight) this.reveal(this.marked);
      this.ask();
    }).observe(host);
    timeline.onChange(() => this.follow());
    this.follow();
    this.ask();
  }

  private get height(): number { return Math.min(this.lines * kRow, kTallest); }
  // Number of lines that fit.
  private get seen(): number { return Math.max(Math.floor(this.host.clientHeight / kRow), 1); }

  // The first visible line, from 0, with the fraction of its row that is scrolled off.
  private get top(): number {
    const most = Math.max(this.height - this.host.clientHeight, 1);
    return this.host.scrollTop / most * Math.max(this.lines - this.host.clientHeight / kRow, 0);
  }

  // Keeps the line at the cursor visible.
  private follow(): void {
    const line = this.timeline.lineOf(this.timeline.tick);
    if (line === this.marked) return;
    this.marked = line;
    this.reveal(line);
    this.ask();
  }

  private reveal(line: number): void {
    const top = this.top;
    if (line > 0 && (line - 1 < top + 1 || line > top + this.seen - 1)) this.scrollTo(line);
  }

  // No row is cut off at the top.
  scrollTo(line: number): void {
    const first = Math.max(line - 1 - Math.floor(this.seen / 2), 0), span = Math.max(this.lines - this.host.clientHeight / kRow, 1);
    this.host.scrollTop = Math.min(first / span, 1) * Math.max(this.height - this.host.clientHeight, 0);
    this.ask();
  }

  private ask(): void {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      this.draw();
    });
  }

  private bytesOf(line: number): Uint8Array {
    const { program, lineStart } = this.timeline.run;
    return program.subarray(lineStart[line - 1], lineStart[line] - 1);
  }

  private draw(): void {
    const top = this.top, first = Math.floor(top), rows: HTMLElement[] = [];
    for (let line = first + 1; line <= Math.min(first + this.seen + 2, this.lines); ++line) rows.push(this.row(line));
    this.rows.replaceChildren(...rows);
    this.rows.style.transform = `translateY(${this.host.scrollTop - (top - first) * kRow}px)`;
    const here = document.getElementById("line-" + String(this.marked));
    this.inSight = here !== null && this.marked > first && this.marked <= first + this.seen + 1;
    if (here) this.host.setAttribute("aria-activedescendant", here.id);
    else this.host.removeAttribute("aria-activedescendant");
  }

  private row(line: number): HTMLElement {
    const bytes = this.bytesOf(line).subarray(0, 400), text = element("span"), refused = this.refused.get(line);
    const part = (from: number, to?: number) => inOrder(this.decoder.decode(bytes.subarray(from, to)));
    const row = element("div", {
      class: "program-row", id: `line-${line}`, "data-line": String(line), role: "option",
      "aria-selected": String(line === this.marked), "aria-posinset": String(line), "aria-setsize": String(this.lines),
    }, element("span", { class: "program-number" }, String(line)), text);
    if (!refused) {
      text.textContent = part(0);
      return row;
    }
    row.classList.add("refused");
    row.title = inOrder(refused.code > 0 ? `error ${refused.code}: ${refused.text}` : refused.text);
    text.append(part(0, refused.begin), element("mark", {}, part(refused.begin, refused.end)), part(refused.end),
      element("span", { class: "program-why" }, row.title));
    return row;
  }
}
