// Where the tables and values of a TOML text stand: what an edit must know to leave all else, comments too, as it is.

export interface KeySpan {
  name: string;
  from: number;       // of the statement
  valueFrom: number;
  valueTo: number;
  to: number;         // after the line's end
}

export interface TableSpan {
  name: string;       // "" for the top of the file
  isList: boolean;    // [[name]]
  from: number;       // of the header, after the comments that stand directly above it
  lead: number;       // of these comments
  headerTo: number;   // after the header's line
  to: number;         // where the next table's `lead` is, or the text ends
  keys: KeySpan[];
}

class Scanner {
  at = 0;
  constructor(private readonly text: string) {}

  ended(): boolean { return this.at >= this.text.length; }
  startsWith(mark: string): boolean { return this.text.startsWith(mark, this.at); }

  toLineEnd(): void {
    const end = this.text.indexOf("\n", this.at);
    this.at = end < 0 ? this.text.length : end + 1;
  }

  blanks(): void { while (!this.ended() && " \t".includes(this.text[this.at])) ++this.at; }

  // Past a string, with one mark or three.
  private string(): void {
    const mark = this.text[this.at], long = this.startsWith(mark.repeat(3)) ? mark.repeat(3) : mark;
    this.at += long.length;
    while (!this.ended() && !this.startsWith(long)) this.at += mark === "\"" && this.text[this.at] === "\\" ? 2 : 1;
    this.at += long.length;
    // a long string may end in one or two marks of its own
    for (let k = 0; long.length === 3 && k < 2 && this.text[this.at] === mark; ++k) ++this.at;
  }

  // Past a key: to the next of `ends` outside of quotes.
  key(ends: string): void {
    while (!this.ended() && !ends.includes(this.text[this.at]) && this.text[this.at] !== "\n") {
      if ("\"'".includes(this.text[this.at])) this.string();
      else ++this.at;
    }
  }

  value(): void {
    for (let depth = 0; !this.ended();) {
      const c = this.text[this.at];
      if ("\"'".includes(c)) {
        this.string();
        if (depth === 0) return;
      } else if ("[{".includes(c)) {
        ++depth;
        ++this.at;
      } else if ("]}".includes(c)) {
        --depth;
        ++this.at;
        if (depth <= 0) return;
      } else if (depth === 0 && " \t\r\n#".includes(c)) {
        // a date may hold a blank; no key of a job is one
        return;
      } else if (c === "#") this.toLineEnd();
      else ++this.at;
    }
  }
}

const bare = (name: string): string => name.split(".").map((part) => part.trim().replace(/^(["'])(.*)\1$/s, "$2")).join(".");

// The start of the comments that end directly above a place; no empty line is between.
function leadOf(text: string, from: number): number {
  let lead = from;
  for (;;) {
    const before = text.lastIndexOf("\n", lead - 2) + 1;
    if (lead === 0 || !/^[ \t]*#/.test(text.slice(before, lead))) return lead;
    lead = before;
  }
}

/** The tables of a text, the top first. A text that is no TOML gives what was understood. */
export function tablesOf(text: string): TableSpan[] {
  const tables: TableSpan[] = [{ name: "", isList: false, from: 0, lead: 0, headerTo: 0, to: text.length, keys: [] }];
  const scanner = new Scanner(text);
  while (!scanner.ended()) {
    const lineFrom = scanner.at;
    scanner.blanks();
    const from = scanner.at;
    if (scanner.startsWith("[")) {
      const isList = scanner.startsWith("[[");
      scanner.at += isList ? 2 : 1;
      const nameFrom = scanner.at;
      scanner.key("]");
      const name = bare(text.slice(nameFrom, scanner.at).trim());
      scanner.toLineEnd();
      const lead = leadOf(text, lineFrom);
      tables[tables.length - 1].to = lead;
      tables.push({ name, isList, from: lineFrom, lead, headerTo: scanner.at, to: text.length, keys: [] });
    } else if (scanner.ended() || "\r\n#".includes(text[from])) {
      scanner.toLineEnd();
    } else {
      scanner.key("=");
      const name = bare(text.slice(from, scanner.at).trim());
      ++scanner.at;
      scanner.blanks();
      const valueFrom = scanner.at;
      scanner.value();
      const valueTo = Math.min(scanner.at, text.length);
      scanner.toLineEnd();
      tables[tables.length - 1].keys.push({ name, from: lineFrom, valueFrom, valueTo, to: Math.min(scanner.at, text.length) });
    }
  }
  return tables;
}
