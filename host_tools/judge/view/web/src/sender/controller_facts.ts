// A controller's description of itself: the answers to $I, $$, $G and $#. A line of another form, as lost bytes make it, says nothing.
import { placeOf } from "./status_report";
import type { Place } from "./status_report";

// The number of one axis, or the last of several; null: a text of another form.
const lengthOf = (text: string): number | null => placeOf(text)?.at(-1) ?? placeOf(`${text},${text},${text}`)?.[2] ?? null;

export class ControllerFacts {
  /** As they were listed, one after the other: what the planners' call `send` reads. */
  listing: string[] = [];
  readonly settings = new Map<number, number>();
  /** Bytes of its receive buffer; 128 where it does not say. */
  buffer = 128;
  version = "";
  /** Words of $G. */
  modal: string[] = [];
  /** By the names of $#: G54 to G59.3, G28, G30, G92. */
  readonly places = new Map<string, Place>();
  probe: { at: Place; touched: boolean } | null = null;
  toolLength = 0;

  take(lines: readonly string[]): void {
    this.listing.push(...lines);
    for (const line of lines) this.takeLine(line);
  }

  private takeLine(line: string): void {
    const setting = /^\$(\d+)=(-?\d+(?:\.\d*)?)(?: \(.*)?$/.exec(line), [, name, value] = /^\[([^:\]]+):(.*)\]$/.exec(line) ?? ["", "", ""];
    if (setting) this.settings.set(Number(setting[1]), Number(setting[2]));
    else if (name === "VER") this.version = value.replace(/:+$/, "");
    else if (name === "OPT") this.buffer = Number(/,(\d{2,6})$/.exec(value)?.[1] ?? this.buffer);
    else if (name === "GC") this.modal = value.split(" ");
    else if (name === "TLO") this.toolLength = lengthOf(value) ?? this.toolLength;
    else if (name === "PRB") {
      const [place, touched] = value.split(":"), at = placeOf(place);
      this.probe = at && { at, touched: touched === "1" };
    } else if (/^G\d/.test(name)) {
      const at = placeOf(value);
      if (at) this.places.set(name, at);
    }
  }

  setting(number: number, otherwise = 0): number { return this.settings.get(number) ?? otherwise; }
}
