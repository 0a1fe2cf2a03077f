// Operations: a list that "Suggest" fills as the one-line plan does, or a person; tools and feeds beside it.
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { addTable, setKey } from "../project/job_text";
import { tablesOf } from "../project/project";
import { quotedList, shown } from "../project/toml_values";
import { Card, KeyField, TableFields } from "./fields";
import { checked, history, job, keys, kinds, placeOf, project } from "./store";
import { Suggest } from "./suggest";

function AddOperation(): JSX.Element {
  const strategy = useSignal(""), known = keys.value?.strategies ?? [];
  const add = () => {
    const name = strategy.value || known[0].name, drawing = [...project.value.files.keys()].find((file) => kinds.drawing.test(file));
    const floor = [...project.value.files.keys()].filter((file) => kinds.surfaces.test(file));
    const items = keys.value!.operation(name), has = (key: string) => items.some((item) => item.name === key);
    const given: [string, string][] = [["strategy", `"${name}"`]];
    if (has("floor") && floor.length > 0) given.push(["floor", quotedList(floor)]);
    if (has("boundary") && drawing) given.push(["boundary", quotedList([drawing]).slice(1, -1)]);
    history.change({ job: addTable(project.value.job, "operation", given, true) });
  };
  return <div class="row">
    <select aria-label="Strategy of the operation to add" value={strategy.value} onChange={(event) => { strategy.value = event.currentTarget.value; }}>
      {known.map(({ name, help }) => <option key={name} value={name} title={help}>{name}</option>)}
    </select>
    <button type="button" disabled={known.length === 0} onClick={add}>Add an operation</button>
  </div>;
}

function Tools(): JSX.Element {
  const tools = tablesOf(job.value.values, "tool"), items = keys.value!.table("tool");
  const add = () => history.change({ job: addTable(project.value.job, "tool", [["shape", "\"flat\""], ["diameter", "6"]], true) });
  return <section><h2>Tools</h2>
    {tools.map((table, k) => <Card key={k} table="tool" index={k} count={tools.length} title={titleOfTool(table, k)}>
      <TableFields table="tool" index={k} items={items} values={table} first={["shape", "diameter"]} /></Card>)}
    <button type="button" onClick={add}>Add a tool</button>
    <TableFields table="cutting" index={0} items={keys.value!.table("cutting")} values={tablesOf(job.value.values, "cutting").at(0) ?? {}} first={["feed", "plunge_feed", "spindle"]} />
  </section>;
}

function titleOfTool(table: Record<string, unknown>, k: number): string {
  const number = typeof table.number === "number" || typeof table.number === "bigint" ? String(table.number) : String(k + 1);
  return `T${number}${typeof table.shape === "string" ? ` ${table.shape}` : ""}${typeof table.diameter === "number" ? ` ${table.diameter}` : ""}`;
}

// Faults that no field shows.
function Faults(): JSX.Element | null {
  const { faults, warnings } = checked.value, elsewhere = faults.filter((fault) => placeOf(fault) === null);
  if (elsewhere.length === 0 && warnings.length === 0) return null;
  return <ul class="warnings">
    {elsewhere.map((fault) => <li key={fault.text} role="alert">{fault.text}</li>)}
    {warnings.map((text) => <li key={text}>{text}</li>)}
  </ul>;
}

function JobText(): JSX.Element {
  const draft = useSignal<string | null>(null), { fault } = job.value;
  return <details open={fault !== ""}><summary>The job as text</summary>
    <textarea class="job-text" aria-label="The job, TOML" spellcheck={false} value={draft.value ?? project.value.job}
      onInput={(event) => { draft.value = event.currentTarget.value; }}
      onChange={(event) => {
        draft.value = null;
        history.change({ job: event.currentTarget.value });
      }} />
    {fault ? <p class="fault" role="alert">{fault}</p> : null}
  </details>;
}

export function OperationsStep(): JSX.Element {
  const tables = keys.value, { values } = job.value;
  if (!tables) return <p class="note">The fields come with the planners.</p>;
  const operations = tablesOf(values, "operation");
  const strategies = (table: Record<string, unknown>, k: number) => <div class="field">
    <label for={`strategy-${k}`}>strategy</label>
    <div class="control"><select id={`strategy-${k}`} value={shown(table.strategy)} onChange={(event) =>
      history.change({ job: setKey(project.value.job, { table: "operation", index: k, key: "strategy" }, `"${event.currentTarget.value}"`) })}>
      {tables.strategies.map(({ name }) => <option key={name} value={name}>{name}</option>)}</select></div>
    <p class="help">{tables.strategies.find(({ name }) => name === table.strategy)?.help ?? ""}</p>
  </div>;
  return <>
    <Suggest />
    <Faults />
    <section><h2>Operations</h2>
      {operations.map((table, k) => <Card key={k} table="operation" index={k} count={operations.length} title={`${k + 1} ${shown(table.strategy)}`}>
        {strategies(table, k)}
        <TableFields table="operation" index={k} items={tables.operation(shown(table.strategy))} values={table} first={["tool", "scallop", "depth"]} /></Card>)}
      <AddOperation />
    </section>
    <Tools />
    <section><h2>Program</h2><div class="fields">{tables.top().map((item) =>
      <KeyField key={item.name} place={{ table: "", index: 0, key: item.name }} item={item} value={values[item.name]} />)}</div></section>
    <JobText />
    <p class="next"><a class="button primary" href="#check">Go on to plan and check</a></p>
  </>;
}
