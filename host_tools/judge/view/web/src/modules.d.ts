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
