// Module that emscripten writes: build.mjs names the file.
declare module "engine-module" {
  const createEngine: unknown;
  export default createEngine;
}
declare module "node:fs/promises" {
  export function readFile(file: URL): Promise<Uint8Array>;
}
