// The pages of cusp view in a real browser: what window.cusp promises, picking, keys, hostile text, contrast.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import test, { after, before } from "node:test";
import { axeSource, coloursOf, cusp, figures, folder, openPage, pageOf, pictureOf, run, startBrowser, top, write } from "./browser.mjs";

const programs = path.join(top, "tests", "programs");
let browser;
before(async () => { browser = await startBrowser(); });
after(async () => { await browser.close(); });

const seek = (page, t) => page.evaluate(async (at) => { await window.cusp.seek(at); return window.cusp.state(); }, t);
const state = (page) => page.evaluate(() => window.cusp.state());

test("facts and set points are those of cusp sim", async () => {
  const program = path.join(programs, "rsq.ngc"), { stats, rows } = figures(program);
  const { page, faults, close } = await openPage(browser, pageOf(program).file);
  const facts = await page.evaluate(() => window.cusp.facts);
  for (const name of ["duration_s", "length_mm", "max_velocity", "max_acceleration", "max_jerk"]) assert.deepEqual(facts[name], stats[name], name);
  assert.equal(facts.ticks, rows.length);
  assert.equal(facts.moves, stats.moves.rapid + stats.moves.line + stats.moves.arc + stats.moves.nurbs);
  for (let k = 0; k < rows.length; k += 97) {
    const at = await seek(page, rows[k][0] * 1e-6);
    assert.ok(Math.abs(at.t_s - rows[k][0] * 1e-6) < 1e-9);
    assert.equal(at.line, rows[k][4]);
    const back = (n) => rows[Math.max(k - n, 0)].slice(1, 4);
    for (let c = 0; c < 3; ++c) {
      const [p0, p1, p2, p3] = [0, 1, 2, 3].map((n) => back(n)[c]);
      assert.ok(Math.abs(at.position_mm[c] - p0 * 1e-6) < 1e-9, `position at row ${k}`);
      assert.ok(Math.abs(at.velocity[c] - (p0 - p1) * 1e-3) < 1e-9, `velocity at row ${k}`);
      assert.ok(Math.abs(at.acceleration[c] - (p0 - 2 * p1 + p2)) < 1e-6, `acceleration at row ${k}`);
      assert.ok(Math.abs(at.jerk[c] - (p0 - 3 * p1 + 3 * p2 - p3) * 1e3) < 1e-3, `jerk at row ${k}`);
    }
  }
  assert.ok(await coloursOf(page) > 30);
  assert.deepEqual(faults, []);
  await close();
});

test("every set point of a long run comes back exactly", async () => {
  const program = path.join(programs, "liss.ngc"), { rows } = figures(program);
  const { page, close } = await openPage(browser, pageOf(program).file);
  const places = await page.evaluate(async (times) => {
    const out = [];
    for (const t of times) {
      void window.cusp.seek(t);
      out.push(window.cusp.state().position_mm.map((v) => Math.round(v * 1e6)));
    }
    return out;
  }, rows.map((row) => row[0] * 1e-6));
  assert.deepEqual(places, rows.map((row) => row.slice(1, 4)));
  await close();
});

test("lines and places are found both ways", async () => {
  const program = path.join(programs, "square.ngc");
  const { page, faults, close } = await openPage(browser, pageOf(program).file);
  const count = fs.readFileSync(program, "utf8").split("\n").length;
  let tried = 0;
  for (let line = 1; line <= count; ++line) {
    const found = await page.evaluate(async (n) => {
      const times = window.cusp.linesAt(n);
      if (!times) return null;
      await window.cusp.seek((times[0] + times[1]) / 2);
      const [px, py] = window.cusp.project(window.cusp.state().position_mm);
      return { line: window.cusp.state().line, at: window.cusp.lineAt(px, py), px, py };
    }, line);
    if (!found) continue;
    ++tried;
    assert.equal(found.line, line);
    assert.equal(found.at, line);
    await page.evaluate(() => window.cusp.seek(0));
    await page.mouse.click(found.px, found.py);
    assert.equal((await state(page)).line, line, "a click on the path");
    await page.waitForFunction((n) => document.querySelector(`[data-line="${n}"]`)?.getAttribute("aria-selected") === "true", line);
  }
  assert.ok(tried >= 4);
  assert.deepEqual(await page.evaluate(() => [0, -1, 1e9, 1.5].map((n) => window.cusp.linesAt(n))), [null, null, null, null]);
  assert.equal(await page.evaluate(() => window.cusp.lineAt(-50, -50)), null);
  await page.locator('[data-line="3"]').click();
  assert.equal((await state(page)).line, 3, "a click on a line");
  assert.deepEqual(faults, []);
  await close();
});

test("each colouring is a picture of its own with a legend", async () => {
  const { page, close } = await openPage(browser, pageOf(path.join(programs, "rsq.ngc")).file);
  const seen = new Set();
  for (const name of ["height", "speed", "limits", "deviation", "operation", "left"]) {
    await page.evaluate((n) => window.cusp.show(n), name);
    seen.add(await page.locator(".legend").innerText());
    await pictureOf(page);
  }
  assert.equal(seen.size, 6);
  assert.match(await page.evaluate(() => { try { window.cusp.show("taste"); return ""; } catch (error) { return String(error); } }), /RangeError.*taste/);
  await close();
});

test("the keyboard alone works the page", async () => {
  const { page, faults, close } = await openPage(browser, pageOf(path.join(programs, "rsq.ngc")).file);
  const reached = new Set();
  for (let k = 0; k < 30; ++k) {
    await page.keyboard.press("Tab");
    reached.add(await page.evaluate(() => document.activeElement.className || document.activeElement.getAttribute("aria-label") || document.activeElement.textContent));
    const outline = await page.evaluate(() => getComputedStyle(document.activeElement).outlineStyle);
    if (await page.evaluate(() => document.activeElement !== document.body)) assert.notEqual(outline, "none", "focus is seen");
  }
  for (const name of ["play", "Time in the run", "program-list", "Colours show", "Keys"]) assert.ok(reached.has(name), `${name} in ${[...reached].join()}`);
  await page.evaluate(() => document.activeElement.blur());
  await page.keyboard.press("Home");
  const start = (await state(page)).t_s;
  await page.keyboard.press("Space");
  await page.waitForFunction((t) => window.cusp.state().t_s > t + 0.05, start);
  await page.keyboard.press("Space");
  const stopped = (await state(page)).t_s;
  await page.waitForTimeout(150);
  assert.equal((await state(page)).t_s, stopped);
  await page.keyboard.press("Shift+ArrowRight");
  assert.ok(Math.abs((await state(page)).t_s - stopped - 0.001) < 1e-9);
  await page.keyboard.press("Home");
  await page.keyboard.press("ArrowDown");
  const line = (await state(page)).line;
  await page.keyboard.press("ArrowDown");
  assert.ok((await state(page)).line > line);
  await page.keyboard.press("ArrowUp");
  assert.equal((await state(page)).line, line);
  await page.keyboard.press("End");
  const views = new Set();
  for (const key of "1234567") {
    await page.keyboard.press(key);
    views.add(await pictureOf(page));
  }
  assert.equal(views.size, 7);
  const before = await pictureOf(page);
  await page.keyboard.press("+");
  assert.notEqual(await pictureOf(page), before);
  const legend = await page.locator(".legend").innerText();
  await page.keyboard.press("c");
  assert.notEqual(await page.locator(".legend").innerText(), legend);
  await page.keyboard.press("?");
  assert.ok(await page.locator("dialog[open]").isVisible());
  await page.keyboard.press("Escape");
  assert.equal(await page.locator("dialog[open]").count(), 0);
  assert.deepEqual(faults, []);
  await close();
});

test("figures below zero have a true minus, and no line of the program is cut off at the top", async () => {
  const lines = Array.from({ length: 300 }, (_, k) => `G1 X${k / 10} Y-${k % 7} Z-${k % 3}`).join("\n");
  const { page, close } = await openPage(browser, pageOf(write("below.ngc", `G21 G90 F1000\n${lines}\n`)).file);
  await page.evaluate(() => window.cusp.show("height"));
  assert.match(await page.locator(".legend").innerText(), /−2/);
  const end = await page.evaluate(() => window.cusp.facts.duration_s);
  for (const share of [0.3, 0.51, 0.77]) {
    await seek(page, end * share);
    assert.equal(await page.locator(".program").evaluate((list) => list.scrollTop % 18), 0);
  }
  assert.doesNotMatch(await page.locator(".legend, .readout").allInnerTexts().then((texts) => texts.join("\n")), /-\d/);
  await close();
});

// The studio's own folders apart: it is a program, these are pages.
test("the pages of cusp view are less than 3000 lines of our own TypeScript", () => {
  const view = path.join(top, "host_tools", "judge", "view");
  const files = ["web/src", "npm"].flatMap((name) => fs.readdirSync(path.join(view, name), { recursive: true }).map((file) => path.join(view, name, file)));
  const own = (file) => file.endsWith(".ts") && !/web\/src\/(engine|machine|mill|port|project|sender|studio)\//.test(file);
  const lines = files.filter(own).flatMap((file) => fs.readFileSync(file, "utf8").split("\n"));
  const code = lines.filter((line) => !/^\s*($|\/\/|\/?\*)/.test(line));
  assert.ok(code.length > 2000 && code.length < 3000, `${code.length} lines`);
});

const attack = '<img src=x onerror="window.hacked=1">', closing = "</script><script>window.hacked=1</script>";

test("hostile text is data", async () => {
  const name = `a<img src=x onerror=window.hacked=1>.ngc`;
  const program = write(name, `(${attack} ${closing} <!-- <script>)\n(tool 1 ${closing})\nT1\nG21 G90\nG1 X5 F600 (<b>bold</b>)\n` +
    `G1 X10 <!--\n; ]]> --> </title> \u2028 \u0000\n${attack}\nG1 X20\n`);
  const { file, status } = pageOf(program);
  assert.equal(status, 1, "lines are refused");
  const { page, faults, close } = await openPage(browser, file);
  assert.equal(await page.evaluate(() => window.hacked), undefined);
  assert.equal(await page.locator("h1").innerText(), name);
  const text = await page.locator(".program").innerText();
  assert.ok(text.includes(attack) && text.includes(closing) && text.includes("<b>bold</b>"));
  assert.equal(await page.locator("img, b").count(), 0);
  assert.ok((await page.locator(".facts").innerText()).includes(closing));
  assert.equal(await page.locator('meta[http-equiv="Content-Security-Policy"]').count(), 1);
  const refused = await page.evaluate(() => fetch("https://example.invalid/").then(() => "sent", () => "refused"));
  assert.equal(refused, "refused");
  assert.ok(faults.every((fault) => /example\.invalid/.test(fault)), faults.join("\n"));
  await close();
});

test("characters that turn text around are shown as their numbers", async () => {
  const program = write("turned\u202egnp.ngc", "G21 G90\n(\u202e0009F 05X 1G \u2066) G1 X5 F600\nG1 X6 Q4 (\u200f)\n");
  const { page, faults, close } = await openPage(browser, pageOf(program).file);
  const rows = await page.locator(".program-row").evaluateAll((all) => all.map((row) => row.textContent));
  assert.equal(rows[1], "2(<U+202E>0009F 05X 1G <U+2066>) G1 X5 F600");
  assert.match(rows[2], /^3G1 X6 Q4 \(<U\+200F>\)error/);
  assert.equal(await page.locator("h1").innerText(), "turned<U+202E>gnp.ngc");
  assert.ok(!/[\u200e\u200f\u202a-\u202e\u2066-\u2069]/.test(await page.locator("body").innerText()));
  assert.deepEqual(faults, []);
  await close();
});

test("a program of any bytes opens", async () => {
  const bytes = Buffer.from([...Array(256).keys(), 10, ...Buffer.from("G21\nG1 X5 F600\n")]);
  const { page, faults, close } = await openPage(browser, pageOf(write("bytes.ngc", bytes)).file);
  assert.deepEqual(faults, []);
  await close();
});

test("a refused line stands in its place with the word that is wrong", async () => {
  const program = write("refused.ngc", "G21 G90\nG1 X10 F600\nG1 X20 Q4\nG77 X5\nG1 X1..5\nG2 X5 Y5\nM30\n");
  const { page, faults, close } = await openPage(browser, pageOf(program).file);
  const rows = await page.locator(".program-row.refused").evaluateAll((all) =>
    all.map((row) => [Number(row.dataset.line), row.querySelector("mark").textContent, row.querySelector(".program-why").textContent]));
  assert.deepEqual(rows.map(([line, word]) => [line, word]), [[3, "Q4"], [4, "G77"], [5, "X1..5"], [6, "G2 X5 Y5"]]);
  for (const [, , why] of rows) assert.match(why, /^error \d+: /);
  assert.match(await page.locator(".warnings").innerText(), /Line 3/);
  assert.equal((await seek(page, 1e9)).line, 2, "the run ends before the refused line");
  assert.deepEqual(faults, []);
  await close();
});

test("the place of a refused word is its own, not a comment's", async () => {
  const { page, close } = await openPage(browser, pageOf(write("comment.ngc", "G21\nG1 X1 F100\n(E2) G1 X1 E2\n")).file);
  const mark = page.locator(".program-row.refused mark");
  assert.equal(await mark.textContent(), "E2");
  assert.equal(await mark.evaluate((word) => word.previousSibling?.textContent), "(E2) G1 X1 ");
  await close();
});

test("--still draws the scene; a browser that is not there is said", () => {
  const program = write("still.ngc", "G21\nG1 X10 Y5 F600\nM30\n"), picture = path.join(folder, "still.png");
  const options = ["view", program, "-o", path.join(folder, "still.html"), "--still", picture];
  assert.equal(run(...options).status, 0);
  const bytes = fs.readFileSync(picture);
  assert.deepEqual([...bytes.subarray(0, 8)], [137, 80, 78, 71, 13, 10, 26, 10]);
  assert.deepEqual([bytes.readUInt32BE(16), bytes.readUInt32BE(20)], [1600, 1000]);
  assert.ok(bytes.length > 10000, `${bytes.length} bytes`);
  fs.rmSync(picture);
  const missing = spawnSync(cusp, options, { encoding: "utf8", env: { ...process.env, CHROMIUM: "/nowhere" } });
  assert.equal(missing.status, 2, missing.stderr);
  assert.match(missing.stderr, /--still: the browser ended/);
  assert.ok(!fs.existsSync(picture));
});

// A shallow pocket: seconds to plan and to cut in any build.
function smallJob(jobName) {
  const job = path.join(top, "examples", "grid_pocket", "rectangle.toml"), program = path.join(folder, "rectangle.ngc");
  run("plan", job, "-o", program);
  const copy = write(jobName, fs.readFileSync(job, "utf8").replaceAll("../parts/", path.join(top, "examples", "parts") + "/"));
  return { job: copy, program };
}

test("with a job: stock at the cursor, bounds, and the worst places", async () => {
  const { job, program } = smallJob("job <img src=x onerror=window.hacked=1>.toml");
  const gouged = write("gouged.ngc", fs.readFileSync(program, "utf8").replace(/M5\s+M30\s*$/, "G0 X1.5 Y1\nG1 Z-1 F20\nG0 Z0.2\nM5\nM30\n"));
  run("verify", job, gouged, "--stats", path.join(folder, "verify.json"));
  const stats = JSON.parse(fs.readFileSync(path.join(folder, "verify.json"), "utf8"));
  const { page, faults, close } = await openPage(browser, pageOf(gouged, "--job", job).file);
  const facts = await page.evaluate(() => window.cusp.facts);
  assert.ok(Math.abs(facts.gouge_max_mm - stats.gouge_max_mm) < 1e-6);
  assert.ok(Math.abs(facts.scallop_max_mm - stats.scallop_max_mm) < 1e-6);
  assert.ok(stats.gouge_max_mm > 1 && facts.worst.length > 0 && facts.worst.length <= 10);
  assert.equal(facts.worst[0].kind, "gouge");
  assert.ok(Math.abs(facts.worst[0].mm - stats.gouge_max_mm) < 1e-6);
  assert.ok(Math.hypot(facts.worst[0].at[0] - 38.1, facts.worst[0].at[1] - 25.4) < 4);
  assert.match(await page.locator(".verdict").innerText(), /bounds are broken/);
  for (const name of ["rapids", "path", "tool"]) await page.locator(`#show-${name}`).uncheck();
  await seek(page, 0);
  const uncut = await pictureOf(page);
  const end = (await seek(page, 1e9)).t_s;
  const cut = await pictureOf(page);
  assert.notEqual(uncut, cut);
  await seek(page, end / 2);
  assert.ok(![uncut, cut].includes(await pictureOf(page)));
  await seek(page, 0);
  assert.equal(await pictureOf(page), uncut, "the stock is whole again");
  await page.evaluate(() => window.cusp.show("left"));
  await seek(page, 1e9);
  const before = await page.evaluate((at) => window.cusp.project(at), facts.worst[0].at);
  await page.locator(".worst button").first().click();
  await page.waitForFunction((b) => { const now = window.cusp.project(window.cusp.facts.worst[0].at); return Math.hypot(now[0] - b[0], now[1] - b[1]) > 1; }, before);
  assert.equal(await page.evaluate(() => window.hacked), undefined);
  assert.deepEqual(faults, []);
  await close();
});

// The corners of a closed loop as a DXF.
const outline = (corners) => ["0", "SECTION", "2", "ENTITIES", "0", "LWPOLYLINE", "8", "0", "90", String(corners.length), "70", "1",
  ...corners.flatMap(([x, y]) => ["10", String(x), "20", String(y)]), "0", "ENDSEC", "0", "EOF", ""].join("\n");

// A slot of 40 mm through the stock, air on the way back, a step aside, then a pass at 60 degrees, and again air.
test("with a job: the engagement of the tool at the cursor, and its chart", async () => {
  const job = write("engagement.toml", `units = "mm"
[tool]
shape = "flat"
diameter = 6.0
[cutting]
feed = 600.0
plunge_feed = 300.0
[stock]
top = 0.0
bottom = -10.0
x = [0.0, 50.0]
y = [0.0, 40.0]
[[operation]]
strategy = "pocket"
boundary = "outline.dxf"
depth = 2.0
clearing = "adaptive"
max_engagement = 90.0
`);
  write("outline.dxf", outline([[2, 2], [48, 2], [48, 38], [2, 38]]));
  const program = write("slot.ngc", "G21 G90 F600\nG0 Z5\nG0 X5 Y20\nG1 Z-2\nG1 X45\nG1 X5\nG1 Y21.5\nG1 X45\nG1 X5\nG0 Z5\nM30\n");
  const { page, faults, close } = await openPage(browser, pageOf(program, "--job", job).file);
  assert.ok(await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => {
    const list = document.querySelector(".program-list").getBoundingClientRect();
    const row = document.querySelector(".program-row[aria-selected=true]")?.getBoundingClientRect();
    done(row !== undefined && row.top >= list.top - 1 && row.bottom <= list.bottom + 1);
  })))), "the line at the cursor is in sight, beside five charts too");
  const expected = { 2: 0, 3: 0, 5: 180, 6: 0, 8: 60, 9: 0 };
  for (const [line, degrees] of Object.entries(expected)) {
    for (const share of [0.3, 0.5, 0.7]) {
      const [from, to] = await page.evaluate((k) => window.cusp.linesAt(k), Number(line));
      const at = await seek(page, from + share * (to - from));
      assert.equal(at.line, Number(line));
      assert.ok(Math.abs(at.engagement_deg - degrees) <= 3, `line ${line}: ${at.engagement_deg} degrees, not ${degrees}`);
    }
  }
  assert.equal(await page.locator(".charts .chart").count(), 5);
  assert.match(await page.locator(".charts").innerText(), /Engagement\s+degrees/);
  assert.match(await page.locator(".facts").innerText(), /Engagement\s+180 °\s+90 °\s+[\d.]+ mm over/);
  assert.match(await page.locator(".readout").innerText(), /Engagement\s*0°/);
  assert.deepEqual(faults, []);
  await close();
  const bare = await openPage(browser, pageOf(program).file);
  assert.equal(await bare.page.locator(".charts .chart").count(), 4);
  assert.equal((await state(bare.page)).engagement_deg, undefined);
  await bare.close();
});

test("run() gives what cusp sim gives, or says that there is no core", async () => {
  const program = path.join(programs, "square.ngc"), { stats } = figures(program);
  const { page, faults, close } = await openPage(browser, pageOf(program).file);
  const answer = await page.evaluate((text) => window.cusp.run(text, "").then((result) => ({ result }), (error) => ({ error: String(error) })), fs.readFileSync(program, "utf8"));
  if (answer.error) assert.match(answer.error, /without the WebAssembly/);
  else for (const name of ["duration_s", "steps", "end_mpos_mm", "edges_crc32"]) assert.deepEqual(answer.result[name], stats[name], name);
  assert.deepEqual(faults, []);
  await close();
});

test("contrast, names and focus hold in light and dark, narrow and wide", async () => {
  const { job, program } = smallJob("job.toml"), { file } = pageOf(program, "--job", job);
  for (const dark of [false, true]) {
    for (const width of [390, 1280]) {
      const { page, faults, close } = await openPage(browser, file, { dark, width });
      await page.evaluate(() => window.cusp.show("left"));
      await page.evaluate(axeSource);
      const found = await page.evaluate(() => window.axe.run(document, { resultTypes: ["violations"] }));
      assert.deepEqual(found.violations.map((v) => `${v.id}: ${v.nodes.slice(0, 3).map((n) => n.html.slice(0, 120)).join(" | ")}`), [], `dark ${dark}, ${width} px`);
      assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "nothing sticks out");
      assert.deepEqual(faults, []);
      await close();
    }
  }
});

test("damaged data are refused in words", async () => {
  const { file } = pageOf(path.join(programs, "square.ngc"));
  const text = fs.readFileSync(file, "utf8"), at = text.indexOf('id="data-path">') + 20;
  const damaged = path.join(folder, "damaged.html");
  fs.writeFileSync(damaged, text.slice(0, at) + "zzzzzzzz" + text.slice(at + 8));
  const context = await browser.newContext(), page = await context.newPage();
  await page.goto("file://" + damaged);
  const reason = await page.evaluate(() => window.cusp.ready.then(() => "", (error) => String(error)));
  assert.match(reason, /damaged/);
  assert.match(await page.locator(".status").innerText(), /damaged/);
  await context.close();
});
