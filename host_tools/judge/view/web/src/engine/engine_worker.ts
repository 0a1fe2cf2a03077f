// The planners' worker: one call after the other, each blocks until its answer is there.
import { Client, ClientError, makeModule } from "engine-client";
import type { FromEngineWorker, ToEngineWorker } from "./engine_messages";

let client: Promise<Client> | null = null;

const tell = (message: FromEngineWorker, moved: Transferable[] = []): void => {
  (self as unknown as { postMessage(message: FromEngineWorker, moved: Transferable[]): void }).postMessage(message, moved);
};

const faultOf = ({ kind, text, file, line, place, key, value, limit }: ClientError): object => ({ kind, text, file, line, place, key, value, limit });

async function answer(name: string, args: unknown, files: [string, Uint8Array][]): Promise<void> {
  const now = await client!;
  try {
    const { result, blocks } = now.call(name, args as object, new Map(files), { progress: ({ share, text }) => { tell({ share, text }); } });
    const list = [...blocks];
    tell({ answer: JSON.stringify({ ok: true, result }), blocks: list, ended: false }, list.map(([, bytes]) => bytes.buffer as ArrayBuffer));
  } catch (reason) {
    const error = reason instanceof ClientError ? faultOf(reason) : { kind: "internal", text: String(reason) };
    tell({ answer: JSON.stringify({ ok: false, error }), blocks: [], ended: !now.isAlive });
  }
}

self.onmessage = ({ data }: MessageEvent<ToEngineWorker>) => {
  if ("module" in data) client = Client.create(makeModule, data.module);
  else void answer(data.name, data.args, data.files);
};
