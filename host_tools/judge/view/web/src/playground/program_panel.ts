// The program's text: editable up to a size, otherwise shown in part, since a text box of a million lines stalls the page.
import type { RunError } from "../core/core";
import { button, element } from "../elements";

const MOST_EDITED = 250_000;  // characters
const SHOWN = 50_000;

export class ProgramPanel {
  readonly box = element("textarea", { spellcheck: "false", autocapitalize: "off", "aria-label": "Program, G-code" });
  private readonly note = element("div", { class: "program-note" });
  private readonly errors = element("ul", { class: "errors", "aria-label": "Errors" });
  private whole: string | null = null;  // of a program too long to edit

  constructor(host: HTMLElement, text: string) {
    host.append(this.box, this.errors, this.note);
    this.text = text;
  }

  get text(): string {
    return this.whole ?? this.box.value;
  }

  set text(text: string) {
    const long = text.length > MOST_EDITED;
    this.whole = long ? text : null;
    this.box.value = long ? text.slice(0, text.lastIndexOf("\n", SHOWN) + 1 || SHOWN) : text;
    this.box.readOnly = long;
    this.note.textContent = long ? `${(text.length / 1e6).toFixed(1)} MB: only its beginning is shown, all of it runs` : "";
    this.note.hidden = !long;
    this.show([]);
  }

  show(errors: RunError[]): void {
    const lines = errors.length > 0 ? this.text.split(/\r\n|\r|\n/) : [];
    this.errors.replaceChildren(...errors.map((error) => {
      const text = error.in === "program" ? (lines[error.line - 1] ?? "").slice(0, 120) : "";
      const where = error.in === "settings" ? "Setting" : `Line ${error.line}`;
      return element("li", {}, button(`${where}: ${error.text}${text ? ` — ${text}` : ""}`, "Go to the line", () => {
        if (error.in === "program") this.goTo(error.line, lines);
      }));
    }));
  }

  private goTo(line: number, lines: string[]): void {
    const before = lines.slice(0, line - 1).reduce((sum, text) => sum + text.length + 1, 0);
    this.box.focus();
    this.box.setSelectionRange(before, before + (lines[line - 1] ?? "").length);
    this.box.scrollTop = Math.max(0, (line - 4) * parseFloat(getComputedStyle(this.box).lineHeight));
  }
}
