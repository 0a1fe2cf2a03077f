// Macros of a person's own, kept by the browser, and single lines with their answers.
import { signal } from "@preact/signals";
import type { JSX } from "preact";
import { inOrder } from "../elements";
import { textOf } from "../engine/engine";
import { command, commands, isBusy, isOpen, now } from "./machine";

interface Macro { name: string; lines: string }
const kStore = "cusp-studio-macros", kMostShown = 200;

function kept(): Macro[] {
  try {
    const found: unknown = JSON.parse(localStorage.getItem(kStore) ?? "[]");
    return Array.isArray(found) ? found.filter((m): m is Macro => typeof (m as Macro | null)?.name === "string" && typeof (m as Macro).lines === "string") : [];
  } catch {
    return [];
  }
}

const macros = signal(kept()), edited = signal<number | null>(null), line = signal(""), log = signal<string[]>([]);

function keep(all: Macro[]): void {
  macros.value = all;
  try {
    localStorage.setItem(kStore, JSON.stringify(all));
  } catch { /* no store: until the page is closed */ }
}

/** Lines as they are sent: without comments, which a person writes for himself. */
const linesOf = ({ lines }: Macro): string[] => lines.split("\n").map((text) => text.replace(/\([^)]*\)|;.*/g, "").trim()).filter((text) => text !== "");

async function send(text: string): Promise<void> {
  const show = (more: string[]): void => { log.value = [...log.value, ...more.map(inOrder)].slice(-kMostShown); };
  show([`> ${text}`]);
  try {
    show([...await command(text), "ok"]);
  } catch (reason) {
    show([textOf(reason)]);
  }
}

function Editor({ at }: { at: number }): JSX.Element {
  const macro = macros.value[at], change = (more: Partial<Macro>): void => { keep(macros.value.map((m, k) => k === at ? { ...m, ...more } : m)); };
  return <div class="card">
    <label class="line">Name <input value={macro.name} maxLength={40} onInput={(event) => { change({ name: event.currentTarget.value }); }} /></label>
    <label class="line">Lines <textarea rows={5} spellcheck={false} value={macro.lines} onInput={(event) => { change({ lines: event.currentTarget.value }); }} /></label>
    <div class="machine-buttons"><button type="button" onClick={() => { edited.value = null; }}>Done</button>
      <button type="button" onClick={() => { edited.value = null; keep(macros.value.filter((_, k) => k !== at)); }}>Delete</button></div>
  </div>;
}

export function MacroPanel(): JSX.Element {
  const off = !isOpen.value || isBusy.value, at = edited.value;
  return <section aria-label="Macros and lines">
    {macros.value.map((macro, k) => <div class="row" key={k}><button type="button" disabled={off} onClick={() => void commands(...linesOf(macro))}>{macro.name || "no name"}</button>
      <button type="button" aria-label={`Edit ${macro.name}`} onClick={() => { edited.value = k; }}>Edit</button></div>)}
    {at !== null && at < macros.value.length ? <Editor at={at} /> : null}
    <button type="button" onClick={() => { keep([...macros.value, { name: `Macro ${macros.value.length + 1}`, lines: "" }]); edited.value = macros.value.length - 1; }}>New macro</button>
    <form class="row" onSubmit={(event) => { event.preventDefault(); if (line.value.trim() !== "") void send(line.value.trim()); line.value = ""; }}>
      <label class="line">A line <input value={line.value} maxLength={255} spellcheck={false} autocomplete="off" onInput={(event) => { line.value = event.currentTarget.value; }} /></label>
      <button type="submit" disabled={off}>Send</button></form>
    <pre class="log" role="log" tabIndex={0} aria-label="Lines and answers">{[...now.value.messages.map((text) => `[${inOrder(text)}]`), ...log.value].slice(-kMostShown).join("\n")}</pre>
  </section>;
}
