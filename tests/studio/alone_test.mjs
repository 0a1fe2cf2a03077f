// The studio in one file, with the planners in the page: from a part to G-code to the virtual mill, from file:// and without a network.
// node alone_test.mjs CUSP WEB TOP STUDIO.html [--same]
// --same: both are of the same sources, and so are the bytes of programs.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import test, { after, before } from "node:test";
import { pathToFileURL } from "node:url";
import { deflateSync } from "node:zlib";
import { cusp, startBrowser, top, write } from "../view/browser.mjs";

const file = process.argv[5], isSame = process.argv[6] === "--same", parts = path.join(top, "examples", "parts"), dome = path.join(parts, "trimmed-dome.json");
let browser;
before(async () => { browser = await startBrowser(); });
after(async () => { await browser.close(); });

async function open() {
  const context = await browser.newContext({ reducedMotion: "reduce", acceptDownloads: true, offline: true });
  context.setDefaultTimeout(300_000);
  const page = await context.newPage(), faults = [], address = pathToFileURL(file).href;
  page.on("request", (r) => { if (!r.url().startsWith("blob:") && r.url() !== address) faults.push("request " + r.url()); });
  page.on("console", (m) => { if (m.type() === "error" || m.type() === "warning") faults.push("console " + m.text()); });
  page.on("pageerror", (error) => faults.push("error " + String(error)));
  await page.goto(address);
  await page.waitForFunction(() => window.cusp?.state);
  await page.evaluate(() => window.cusp.ready);
  return { page, faults, close: () => context.close() };
}

const step = async (page, name) => { await page.getByRole("navigation").getByRole("link", { name }).click(); };

async function suggested(page, part, tools, scallop) {
  await page.locator("input[type=file]").setInputFiles([part]);
  await step(page, "Operations");
  await page.getByLabel("Tools", { exact: true }).fill(tools);
  await page.locator("#suggest-scallop").fill(scallop);
  await page.getByRole("button", { name: "Suggest" }).click();
  await page.waitForFunction(() => window.cusp.state().job.includes("[[operation]]"));
  await step(page, "Check");
}

test("a part becomes a program whose bounds hold, in the page and by cusp verify", async () => {
  const { page, faults, close } = await open();
  await suggested(page, dome, "flat:10 ball:10", "1");
  await page.getByRole("button", { name: "Plan", exact: true }).click();
  await page.waitForFunction(() => window.cusp.state().checked);
  assert.match(await page.locator(".headline").innerText(), /All bounds hold/);
  const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "Download trimmed-dome.ngc" }).click()]);
  const { job } = await page.evaluate(() => window.cusp.state()), own = write("alone/job.toml", job), folder = path.dirname(own);
  fs.copyFileSync(dome, path.join(folder, path.basename(dome)));
  const program = await download.path(), native = (...call) => assert.equal(spawnSync(cusp, call, { cwd: folder }).status, 0, call[0]);
  native("verify", "job.toml", program);
  if (isSame) {
    native("plan", "job.toml", "-o", "trimmed-dome.ngc");
    assert.ok(fs.readFileSync(program).equals(fs.readFileSync(path.join(folder, "trimmed-dome.ngc"))), "the bytes are those of the program");
  }
  assert.deepEqual(faults, []);
  await close();
});

/** Greys that rise from left to right, as PNG. */
function ramp(width, height) {
  const crc = (bytes) => ~bytes.reduce((sum, byte) => {
    let rest = sum ^ byte;
    for (let bit = 0; bit < 8; bit += 1) rest = (rest >>> 1) ^ (rest & 1 ? 0xedb88320 : 0);
    return rest;
  }, -1) >>> 0;
  const word = (value) => { const bytes = Buffer.alloc(4); bytes.writeUInt32BE(value); return bytes; };
  const chunk = (kind, data) => { const body = Buffer.concat([Buffer.from(kind), data]); return Buffer.concat([word(data.length), body, word(crc(body))]); };
  const rows = Array.from({ length: height }, () => Buffer.from([0, ...Array.from({ length: width }, (_, x) => Math.round(255 * x / (width - 1)))]));
  return Buffer.concat([Buffer.from("\x89PNG\r\n\x1a\n", "latin1"), chunk("IHDR", Buffer.concat([word(width), word(height), Buffer.from([8, 0, 0, 0, 0])])),
    chunk("IDAT", deflateSync(Buffer.concat(rows))), chunk("IEND", Buffer.alloc(0))]);
}

test("a picture becomes a relief of the size that Suggest asks for", async () => {
  const { page, faults, close } = await open();
  await page.locator("input[type=file]").setInputFiles([write("alone/ramp.png", ramp(40, 30))]);
  await page.getByText("shown 100 mm wide").waitFor();
  await step(page, "Operations");
  await page.getByLabel("Tools", { exact: true }).fill("ball:6");
  await page.locator("details").evaluateAll((all) => all.forEach((one) => { one.open = true; }));
  for (const [key, text] of [["scallop", "0.5"], ["width", "40"], ["heights", "-4, 0"]]) await page.locator(`#suggest-${key}`).fill(text);
  await page.getByRole("button", { name: "Suggest" }).click();
  await page.waitForFunction(() => window.cusp.state().job.includes("heights = [-4, 0]"));
  await step(page, "Check");
  await page.getByRole("button", { name: "Plan", exact: true }).click();
  await page.waitForFunction(() => window.cusp.state().checked);
  assert.match(await page.locator(".headline").innerText(), /All bounds hold/);
  assert.deepEqual(faults, []);
  await close();
});

test("an SVG drawing is cut out, its islands left", async () => {
  const { page, faults, close } = await open();
  await page.locator("input[type=file]").setInputFiles([write("alone/plate.svg", `<svg xmlns="http://www.w3.org/2000/svg" width="60mm" height="40mm"
    viewBox="0 0 60 40"><rect x="5" y="5" width="50" height="30" rx="4"/><path id="hole" d="M20 20a6 6 0 1 0 12 0a6 6 0 1 0 -12 0z"/></svg>`)]);
  await step(page, "Operations");
  await page.getByLabel("Tools", { exact: true }).fill("flat:3");
  await page.locator("details").evaluateAll((all) => all.forEach((one) => { one.open = true; }));
  await page.locator("#suggest-depth").fill("4");
  await page.getByRole("button", { name: "Suggest" }).click();
  await page.waitForFunction(() => window.cusp.state().job.includes("plate.svg"));
  await step(page, "Check");
  await page.getByRole("button", { name: "Plan", exact: true }).click();
  await page.waitForFunction(() => window.cusp.state().checked);
  assert.match(await page.locator(".headline").innerText(), /All bounds hold/);
  assert.deepEqual(faults, []);
  await close();
});

test("a plan is cancelled at once, and the next one works", async () => {
  const { page, faults, close } = await open();
  await suggested(page, path.join(parts, "sine-hills.json"), "ball:2", "0.005");
  await page.getByRole("button", { name: "Plan", exact: true }).click();
  await page.getByRole("button", { name: "Cancel" }).click();
  await page.getByText(/cancelled/).waitFor({ timeout: 2000 });
  await step(page, "Operations");
  await page.getByLabel("Tools", { exact: true }).fill("ball:10");
  await page.locator("#suggest-scallop").fill("1");
  await page.getByRole("button", { name: "Suggest" }).click();
  await page.waitForFunction(() => /diameter = 10/.test(window.cusp.state().job));
  assert.deepEqual(faults, []);
  await close();
});

test("a plan that begins while the page still reads the job is a plan all the same", async () => {
  for (const wait of [345, 352, 360]) {  // ms: the page reads a job 350 ms after the last edit
    const { page, faults, close } = await open();
    await suggested(page, dome, "flat:10 ball:10", "1");
    await page.evaluate(async (ms) => {
      const again = (text) => window.cusp.take([new File([window.cusp.state().job + text], "job.toml")]);
      await again("# once more");
      setTimeout(() => void window.cusp.plan(), ms);
      setTimeout(() => void again("# and again"), ms + 30);
    }, wait);
    await page.waitForFunction(() => window.cusp.state().checked, null, { timeout: 90_000 });
    assert.deepEqual(faults, []);
    await close();
  }
});

test("a fault stands at the key that caused it", async () => {
  const { page, close } = await open();
  await suggested(page, dome, "flat:10 ball:10", "1");
  const { job } = await page.evaluate(() => window.cusp.state());
  await page.evaluate((text) => window.cusp.take([new File([text], "job.toml")]), job.replace(/^scallop = .*$/m, "scallop = -1"));
  await page.waitForFunction(() => window.cusp.state().faults.some(({ key }) => key === "scallop"));
  await close();
});

test("a program of the project runs on the virtual mill, sent as the planners in the page read it", async () => {
  const { page, faults, close } = await open();
  await page.locator("input[type=file]").setInputFiles(write("alone/part.ngc", "G21 G90 F3000\n(there)\nG1 X10 Y2\nG1 X0 Y0\nM2\n"));
  await step(page, "Machine");
  await page.getByRole("button", { name: "Run", exact: true }).click();
  await page.getByRole("button", { name: "Run all the same" }).click();
  await page.waitForFunction(() => window.cusp.state().machine.run?.phase === "done");
  assert.equal((await page.evaluate(() => window.cusp.state().machine.run)).line, 5);
  assert.deepEqual(faults, []);
  await close();
});
