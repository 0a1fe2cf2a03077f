// The worker that unpacks a run to arrays.
import { inflate } from "./inflate";
import type { Run, Triple } from "./run_data";
import { bytesOfText, lineStarts, measure, unpackLeft, unpackLineRuns, unpackPath, unpackSamples, unpackStock } from "./unpack";

// The text of a page, or the bytes that it stands for; empty: the run has none.
export type Block = string | Uint8Array;

export interface UnpackRequest {
  samples: Block; lines: Block; path: Block; program: Block; rapid: Block; stock: Block; left: Block; engagement: Block;
  limits: Triple[];  // velocity, acceleration, jerk
  farthest: number;  // nm from the first set point
}
export type UnpackAnswer = { begun: true } | { run: Run } | { failed: string };

const bytesOf = (block: Block): Uint8Array => typeof block === "string" ? bytesOfText(block) : block;

async function unpack(request: UnpackRequest): Promise<Run> {
  const inflated = (block: Block) => inflate(bytesOf(block));
  const samples = await unpackSamples(bytesOf(request.samples), request.farthest);
  const path = unpackPath(await inflated(request.path));
  const program = await inflated(request.program);
  const stock = request.stock.length > 0 ? await unpackStock(bytesOf(request.stock)) : null;
  const engagement = request.engagement.length > 0 ? await inflated(request.engagement) : null;
  return {
    ...samples, ...unpackLineRuns(await inflated(request.lines)), ...path,
    ...measure(samples, path.vertexTick, request.limits, engagement), engagement,
    program, lineStart: lineStarts(program), rapid: await inflated(request.rapid), stock,
    left: stock && request.left.length > 0 ? await unpackLeft(bytesOf(request.left), stock.nx * stock.ny) : null,
  };
}

// All buffers of a value, to transfer instead of copy them.
function buffersOf(value: unknown, found = new Set<ArrayBuffer>()): Set<ArrayBuffer> {
  if (ArrayBuffer.isView(value)) found.add(value.buffer as ArrayBuffer);
  else if (value !== null && typeof value === "object") for (const part of Object.values(value)) buffersOf(part, found);
  return found;
}

self.onmessage = (event: MessageEvent<UnpackRequest>) => {
  self.postMessage({ begun: true } satisfies UnpackAnswer);
  unpack(event.data).then(
    (run) => self.postMessage({ run } satisfies UnpackAnswer, { transfer: [...buffersOf(run)] }),
    (error: unknown) => self.postMessage({ failed: String(error) } satisfies UnpackAnswer));
};
