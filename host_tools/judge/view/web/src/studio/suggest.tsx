// Suggest: fills the list of operations as a plan without a job does. The program says which options that has; the page shows those
// that suit the parts, the usual ones first.
import { signal } from "@preact/signals";
import type { JSX } from "preact";
import type { SuggestKey } from "../engine/engine";
import { engineCall, history, inch, keys, kinds, project, say, work, working } from "./store";

type Use = "surfaces" | "drawings";

const kFirst = ["tools", "scallop", "depth", "tabs", "layers", "material"];
/** The typed fields, by the kind of parts. */
const wanted = signal<Record<Use, Record<string, string>>>({
  surfaces: { tools: "flat:8 ball:6", scallop: "0.02" }, drawings: { tools: "flat:3", depth: "3" },
});
/** The choices of the last suggestion, in words. */
const chosen = signal<string[]>([]);

const partsOf = (): { use: Use; parts: string[] } => {
  const names = [...project.value.files.keys()], surfaces = names.filter((name) => kinds.surfaces.test(name));
  return surfaces.length > 0 ? { use: "surfaces", parts: surfaces } : { use: "drawings", parts: names.filter((name) => kinds.drawing.test(name)) };
};

const listOf = (text: string, separator: RegExp): string[] => text.split(separator).map((part) => part.trim()).filter((part) => part !== "");

function numberOf({ name }: SuggestKey, text: string): number {
  const value = Number(text);
  if (text === "" || !Number.isFinite(value)) throw new RangeError(`${name.replace(/_/g, " ")}: "${text}" is not a number`);
  return value;
}

function valueOf(key: SuggestKey, text: string): unknown {
  switch (key.kind) {
    case "number": return numberOf(key, text.trim());
    case "numbers": return listOf(text, /[\s,]+/).map((part) => numberOf(key, part));
    case "texts": return listOf(text, key.type.endsWith("...") ? /[\s,]+/ : /,/);  // names of layers may hold spaces
    default: return text.trim();
  }
}

async function suggest(): Promise<void> {
  const { use, parts } = partsOf(), { files } = project.value, given = wanted.value[use];
  if (parts.length === 0) {
    say("Suggest needs a part, such as STEP, STL or DXF: choose one in the step Part", true);
    return;
  }
  const args: Record<string, unknown> = { parts, inch: inch.value };
  try {
    for (const key of keysFor(use)) if (key.name in given && given[key.name].trim() !== "") args[key.name] = valueOf(key, given[key.name]);
  } catch (reason) {
    say(reason instanceof Error ? reason.message : String(reason), true);
    return;
  }
  const answer = await working("Suggesting", (options) => engineCall("suggest", args, files, options));
  if (!answer) return;
  history.change({ job: answer.result.job });
  chosen.value = answer.result.said.filter((line) => line !== "");
}

function keysFor(use: Use): SuggestKey[] {
  const place = ({ name }: SuggestKey) => (kFirst.indexOf(name) + kFirst.length + 1) % (kFirst.length + 1);
  return (keys.value?.suggest ?? []).filter((key) => key.use === "any" || key.use === use).sort((a, b) => place(a) - place(b));
}

function unitOf({ type }: SuggestKey): string {
  const length = inch.value ? "in" : "mm";
  return { LENGTH: length, FEED: `${length}/min`, RPM: "rpm", DEGREES: "°" }[type] ?? "";
}

function SuggestField({ item, use }: { item: SuggestKey; use: Use }): JSX.Element {
  const id = `suggest-${item.name}`, name = item.name.replace(/_/g, " "), now = wanted.value[use][item.name] ?? "", unit = unitOf(item);
  const set = (text: string) => { wanted.value = { ...wanted.value, [use]: { ...wanted.value[use], [item.name]: text } }; };
  return <div class="field"><label for={id}>{name[0].toUpperCase() + name.slice(1)}</label>
    <div class="control">{item.choices.length > 0
      ? <select id={id} aria-describedby={`${id}-help`} value={now} onChange={(event) => set(event.currentTarget.value)}>
        <option value="">as usual</option>
        {item.choices.map((choice) => <option key={choice} value={choice}>{choice}</option>)}
      </select>
      : <input id={id} aria-describedby={`${id}-help`} value={now} spellcheck={false} autocomplete="off"
        inputMode={item.kind === "number" ? "decimal" : "text"} onInput={(event) => set(event.currentTarget.value)} />}
    {unit ? <span class="unit">{unit}</span> : null}</div>
    <p class="help" id={`${id}-help`}>{item.help}</p></div>;
}

export function Suggest(): JSX.Element {
  const { use } = partsOf(), all = keysFor(use), first = all.filter(({ name }) => kFirst.includes(name)), rest = all.slice(first.length);
  const field = (item: SuggestKey) => <SuggestField key={item.name} item={item} use={use} />;
  return <section class="suggest">
    <h2>Suggest</h2>
    <div class="fields">{first.map(field)}</div>
    {rest.length > 0 ? <details><summary>{`${rest.length} more`}</summary><div class="fields">{rest.map(field)}</div></details> : null}
    <button type="button" class="primary" disabled={work.value !== null || !keys.value} onClick={() => void suggest()}>Suggest</button>
    {chosen.value.length > 0 ? <ul class="chosen" aria-label="What was chosen">{chosen.value.map((line) => <li key={line}>{line}</li>)}</ul> : null}
  </section>;
}
