// The promises of the package cusp-engine, installed from its tarball: engine_package.py runs this beside it.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync, statSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { test } from "node:test";
import { gzipSync } from "node:zlib";
import { EngineError, check, describe, fit, keys, newEngine, plan, simulate, suggest, verify } from "cusp-engine";

const require = createRequire(import.meta.url);
const folder = require.resolve("cusp-engine").replace(/index\.js$/, "");

const corner = [[0, 0, 0], [20, 0, 0], [20, 20, 0], [0, 20, 0]];
const facets = corner.map((a, k) => [a, corner[(k + 1) % 4], [10, 10, 5]]);
const PYRAMID = `solid p\n${facets.map((facet) =>
  `facet normal 0 0 1\nouter loop\n${facet.map((v) => `vertex ${v.join(" ")}`).join("\n")}\nendloop\nendfacet`).join("\n")}\nendsolid p\n`;
const files = { "p.stl": PYRAMID };

test("the module is at most 1.5 MB compressed", () => {
  const bytes = readFileSync(folder + "engine.wasm");
  const size = gzipSync(bytes, { level: 9 }).length;
  console.log(`engine.wasm: ${bytes.length} bytes, ${size} compressed; index.js: ${statSync(folder + "index.js").size}`);
  assert.ok(size <= 1_500_000, `${size} bytes`);
});

test("keys list strategies, posts and a schema", async () => {
  const { strategies, posts, schema, cad, threads } = await keys();
  assert.ok(strategies.length >= 13 && posts.includes("linuxcnc") && schema.definitions.operation);
  assert.deepEqual([cad, threads], [false, 1]);
});

test("a mesh becomes a job, a program, and a verified part", async () => {
  const info = await describe(["p.stl"], files);
  assert.equal(info.facets[0].corners.length, 36);
  const { job, said } = await suggest(["p.stl"], ["ball:6"], files, { scallop: 0.1 });
  assert.ok(said.length > 0);
  assert.deepEqual((await check(job, files)).faults, []);
  const seen = [];
  const [program] = await plan(job, files, { progress: (p) => seen.push(p) });
  assert.ok(seen.some(({ share }) => share > 0.5) && seen.every(({ text }) => text !== ""));
  const found = await verify(job, program.gcode, files);
  assert.deepEqual(found.broken, []);
  const run = await simulate(program.gcode);
  assert.ok(run.good && run.stats.duration_s > 1 && /^[0-9a-f]{8}$/.test(run.stats.edges_crc32));
  assert.ok((await fit(program.gcode, 0.01)).gcode.length > 100);
});

test("a fault names table, key, value and limit", async () => {
  const { job } = await suggest(["p.stl"], ["ball:6"], files, { scallop: 0.1 });
  const wrong = job.replace(/^feed = .*$/m, "feed = -1.0");
  const { faults } = await check(wrong, files);
  assert.equal(faults[0].key, "feed");
  await assert.rejects(plan(wrong, files), (error) => error instanceof EngineError && error.kind === "input" &&
    error.key === "feed" && error.value === "-1.0" && error.line > 1 && error.limit !== "");
  await assert.rejects(plan(job, {}), /p\.stl: is not among the files/);
});

test("STEP is refused with the reason", async () => {
  await assert.rejects(describe(["a.step"], { "a.step": "ISO-10303-21;" }), /a\.step: STEP, IGES and BREP can't be read/);
});

test("aborting ends a call, and the next one works", async () => {
  const { job } = await suggest(["p.stl"], ["ball:6"], files, { scallop: 0.1 });
  const stop = new AbortController();
  await assert.rejects(plan(job, files, { signal: stop.signal, progress: () => stop.abort() }), { kind: "cancelled" });
  assert.equal((await plan(job, files)).length, 1);
});

test("an instance of one's own, from bytes", async () => {
  const engine = await newEngine(readFileSync(folder + "engine.wasm"));
  assert.throws(() => engine.call("bore"), { kind: "input" });
  assert.ok(engine.isAlive && engine.call("keys").result.version);
});

test("the example plans a mesh", () => {
  writeFileSync("p.stl", PYRAMID);
  const said = execFileSync("node", ["example.mjs", "p.stl", "p.ngc"], { encoding: "utf8", stdio: ["ignore", "pipe", "ignore"] });
  assert.match(said, /all bounds hold/);
  assert.match(readFileSync("p.ngc", "utf8"), /M30|M2/);
});

test("the types name what there is", () => {
  const types = readFileSync(folder + "index.d.ts", "utf8") + readFileSync(folder + "engine.d.ts", "utf8");
  for (const name of ["plan", "verify", "simulate", "describe", "keys", "suggest", "EngineError", "Float32Array"]) assert.ok(types.includes(name), name);
});
