// The server of `cusp studio`: who may ask, what a call gets, when it ends. node server_test.mjs CUSP TOP
import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import test, { after, before } from "node:test";
import { answerOf, ask, call, callBody, startStudio } from "./studio_program.mjs";

const [cusp, top] = process.argv.slice(2);
let studio;
before(async () => { studio = await startStudio(cusp, "--linger", "0.4"); });
after(() => studio.stop());

const part = "sine-hills.json";
const files = { [part]: fs.readFileSync(path.join(top, "examples", "parts", part)) };
// Minutes of work: it is always ended before.
const long = `units = "mm"\n[tool]\nshape = "ball"\ndiameter = 3\n[cutting]\nfeed = 1000\n[[operation]]\nstrategy = "adaptive_isocurve"\nfloor = "${part}"\nscallop = 0.00002\nfloor_tolerance = 0.00001\nplan_tolerance = 0.00001\n`;

// The processes that a process has started and that still live.
const childrenOf = (pid) => fs.readdirSync("/proc").filter((name) => /^\d+$/.test(name)).filter((name) => {
  try {
    const stat = fs.readFileSync(`/proc/${name}/stat`, "utf8");
    return Number(stat.slice(stat.lastIndexOf(")")).split(" ")[2]) === pid;
  } catch {
    return false;
  }
});
async function until(holds, what) {
  for (const end = Date.now() + 20_000; Date.now() < end;) {
    if (holds()) return;
    await new Promise((done) => { setTimeout(done, 20); });
  }
  assert.fail(what);
}

test("without the token, and with a wrong one, nothing is answered", async () => {
  for (const path of ["/api/facts", "/api/open", "/api/call/keys", "/elsewhere", "/api/../api/facts"]) {
    for (const given of [null, "", "0".repeat(32), studio.token.slice(1), studio.token + "0", studio.token.toUpperCase() + "x"]) {
      const method = path.includes("call") ? "POST" : "GET";
      assert.equal((await ask(studio, path, { method, headers: { "X-Cusp-Token": given } })).status, 401, `${path} ${given}`);
    }
  }
  assert.equal((await ask(studio, "/api/facts")).status, 200);
});

test("a foreign Host or Origin is refused, with the token too", async () => {
  const hosts = ["evil.example", `evil.example:${studio.port}`, `localhost:${studio.port}`, "127.0.0.1", `127.0.0.1:${studio.port}.evil.example`, `[::1]:${studio.port}`, null];
  for (const path of ["/", "/api/facts"]) {
    for (const Host of hosts) assert.notEqual((await ask(studio, path, { headers: { Host } })).status, 200, `Host ${Host}`);
    for (const Origin of ["null", "http://evil.example", "https://127.0.0.1:" + studio.port, `http://127.0.0.1:${studio.port + 1}`]) {
      assert.equal((await ask(studio, path, { headers: { Origin } })).status, 403, `Origin ${Origin}`);
    }
    assert.equal((await ask(studio, path, { headers: { Origin: `http://127.0.0.1:${studio.port}` } })).status, 200);
  }
});

test("no other address than 127.0.0.1 is listened at", () => {
  const port = studio.port.toString(16).toUpperCase().padStart(4, "0");
  const listening = (name) => fs.readFileSync(name, "utf8").split("\n").map((line) => line.trim().split(/\s+/))
    .filter((row) => row[3] === "0A" && row[1]?.endsWith(`:${port}`)).map((row) => row[1]);
  assert.deepEqual(listening("/proc/net/tcp"), [`0100007F:${port}`]);
  if (fs.existsSync("/proc/net/tcp6")) assert.deepEqual(listening("/proc/net/tcp6"), []);
});

test("the page says what it may do, and does not hold the token", async () => {
  const { headers, text } = await ask(studio, "/", { headers: { "X-Cusp-Token": null } });
  assert.match(headers["content-type"], /^text\/html/);
  assert.equal(headers["content-security-policy"], "frame-ancestors 'none'");
  assert.equal(headers["access-control-allow-origin"], undefined);
  assert.equal(headers["cache-control"], "no-store");
  assert.equal(headers["cross-origin-opener-policy"], "same-origin");
  assert.match(text, /Content-Security-Policy" content="default-src 'none'/);
  assert.ok(!text.includes(studio.token));
});

test("a call is answered, with progress, and with the program's own bytes", async () => {
  const { result: { job } } = await call(studio, "suggest", { parts: [part], tools: ["flat:10", "ball:8"], scallop: 0.5 }, files);
  const answer = await ask(studio, "/api/call/plan", { method: "POST", body: callBody({ job, name: "job.toml", program: "hills.ngc" }, files) });
  assert.match(answer.text.slice(0, 200), /^\{"progress":\{"share":/);
  const planned = answerOf(answer);
  assert.ok(planned.ok, JSON.stringify(planned.error));
  assert.match(planned.blocks[planned.result.programs[0].block].toString(), /^G1 /m);
});

test("a fault names its key, and no request makes the server fall", async () => {
  const { ok, error } = await call(studio, "plan", { job: long.replace("scallop = 0.00002", "scalop = 1"), name: "job.toml", program: "x.ngc" }, files);
  assert.equal(ok, false);
  assert.equal(error.kind, "input");
  assert.match(error.text, /scalop/);
  for (const body of ["", "{}", "\n", "[]\n", "{\"files\":[{\"name\":\"x\",\"size\":9}]}\nabc", "{\"files\":3}\n", "{\"files\":[{\"size\":-1}]}\n", "\xff\xfe\n"]) {
    const answer = answerOf(await ask(studio, "/api/call/keys", { method: "POST", body }));
    if (body !== "[]\n") assert.equal(answer.ok, false, JSON.stringify(body));
  }
  assert.equal((await call(studio, "no_such_call", {})).ok, false);
  for (const path of ["/api/call/KEYS", "/api/call/", "/api/call/a%2fb", "/api/call/" + "x".repeat(60)]) {
    assert.equal((await ask(studio, path, { method: "POST", body: callBody({}) })).status, 404, path);
  }
  assert.equal((await call(studio, "keys", {})).ok, true);
});

test("a request that is closed ends its call, and one that dies says so", async () => {
  assert.deepEqual(childrenOf(studio.pid), []);
  const stop = new AbortController();
  const asked = ask(studio, "/api/call/plan", { method: "POST", body: callBody({ job: long, name: "job.toml", program: "x.ngc" }, files), signal: stop.signal }).catch((reason) => reason.name);
  await until(() => childrenOf(studio.pid).length === 1, "the call has a process");
  stop.abort();
  const closed = Date.now();
  assert.equal(await asked, "AbortError");
  await until(() => childrenOf(studio.pid).length === 0, "its process has ended");
  assert.ok(Date.now() - closed < 5000);

  const killed = ask(studio, "/api/call/plan", { method: "POST", body: callBody({ job: long, name: "job.toml", program: "x.ngc" }, files) });
  await until(() => childrenOf(studio.pid).length === 1, "the call has a process");
  process.kill(Number(childrenOf(studio.pid)[0]), "SIGKILL");
  const { ok, error } = answerOf(await killed);
  assert.equal(ok, false);
  assert.match(error.text, /ended by signal 9/);
});

test("it ends with its last page, and not while one is open or is loaded again", async () => {
  const own = await startStudio(cusp, "--linger", "3"), pages = [new AbortController(), new AbortController()];
  const open = (page) => new Promise((done) => { void ask(own, "/api/open", { signal: page.signal, onData: done }).catch(() => undefined); });
  await open(pages[0]);
  await open(pages[1]);
  pages[0].abort();
  assert.equal(await Promise.race([own.ended, new Promise((done) => { setTimeout(done, 4000, "open"); })]), "open");
  pages[1].abort();
  await new Promise((done) => { setTimeout(done, 300); });
  const again = new AbortController();
  await open(again);
  assert.equal(await Promise.race([own.ended, new Promise((done) => { setTimeout(done, 4000, "open"); })]), "open");
  again.abort();
  assert.equal(await own.ended, 0);
});

test("a port that is taken is refused in words", async () => {
  const { spawnSync } = await import("node:child_process");
  const { status, stderr } = spawnSync(cusp, ["studio", "--no-browser", "--port", String(studio.port)], { encoding: "utf8", timeout: 10_000 });
  assert.equal(status, 2);
  assert.match(stderr, new RegExp(`cusp: cusp studio: port ${studio.port} of 127.0.0.1 can't be used`));
});
