// The engine behind the server that `cusp studio` runs on this machine: all cores, and every format that it reads.
import { resultOf } from "./engine";
import type { Answer, AnswerLine, Calls, CallOptions, Engine, EngineFacts, FileSet } from "./engine";

interface Line { progress?: { share: number; text: string }; answer?: unknown; blocks?: { name: string; size: number }[] }

// Reads a stream by lines, and then by counted bytes.
class ByteReader {
  private held = new Uint8Array();

  constructor(private readonly source: ReadableStreamDefaultReader<Uint8Array>) {}

  private async more(): Promise<boolean> {
    const { value, done } = await this.source.read();
    if (done) return false;
    const joined = new Uint8Array(this.held.length + value.length);
    joined.set(this.held);
    joined.set(value, this.held.length);
    this.held = joined;
    return true;
  }

  async line(): Promise<string | null> {
    for (let from = 0; ;) {
      const end = this.held.indexOf(10, from);
      if (end >= 0) {
        const text = new TextDecoder().decode(this.held.subarray(0, end));
        this.held = this.held.slice(end + 1);
        return text;
      }
      from = this.held.length;
      if (!await this.more()) return null;
    }
  }

  // The bytes of a block of known size, without joining piece by piece.
  async bytes(size: number): Promise<Uint8Array> {
    const out = new Uint8Array(size);
    let at = Math.min(size, this.held.length);
    out.set(this.held.subarray(0, at));
    this.held = this.held.slice(at);
    while (at < size) {
      const { value, done } = await this.source.read();
      if (done) throw new Error("the answer of the planners is not complete");
      const taken = Math.min(value.length, size - at);
      out.set(value.subarray(0, taken), at);
      at += taken;
      this.held = value.slice(taken);
    }
    return out;
  }
}

function requestOf(args: unknown, files: FileSet): Blob {
  const list = [...files].map(([name, bytes]) => ({ name, size: bytes.length }));
  const head = `${JSON.stringify({ arguments: args, files: list })}\n`;
  return new Blob([head, ...[...files.values()] as BlobPart[]], { type: "application/octet-stream" });
}

export class LoopbackEngine implements Engine {
  constructor(private readonly token: string) {}

  private async fetch(path: string, init: RequestInit = {}): Promise<Response> {
    let response: Response;
    try {
      response = await fetch(path, { ...init, headers: { "X-Cusp-Token": this.token } });
    } catch (reason) {
      if (init.signal?.aborted) throw reason;
      throw new Error("cusp studio does not answer: start it again, and open the address that it prints", { cause: reason });
    }
    if (response.status === 401) throw new Error("cusp studio was started anew: open the address that it prints");
    if (!response.ok) throw new Error(`cusp studio refuses the request: ${response.status} ${await response.text()}`);
    return response;
  }

  async facts(): Promise<EngineFacts> {
    return await (await this.fetch("/api/facts")).json() as EngineFacts;
  }

  /** Tells the server that this page is open, as long as it is. */
  async stayOpen(): Promise<void> {
    const reader = (await this.fetch("/api/open")).body!.getReader();
    while (!(await reader.read()).done);
  }

  async call<K extends keyof Calls>(name: K, args: Calls[K]["args"], files: FileSet, options: CallOptions = {}): Promise<Answer<Calls[K]["result"]>> {
    const response = await this.fetch(`/api/call/${name}`, { method: "POST", body: requestOf(args, files), signal: options.signal });
    const reader = new ByteReader(response.body!.getReader());
    for (let text = await reader.line(); text !== null; text = await reader.line()) {
      const line = JSON.parse(text) as Line;
      if (line.progress) options.progress?.(line.progress.share, line.progress.text);
      if (line.answer === undefined) continue;
      const blocks = new Map<string, Uint8Array>();
      for (const block of line.blocks ?? []) blocks.set(block.name, await reader.bytes(block.size));
      return { result: resultOf(line.answer as AnswerLine<Calls[K]["result"]>), blocks };
    }
    throw new Error("the planners ended without an answer");
  }
}

const kStored = "cusp-studio-token";

/** The engine of the server that this page comes from; null: it comes from a file. Takes the token out of the address. */
export function loopbackEngine(): LoopbackEngine | null {
  if (location.protocol !== "http:" || location.hostname !== "127.0.0.1") return null;
  const given = /^#([0-9a-f]{32})$/.exec(location.hash)?.[1];
  if (given) {
    sessionStorage.setItem(kStored, given);
    history.replaceState(null, "", "#part");
  }
  return new LoopbackEngine(given ?? sessionStorage.getItem(kStored) ?? "");
}
