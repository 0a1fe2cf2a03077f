// Edits of a job's text, which is the truth of a project: a value is written where it stands, and comments stay.
//
//     setKey(text, { table: "operation", index: 1, key: "scallop" }, "0.02")
import { parse } from "smol-toml";
import { tomlOf } from "./toml_values";
import { tablesOf } from "./toml_spans";
import type { TableSpan } from "./toml_spans";

/** The key of a table, "" for the top; `index` counts tables of one name, from 0. */
export interface KeyPlace { table: string; index: number; key: string }

const named = (text: string, name: string): TableSpan[] => tablesOf(text).filter((table) => table.name === name);

// A text that ends with a line end, as what is added after it needs.
const closed = (text: string): string => text === "" || text.endsWith("\n") ? text : text + "\n";

const spliced = (text: string, from: number, to: number, part: string): string => text.slice(0, from) + part + text.slice(to);

// A table that stands in braces, `stock = { top = 0 }`, as one with a header; of lists likewise.
function unfolded(text: string, name: string): string {
  const span = name === "" ? undefined : tablesOf(text)[0].keys.find((key) => key.name === name);
  if (!span) return text;
  const value = parse(text.slice(span.from, span.to))[name], isList = Array.isArray(value);
  let out = spliced(text, span.from, span.to, "");
  for (const table of (isList ? value : [value]) as Record<string, unknown>[]) {
    out = addTable(out, name, Object.entries(table).map(([key, part]) => [key, tomlOf(part)]), isList);
  }
  return out;
}

/** Writes a value, as TOML, or takes the key away where it is undefined. A table that is missing is added. */
export function setKey(given: string, { table, index, key }: KeyPlace, value: string | undefined): string {
  const text = unfolded(given, table);
  const found = named(text, table).at(index);
  if (!found) return value === undefined ? text : setKey(addTable(text, table, [], index > 0), { table, index, key }, value);
  const span = found.keys.find((k) => k.name === key);
  if (span) return value === undefined ? spliced(text, span.from, span.to, "") : spliced(text, span.valueFrom, span.valueTo, value);
  if (value === undefined) return text;
  const at = found.keys.at(-1)?.to ?? found.headerTo, before = closed(text.slice(0, at));
  const gap = table === "" && found.keys.length === 0 && /^\s*\[/.test(text.slice(at)) ? "\n" : "";
  return `${before}${key} = ${value}\n${gap}${text.slice(at)}`;
}

/** Adds a table at the end of those of its name, or of the text. isList: as [[name]]; a single [name] becomes one of them. */
export function addTable(text: string, name: string, keys: [string, string][], isList: boolean): string {
  let all = closed(unfolded(text, name));
  const before = named(all, name);
  if (isList && before.length === 1 && !before[0].isList) {
    const header = all.slice(before[0].from, before[0].headerTo);
    all = spliced(all, before[0].from, before[0].headerTo, header.replace(/\[([^\]]*)\]/, "[[$1]]"));
  }
  const last = named(all, name).at(-1), at = last ? endOf(all, last) : all.length;
  const header = isList ? `[[${name}]]` : `[${name}]`;
  const body = [header, ...keys.map(([key, value]) => `${key} = ${value}`)].join("\n") + "\n";
  const above = closed(all.slice(0, at)), rest = all.slice(at);
  return above + (above === "" || above.endsWith("\n\n") ? "" : "\n") + body + (rest === "" ? "" : "\n" + rest);
}

// The end of a table with the tables inside it, such as [operation.x] in [[operation]].
function endOf(text: string, table: TableSpan): number {
  const tables = tablesOf(text), first = tables.findIndex((other) => other.from === table.from);
  let end = table.to;
  for (const inner of tables.slice(first + 1)) {
    if (!inner.name.startsWith(table.name + ".")) break;
    end = inner.to;
  }
  return end;
}

/** Takes a table away, with the comments directly above it. */
export function removeTable(given: string, name: string, index: number): string {
  const text = unfolded(given, name);
  const table = named(text, name).at(index);
  return table ? spliced(text, table.lead, endOf(text, table), "") : text;
}

/** Changes places with the table of the same name that follows it. */
export function swapWithNext(given: string, name: string, index: number): string {
  const text = unfolded(given, name);
  const [first, second] = named(text, name).slice(index, index + 2) as (TableSpan | undefined)[];
  if (!first || !second) return text;
  const all = closed(text), firstTo = endOf(all, first), secondTo = endOf(all, named(all, name)[index + 1]);
  const body = all.slice(second.lead, secondTo);
  return all.slice(0, first.lead) + (body.endsWith("\n\n") || secondTo < all.length ? body : body + "\n") + all.slice(firstTo, second.lead) +
    all.slice(first.lead, firstTo) + all.slice(secondTo);
}

/** The table and key at a line of the text, from 1: where a fault of that line is shown. */
export function placeOfLine(text: string, line: number): KeyPlace | null {
  let at = 0;
  for (let k = 1; k < line; ++k) at = text.indexOf("\n", at) + 1 || text.length;
  const counts = new Map<string, number>();
  for (const table of tablesOf(text)) {
    const index = counts.get(table.name) ?? 0;
    counts.set(table.name, index + 1);
    if (at < table.lead || at >= table.to) continue;
    return { table: table.name, index, key: table.keys.find((key) => at >= key.from && at < key.to)?.name ?? "" };
  }
  return null;
}
