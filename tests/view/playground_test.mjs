// The playground in a real browser: the core's runs are those of cusp sim, editing, opening, stopping, large programs, traps.
import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import test, { after, before } from "node:test";
import { axeSource, figures, folder, openPage, pageOf, run, startBrowser, top, write } from "./browser.mjs";

let browser, playground;
before(async () => {
  playground = path.join(folder, "playground.html");
  assert.equal(run("view", "--playground", "-o", playground).status, 0);
  browser = await startBrowser();
});
after(async () => { await browser.close(); });

const runOf = (page, text, settings = "") => page.evaluate(([t, s]) => window.cusp.run(t, s), [text, settings]);
const edited = async (page, text) => {
  await page.locator(".program textarea").fill(text);
  await page.getByRole("button", { name: "Run" }).click();
};
// Days of the mill in a short text; opened, since fill() makes Chromium insert line by line, in a time that is quadratic
// in their number on any page.
const long = "G21 G90 F60\n" + "G1 X200\nX0\n".repeat(1000);

test("runs in both pages are those of cusp sim", async () => {
  const files = [...["rsq", "spiral"].map((name) => path.join(top, "tests/programs", name + ".ngc")),
    ...["moves", "curves"].map((name) => path.join(top, "tests/target/programs", name + ".ngc"))];
  for (const file of [playground, pageOf(files[0]).file]) {
    const { page, faults, close } = await openPage(browser, file);
    for (const program of files) {
      const { stats } = figures(program), got = await runOf(page, fs.readFileSync(program, "utf8"));
      for (const key of ["duration_s", "steps", "end_mpos_mm", "edges_crc32", "length_mm", "max_jerk", "moves"]) {
        assert.deepEqual(got[key], stats[key], `${path.basename(program)} ${key}`);
      }
      assert.deepEqual(got.errors, []);
    }
    const settings = path.join(top, "tests/target/programs/inches.settings"), inches = path.join(top, "tests/target/programs/inches.ngc");
    const { stats } = figures(inches, "--settings", settings);
    const got = await runOf(page, fs.readFileSync(inches, "utf8"), fs.readFileSync(settings, "utf8"));
    assert.equal(got.edges_crc32, stats.edges_crc32);
    assert.deepEqual(faults, []);
    await close();
  }
});

test("what is edited runs: time, charts, errors by line", async () => {
  const { page, faults, close } = await openPage(browser, playground);
  assert.equal(await page.locator(".charts .chart").count(), 4);
  await edited(page, "G21 G90\nG1 X30 F600\nM30\n");
  await page.waitForFunction(() => /^3\.\d+ s in motion/.test(document.querySelector(".run-state").textContent));
  await page.getByLabel("$110 X maximum rate").fill("300");
  await page.getByLabel("$110 X maximum rate").press("Tab");
  await page.waitForFunction(() => /^6\.\d+ s in motion/.test(document.querySelector(".run-state").textContent));
  await edited(page, "G21\nG1 X1 F100\nG1 X2 Q <img src=x onerror=alert(1)>\n");
  await page.locator(".errors button").waitFor();
  const said = await page.locator(".errors button").textContent();
  assert.ok(said.startsWith("Line 3: error:2: a number is missing or malformed"), said);
  assert.ok(said.endsWith("G1 X2 Q <img src=x onerror=alert(1)>"), said);
  await page.locator(".errors button").click();
  assert.equal(await page.evaluate(() => { const b = document.activeElement; return b.value.slice(b.selectionStart, b.selectionEnd); }),
    "G1 X2 Q <img src=x onerror=alert(1)>");
  await page.getByLabel("$120 X acceleration").fill("-1");
  await page.getByLabel("$120 X acceleration").press("Tab");
  await page.waitForFunction(() => document.querySelector(".errors").textContent.includes("$120=-1 is out of range"));
  assert.deepEqual(faults, []);
  await close();
});

test("files are opened, settings and programs", async () => {
  const { page, faults, close } = await openPage(browser, playground);
  const picker = page.locator("input[type=file]");
  await picker.setInputFiles(write("mill.settings", "; my mill\n$110=1200\n$800=9999 (jerk)\n"));
  await page.waitForFunction(() => document.querySelector(".run-state").textContent === "2 settings from mill.settings");
  assert.equal(await page.getByLabel("$110 X maximum rate").inputValue(), "1200");
  await picker.setInputFiles(write("<b>part.ngc", "G21 G90\nG1 X40 F6000\n"));
  await page.waitForFunction(() => /^2\.\d+ s in motion/.test(document.querySelector(".run-state").textContent));
  assert.equal(await page.locator("h1").textContent(), "<b>part.ngc");
  assert.deepEqual(faults, []);
  await close();
});

test("a run is stopped, and the next one runs", async () => {
  const { page, faults, close } = await openPage(browser, playground);
  await page.locator("input[type=file]").setInputFiles(write("long.ngc", long));
  await page.waitForFunction(() => /^line \d+/.test(document.querySelector(".run-state").textContent));
  await page.getByRole("button", { name: "Stop" }).click();
  await page.waitForFunction(() => document.querySelector(".run-state").textContent === "stopped");
  await edited(page, "G21 G90\nG1 X10 F600\n");
  await page.waitForFunction(() => /^1\.\d+ s in motion/.test(document.querySelector(".run-state").textContent));
  assert.deepEqual(faults, []);
  await close();
});

test("a million lines do not freeze the page", async () => {
  const { page, faults, close } = await openPage(browser, playground);
  const file = write("million.ngc", "G21 G91 F6000\n" + "G1 X0.01\nX-0.01\n".repeat(500_000));
  await page.evaluate(() => {
    window.longest = 0;
    let last = performance.now();
    setInterval(() => { const now = performance.now(); window.longest = Math.max(window.longest, now - last); last = now; }, 20);
  });
  await page.locator("input[type=file]").setInputFiles(file);
  await page.waitForFunction(() => /^line [1-9]\d+/.test(document.querySelector(".run-state").textContent));
  const longest = await page.evaluate(() => window.longest);
  assert.ok(longest < 2000, `the page stood still for ${longest.toFixed(0)} ms`);
  await page.keyboard.press("Escape");
  await page.waitForFunction(() => document.querySelector(".run-state").textContent === "stopped");
  assert.deepEqual(faults, []);
  await close();
});

// A module whose functions all trap, in place of the core.
function trappingModule() {
  const names = ["_initialize", "cusp_text", "cusp_take_settings", "cusp_run_begin", "cusp_run_advance"];
  const text = (name) => [name.length, ...Buffer.from(name)];
  const exported = [[...text("memory"), 2, 0], ...names.map((name) => [...text(name), 0, 0])].flat();
  const section = (id, bytes) => [id, ...(bytes.length < 128 ? [bytes.length] : [bytes.length & 127 | 128, bytes.length >> 7]), ...bytes];
  return [0, 0x61, 0x73, 0x6d, 1, 0, 0, 0, ...section(1, [1, 0x60, 0, 0]), ...section(3, [1, 0]), ...section(5, [1, 0, 1]),
    ...section(7, [names.length + 1, ...exported]), ...section(10, [1, 3, 0, 0, 0x0b])];
}

test("a trap of the module ends the run with its reason", async () => {
  const { page, close } = await openPage(browser, playground);
  const said = await page.evaluate(async (bytes) => {
    const module = await WebAssembly.compile(new Uint8Array(bytes)), post = Worker.prototype.postMessage;
    Worker.prototype.postMessage = function (message) { post.call(this, { ...message, module }); };
    try {
      await window.cusp.run("G1 X1 F600", "");
      return "";
    } catch (reason) {
      return String(reason);
    } finally {
      Worker.prototype.postMessage = post;
    }
  }, trappingModule());
  assert.match(said, /the core failed: RuntimeError: unreachable/);
  assert.equal((await runOf(page, "G1 X1 F600\n")).end_mpos_mm[0], 1);
  await close();
});

test("contrast, names and keys", async () => {
  for (const dark of [false, true]) {
    const { page, close } = await openPage(browser, playground, { dark });
    await page.evaluate(axeSource);
    const found = await page.evaluate(() => window.axe.run(document, { runOnly: ["wcag2a", "wcag2aa"] }));
    assert.deepEqual(found.violations.map((v) => `${v.id}: ${v.nodes[0].html}`), []);
    await page.locator(".program textarea").focus();
    await page.keyboard.press("Control+Enter");
    await page.waitForFunction(() => document.querySelector(".run-state").textContent.includes("in motion"));
    await close();
  }
  const { page, close } = await openPage(browser, playground, { width: 390 });
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth) <= 390);
  await close();
});

test("what the playground is not given is refused", () => {
  assert.throws(() => run("view", "--playground", "part.ngc", "-o", path.join(folder, "x.html")), /takes no program/);
  assert.throws(() => run("view", "-o", path.join(folder, "x.html")), /needs a program, or --playground/);
  assert.equal(fs.existsSync(path.join(folder, "x.html")), false);
});
