// Fields for keys and cards for tables: a value that is typed goes into the job's text, and faults stand where they belong.
import { useSignal } from "@preact/signals";
import type { Signal } from "@preact/signals";
import type { ComponentChildren, JSX } from "preact";
import { useEffect } from "preact/hooks";
import { removeTable, setKey, swapWithNext } from "../project/job_text";
import type { KeyPlace } from "../project/job_text";
import { shown, typed } from "../project/toml_values";
import { rangeOf, unitOf } from "./keys";
import type { Key } from "./keys";
import { faultAt, history, inch, project } from "./store";

// Backquotes in a key's help mark words of the job.
const plain = (text: string): string => text.replace(/`/g, "");
const labelOf = (name: string): string => name.replace(/_/g, " ");
const kPlaceholder = /^(none|needed|see)/;

// Text that is being typed is the field's own until it is set: the page may be drawn anew meanwhile.
function Control({ item, id, value, listId, typing, set }: { item: Key; id: string; value: unknown; listId: string; typing: Signal<string | null>; set: (text: string) => void }): JSX.Element {
  const described = `${id}-help ${id}-fault`;
  if (item.choices.length > 0 || item.kind === "true or false") {
    const choices = item.choices.length > 0 ? item.choices : ["true", "false"], now = shown(value);
    return <select id={id} aria-describedby={described} value={now} onChange={(event) => set(event.currentTarget.value)}>
      <option value="">{item.needed ? "choose …" : `default: ${plain(item.otherwise)}`}</option>
      {choices.map((choice) => <option key={choice} value={choice}>{choice}</option>)}
    </select>;
  }
  return <input id={id} aria-describedby={described} value={typing.value ?? shown(value)} list={listId} spellcheck={false} autocomplete="off"
    onInput={(event) => { typing.value = event.currentTarget.value; }}
    inputMode={/length|feed|number|angle/.test(item.kind) ? "decimal" : "text"}
    placeholder={kPlaceholder.test(item.otherwise) ? "" : plain(item.otherwise)} onChange={(event) => set(event.currentTarget.value)} />;
}

export function KeyField({ place, item, value }: { place: KeyPlace; item: Key; value: unknown }): JSX.Element {
  const wrong = useSignal(""), typing = useSignal<string | null>(null), now = shown(value);
  useEffect(() => { typing.value = null; wrong.value = ""; }, [now, typing, wrong]);
  const id = `${place.table || "job"}-${place.index}-${item.name}`, unit = unitOf(item.kind, inch.value), range = rangeOf(item);
  const fault = wrong.value || faultAt(place);
  const set = (text: string) => {
    try {
      wrong.value = "";
      history.change({ job: setKey(project.value.job, place, typed(item.kind, text)) });
      typing.value = null;
    } catch (reason) {
      wrong.value = reason instanceof Error ? reason.message : String(reason);
    }
  };
  const listId = item.kind === "text" || item.kind === "text or list of texts" ? "files-of-project" : item.kind.includes("tool") ? "tools-of-project" : "";
  return <div class={`field${fault ? " wrong" : ""}`}>
    <label for={id}>{labelOf(item.name)}{item.needed && value === undefined ? <span class="needed" title="needed">•</span> : null}</label>
    <div class="control"><Control item={item} id={id} value={value} listId={listId} typing={typing} set={set} />{unit ? <span class="unit">{unit}</span> : null}</div>
    <p class="help" id={`${id}-help`}>{plain(item.help)}{range ? ` (${range})` : ""}</p>
    <p class="fault" id={`${id}-fault`} role={fault ? "alert" : undefined}>{fault}</p>
  </div>;
}

/** All fields of a table: those in use and those that must be given first, the rest folded. `first` come before the others. */
export function TableFields({ table, index, items, values, first = [] }:
  { table: string; index: number; items: Key[]; values: Record<string, unknown>; first?: string[] }): JSX.Element {
  const isOpen = (item: Key) => item.needed || item.name in values || first.includes(item.name) || faultAt({ table, index, key: item.name }) !== "";
  const order = (item: Key) => first.includes(item.name) ? first.indexOf(item.name) : first.length;
  const used = items.filter(isOpen).sort((a, b) => order(a) - order(b)), rest = items.filter((item) => !isOpen(item));
  const field = (item: Key) => <KeyField key={item.name} place={{ table, index, key: item.name }} item={item} value={values[item.name]} />;
  const whole = faultAt({ table, index, key: "" });
  return <>
    {whole ? <p class="fault" role="alert">{whole}</p> : null}
    <div class="fields">{used.map(field)}</div>
    {rest.length > 0 ? <details><summary>{`${rest.length} more`}</summary><div class="fields">{rest.map(field)}</div></details> : null}
  </>;
}

/** A table of a list, with its place in it. */
export function Card({ table, index, count, title, children }: { table: string; index: number; count: number; title: string; children: ComponentChildren }): JSX.Element {
  const edit = (text: string) => history.change({ job: text });
  return <article class="card">
    <header class="card-head">
      <h3>{title}</h3>
      <button type="button" aria-label={`Move ${title} up`} disabled={index === 0} onClick={() => edit(swapWithNext(project.value.job, table, index - 1))}>↑</button>
      <button type="button" aria-label={`Move ${title} down`} disabled={index + 1 >= count} onClick={() => edit(swapWithNext(project.value.job, table, index))}>↓</button>
      <button type="button" aria-label={`Remove ${title}`} onClick={() => edit(removeTable(project.value.job, table, index))}>Remove</button>
    </header>
    {children}
  </article>;
}
