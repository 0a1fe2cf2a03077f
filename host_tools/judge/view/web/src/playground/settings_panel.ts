// The settings as a form: limits first, the others collapsed. Values other than the default are marked.
import type { SettingEntry } from "../core/core";
import { element } from "../elements";
import { firstSettings, settingName } from "./setting_names";

export class SettingsPanel {
  readonly host = element("section", { class: "settings", "aria-label": "Settings" }, element("h2", {}, "Limits and settings"));
  private readonly inputs = new Map<number, HTMLInputElement>();
  private readonly entries = new Map<number, SettingEntry>();

  constructor(table: SettingEntry[], changed: () => void) {
    const first = element("table"), rest = element("table");
    for (const entry of table) {
      this.entries.set(entry.number, entry);
      (firstSettings.has(entry.number) ? first : rest).append(this.row(entry, changed));
    }
    this.host.append(first, element("details", {}, element("summary", {}, "All other settings"), rest));
  }

  /** The settings that differ from the defaults, as lines $N=v. */
  text(): string {
    return [...this.inputs].filter(([number, input]) => Number(input.value) !== this.entries.get(number)!.standard || input.value === "")
      .map(([number, input]) => `$${number}=${input.value}\n`).join("");
  }

  value(number: number): number {
    return Number(this.inputs.get(number)!.value);
  }

  /** Applies lines $N=v; ignores those that are no setting. Returns the number of settings applied. */
  take(text: string): number {
    let taken = 0;
    for (const [, number, value] of text.matchAll(/^\s*\$\s*(\d+)\s*=\s*([-\d.eE]+)/gm)) {
      const input = this.inputs.get(Number(number));
      if (!input) continue;
      input.value = value;
      this.mark(Number(number));
      taken += 1;
    }
    return taken;
  }

  private row(entry: SettingEntry, changed: () => void): HTMLTableRowElement {
    const name = settingName(entry.number);
    const input = element("input", {
      type: "number", step: "any", min: String(entry.least), max: String(entry.most), "aria-label": `$${entry.number} ${name}`,
      title: `${entry.least} to ${entry.most}; default ${entry.standard}`,
    });
    input.value = String(Number(entry.standard.toFixed(entry.decimals)));
    input.addEventListener("change", () => { this.mark(entry.number); changed(); });
    this.inputs.set(entry.number, input);
    this.entries.set(entry.number, { ...entry, standard: Number(input.value) });
    return element("tr", {}, element("th", { scope: "row" }, `$${entry.number} ${name}`), element("td", {}, input));
  }

  private mark(number: number): void {
    const input = this.inputs.get(number)!;
    input.classList.toggle("changed", Number(input.value) !== this.entries.get(number)!.standard);
  }
}
