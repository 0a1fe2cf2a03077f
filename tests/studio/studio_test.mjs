// The studio in a real browser, with the planners of `cusp studio` behind it: from a part to G-code to the virtual mill.
// node studio_test.mjs CUSP WEB TOP
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import test, { after, before } from "node:test";
import { axeSource, cusp, folder, run, startBrowser, top, write } from "../view/browser.mjs";
import { startStudio } from "./studio_program.mjs";

const parts = path.join(top, "examples", "parts"), hills = path.join(parts, "sine-hills.json"), dome = path.join(parts, "trimmed-dome.json");
let browser, studio;
before(async () => {
  studio = await startStudio(cusp, "--linger", "600");
  browser = await startBrowser();
});
after(async () => {
  await browser.close();
  studio.stop();
});

// A page of its own, with an empty store; `faults` says what it asked of others, and what went wrong in it.
async function openStudio({ width = 1280, height = 800, dark = false, address = studio.address } = {}) {
  const context = await browser.newContext({ viewport: { width, height }, colorScheme: dark ? "dark" : "light", reducedMotion: "reduce", acceptDownloads: true });
  context.setDefaultTimeout(120_000);
  const page = await context.newPage(), faults = [], own = `http://127.0.0.1:${studio.port}/`;
  page.on("request", (r) => { if (!r.url().startsWith("blob:") && !r.url().startsWith(own)) faults.push("request " + r.url()); });
  page.on("console", (m) => { if (m.type() === "error" || m.type() === "warning") faults.push("console " + m.text()); });
  page.on("pageerror", (error) => faults.push("error " + String(error)));
  page.on("dialog", (d) => { faults.push("dialog " + d.message()); void d.dismiss(); });
  await page.goto(address);
  await page.waitForFunction(() => window.cusp?.state);
  await page.evaluate(() => window.cusp.ready);
  return { page, faults, close: () => context.close() };
}

const state = (page) => page.evaluate(() => window.cusp.state());
const step = async (page, name) => { await page.getByRole("navigation").getByRole("link", { name }).click(); };
const choose = (page, ...files) => page.locator("input[type=file]").setInputFiles(files);

// A part with few and short passes: the suggestion is planned and cut within seconds.
async function suggested(page, file, tools, scallop) {
  await choose(page, file);
  await step(page, "Operations");
  await page.getByLabel("Tools", { exact: true }).fill(tools);
  await page.locator("#suggest-scallop").fill(scallop);
  await page.getByRole("button", { name: "Suggest" }).click();
  await page.waitForFunction(() => window.cusp.state().job.includes("[[operation]]"));
}

test("a drawing is cut to a depth: its own fields, layers and tabs; what does not suit it is not asked for", async () => {
  const { page, faults, close } = await openStudio();
  await choose(page, path.join(top, "examples", "plate", "plate.dxf"));
  await step(page, "Operations");
  assert.equal(await page.locator("#suggest-scallop").count(), 0);
  await page.getByLabel("Tools", { exact: true }).fill("flat:6 drill:5 vee:6:60");
  await page.getByLabel("Depth", { exact: true }).fill("deep");
  await page.getByRole("button", { name: "Suggest" }).click();
  await page.getByText("depth: \"deep\" is not a number").waitFor();
  await page.getByLabel("Depth", { exact: true }).fill("6");
  await page.getByLabel("Tabs", { exact: true }).fill("4");
  await page.locator(".suggest summary").click();
  await page.getByLabel("Side", { exact: true }).selectOption("outside");
  await page.getByRole("button", { name: "Suggest" }).click();
  await page.waitForFunction(() => window.cusp.state().job.includes("[[operation]]"));
  const { job } = await state(page);
  const told = spawnSync(cusp, ["plan", path.join(top, "examples", "plate", "plate.dxf"), "--tool", "flat:6", "drill:5", "vee:6:60", "--depth", "6", "--tabs", "4", "--side", "outside",
    "--print-job"], { encoding: "utf8" });
  const plain = (text) => text.replaceAll(/[^"\s]*plate\.dxf/g, "plate.dxf");
  assert.equal(plain(job), plain(told.stdout));
  assert.deepEqual(faults, []);
  await close();
});

test("from a part to G-code that is cusp plan's own, byte for byte, then to the virtual mill", async () => {
  const { page, faults, close } = await openStudio();
  assert.equal(await page.evaluate(() => location.hash), "#part", "the token has left the address");
  await suggested(page, dome, "flat:10 ball:10", "1");
  await page.waitForFunction(() => document.querySelector(".stage canvas"));
  await step(page, "Check");
  await page.getByRole("button", { name: "Plan", exact: true }).click();
  await page.waitForFunction(() => window.cusp.state().checked);
  assert.match(await page.locator(".headline").innerText(), /All bounds hold/);
  const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "Download trimmed-dome.ngc" }).click()]);
  const { job } = await state(page), file = write("own/job.toml", job);
  fs.copyFileSync(dome, path.join(path.dirname(file), path.basename(dome)));
  const own = path.join(path.dirname(file), "trimmed-dome.ngc");
  assert.equal(spawnSync(cusp, ["plan", "job.toml", "-o", "trimmed-dome.ngc"], { cwd: path.dirname(file) }).status, 0);
  assert.ok(fs.readFileSync(await download.path()).equals(fs.readFileSync(own)), "the download is cusp plan's program");

  await page.waitForFunction(() => document.querySelectorAll(".run-view .program-row").length > 5);
  assert.match(await page.locator(".run-view .facts").innerText(), /Bounds of the job/i);
  await step(page, "Machine");
  await page.locator(".machine, .machine-note").waitFor();
  if (await page.locator(".machine").count() > 0) await runsOnTheMill(page, own);
  else assert.match(await page.locator(".machine-note").innerText(), /no virtual mill/);
  assert.deepEqual(faults, []);
  await close();
});

// Hold stops the tool and resume goes on; a change of tool waits; the end is that of `cusp sim`.
async function runsOnTheMill(page, program) {
  const stats = path.join(folder, "mill.json");
  run("sim", program, "--stats", stats);
  const { end_mpos_mm } = JSON.parse(fs.readFileSync(stats, "utf8"));
  await page.waitForTimeout(300);
  assert.equal((await state(page)).machine.link, "none", "nothing moves without a click");
  const until = (holds) => page.waitForFunction(holds);
  await page.getByLabel("Time").selectOption("10");
  await page.getByRole("button", { name: "Run", exact: true }).click();
  await until(() => window.cusp.state().machine.run?.seconds > 1);
  await page.getByRole("button", { name: "Hold" }).click();
  await until(() => window.cusp.state().machine.state === "Hold" && window.cusp.state().machine.substate === 0);
  const held = (await state(page)).machine;
  await page.waitForTimeout(400);
  assert.deepEqual((await state(page)).machine.machine, held.machine, "a hold holds");
  await page.getByRole("button", { name: "Resume" }).click();
  await page.waitForFunction((line) => window.cusp.state().machine.run.line > line, held.run.line);
  await page.keyboard.press("Escape");
  await until(() => window.cusp.state().machine.run.phase === "stopped" && window.cusp.state().machine.ready);
  await page.getByRole("button", { name: "Disconnect" }).click();
  await page.getByLabel("Time").selectOption("300");
  await page.getByRole("button", { name: "Run", exact: true }).click();
  await until(() => window.cusp.state().machine.pause?.kind === "tool");
  assert.match(await page.locator(".wait").innerText(), /Change to tool T2, at line \d+: M0 \(tool 2 ball diameter 10 mm\)\..* Then Resume/);
  await page.getByRole("button", { name: "Resume" }).click();
  await until(() => window.cusp.state().machine.run?.phase === "done");
  await page.waitForTimeout(300);
  const { machine } = await state(page);
  machine.machine.forEach((value, k) => assert.ok(Math.abs(value - end_mpos_mm[k]) < 6e-4, `end of axis ${k}`));
}

test("a fault stands at its key, and undo takes it back", async () => {
  const { page, faults, close } = await openStudio();
  await suggested(page, hills, "ball:10", "1");
  const before = (await state(page)).job;
  const field = page.getByLabel("scallop", { exact: true }).first();
  await field.fill("-3");
  await page.waitForTimeout(1500);  // the answer about the job before comes meanwhile
  assert.equal(await field.inputValue(), "-3");
  await field.press("Tab");
  const fault = page.locator(".field.wrong .fault");
  await fault.waitFor();
  assert.match(await fault.innerText(), /scallop/);
  assert.ok((await field.getAttribute("aria-describedby")).split(" ").includes(await fault.getAttribute("id")));
  await field.fill("3,5");
  await field.press("Tab");
  assert.match(await fault.innerText(), /"3,5" is not a number/);
  await page.getByRole("button", { name: "Undo" }).click();
  assert.equal((await state(page)).job, before);
  await page.waitForFunction(() => window.cusp.state().faults.length === 0);
  await page.getByRole("button", { name: "Redo" }).click();
  assert.notEqual((await state(page)).job, before);
  assert.deepEqual(faults, []);
  await close();
});

test("a plan is cancelled, and the next one is made; a page that is loaded again has its project", async () => {
  const { page, faults, close } = await openStudio();
  await suggested(page, hills, "ball:3", "0.0005");
  await step(page, "Check");
  await page.getByRole("button", { name: "Plan", exact: true }).click();
  await page.getByRole("button", { name: "Cancel" }).waitFor();
  await page.waitForFunction(() => /\d %/.test(document.querySelector(".work")?.textContent ?? ""));
  const clicked = Date.now();
  await page.getByRole("button", { name: "Cancel" }).click();
  await page.waitForFunction(() => /Planning: cancelled/.test(document.querySelector(".said")?.textContent ?? ""));
  assert.ok(Date.now() - clicked < 5000, `${Date.now() - clicked} ms`);  // of minutes; a loaded machine answers late
  const { job, files } = await state(page);
  await page.waitForTimeout(1500);
  await page.reload();
  await page.waitForFunction(() => window.cusp?.state);
  await page.evaluate(() => window.cusp.ready);
  const again = await state(page);
  assert.equal(again.job, job);
  assert.deepEqual(again.files, files);
  assert.ok(again.strategies.length > 5, "the planners answer the page that was loaded again");
  assert.deepEqual(faults, []);
  await close();
});

test("names and texts that hold markup are shown as they are", async () => {
  const { page, faults, close } = await openStudio();
  const name = "<img src=x onerror=alert(1)>.stl";
  await choose(page, write("hostile/" + name, "solid <script>alert(2)</script>\nendsolid\n"), write("hostile/job.toml", "# </textarea><script>alert(3)</script>\n[[operation]]\nstrategy = \"<b>x</b>\"\nfloor = [\"<i>y\"]\n[[tool]]\nname = \"<u>\"\n"));
  await page.waitForFunction(() => window.cusp.state().files.length === 1);
  assert.equal(await page.locator(".card h3").first().innerText(), name);
  for (const where of ["Operations", "Stock", "Check", "Machine", "Part"]) {
    await step(page, where);
    assert.equal(await page.locator("main img, main script, main b, main u").count(), 0);
  }
  await page.waitForFunction(() => window.cusp.state().faults.length > 0);
  assert.deepEqual(faults, []);
  await close();
});

test("contrast, names, widths and targets hold in all steps, light and dark", async () => {
  for (const [dark, width] of [[false, 1280], [true, 390], [false, 390], [true, 2560]]) {
    const { page, faults, close } = await openStudio({ dark, width });
    await suggested(page, hills, "flat:10 ball:10", "1");
    await page.evaluate(axeSource);
    for (const where of ["Part", "Stock", "Operations", "Check", "Machine"]) {
      await step(page, where);
      await page.waitForTimeout(50);
      const { violations } = await page.evaluate(() => window.axe.run(document, { resultTypes: ["violations"] }));
      assert.deepEqual(violations.map((v) => `${v.id}: ${v.nodes.slice(0, 3).map((n) => n.html.slice(0, 120)).join(" | ")}`), [], `${where}, dark ${dark}, ${width} px`);
      assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), `${where}: nothing sticks out at ${width} px`);
    }
    const small = await page.locator(".machine button, .machine select").evaluateAll((all) => all.map((e) => e.getBoundingClientRect().height).filter((height) => height < 44));
    assert.deepEqual(small, [], "targets of the step Machine");
    assert.deepEqual(faults, []);
    await close();
  }
});

test("without the token the page says what to do", async () => {
  const { page, close } = await openStudio({ address: `http://127.0.0.1:${studio.port}/` });
  assert.match(await page.locator(".studio-foot").innerText(), /open the address that it prints/);
  await close();
});
