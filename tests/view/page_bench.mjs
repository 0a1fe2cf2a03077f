// Sizes and times of cusp view on a made-up program: a million short moves, ten million set points.
//
//   node page_bench.mjs CUSP WEB TOP [MOVES]
//
// Prints size, seconds to make and to open, and the memory of the page's process; exit 1 where a bound does not hold.
import { execFileSync } from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import { cusp, folder, openPage, startBrowser } from "./browser.mjs";

const moves = Number(process.argv[5] ?? 1e6), whole = moves >= 1e6;
const bounds = { mb: 40, made_s: 20, open_s: 15, memory_mb: 1536 };

// A surface finished in zigzag: moves of 0.2 mm at 1200 mm/min, ten set points each.
const file = path.join(folder, "million.ngc"), out = fs.createWriteStream(file);
out.write("G21 G90 G17 G94\nG0 X0 Y0 Z5\nG1 F1200\n");
const each = 1000;
for (let k = 0, text = ""; k < moves; ++k) {
  const row = Math.floor(k / each), along = k % each, x = 0.2 * (row % 2 ? each - 1 - along : along), y = 0.2 * row;
  text += `X${x.toFixed(3)} Y${y.toFixed(3)} Z${(3 * Math.sin(x / 17) * Math.cos(y / 23)).toFixed(3)}\n`;
  if (text.length > 1e6 || k === moves - 1) {
    out.write(text);
    text = "";
  }
}
out.end("M30\n");
await new Promise((done) => out.on("finish", done));

const page_file = path.join(folder, "million.html"), begin = performance.now();
console.log(execFileSync(cusp, ["view", file, "-o", page_file], { encoding: "utf8", stdio: ["ignore", "pipe", "ignore"] }).trim());
const made_s = (performance.now() - begin) / 1000, mb = fs.statSync(page_file).size / 1048576;

// Proportional set size of all processes of the browser that hold pages.
function memory() {
  let most = 0;
  for (const id of fs.readdirSync("/proc").filter((name) => /^\d+$/.test(name))) {
    try {
      if (!fs.readFileSync(`/proc/${id}/cmdline`, "utf8").includes("--type=renderer")) continue;
      const pss = /^Pss:\s+(\d+)/m.exec(fs.readFileSync(`/proc/${id}/smaps_rollup`, "utf8"));
      most = Math.max(most, Number(pss[1]) / 1024);
    } catch { /* it has ended */ }
  }
  return most;
}
const browser = await startBrowser(), opened = performance.now();
let memory_mb = 0;
const watch = setInterval(() => { memory_mb = Math.max(memory_mb, memory()); }, 200);
const { page, faults } = await openPage(browser, page_file);
const open_s = (performance.now() - opened) / 1000;
const sought = performance.now();
for (let k = 0; k < 10; ++k) await page.evaluate((t) => window.cusp.seek(t), k * 1000);
const seek_s = (performance.now() - sought) / 10000;
clearInterval(watch);
const ticks = await page.evaluate(() => window.cusp.facts.ticks);
await browser.close();

const measured = { mb, made_s, open_s, memory_mb };
console.log(`${moves} moves, ${ticks} set points; a seek takes ${seek_s.toFixed(2)} s`);
const broken = faults.slice();
for (const [name, bound] of Object.entries(bounds)) {
  const holds = measured[name] <= bound;
  console.log(`${name}: ${measured[name].toFixed(2)} (${whole ? `at most ${bound}` : "no bound for fewer moves"})`);
  if (whole && !holds) broken.push(`${name} ${measured[name].toFixed(2)} is over ${bound}`);
}
console.log(broken.length > 0 ? `broken: ${broken.join("; ")}` : "all bounds hold");
process.exit(broken.length > 0 ? 1 : 0);
