// Stock: what the part is cut from, how it lies, and what holds it.
import type { JSX } from "preact";
import { addTable } from "../project/job_text";
import { tablesOf } from "../project/project";
import { Card, TableFields } from "./fields";
import { checked, history, job, keys, project } from "./store";

function SetupFacts(): JSX.Element | null {
  const { setups } = checked.value;
  if (setups.length === 0) return null;
  const size = (extent: [number, number] | null) => extent ? `${extent[0].toFixed(2)} to ${extent[1].toFixed(2)}` : "as the part";
  return <dl class="facts-list">{setups.flatMap((setup) => [
    <dt key={`${setup.name}-t`}>{setup.name || "Stock, mm"}</dt>,
    <dd key={`${setup.name}-d`}>{`X ${size(setup.stock.x)}, Y ${size(setup.stock.y)}, Z ${setup.stock.bottom === null ? `up to ${setup.stock.top.toFixed(2)}` : size([setup.stock.bottom, setup.stock.top])}`}</dd>,
  ])}</dl>;
}

export function StockStep(): JSX.Element {
  const tables = keys.value, { values } = job.value;
  if (!tables) return <p class="note">The fields come with the planners.</p>;
  const fixtures = tablesOf(values, "fixture");
  const addFixture = () => history.change({
    job: addTable(project.value.job, "fixture", [["x", "[0, 10]"], ["y", "[0, 10]"], ["top", "5"]], true),
  });
  return <>
    <SetupFacts />
    <section><h2>Stock</h2><TableFields table="stock" index={0} items={tables.table("stock")} values={tablesOf(values, "stock").at(0) ?? {}}
      first={["top", "bottom", "margin", "clearance"]} /></section>
    <section><h2>Placing</h2>
      {(tablesOf(values, "placing").length > 0 ? tablesOf(values, "placing") : [{}]).map((table, k) =>
        <TableFields key={k} table="placing" index={k} items={tables.table("placing")} values={table} first={["origin", "up", "rotate", "scale"]} />)}
    </section>
    <section><h2>Fixtures</h2>
      {fixtures.map((table, k) => <Card key={k} table="fixture" index={k} count={fixtures.length} title={`Fixture ${k + 1}`}>
        <TableFields table="fixture" index={k} items={tables.table("fixture")} values={table} first={["x", "y", "top"]} /></Card>)}
      <button type="button" onClick={addFixture}>Add a fixture</button>
    </section>
  </>;
}
