// A project as a zip: job.toml and its files, so that `cusp plan job.toml` plans the same.
import { inflate } from "../inflate";
import type { FileSet } from "../engine/engine";

const kEntry = 0x02014b50, kFile = 0x04034b50, kEnd = 0x06054b50;
const kUtf8 = 0x800;
// 1 January 1980, which is where these dates begin: the same project is the same file.
const kDay = 0x21;

const crcTable = Uint32Array.from({ length: 256 }, (_, k) => {
  let c = k;
  for (let bit = 0; bit < 8; ++bit) c = c & 1 ? c >>> 1 ^ 0xedb88320 : c >>> 1;
  return c >>> 0;
});

export function crc32(bytes: Uint8Array): number {
  let c = 0xffffffff;
  for (const byte of bytes) c = crcTable[(c ^ byte) & 255] ^ c >>> 8;
  return (c ^ 0xffffffff) >>> 0;
}

// The fields that both headers of a file share, from the version on.
function fields(name: Uint8Array, bytes: Uint8Array): number[][] {
  const size = bytes.length;
  return [[20, 2], [kUtf8, 2], [0, 2], [0, 2], [kDay, 2], [crc32(bytes), 4], [size, 4], [size, 4], [name.length, 2], [0, 2]];
}

function record(...parts: number[][]): Uint8Array {
  const out = new Uint8Array(parts.reduce((sum, [, size]) => sum + size, 0)), view = new DataView(out.buffer);
  let at = 0;
  for (const [value, size] of parts) {
    if (size === 2) view.setUint16(at, value, true);
    else view.setUint32(at, value, true);
    at += size;
  }
  return out;
}

/** Files stored as they are. */
export function zipOf(files: FileSet): Blob {
  const body: Uint8Array[] = [], index: Uint8Array[] = [];
  let at = 0, indexSize = 0;
  for (const [text, bytes] of files) {
    const name = new TextEncoder().encode(text), shared = fields(name, bytes);
    const head = record([kFile, 4], ...shared), entry = record([kEntry, 4], [20, 2], ...shared, [0, 2], [0, 2], [0, 2], [0, 4], [at, 4]);
    body.push(head, name, bytes);
    index.push(entry, name);
    at += head.length + name.length + bytes.length;
    indexSize += entry.length + name.length;
  }
  const end = record([kEnd, 4], [0, 2], [0, 2], [files.size, 2], [files.size, 2], [indexSize, 4], [at, 4], [0, 2]);
  return new Blob([...body, ...index, end] as BlobPart[], { type: "application/zip" });
}

/** The files of a zip, stored or deflated. */
export async function filesOfZip(bytes: Uint8Array): Promise<Map<string, Uint8Array>> {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.length), files = new Map<string, Uint8Array>();
  let end = bytes.length - 22;
  while (end >= 0 && view.getUint32(end, true) !== kEnd) --end;
  if (end < 0) throw new Error("this is no zip file, or its end is missing");
  let at = view.getUint32(end + 16, true);
  for (let count = view.getUint16(end + 10, true); count > 0; --count) {
    if (view.getUint32(at, true) !== kEntry) throw new Error("the list of files of this zip is damaged");
    const method = view.getUint16(at + 10, true), size = view.getUint32(at + 20, true), nameSize = view.getUint16(at + 28, true);
    const name = new TextDecoder().decode(bytes.subarray(at + 46, at + 46 + nameSize)), head = view.getUint32(at + 42, true);
    const from = head + 30 + view.getUint16(head + 26, true) + view.getUint16(head + 28, true), data = bytes.subarray(from, from + size);
    if (method !== 0 && method !== 8) throw new Error(`${name}: packed by a method (${method}) that is not read`);
    if (!name.endsWith("/")) files.set(name, method === 8 ? await inflate(data) : data.slice());
    at += 46 + nameSize + view.getUint16(at + 30, true) + view.getUint16(at + 32, true);
  }
  return files;
}
