// An instance of the engine: calls with JSON and files, as host_tools/cam/engine/engine.hpp describes them.
// The module is emscripten's; nothing here knows node or a browser.

/** The module that emscripten makes of host_tools/cam/engine/wasm/engine_abi.cpp. */
export interface EngineModule {
  HEAPU8: Uint8Array;
  UTF8ToString(place: number): string;
  stringToUTF8(text: string, place: number, room: number): void;
  lengthBytesUTF8(text: string): number;
  _malloc(size: number): number;
  _free(place: number): void;
  _cusp_put_file(name: number, bytes: number, size: number): void;
  _cusp_forget_files(): void;
  _cusp_call(name: number, args: number): void;
  _cusp_answer(): number;
  _cusp_block_count(): number;
  _cusp_block_name(number: number): number;
  _cusp_block_bytes(number: number): number;
  _cusp_block_size(number: number): number;
  cuspProgress?: (share: number, text: string) => void;
  cuspCancelled?: () => boolean;
}
/** The bytes of engine.wasm, or what they compile to. */
export type EngineWasm = ArrayBuffer | Uint8Array | WebAssembly.Module;
export interface MakerOptions {
  wasmBinary?: ArrayBuffer | Uint8Array;
  instantiateWasm?: (imports: WebAssembly.Imports, done: (instance: WebAssembly.Instance) => void) => object;
  locateFile?: (name: string) => string;
  printErr?: (line: string) => void;
}
export type ModuleMaker = (options: MakerOptions) => Promise<EngineModule>;

const sourceOf = (wasm: EngineWasm): MakerOptions => !(wasm instanceof WebAssembly.Module) ? { wasmBinary: wasm } : {
  instantiateWasm: (imports, done) => {
    void WebAssembly.instantiate(wasm, imports).then(done);
    return {};
  },
  locateFile: (name) => name,  // nothing is fetched
};

/** Paths as jobs spell them, with bytes or text. */
export type Files = ReadonlyMap<string, Uint8Array | string> | Readonly<Record<string, Uint8Array | string>>;

export interface Progress {
  /** 0 to 1, of the piece of work that `text` names. */
  share: number;
  text: string;
}

export interface CallOptions {
  progress?: (progress: Progress) => void;
  /** Aborting it, as from `progress`, ends the call with an EngineError of the kind "cancelled". */
  signal?: AbortSignal;
}

/** A fault as far as it is known: `place` is the table of `key`, such as "operation 2". */
export interface Fault {
  text: string;
  file: string;
  line: number;
  place: string;
  key: string;
  value: string;
  limit: string;
}

export class EngineError extends Error implements Fault {
  readonly kind: "input" | "cancelled" | "memory" | "internal";
  readonly text: string;
  readonly file: string;
  readonly line: number;
  readonly place: string;
  readonly key: string;
  readonly value: string;
  readonly limit: string;

  constructor(error: Partial<Fault> & { kind: EngineError["kind"]; text: string }) {
    super(error.text);
    this.name = "EngineError";
    this.kind = error.kind;
    this.text = error.text;
    this.file = error.file ?? "";
    this.line = error.line ?? 0;
    this.place = error.place ?? "";
    this.key = error.key ?? "";
    this.value = error.value ?? "";
    this.limit = error.limit ?? "";
  }
}

export interface Answer {
  result: unknown;
  blocks: Map<string, Uint8Array>;
}

const entriesOf = (files: Files): Iterable<[string, Uint8Array | string]> =>
  files instanceof Map ? (files as Map<string, Uint8Array | string>).entries() : Object.entries(files as Record<string, Uint8Array | string>);

export class Engine {
  private broken = "";
  private lastWords = "";

  private constructor(private readonly module: EngineModule) {}

  static async create(make: ModuleMaker, wasm: EngineWasm): Promise<Engine> {
    let engine: Engine | null = null;
    const module = await make({ ...sourceOf(wasm), printErr: (line) => { if (engine) engine.lastWords = line; } });
    engine = new Engine(module);
    return engine;
  }

  /** False after a fault of the engine itself: another instance has to be made. */
  get isAlive(): boolean { return this.broken === ""; }

  /** Blocks until the answer is there. Throws EngineError. */
  call(name: string, args: object = {}, files: Files = {}, options: CallOptions = {}): Answer {
    if (!this.isAlive) throw new EngineError({ kind: "internal", text: this.broken });
    const { module } = this;
    module.cuspProgress = (share, text) => options.progress?.({ share, text });
    module.cuspCancelled = () => options.signal?.aborted ?? false;
    try {
      module._cusp_forget_files();
      for (const [path, bytes] of entriesOf(files)) this.put(path, bytes);
      this.withText(name, (called) => this.withText(JSON.stringify(args), (given) => module._cusp_call(called, given)));
      return this.answer();
    } catch (error) {
      if (error instanceof EngineError) throw error;
      // a trap: the memory of the instance is not to be trusted
      this.broken = `the engine ended: ${this.lastWords || String(error)}`;
      throw new EngineError({ kind: /memory|allocat/i.test(this.broken) ? "memory" : "internal", text: this.broken });
    } finally {
      if (this.isAlive) module._cusp_forget_files();
    }
  }

  private put(path: string, content: Uint8Array | string): void {
    const bytes = typeof content === "string" ? new TextEncoder().encode(content) : content;
    const place = this.module._malloc(Math.max(1, bytes.length));
    this.module.HEAPU8.set(bytes, place);
    this.withText(path, (name) => this.module._cusp_put_file(name, place, bytes.length));
    this.module._free(place);
  }

  private withText(text: string, use: (place: number) => void): void {
    const room = this.module.lengthBytesUTF8(text) + 1;
    const place = this.module._malloc(room);
    this.module.stringToUTF8(text, place, room);
    use(place);
    this.module._free(place);
  }

  private answer(): Answer {
    const { module } = this;
    const answer = JSON.parse(module.UTF8ToString(module._cusp_answer())) as { ok: boolean; result: unknown; error: Fault & { kind: EngineError["kind"] } };
    if (!answer.ok) throw new EngineError(answer.error);
    const blocks = new Map<string, Uint8Array>();
    for (let k = 0; k < module._cusp_block_count(); ++k) {
      const begin = module._cusp_block_bytes(k);
      blocks.set(module.UTF8ToString(module._cusp_block_name(k)), module.HEAPU8.slice(begin, begin + module._cusp_block_size(k)));
    }
    return { result: answer.result, blocks };
  }
}
