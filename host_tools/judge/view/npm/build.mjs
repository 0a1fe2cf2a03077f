// Builds dist/ of the package: script, types, module and licence. `npm pack` calls it.
//
//   node build.mjs [--out FOLDER] [--core CORE.wasm] [--modules FOLDER/node_modules]
//
// --out: a whole package there, not dist/ here. --core: build/wasm's by default. --modules: where esbuild and
// typescript are: ../web/node_modules by default, which `npm ci` in ../web fills.
import { copyFileSync, existsSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const option = (name, standard) => {
  const at = process.argv.indexOf("--" + name);
  return resolve(at < 0 ? standard : process.argv[at + 1]);
};
const core = option("core", join(here, "../../../../build/wasm/bin/cusp_core.wasm"));
const modules = option("modules", join(here, "../web/node_modules"));
const out = option("out", here);

for (const [file, remedy] of [[core, "cmake --preset wasm && cmake --build --preset wasm"], [modules, "npm ci in host_tools/judge/view/web"]]) {
  if (!existsSync(file)) {
    console.error(`cusp-core: ${file} is missing: ${remedy}`);
    process.exit(2);
  }
}
const require = createRequire(join(modules, "x.js"));
const { buildSync } = require("esbuild");
const typescript = require("typescript");

const dist = join(out, "dist");
rmSync(dist, { recursive: true, force: true });
mkdirSync(dist, { recursive: true });
buildSync({
  entryPoints: [join(here, "index.ts")], outfile: join(dist, "index.js"), bundle: true, format: "esm", target: "es2022",
  external: ["node:*"], logLevel: "warning",
});
writeTypes();
copyFileSync(core, join(dist, "cusp_core.wasm"));
copyFileSync(join(here, "../../../../LICENSE"), join(out, "LICENSE"));
if (out !== here) for (const file of ["package.json", "README.md"]) copyFileSync(join(here, file), join(out, file));

// index.d.ts, and core.d.ts to which it refers.
function writeTypes() {
  const program = typescript.createProgram([join(here, "index.ts")], {
    target: typescript.ScriptTarget.ES2022, lib: ["lib.es2022.d.ts", "lib.dom.d.ts"], strict: true, declaration: true,
    emitDeclarationOnly: true, module: typescript.ModuleKind.ESNext, types: [], skipLibCheck: true,
    moduleResolution: typescript.ModuleResolutionKind.Bundler, noResolve: false,
  });
  program.emit(undefined, (file, text) => {
    const name = file.split("/").at(-1);
    if (name === "index.d.ts" || name === "core.d.ts") {
      writeFileSync(join(dist, name), text.replaceAll("../web/src/core/core", "./core.js"));
    }
  });
}
