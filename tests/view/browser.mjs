// Shared by the tests of pages: a browser that watches for requests, errors and dialogs, and cusp.
import { spawnSync } from "node:child_process";
import fs from "node:fs";
import { createRequire } from "node:module";
import os from "node:os";
import path from "node:path";
import { pathToFileURL } from "node:url";

// Debian's Chromium has no compatible renderer in hardware here: SwiftShader draws.
const switches = ["--headless=new", "--no-sandbox", "--enable-unsafe-swiftshader", "--use-angle=swiftshader", "--disable-quic",
  "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"];

// node SCRIPT CUSP WEB TOP: the program, the folder with node_modules, the top of the tree.
export const [cusp, web, top] = process.argv.slice(2);
const require = createRequire(path.join(web, "package.json"));
const { chromium } = require("playwright-core");
export const axeSource = fs.readFileSync(require.resolve("axe-core/axe.min.js"), "utf8");

export const folder = fs.mkdtempSync(path.join(os.tmpdir(), "cusp-view-"));
process.on("exit", () => fs.rmSync(folder, { recursive: true, force: true }));

export function write(name, text) {
  const file = path.join(folder, name);
  fs.mkdirSync(path.dirname(file), { recursive: true });
  fs.writeFileSync(file, text);
  return file;
}

// Runs cusp; statuses other than 0 and 1 are failures of the test.
export function run(...args) {
  const result = spawnSync(cusp, args, { encoding: "utf8" });
  if (result.status !== 0 && result.status !== 1) throw new Error(`cusp ${args.join(" ")}: ${result.status}: ${result.stderr}`);
  return result;
}

export function figures(program, ...options) {
  const stats = path.join(folder, "stats.json"), samples = path.join(folder, "samples.csv");
  run("sim", program, "--stats", stats, "--samples", samples, ...options);
  const rows = fs.readFileSync(samples, "utf8").trim().split("\n").slice(1).map((row) => row.split(",").map(Number));
  return { stats: JSON.parse(fs.readFileSync(stats, "utf8")), rows };
}

export function pageOf(program, ...options) {
  const file = path.join(folder, path.basename(program).replace(/\W/g, "_") + ".html");
  const result = run("view", program, "-o", file, ...options);
  return { file, status: result.status, said: result.stdout + result.stderr };
}

export async function startBrowser() {
  return chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: switches });
}

// Opens a page that must ask for nothing and complain of nothing: `faults` says what it did.
export async function openPage(browser, file, { width = 1280, height = 800, dark = false } = {}) {
  const context = await browser.newContext({ viewport: { width, height }, colorScheme: dark ? "dark" : "light", reducedMotion: "reduce" });
  context.setDefaultTimeout(120_000);  // a loaded machine
  const page = await context.newPage(), faults = [], address = pathToFileURL(file).href;
  page.on("request", (r) => { if (!r.url().startsWith("blob:") && r.url() !== address) faults.push("request " + r.url()); });
  page.on("console", (m) => { if (m.type() === "error" || m.type() === "warning") faults.push("console " + m.text()); });
  page.on("pageerror", (error) => faults.push("error " + String(error)));
  page.on("dialog", (d) => { faults.push("dialog " + d.message()); void d.dismiss(); });
  await page.goto(address);
  await page.waitForFunction(() => window.cusp);
  await page.evaluate(() => window.cusp.ready);
  return { page, faults, close: () => context.close() };
}

// Number of colours of the scene.
export function coloursOf(page) {
  return page.evaluate(async () => {
    await window.cusp.seek(window.cusp.state().t_s);
    const from = document.querySelector(".stage canvas"), to = document.createElement("canvas");
    [to.width, to.height] = [from.width, from.height];
    const pen = to.getContext("2d");
    pen.drawImage(from, 0, 0);
    return new Set(new Uint32Array(pen.getImageData(0, 0, to.width, to.height).data.buffer)).size;
  });
}

// A checksum of what the scene shows.
export function pictureOf(page) {
  return page.evaluate(async () => {
    await window.cusp.seek(window.cusp.state().t_s);
    const text = document.querySelector(".stage canvas").toDataURL();
    let sum = 0;
    for (let k = 0; k < text.length; ++k) sum = (sum * 31 + text.charCodeAt(k)) | 0;
    return sum;
  });
}
