// Types of the imports that build.mjs resolves.
declare module "worker:*" {
  const script: string;
  export default script;
}
declare module "core-wasm" {
  const base64: string;
  export default base64;
}
declare module "licences" {
  const text: string;
  export default text;
}
declare module "*.ngc" {
  const program: string;
  export default program;
}
declare module "engine-wasm" {
  const deflatedBase64: string;
  export default deflatedBase64;
}
declare module "engine-client" {
  export class Client {
    readonly isAlive: boolean;
    static create(make: unknown, module: WebAssembly.Module): Promise<Client>;
    call(name: string, args: object, files: Map<string, Uint8Array>, options: { progress: (now: { share: number; text: string }) => void }):
      { result: unknown; blocks: Map<string, Uint8Array> };
  }
  export class ClientError extends Error {
    readonly kind: string;
    readonly text: string;
    readonly file?: string;
    readonly line?: number;
    readonly place?: string;
    readonly key?: string;
    readonly value?: string;
    readonly limit?: string;
  }
  export const makeModule: unknown;
}
