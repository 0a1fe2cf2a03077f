// The promises of the package cusp-core, installed from its tarball: npm_package.py runs this beside it.
import assert from "node:assert/strict";
import { readFileSync, statSync } from "node:fs";
import { createRequire } from "node:module";
import { test } from "node:test";
import { POINT_FIELDS, settingTable, simulate } from "cusp-core";

const require = createRequire(import.meta.url);
const folder = require.resolve("cusp-core").replace(/index\.js$/, "");

test("the module is at most 420 kB", () => {
  const { size } = statSync(folder + "cusp_core.wasm");
  assert.ok(size > 100_000 && size <= 420_000, `${size} bytes`);
});

test("a program gives its figures", async () => {
  const run = await simulate("G21 G90 G61\r\nG1 X10 F600\r\nM30\r\n");
  assert.deepEqual(run.errors, []);
  assert.deepEqual(run.end_mpos_mm, [10, 0, 0]);
  assert.deepEqual(run.steps, [8000, 0, 0]);
  assert.ok(Math.abs(run.duration_s - 1.03) < 0.02, `${run.duration_s} s`);
  assert.match(run.edges_crc32, /^[0-9a-f]{8}$/);
  assert.equal(run.alarm, null);
});

test("settings count, as text and as numbers", async () => {
  const program = "G21 G90\nG1 X10 F6000\n";
  const standard = await simulate(program);
  const slow = await simulate(program, "$110=300\n");
  assert.deepEqual(await simulate(program, { $110: 300 }), slow);
  assert.ok(slow.duration_s > 1.9 && standard.duration_s < 0.5);
});

test("refused settings and lines are told with their line", async () => {
  const settings = async (text) => (await simulate("G1 X1 F600\n", text)).errors;
  assert.deepEqual(await settings("$100=800\n$999=1\n"), [{ in: "settings", line: 2, code: 0, text: "there is no setting $999" }]);
  assert.match((await settings("$110=-5"))[0].text, /^\$110=-5 is out of range: /);
  assert.match((await settings("fast"))[0].text, /^'fast' is no setting such as \$100=800\.000$/);
  const run = await simulate("G21\nG1 X1 F100\nG1 X2 Q<b>\n");
  assert.deepEqual(run.errors, [{ in: "program", line: 3, code: 2, text: 'error:2: a number is missing or malformed: Q in "G1 X2 Q<b>"' }]);
  assert.equal(run.end_mpos_mm[0], 1);
  const alarm = await simulate("G38.2 Z-5 F200\n");
  assert.equal(alarm.alarm, 5);
  assert.equal(alarm.errors[0].text, "ALARM:5: alarm: the probe did not touch");
});

test("texts of any bytes and sizes are programs", async () => {
  assert.deepEqual((await simulate("")).errors, []);
  assert.equal((await simulate("G1 X\u0000\u{1F600}\n")).errors[0].line, 1);
  assert.equal((await simulate("(" + "x".repeat(200_000) + ")\nG1 X1 F600\n")).errors.length, 0);
  assert.equal((await simulate("G1 X1 F600\n".repeat(3) + "X".repeat(100_000))).errors[0].line, 4);
});

test("set points come with their line, every millisecond", async () => {
  const rows = [];
  const run = await simulate("G21 G90 G61\n\nG1 X3 F600\nY1\n", "", { setPoints: (points) => rows.push(...points) });
  const ticks = rows.length / POINT_FIELDS;
  assert.equal(ticks, Math.round(run.total_s * 1000) + 1);
  const at = (tick) => rows.slice(POINT_FIELDS * tick, POINT_FIELDS * tick + POINT_FIELDS);
  assert.deepEqual(at(0), [0, 0, 0, 0]);
  assert.equal(at(150)[3], 3);
  assert.equal(at(ticks - 10)[3], 4);
  assert.deepEqual(at(ticks - 1).slice(0, 3), [3, 1, 0]);
});

test("a run tells of its progress and can be stopped", async () => {
  const long = "G21 G91 F6000\n" + "G1 X5\nX-5\n".repeat(5000);
  const seen = [];
  const stop = new AbortController();
  const progress = (p) => {
    seen.push(p);
    if (seen.length === 3) stop.abort();
  };
  await assert.rejects(simulate(long, "", { progress, signal: stop.signal }), { name: "AbortError" });
  assert.ok(seen[2].fraction > seen[0].fraction && seen[2].fraction < 1);
  assert.ok(seen[2].simulated_s > seen[0].simulated_s);
  // the next run has an instance of its own
  assert.equal((await simulate("G1 X1 F600\n")).end_mpos_mm[0], 1);
});

test("runs that overlap do not meet", async () => {
  const [a, b] = await Promise.all([simulate("G1 X1 F600\n"), simulate("G1 Y2 F600\n")]);
  assert.deepEqual([a.end_mpos_mm, b.end_mpos_mm], [[1, 0, 0], [0, 2, 0]]);
});

test("the settings are listed with their ranges", async () => {
  const rate = (await settingTable()).find((entry) => entry.number === 110);
  assert.equal(rate.standard, 6000);
  assert.ok(rate.least > 0 && rate.most > rate.standard);
});

test("the types name what there is", () => {
  const types = readFileSync(folder + "index.d.ts", "utf8") + readFileSync(folder + "core.d.ts", "utf8");
  for (const name of ["simulate", "settingTable", "edges_crc32", "end_mpos_mm", "RunResult"]) assert.ok(types.includes(name), name);
});
