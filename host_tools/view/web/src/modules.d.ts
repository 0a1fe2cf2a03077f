// What build.mjs makes of imports that are no TypeScript.
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
