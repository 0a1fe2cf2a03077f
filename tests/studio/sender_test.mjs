// The page's sender without a browser, on the virtual mill behind a line that loses, repeats and changes bytes.
// node sender_test.mjs WEB TOP CORE.wasm
import assert from "node:assert/strict";
import fs from "node:fs";
import { createRequire } from "node:module";
import os from "node:os";
import path from "node:path";
import test, { after } from "node:test";
import { pathToFileURL } from "node:url";
import { FaultyPort, numbers } from "./faulty_port.mjs";

const [web, , core] = process.argv.slice(2), require = createRequire(path.join(web, "package.json"));
const folder = fs.mkdtempSync(path.join(os.tmpdir(), "cusp-sender-"));
after(() => fs.rmSync(folder, { recursive: true, force: true }));
const bundle = path.join(folder, "sender.mjs");
await require("esbuild").build({
  stdin: { contents: ["sender/session", "sender/status_report", "sender/crc32", "sender/line_window", "sender/controller_facts", "port/mill_core"].map((name) => `export * from "./src/${name}";`).join("\n"),
    resolveDir: web }, bundle: true, format: "esm", outfile: bundle, logLevel: "error",
});
const { Session, MillCore, statusReport, ReportFilter, ControllerFacts, crc32 } = await import(pathToFileURL(bundle));
const module = await WebAssembly.compile(fs.readFileSync(core));
const seed = Number(process.env.SEED ?? 20261129);
console.log(`SEED=${seed}`);

// Lines of a program as the planners' call `send` gives them.
const linesOf = (text) => text.trim().split("\n").map((line, k) => ({ line: k + 1, text: line.replaceAll(" ", "") }));
// To and fro, with as many lines; it ends where it begins, so that each line that is lost or cut twice shows.
function zigzag(count) {
  const out = ["G21G91G94", "G1F3000"];
  for (let k = 0; k < count; ++k) out.push(`G1X${(k % 7) * 0.25 + 0.125}Y${k % 2 ? 0.5 : -0.25}`);
  return linesOf([...out, "M2"].join("\n"));
}
const endOf = (lines) => lines.reduce(([x, y], { text }) => [x + Number(/X([-\d.]+)/.exec(text)?.[1] ?? 0), y + Number(/Y([-\d.]+)/.exec(text)?.[1] ?? 0)], [0, 0]);

async function connected({ faults = {}, random = numbers(seed), grbl = false, settings = "" } = {}) {
  const mill = new MillCore(module, settings, -20), port = new FaultyPort(grbl ? stockGrbl(mill) : mill, random, faults), session = new Session(() => undefined);
  await session.open(port, "test");
  await port.until(() => session.snapshot().ready, 60_000);
  return { mill, port, session };
}

// A controller that knows no checked lines and has a buffer of 128 bytes.
function stockGrbl(mill) {
  const text = (bytes) => String.fromCharCode(...bytes), bytes = (all) => Uint8Array.from(all, (c) => c.charCodeAt(0));
  const answers = (given) => bytes(text(given).replace(/\[OPT:.*\]/, "[OPT:V,15,128]"));
  return {
    send: (given) => answers(mill.send(bytes(text(given).replace("$CRC=1", "$XYZ=1")))), tick: () => answers(mill.tick()),
    mark: () => mill.mark(), figures: () => mill.figures(),
  };
}

const near = (a, b, most, what) => assert.ok(Math.abs(a - b) <= most, `${what}: ${a}, wanted ${b}`);
function atEnd(mill, start, lines) {
  const end = endOf(lines), { at } = mill.figures();
  near(at[0] - start[0], end[0], 0.002, "X");
  near(at[1] - start[1], end[1], 0.002, "Y");
}

test("a program runs to its end; a clean line has nothing sent twice", async () => {
  const { mill, port, session } = await connected(), lines = zigzag(400), start = mill.figures().at;
  assert.equal(session.snapshot().checked, true);
  session.begin(lines);
  await port.until(() => session.snapshot().run.phase !== "run");
  const { run, resent, refused } = session.snapshot();
  assert.deepEqual([run.phase, run.answered, resent, refused], ["done", lines.length, 0, 0]);
  atEnd(mill, start, lines);
});

test("each line is executed once on a line that loses, repeats and changes bytes, and no false place is shown", async () => {
  for (let round = 0; round < 12; ++round) {
    const random = numbers(seed + round), p = [0.002, 0.01][round % 2];
    const { mill, port, session } = await connected({ faults: { loss: p, doubling: p / 4, noise: p / 4 }, random });
    const lines = zigzag(300), start = mill.figures().at;
    session.begin(lines);
    const places = new Set(), shown = new Set();
    let tail = "";
    port.says = (bytes) => {
      tail = (tail + String.fromCharCode(...bytes)).slice(-4000);
      for (const [, place] of tail.matchAll(/MPos:([-.\d,]+)\|/g)) places.add(place);
    };
    while (session.snapshot().run.phase === "run") {
      await port.run(20);
      shown.add(session.snapshot().machine.map((v) => v.toFixed(3)).join(","));
      assert.ok(port.ticks < 600_000, "it ends");
    }
    const told = new Set([...places].map((place) => place.split(",").map((v) => Number(v).toFixed(3)).join(",")));
    for (const place of [...shown].slice(1)) assert.ok(told.has(place), `round ${round}: the controller never was at ${place}, which is shown`);
    const { run } = session.snapshot();
    assert.deepEqual([run.phase, run.answered], ["done", lines.length], `round ${round}: ${run.text} ${run.error}`);
    await port.run(200);
    atEnd(mill, start, lines);
    assert.ok(shown.size > 10 && port.to.faults > 5, `${port.to.faults} bytes lost, ${shown.size} places shown`);
  }
});

test("unplugged and plugged in again, the program goes on and each line is executed once", async () => {
  for (let round = 0; round < 10; ++round) {
    const random = numbers(seed + 100 + round), faults = round % 2 ? { loss: 0.003 } : {};
    const { mill, port, session } = await connected({ random, faults, settings: round % 3 ? "$791=500\n" : "" });
    const lines = zigzag(300), start = mill.figures().at;
    session.begin(lines);
    await port.run(1500 + Math.floor(4000 * random()));
    port.lose();
    assert.equal(session.snapshot().run.phase, "lost");
    assert.equal(session.snapshot().link, "lost");
    await port.run(round % 3 ? 4000 : 300);
    const again = new FaultyPort(mill, random, faults);
    await session.open(again, "again");
    await again.until(() => session.snapshot().run.canContinue, 5000);
    assert.equal(session.snapshot().run.phase, "lost", "nothing moves before the click");
    if (round % 3) {
      assert.equal(session.snapshot().state, "Hold");
      const { at } = mill.figures();
      await again.run(3000);
      assert.deepEqual(mill.figures().at, at);
    }
    session.goOn();
    await again.until(() => session.snapshot().run.phase !== "run");
    const { run } = session.snapshot();
    assert.deepEqual([run.phase, run.answered], ["done", lines.length], `${run.text} ${run.error}`);
    atEnd(mill, start, lines);
  }
});

test("a controller that was reset while unplugged is not taken for the one before", async () => {
  const { mill, port, session } = await connected(), lines = zigzag(300);
  session.begin(lines);
  await port.run(2000);
  port.lose();
  mill.send(Uint8Array.from([0x18, 0x18, 0x18]));
  await port.run(1000);
  const again = new FaultyPort(mill, numbers(1), {});
  await session.open(again, "again");
  await again.until(() => session.snapshot().state !== "", 5000);
  await again.run(3000);
  assert.equal(session.snapshot().run.canContinue, false);
  assert.throws(() => { session.goOn(); }, /was reset/);
});

test("plain Grbl: characters are counted, at most 128 wait, and every answer is due", async () => {
  const { mill, port, session } = await connected({ grbl: true }), lines = zigzag(300), start = mill.figures().at;
  assert.equal(session.snapshot().checked, false);
  let outstanding = 0, most = 0;
  const waiting = [], write = port.write.bind(port), deliver = port.deliver.bind(port);
  port.write = (bytes) => {
    const text = String.fromCharCode(...bytes).replace("?", "");
    if (text.endsWith("\n")) { waiting.push(text.length); outstanding += text.length; most = Math.max(most, outstanding); }
    write(bytes);
  };
  port.deliver = (bytes) => {
    for (const _ of String.fromCharCode(...bytes).matchAll(/^ok\r?$/gm)) outstanding -= waiting.shift();
    deliver(bytes);
  };
  session.begin(lines);
  await port.until(() => session.snapshot().run.phase !== "run");
  assert.equal(session.snapshot().run.phase, "done");
  assert.ok(most > 90 && most <= 128, `${most} bytes`);
  atEnd(mill, start, lines);
});

test("stop holds and then resets: the place is kept; twice resets at once", async () => {
  const { mill, port, session } = await connected();
  session.begin(linesOf("G21G91\nG1X100F3000\nG1X-100\nM2"));
  await port.run(800);
  session.stop();
  await port.until(() => session.snapshot().ready && session.snapshot().state === "Idle", 8000);
  assert.equal(session.snapshot().run.phase, "stopped");
  assert.equal(session.snapshot().alarm, 0, "a soft stop is no alarm");
  const { at } = mill.figures();
  await port.run(1000);
  assert.deepEqual(mill.figures().at, at);
  session.begin(linesOf("G21G91\nG1X100F3000\nG1X-100\nM2"));
  await port.run(800);
  session.stop();
  session.stop();
  await port.run(400);
  assert.equal(session.snapshot().state, "Alarm");
  assert.equal(session.snapshot().alarm, 3);
});

test("a jog ends when its button is released, and by itself when the page falls silent", async () => {
  for (const released of [true, false]) {
    const { mill, port, session } = await connected({ faults: { loss: 0.002 } }), start = mill.figures().at;
    session.jogBegin([1, 0, 0], 3000);
    for (let k = 0; k < 20; ++k) {
      session.jogKeep();
      await port.run(50);
    }
    const moved = mill.figures().at[0] - start[0];
    assert.ok(moved > 30 && moved < 55, `${moved} mm in a second at 50 mm/s`);
    if (released) session.jogEnd();
    const before = mill.figures().at[0];
    await port.run(1500);
    assert.ok(mill.figures().at[0] - before < (released ? 8 : 32), `${mill.figures().at[0] - before} mm after it`);
    assert.equal(session.snapshot().state, "Idle");
    await port.run(3000);
    session.jogStep([0, -1, 0], 0.1, 500);
    const y = mill.figures().at[1];
    await port.run(1500);
    near(mill.figures().at[1] - y, -0.1, 0.002, "a step");
  }
});

test("M0 and tool changes say what they wait for; errors name their line", async () => {
  const { port, session } = await connected();
  session.begin(linesOf("G21G91\nG1X1F1000\nM0\nG1X1\nT3M6\nG1X1\nM2"));
  await port.until(() => session.snapshot().pause !== null, 20_000);
  assert.deepEqual(session.snapshot().pause, { kind: "stop", line: 3, text: "M0" });
  session.resume();
  await port.run(500);
  await port.until(() => session.snapshot().pause !== null, 20_000);
  assert.deepEqual(session.snapshot().pause, { kind: "tool", line: 5, text: "T3M6" });
  session.resume();
  await port.until(() => session.snapshot().run.phase !== "run", 20_000);
  assert.equal(session.snapshot().run.phase, "done");
  session.begin(linesOf("G21G91\nG1X1F1000\nG1X1E7\nG1X5"));
  await port.until(() => session.snapshot().run.phase !== "run", 20_000);
  const { run } = session.snapshot();
  assert.deepEqual([run.phase, run.error, run.line], ["fault", 20, 3]);
});

test("a listing of settings and offsets is whole on a line that loses bytes", async () => {
  const clean = await connected(), noisy = await connected({ faults: { loss: 0.004 } });
  for (const { port, session } of [clean, noisy]) {
    await port.until(() => session.snapshot().ready, 5000);
    // A move is under way when the listing is asked for, in which the controller refuses it.
    const done = (async () => {
      for (const line of ["G10L2P1X1.5Y2.25Z-3", "G43.1Z-1.25", "G21G91G0X5"]) assert.equal((await session.command(line)).error, 0);
      await session.refresh();
    })();
    let over = false;
    void done.then(() => { over = true; });
    await port.until(() => over, 60_000);
  }
  assert.deepEqual(noisy.session.snapshot().settings, clean.session.snapshot().settings);
  assert.equal(noisy.session.snapshot().toolLength, -1.25);
  assert.deepEqual(noisy.session.snapshot().places.G54, [1.5, 2.25, -3]);
  assert.deepEqual(noisy.session.snapshot().places, clean.session.snapshot().places);
});

test("a report that lost a byte is refused by its form or does not follow the one before", () => {
  const whole = "<Run|MPos:-120.250,-80.125,-32.000|Bf:35,1024|Ln:99|FS:1500,12000|WCO:-50.000,-40.000,-10.000>";
  assert.ok(statusReport(whole));
  let accepted = 0;
  for (let at = 0; at < whole.length; ++at) {
    for (let size = 1; size <= 12 && at + size <= whole.length; ++size) {
      const damaged = statusReport(whole.slice(0, at) + whole.slice(at + size)), filter = new ReportFilter();
      assert.ok(!filter.accept(statusReport(whole), 0));
      assert.ok(filter.accept(statusReport(whole), 200));
      if (!damaged || !filter.accept(damaged, 400)) continue;
      accepted += 1;
      const wrong = Math.hypot(...damaged.machine.map((v, k) => v - [-120.25, -80.125, -32][k]));
      assert.ok(wrong <= 8.9, `${whole.slice(0, at)}…${whole.slice(at + size)} shows a place ${wrong} mm off`);
    }
  }
  assert.ok(accepted > 10, "what lacks a whole field is a report still");
  assert.equal(crc32("ok N1"), "360E43D2");
});

test("checks stay on through long moves and holds, and an overnight hold fills no buffer", async () => {
  const { port, session } = await connected();
  session.begin(linesOf("G21G91\nG1X20F240\nG1X-20\nM0\nG1X1\nM2"));
  await port.until(() => session.snapshot().pause !== null, 60_000);
  const { length } = port.sent;
  await port.run(900_000);
  assert.equal(port.sent.slice(length).replaceAll("?", ""), "", "a quarter of an hour is asked for reports alone");
  session.resume();
  await port.until(() => session.snapshot().run.phase !== "run", 60_000);
  await port.run(10_000);
  const { run, checked, refused, messages } = session.snapshot();
  assert.deepEqual([run.phase, checked, refused, messages], ["done", true, 0, ["Pgm End"]]);
});

test("a damaged line of a listing is no place, no length and no setting", () => {
  const whole = ["[G54:1.500,2.250,-3.000]", "[PRB:-1.000,0.500,-7.125:1]", "[TLO:-1.250]", "$110=500.000", "$10=1"], facts = new ControllerFacts();
  facts.take(whole);
  assert.deepEqual([facts.places.get("G54"), facts.probe, facts.toolLength, facts.setting(110), facts.setting(10)],
    [[1.5, 2.25, -3], { at: [-1, 0.5, -7.125], touched: true }, -1.25, 500, 1]);
  facts.take(["[TLO:0.000,0.000,-2.500]"]);
  assert.equal(facts.toolLength, -2.5);
  const damaged = new ControllerFacts();
  damaged.take(["[G54:1.500,,-3.000]", "[G55:1.500,2.250]", "[G56:1.500,0x10,-3.000]", "[G57:1.500,2.25,-3.000]", "[G58:1e9,2.250,-3.000]", "[PRB:-1.000,0.5.00,-7.125:1]", "[TLO:-1.2]", "$110=500.0.0", "$111=--5", "$112=5x"]);
  assert.deepEqual([damaged.places.size, damaged.probe, damaged.toolLength, damaged.settings.size], [0, null, 0, 0]);
  const random = numbers(seed);
  for (let round = 0; round < 20_000; ++round) {
    const line = [...whole[Math.floor(whole.length * random())]], any = new ControllerFacts();
    for (let k = 0; k < 3; ++k) line.splice(Math.floor(line.length * random()), Math.floor(3 * random()), ...(random() < 0.5 ? [String.fromCharCode(Math.floor(256 * random()))] : []));
    any.take([line.join("")]);
    const all = [...any.settings.values(), ...[...any.places.values()].flat(), ...(any.probe?.at ?? []), any.toolLength];
    assert.ok(all.every(Number.isFinite), line.join(""));
  }
});
