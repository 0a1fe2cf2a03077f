// The step Machine in a real browser: a controller behind a fake navigator.serial, which is the virtual mill on a line with faults.
// node machine_test.mjs CUSP WEB TOP CORE.wasm
import assert from "node:assert/strict";
import fs from "node:fs";
import { createRequire } from "node:module";
import path from "node:path";
import test, { after, before } from "node:test";
import { axeSource, folder, run, startBrowser, top, web, write } from "../view/browser.mjs";
import { startStudio } from "./studio_program.mjs";

const [cusp] = process.argv.slice(2), core = fs.readFileSync(process.argv[5]).toString("base64");
const here = path.join(top, "tests", "studio"), require = createRequire(path.join(web, "package.json"));
let browser, studio, fake;
before(async () => {
  // The mill's class is the page's own.
  const source = fs.readFileSync(path.join(here, "fake_serial.mjs"), "utf8").replace("./faulty_port.mjs", path.join(here, "faulty_port.mjs"));
  const { outputFiles } = await require("esbuild").build({ stdin: { contents: source, resolveDir: web }, bundle: true, format: "iife", write: false, logLevel: "error" });
  fake = outputFiles[0].text;
  studio = await startStudio(cusp, "--linger", "600");
  browser = await startBrowser();
});
after(async () => {
  await browser.close();
  studio.stop();
});

// A page at the step Machine with this program. `port` evaluates with the fake port, which is in the page or in the worker.
async function open(program, options = {}, { inWorker = false, width = 1280, dark = false } = {}) {
  const context = await browser.newContext({ viewport: { width, height: 900 }, colorScheme: dark ? "dark" : "light", reducedMotion: "reduce" });
  context.setDefaultTimeout(60_000);
  const page = await context.newPage(), faults = [], workers = [];
  page.on("console", (m) => { if (m.type() === "error" || m.type() === "warning") faults.push("console " + m.text()); });
  page.on("pageerror", (error) => faults.push("error " + String(error)));
  const dialogs = [];
  page.on("dialog", (d) => { dialogs.push(d.type()); void d.accept(); });
  await page.addInitScript(fake);
  if (inWorker) {
    await page.addInitScript(() => { globalThis.fakeName(); });
    page.on("worker", (worker) => workers.push(worker.evaluate(fake).then(() => worker.evaluate(([c, o]) => globalThis.fakeSerial(c, o).then(() => self.name), [core, options]))
      .then((name) => name === "sender" ? worker : null, () => null)));
  }
  await page.goto(studio.address);
  await page.waitForFunction(() => window.cusp?.state);
  await page.evaluate(() => window.cusp.ready);
  if (!inWorker) await page.evaluate(([c, o]) => globalThis.fakeSerial(c, o), [core, options]);
  await page.locator("input[type=file]").setInputFiles(write(`machine/${faults.length}-${Date.now()}/part.ngc`, program));
  await page.getByRole("navigation").getByRole("link", { name: "Machine" }).click();
  await page.getByRole("button", { name: "Serial port" }).waitFor();
  await page.waitForTimeout(300);
  const where = async () => {
    for (;;) {
      const found = inWorker ? (await Promise.all(workers)).find((worker) => worker) : page;
      if (found) return found;
      await page.waitForTimeout(100);
    }
  };
  return { page, faults, dialogs, port: async (act, given) => (await where()).evaluate(act, given), close: () => context.close() };
}

const state = (page) => page.evaluate(() => window.cusp.state());
const machine = async (page) => (await state(page)).machine;
const until = (page, holds) => page.waitForFunction(holds).catch(async (reason) => {
  const { modal, settings, places, ...now } = await machine(page);
  throw new Error(`${JSON.stringify(now)} ${await page.locator(".studio-foot").innerText()}`, { cause: reason });
});
const click = (page, name) => page.getByRole("button", { name, exact: true }).click();

async function connect(page) {
  await page.getByRole("button", { name: "Serial port" }).click();
  await until(page, () => window.cusp.state().machine.ready);
}
// A program that lies in the project is not known to hold its bounds: two clicks. A fast one may have ended when it is next looked at.
async function runTwice(page) {
  const { machine: { run: before } } = await state(page);
  await click(page, "Run");
  await click(page, "Run all the same");
  await page.waitForFunction((last) => JSON.stringify(window.cusp.state().machine.run) !== last, JSON.stringify(before));
}
const runs = (page) => until(page, () => window.cusp.state().machine.run?.phase === "run");
const ended = (page) => until(page, () => window.cusp.state().machine.run?.phase !== "run");

// Moves by differences: a line that is lost or cut twice shifts the end.
function zigzag(count) {
  const out = ["G21 G91 G94", "G1 F3000"];
  for (let k = 0; k < count; ++k) out.push(`G1 X${k % 7 * 0.25 + 0.125} Y${k % 2 ? 0.5 : -0.25} (${k})`);
  return [...out, "M2", ""].join("\n");
}
function endOf(program) {
  const stats = path.join(folder, "end.json");
  run("sim", write("end.ngc", program), "--stats", stats);
  return JSON.parse(fs.readFileSync(stats, "utf8")).end_mpos_mm;
}
async function atEnd({ page, port }, program, zero) {
  const end = endOf(program), { machine: at } = await machine(page), iron = (await port(() => globalThis.fake.mill.figures().at)).map((v, k) => v - zero[k]);
  end.forEach((v, k) => {
    assert.ok(Math.abs(at[k] - v) < 0.0015, `the readout of axis ${k}: ${at[k]}, wanted ${v}`);
    assert.ok(Math.abs(iron[k] - v) < 0.004, `axis ${k} itself: ${iron[k]}, wanted ${v}`);
  });
}
const ironPlace = (port) => port(() => globalThis.fake.mill.figures().at);

test("a noisy serial port: nothing goes out before a click, each line is executed once, and the readout is the tool's place", async () => {
  const program = zigzag(150), open1 = await open(program, { seed: 3, faults: { loss: 0.003, doubling: 0.001 } }), { page, port, faults, close } = open1;
  assert.equal(await port(() => globalThis.fake.opened + globalThis.fake.sent.length), 0, "nothing is opened before a click");
  const zero = await ironPlace(port);
  await connect(page);
  await page.waitForTimeout(500);
  assert.deepEqual(await ironPlace(port), zero, "connecting moves nothing");
  assert.match(await page.locator(".dro").innerText(), /numbered and checked/);
  await runTwice(page);
  await ended(page);
  const { run: at, resent } = await machine(page);
  assert.deepEqual([at.phase, at.error, at.text], ["done", 0, ""]);
  assert.ok(resent > 0, "bytes were lost, so lines were sent again");
  await atEnd(open1, program, zero);
  assert.deepEqual(faults, []);
  await close();
});

test("a port in the worker: unplugged amid a cut it holds, and goes on after the plug; Esc stops", async () => {
  const program = zigzag(80), open1 = await open(program, { seed: 5, settings: "$791=400\n" }, { inWorker: true }), { page, port, faults, close } = open1;
  const zero = await ironPlace(port);
  await connect(page);
  await runTwice(page);
  await until(page, () => window.cusp.state().machine.run.line > 40);
  await port(() => globalThis.fake.unplug());
  await until(page, () => window.cusp.state().machine.link === "lost");
  assert.match(await page.locator(".dro").innerText(), /The link is lost: /);
  await page.waitForTimeout(1500);
  const held = await ironPlace(port);
  await page.waitForTimeout(400);
  assert.deepEqual(await ironPlace(port), held, "the machine holds in the silence");
  await port(() => globalThis.fake.plug());
  await page.getByRole("button", { name: "Serial port" }).click();
  await page.getByRole("button", { name: "Go on" }).waitFor();
  await page.waitForTimeout(400);
  assert.deepEqual(await ironPlace(port), held, "it waits for the click");
  await click(page, "Go on");
  await runs(page);
  await ended(page);
  assert.equal((await machine(page)).run.phase, "done");
  await atEnd(open1, program, zero);
  await runTwice(page);
  await until(page, () => window.cusp.state().machine.run.line > 10);
  await page.keyboard.press("Escape");
  await until(page, () => window.cusp.state().machine.run.phase === "stopped" && window.cusp.state().machine.ready);
  await until(page, () => window.cusp.state().machine.state === "Idle"); // by the first report after the reset
  assert.equal((await machine(page)).alarm, 0);
  assert.deepEqual(faults, []);
  await close();
});

test("plain Grbl that was reset by the plug: the way back is shown, and the program resumes", async () => {
  const program = ["G21 G90 G94 F1500", "G0 Z5", ...Array.from({ length: 60 }, (_, k) => `G1 X${k % 2 ? 0 : 6} Y${k * 0.25} Z-1`), "G0 Z5", "M2", ""].join("\n");
  const open1 = await open(program, { grbl: true }), { page, port, faults, close } = open1, zero = await ironPlace(port);
  await connect(page);
  assert.match(await page.locator(".dro").innerText(), /plain Grbl/);
  await runTwice(page);
  await until(page, () => window.cusp.state().machine.run.executed > 8);
  // Its motion ends before the power of the plug is back.
  await port(() => { globalThis.fake.unplug(); globalThis.fake.mill.send(new Uint8Array([0x21])); });
  await page.waitForTimeout(1500);
  await port(() => { globalThis.fake.mill.send(new Uint8Array([0x18])); globalThis.fake.plug(); });
  await page.getByRole("button", { name: "Serial port" }).click();
  const way = page.getByRole("button", { name: /Show the way to line/ });
  await way.waitFor();
  await until(page, () => window.cusp.state().machine.ready);
  await way.click();
  await page.getByRole("button", { name: /Go on at line/ }).waitFor();
  assert.match(await page.locator(".machine .card").innerText(), /goes up to Z 5\.000 and over X/);
  const stood = await ironPlace(port);
  await page.waitForTimeout(400);
  assert.deepEqual(await ironPlace(port), stood, "it waits for the click");
  await page.getByRole("button", { name: /Go on at line/ }).click();
  await runs(page);
  await ended(page);
  assert.equal((await machine(page)).run.phase, "done");
  await atEnd(open1, program, zero);
  assert.deepEqual(faults, []);
  await close();
});

test("waits, alarms and errors are said in words, and texts of programs stay texts", async () => {
  const program = "G21 G91\nG1 X1 F2000\nM0 (<img src=x onerror=alert`1`> turn the part)\nG1 X1\nT3 M6\nG1 X1 E7\nG1 X1\n";
  const { page, faults, dialogs, close } = await open(program, {});
  await connect(page);
  await runTwice(page);
  await until(page, () => document.querySelector(".wait"));
  assert.match(await page.locator(".wait").innerText(), /waits for you at line 3: M0 \(<img src=x onerror=alert`1`> turn the part\)\. Do what it asks for, then Resume/);
  assert.equal(await page.locator(".machine img").count(), 0);
  await click(page, "Resume");
  await until(page, () => window.cusp.state().machine.pause?.kind === "tool");
  assert.match(await page.locator(".wait").innerText(), /Change to tool T3, at line 5/);
  await click(page, "Resume");
  await ended(page);
  assert.match(await page.locator(".dro").innerText(), /Line 6: error 20: a G or M word is not supported/);
  await until(page, () => window.cusp.state().machine.ready);
  assert.deepEqual([faults, dialogs], [[], []]);
  await close();
});

test("the virtual mill at 300 times the speed cuts the edges of cusp sim", async () => {
  const file = path.join(top, "tests", "programs", "liss.ngc"), stats = path.join(folder, "liss.json"), { page, faults, close } = await open(fs.readFileSync(file, "utf8"));
  run("sim", file, "--stats", stats);
  await page.getByLabel("Time").selectOption("300");
  await runTwice(page);
  await ended(page);
  await page.waitForTimeout(300);
  const { machine: at, mill } = await state(page);
  assert.deepEqual([at.run.phase, mill.edges], ["done", JSON.parse(fs.readFileSync(stats, "utf8")).edges_crc32]);
  assert.deepEqual(faults, []);
  await close();
});

const panel = (page, name) => page.getByRole("group", { name: "Panel" }).getByRole("button", { name }).click();
const rests = (page) => until(page, () => window.cusp.state().machine.ready && window.cusp.state().machine.state === "Idle");
// Places of the tool before and some time after.
async function moved(port, page, ms = 600) {
  const before = await ironPlace(port);
  await page.waitForTimeout(ms);
  return Math.hypot(...(await ironPlace(port)).map((v, k) => v - before[k]));
}

test("jogs: by steps, while a button or key is held, by a gamepad; they end at release, blur and Esc", async () => {
  const { page, port, faults, close } = await open("M2\n", {}), zero = await ironPlace(port);
  await connect(page);
  await panel(page, "Jog");
  await page.getByRole("button", { name: "Jog X plus", exact: true }).click();
  await page.waitForTimeout(900);
  assert.ok(Math.abs((await ironPlace(port))[0] - zero[0] - 1) < 0.003, "a step of 1 mm");
  await page.keyboard.press("ArrowUp");
  assert.ok(await moved(port, page) < 1e-9, "keys do nothing before they are clicked on");
  await page.getByRole("button", { name: "while held" }).click();
  const box = await page.getByRole("button", { name: "Jog Y minus", exact: true }).boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.waitForTimeout(400);
  assert.ok(await moved(port, page, 500) > 3, "it moves while the button is held");
  await page.mouse.up();
  await page.waitForTimeout(500);
  assert.ok(await moved(port, page) < 1e-9, "it stands after the release");
  for (const end of ["up", "blur", "Escape"]) {
    await page.getByLabel(/Arrow keys/).check();
    await rests(page);
    await page.keyboard.down("ArrowRight");
    await page.waitForTimeout(400);
    assert.ok(await moved(port, page, 400) > 2, `${end}: it moves while the key is held`);
    if (end === "blur") await page.evaluate(() => { window.dispatchEvent(new Event("blur")); });
    if (end === "Escape") await page.keyboard.press("Escape");
    if (end === "up") await page.keyboard.up("ArrowRight");
    await page.waitForTimeout(700);
    assert.ok(await moved(port, page) < 1e-9, `it stands after ${end}`);
    await page.keyboard.up("ArrowRight");
    await rests(page);
    if (end === "blur") assert.equal(await page.getByLabel(/Arrow keys/).isChecked(), false);
  }
  await page.evaluate(() => {
    globalThis.pad = { connected: true, axes: [0, 0, 0, 0], buttons: [{ pressed: false }] };
    Object.defineProperty(navigator, "getGamepads", { configurable: true, value: () => [globalThis.pad] });
    globalThis.pad.axes[0] = -0.9;
  });
  assert.ok(await moved(port, page) < 1e-9, "a gamepad does nothing before it is clicked on");
  await page.getByLabel(/A gamepad jogs/).check();
  await page.waitForTimeout(500);
  assert.ok(await moved(port, page, 500) > 2, "the stick moves it");
  await page.evaluate(() => { globalThis.pad.axes[0] = 0.1; });
  await page.waitForTimeout(600);
  assert.ok(await moved(port, page) < 1e-9, "it stands with the stick in its middle");
  assert.deepEqual(faults, []);
  await close();
});

test("zero, probe and tool length, on a line that loses bytes; no contact is an alarm in words", async () => {
  const { page, port, faults, close } = await open("M2\n", { seed: 9, faults: { loss: 0.002 } }), zero = await ironPlace(port);
  await connect(page);
  await panel(page, "Zero");
  for (const [label, value] of [["Fast, mm/min", "1500"], ["Slow, mm/min", "200"], ["At most, mm", "30"], ["Plate, mm thick", "12.5"]]) {
    await page.getByLabel(label).fill(value);
    await page.getByLabel(label).press("Tab");
  }
  assert.ok(await moved(port, page, 300) < 1e-9, "nothing moves before the click");
  await click(page, "Probe Z");
  await until(page, () => Math.abs(window.cusp.state().machine.work[2] - 17.5) < 0.02 && window.cusp.state().machine.state === "Idle");
  assert.ok(Math.abs((await ironPlace(port))[2] - zero[2] + 15) < 0.02, "5 mm over the plate, 20 mm under the start");
  await click(page, "X Y zero here");
  await until(page, () => window.cusp.state().machine.work.slice(0, 2).every((v) => v === 0));
  await click(page, "Measure first tool");
  await until(page, () => /first tool is measured/.test(document.querySelector(".said")?.textContent ?? ""));
  await until(page, () => ![...document.querySelectorAll("button")].find((b) => b.textContent === "Probe Z").disabled);
  // A tool 3 mm shorter touches the plate 3 mm deeper.
  await port(() => { globalThis.fake.mill.plate(-23); });
  await until(page, () => ![...document.querySelectorAll("button")].find((b) => b.textContent === "Measure this tool").disabled);
  await click(page, "Measure this tool");
  await until(page, () => /(2\.9|3\.0)\d+ mm shorter than the first/.test(document.querySelector(".said")?.textContent ?? "") && Math.abs(window.cusp.state().machine.toolLength + 3) < 0.02);
  await rests(page);
  await page.getByLabel("At most, mm").fill("2");
  await page.getByLabel("At most, mm").press("Tab");
  await until(page, () => ![...document.querySelectorAll("button")].find((b) => /Probe side/.test(b.textContent)).disabled);
  // The controller names an alarm once: where that line is lost, the page only knows that there is one.
  await port(() => { globalThis.fake.from.loss = 0; });
  await page.getByRole("button", { name: "Probe side in X+" }).click();
  await until(page, () => window.cusp.state().machine.state === "Alarm");
  assert.match(await page.locator(".dro").innerText(), /Alarm 5: the probe did not touch\. Bring the tool nearer/);
  await click(page, "Unlock");
  await rests(page);
  assert.deepEqual(faults, []);
  await close();
});

test("overrides act; macros and lines are sent, kept, and shown as text", async () => {
  const { page, faults, dialogs, close } = await open("M2\n", {});
  await connect(page);
  await panel(page, "Rates");
  await page.getByRole("group", { name: "Feed" }).getByRole("button", { name: "+10" }).click();
  await until(page, () => window.cusp.state().machine.overrides[0] === 110);
  await page.getByRole("group", { name: "Rapids" }).getByRole("button", { name: "25 %" }).click();
  await until(page, () => window.cusp.state().machine.overrides[1] === 25);
  await panel(page, "Macros");
  await click(page, "New macro");
  await page.getByLabel("Name").fill("<img src=x onerror=alert(1)>");
  await page.getByLabel("Lines", { exact: true }).fill("G10 L20 P0 X3 (here)\n; and there\nG10 L20 P0 Y4");
  await click(page, "Done");
  await page.getByRole("button", { name: "<img src=x onerror=alert(1)>", exact: true }).click();
  await until(page, () => window.cusp.state().machine.work[0] === 3 && window.cusp.state().machine.work[1] === 4);
  await page.getByLabel("A line").fill("$I");
  await page.getByLabel("A line").press("Enter");
  await until(page, () => /VER:1\.1h.*ok/s.test(document.querySelector(".log").textContent));
  await page.getByLabel("A line").fill("G1 X1 E<b>");
  await page.getByLabel("A line").press("Enter");
  await until(page, () => /error \d+: /.test(document.querySelector(".log").textContent));
  assert.equal(await page.locator(".machine img, .machine b").count(), 0);
  await page.reload();
  await page.waitForFunction(() => window.cusp?.state);
  await panel(page, "Macros");
  assert.equal(await page.getByRole("button", { name: "<img src=x onerror=alert(1)>", exact: true }).count(), 1, "macros are kept");
  assert.deepEqual([faults, dialogs], [[], []]);
  await close();
});

test("all panels: contrast, names, 44 px, nothing sticks out", async () => {
  for (const [width, dark] of [[1280, false], [390, true]]) {
    const { page, faults, close } = await open("M2\n", {}, { width, dark });
    await connect(page);
    await page.evaluate(axeSource);
    for (const name of ["Cut", "Jog", "Zero", "Rates", "Macros"]) {
      await panel(page, name);
      if (name === "Macros") await click(page, "New macro");
      await page.waitForTimeout(50);
      const { violations } = await page.evaluate(() => window.axe.run(document, { resultTypes: ["violations"] }));
      assert.deepEqual(violations.map((v) => `${v.id}: ${v.nodes.slice(0, 3).map((n) => n.html.slice(0, 120)).join(" | ")}`), [], `${name}, ${width} px`);
      assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), `${name}: nothing sticks out at ${width} px`);
      const small = await page.locator(".machine button, .machine select, .machine input:not([type=checkbox]), .machine .check-line, .machine summary")
        .evaluateAll((all) => all.filter((e) => e.getBoundingClientRect().height < 44).map((e) => e.outerHTML.slice(0, 100)));
      assert.deepEqual(small, [], `targets of ${name}`);
      await page.evaluate(() => { window.scrollTo(0, 0); });
      const stop = await page.getByRole("button", { name: "Stop", exact: true }).boundingBox();
      assert.ok(stop.y > 0 && stop.y + stop.height <= 900, `${name}: Stop is in sight at ${width} px`);
    }
    assert.deepEqual(faults, []);
    await close();
  }
});

test("a page that is busy, hidden or closed loses no cut: the worker sends on, the screen stays on, and the next page knows the line", async () => {
  // It waits near its end, so that a slow browser still meets it amid the cut.
  const program = zigzag(90).replace("(75)\n", "(75)\nM0\n"), open1 = await open(program, { seed: 11 }, { inWorker: true });
  const { page, port, faults, dialogs, close } = open1, zero = await ironPlace(port);
  await page.evaluate(() => {
    globalThis.locks = [];
    const request = () => {
      const lock = { released: false, release: () => { lock.released = true; return Promise.resolve(); } };
      globalThis.locks.push(lock);
      return Promise.resolve(lock);
    };
    Object.defineProperty(navigator, "wakeLock", { configurable: true, value: { request } });
  });
  const locks = () => page.evaluate(() => globalThis.locks.map(({ released }) => released));
  await connect(page);
  assert.deepEqual(await locks(), []);
  await runTwice(page);
  await until(page, () => window.cusp.state().machine.run.executed > 5);
  assert.ok((await port(() => globalThis.fake.sent)).includes("$791=3000*"), "the controller is told to hold in silence");
  assert.deepEqual(await locks(), [false]);
  // The browser takes the lock from a hidden page; it is asked for again when the page is seen.
  await page.evaluate(() => {
    globalThis.locks[0].released = true;
    document.dispatchEvent(new Event("visibilitychange"));
  });
  await page.waitForFunction(() => globalThis.locks.length === 2);
  const sent = () => port(() => globalThis.fake.sent.length), before = await ironPlace(port), already = await sent();
  const blocked = page.evaluate(() => { for (const end = performance.now() + 2500; performance.now() < end;); });
  await page.waitForTimeout(2000);
  assert.notDeepEqual(await ironPlace(port), before, "it cuts while the page hangs");
  assert.ok(await sent() >= already + 6, "the worker sends on, reports at the least");
  await blocked;
  await until(page, () => window.cusp.state().machine.pause?.kind === "stop");
  await click(page, "Resume");
  await ended(page);
  assert.deepEqual([(await machine(page)).run.phase, (await locks()).at(-1)], ["done", true]);
  await atEnd(open1, program, zero);
  assert.equal(await page.evaluate(() => localStorage.getItem("cusp-studio-cut")), null, "a program that has ended leaves nothing");
  await page.waitForTimeout(500);
  await runTwice(page);
  await until(page, () => window.cusp.state().machine.run.executed > 8);
  await page.waitForTimeout(1500);
  assert.deepEqual(dialogs, []);
  await page.reload();
  assert.deepEqual(dialogs, ["beforeunload"], "closing asks");
  await page.waitForFunction(() => window.cusp?.state);
  await page.evaluate(() => window.cusp.ready);
  await page.locator(".machine .card").waitFor();
  const line = Number(/amid part\.ngc: the tool had reached line (\d+)/.exec(await page.locator(".machine .card").innerText())[1]);
  assert.ok(line > 5 && line < 93, `line ${line}`);
  await page.evaluate(() => { localStorage.setItem("cusp-studio-cut", JSON.stringify({ name: "<b>", crc: 1, line: "x", start: [3] })); });
  await page.reload();
  await page.waitForFunction(() => window.cusp?.state);
  await page.evaluate(() => window.cusp.ready);
  assert.equal(await page.locator(".machine .card").count(), 0);
  assert.deepEqual([faults, dialogs], [[], ["beforeunload"]]);
  await close();
});

test("the script keeps its budget", async () => {
  const page = fs.readFileSync(path.join(top, "host_tools", "judge", "view", "bundle", "studio.html"), "utf8");
  const packed = Buffer.from(/id="packed-script">([^<]*)/.exec(page)[1], "base64").length;
  assert.ok(packed > 100_000 && packed <= 250_000, `${packed} bytes`);
});
