// The studio's project without a browser: edits of a job's text, undo, zips. node project_test.mjs WEB TOP
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import fs from "node:fs";
import { createRequire } from "node:module";
import os from "node:os";
import path from "node:path";
import test, { after } from "node:test";
import { pathToFileURL } from "node:url";

const [web, top] = process.argv.slice(2), require = createRequire(path.join(web, "package.json"));
const folder = fs.mkdtempSync(path.join(os.tmpdir(), "cusp-studio-"));
after(() => fs.rmSync(folder, { recursive: true, force: true }));
const bundle = path.join(folder, "project.mjs");
await require("esbuild").build({
  stdin: { contents: ["job_text", "toml_spans", "toml_values", "project", "zip"].map((name) => `export * as ${name} from "./src/project/${name}";`).join("\n") +
    `export { parse } from "smol-toml";`, resolveDir: web }, bundle: true, format: "esm", outfile: bundle, logLevel: "error",
});
const { job_text: edit, toml_values: values, project: projects, zip, parse } = await import(pathToFileURL(bundle));

// A seeded sequence: the tests print where they begin.
const seed = Number(process.env.SEED ?? 20261128);
function numbers(state) {
  return (most) => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return Math.floor(state / 2 ** 32 * most);
  };
}
console.log(`SEED=${seed}`);

const jobs = fs.readdirSync(path.join(top, "examples"), { recursive: true }).filter((name) => name.endsWith(".toml"))
  .map((name) => fs.readFileSync(path.join(top, "examples", name), "utf8"));
const hostile = [
  "units = \"mm\" # \"[stock]\"\ntool = { shape = \"ball\", diameter = 6 }\nstock = {top = 1}\n[[operation]] # first\nfloor = [ # \"]\"\n  \"a[#]b.stl\", 'c\\.stl',\n]\nname = \"\"\"x\n[stock]\n\"\"\"\n[operation.inner]\nx = 1\n\n# second\n[[operation]]\nstrategy = 'drill'",
  "[cutting]\r\nfeed = 1_000\r\n# end", "", "# nothing but this", "[[tool]]\n[[tool]]\ndiameter = 3",
];
const comments = (text) => [...text.matchAll(/^[ \t]*#.*$/gm)].map(([line]) => line.trim());

function withoutNewlines(value) { return JSON.parse(JSON.stringify(value, (_, v) => typeof v === "bigint" ? Number(v) : v)); }

test("a key is set, changed and taken away, and all else stays: values and comments", () => {
  assert.ok(jobs.length > 10);
  const random = numbers(seed);
  let tried = 0;
  for (let round = 0; round < 1500; ++round) {
    const all = [...jobs, ...hostile], text = all[random(all.length)], before = withoutNewlines(parse(text));
    const table = ["", "stock", "cutting", "tool", "operation", "placing"][random(6)];
    const count = table === "" ? 1 : Array.isArray(before[table]) ? before[table].length : 1, index = random(count);
    const key = ["top", "feed", "scallop", "name", "diameter", "strategy", "units"][random(7)], value = [1.5, "a \"b\" #c", [1, 2], undefined][random(4)];
    const changed = edit.setKey(text, { table, index, key }, value === undefined ? undefined : values.tomlOf(value));
    const after = withoutNewlines(parse(changed)), wanted = withoutNewlines(before);
    const owner = table === "" ? wanted : Array.isArray(wanted[table]) ? wanted[table][index] : wanted[table] ?? (value === undefined ? {} : (wanted[table] = {}));
    if (value === undefined) delete owner[key];
    else owner[key] = value;
    assert.deepEqual(after, wanted, `${JSON.stringify({ table, index, key, value })} in\n${text}\ngave\n${changed}`);
    for (const line of comments(text)) if (!text.includes("\"\"\"")) assert.ok(changed.includes(line), `the comment ${line} is lost in\n${changed}`);
    ++tried;
  }
  assert.equal(tried, 1500);
});

test("tables are added, taken away and change places", () => {
  const random = numbers(seed + 1);
  for (let round = 0; round < 800; ++round) {
    const all = [...jobs, ...hostile], text = all[random(all.length)], name = ["tool", "operation", "fixture"][random(3)];
    const listOf = (job) => { const found = withoutNewlines(parse(job))[name]; return Array.isArray(found) ? found : found === undefined ? [] : [found]; };
    const others = (job) => { const { [name]: _, ...rest } = withoutNewlines(parse(job)); return rest; };
    const list = listOf(text), added = edit.addTable(text, name, [["x", "1"]], true), what = `in\n${text}\ngave\n`;
    assert.deepEqual(listOf(added), [...list, { x: 1 }], what + added);
    assert.deepEqual(others(added), others(text), what + added);
    const k = random(list.length + 1), removed = edit.removeTable(added, name, k);
    assert.deepEqual(listOf(removed), listOf(added).filter((_, i) => i !== k), `${k} ${what}${removed}`);
    assert.deepEqual(others(removed), others(text), what + removed);
    if (list.length === 0) continue;
    const at = random(list.length), swapped = edit.swapWithNext(added, name, at), wanted = listOf(added);
    [wanted[at], wanted[at + 1]] = [wanted[at + 1], wanted[at]];
    assert.deepEqual(listOf(swapped), wanted, what + swapped);
    assert.deepEqual(others(swapped), others(text), what + swapped);
  }
});

test("a line of the text leads to its key", () => {
  const text = "# a\nunits = \"mm\"\n\n[stock]\ntop = 1\n\n# two\n[[operation]]\nstrategy = \"drill\"\n[[operation]]\nfloor = [\n  \"x\"]\n";
  const at = (line) => { const { table, index, key } = edit.placeOfLine(text, line); return [table, index, key]; };
  assert.deepEqual(at(2), ["", 0, "units"]);
  assert.deepEqual(at(5), ["stock", 0, "top"]);
  assert.deepEqual(at(9), ["operation", 0, "strategy"]);
  assert.deepEqual(at(12), ["operation", 1, "floor"]);
});

test("fields take what people type, and refuse what is no value", () => {
  assert.equal(values.typed("length", " .5 "), "0.5");
  assert.equal(values.typed("length", "3."), "3.0");
  assert.equal(values.typed("length", ""), undefined);
  assert.throws(() => values.typed("length", "3,5"), /"3,5" is not a number/);
  assert.throws(() => values.typed("[least, greatest]", "0, x"), /"x" is not a number/);
  assert.equal(values.typed("[least, greatest]", "[0, 10]"), "[0, 10]");
  assert.equal(values.typed("length or two", "4"), "4");
  assert.equal(values.typed("tool", "6mm flat"), "\"6mm flat\"");
  assert.equal(values.typed("list of tools", "1, x"), "[1, \"x\"]");
  assert.equal(values.typed("text or list of texts", "a.stl, b.stl"), "[\"a.stl\", \"b.stl\"]");
  assert.equal(values.typed("list of pairs", "[10, 20], [30, 5]"), "[[10, 20], [30, 5]]");
  for (const value of [1.5, "x", [1, 2], [[1, 2], [3, 4]], true]) {
    const kind = { number: "length", boolean: "true or false", string: "text" }[typeof value] ?? (Array.isArray(value[0]) ? "list of pairs" : "list of lengths");
    assert.deepEqual(withoutNewlines(parse(`v = ${values.typed(kind, values.shown(value))}`)).v, value);
  }
});

test("undo after any edits gives each project as it was, and redo the later ones", () => {
  const random = numbers(seed + 2);
  for (let round = 0; round < 60; ++round) {
    const history = new projects.History(), seen = [history.now.value];
    for (let k = 0; k < 1 + random(40); ++k) {
      const files = new Map(history.now.value.files);
      const job = history.now.value.job;
      if (random(3) === 0) files.set(`f${random(4)}`, new Uint8Array([k]));
      history.change(random(3) === 0 ? { files } : { job: edit.setKey(job, { table: "stock", index: 0, key: "top" }, String(k)) });
      if (history.now.value !== seen.at(-1)) seen.push(history.now.value);
    }
    for (let k = seen.length - 2; k >= 0; --k) { history.undo(); assert.equal(history.now.value, seen[k]); }
    assert.equal(history.canUndo.value, false);
    for (let k = 1; k < seen.length; ++k) { history.redo(); assert.equal(history.now.value, seen[k]); }
    assert.equal(history.canRedo.value, false);
    history.undo();
    history.change({ job: "# other" });
    assert.equal(history.canRedo.value, false);
  }
});

test("a zip is read back, and by another program", async () => {
  const files = new Map([["job.toml", Buffer.from("units = \"mm\"\n")], ["ä/tap.stl", Buffer.from([0, 255, 1, 2])], ["empty", Buffer.alloc(0)]].map(([n, b]) => [n, new Uint8Array(b)]));
  const bytes = new Uint8Array(await zip.zipOf(files).arrayBuffer()), file = path.join(folder, "project.zip");
  fs.writeFileSync(file, bytes);
  assert.deepEqual(await zip.filesOfZip(bytes), files);
  const script = "import sys,zipfile\nz=zipfile.ZipFile(sys.argv[1])\nassert z.testzip() is None\nprint('|'.join(z.namelist()), len(z.read('ä/tap.stl')))\nw=zipfile.ZipFile(sys.argv[2],'w',zipfile.ZIP_DEFLATED)\nw.writestr('big.txt','abc'*9999)\nw.close()";
  const other = path.join(folder, "other.zip"), said = spawnSync("python3", ["-c", script, file, other], { encoding: "utf8" });
  assert.equal(said.stdout.trim(), "job.toml|ä/tap.stl|empty 4", said.stderr);
  assert.equal((await zip.filesOfZip(new Uint8Array(fs.readFileSync(other)))).get("big.txt").length, 3 * 9999);
  await assert.rejects(zip.filesOfZip(new Uint8Array(10)), /no zip file/);
});

test("files are found as the job spells them", () => {
  const files = new Map([["tap.stl", new Uint8Array([1])], ["plate.dxf", new Uint8Array([2])]]);
  const found = projects.filesFor({ job: "[[operation]]\nfloor = [\"../parts/tap.stl\"]\nboundary = \"plate.dxf#outline\"\n", files });
  assert.deepEqual([...found.keys()].sort(), ["../parts/tap.stl", "plate.dxf", "tap.stl"]);
});
