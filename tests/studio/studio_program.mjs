// Starts `cusp studio` for a test, and asks it with any headers: node's own http lets a test set Host and Origin.
import { spawn } from "node:child_process";
import http from "node:http";
import readline from "node:readline";

// The running server: its address, port and token, and a promise of its exit status.
export async function startStudio(cusp, ...options) {
  const child = spawn(cusp, ["studio", "--no-browser", ...options], { stdio: ["ignore", "pipe", "inherit"] });
  const ended = new Promise((done) => { child.on("exit", (status, signal) => done(signal ?? status)); });
  const lines = readline.createInterface({ input: child.stdout });
  const address = await new Promise((done) => { lines.once("line", done); });
  const [, port, token] = /^http:\/\/127\.0\.0\.1:(\d+)\/#([0-9a-f]{32})$/.exec(address) ?? [];
  if (!token) throw new Error(`no address: ${address}`);
  return { address, port: Number(port), token, pid: child.pid, ended, stop: () => child.kill() };
}

// Asks; the answer's body is text. `headers` replace those that the page sends; null takes one away.
export function ask({ port, token }, path, { method = "GET", body, headers = {}, onData, signal } = {}) {
  const all = { Host: `127.0.0.1:${port}`, "X-Cusp-Token": token, ...headers };
  for (const [name, value] of Object.entries(all)) if (value === null) delete all[name];
  return new Promise((done, fail) => {
    const request = http.request({ host: "127.0.0.1", port, path, method, headers: all, setHost: false, signal, agent: false }, (answer) => {
      const parts = [];
      answer.on("data", (part) => { parts.push(part); onData?.(part.toString()); });
      answer.on("end", () => done({ status: answer.statusCode, headers: answer.headers, bytes: Buffer.concat(parts), text: Buffer.concat(parts).toString() }));
      answer.on("error", fail);
    });
    request.on("error", fail);
    request.end(body);
  });
}

// The request of a call, as call.hpp has it.
export function callBody(args, files = {}) {
  const list = Object.entries(files).map(([name, bytes]) => [name, Buffer.from(bytes)]);
  const head = JSON.stringify({ arguments: args, files: list.map(([name, bytes]) => ({ name, size: bytes.length })) });
  return Buffer.concat([Buffer.from(head + "\n"), ...list.map(([, bytes]) => bytes)]);
}

// The answer of a call: its last line, and the blocks after it.
export function answerOf({ bytes }) {
  for (let at = 0; at < bytes.length;) {
    const end = bytes.indexOf(10, at), line = JSON.parse(bytes.subarray(at, end).toString());
    at = end + 1;
    if (!line.answer) continue;
    const blocks = {};
    for (const { name, size } of line.blocks) {
      blocks[name] = bytes.subarray(at, at + size);
      at += size;
    }
    return { ...line.answer, blocks };
  }
  throw new Error("no answer");
}

export const call = async (studio, name, args, files) =>
  answerOf(await ask(studio, `/api/call/${name}`, { method: "POST", body: callBody(args, files) }));
