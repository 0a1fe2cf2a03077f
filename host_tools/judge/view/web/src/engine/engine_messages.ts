// Messages between the page and the worker of the planners.

export type ToEngineWorker = { module: WebAssembly.Module } | { name: string; args: unknown; files: [string, Uint8Array][] };

/** The share of the work at hand; or the answer as JSON, with its blocks. `ended`: the planners have to be started anew. */
export type FromEngineWorker = { share: number; text: string } | { answer: string; blocks: [string, Uint8Array][]; ended: boolean };
