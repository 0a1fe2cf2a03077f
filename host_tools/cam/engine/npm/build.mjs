// Builds dist/ of the package: script, types, module and licence. `npm pack` calls it.
//
//   node build.mjs [--out FOLDER] [--engine FOLDER] [--modules FOLDER/node_modules]
//
// --out: a whole package there, not dist/ here. --engine: where engine.mjs and engine.wasm are: build/wasm-engine/bin by
// default. --modules: where esbuild and typescript are: those of host_tools/judge/view/web by default.
import { copyFileSync, existsSync, mkdirSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const top = join(here, "../../../..");
const option = (name, standard) => {
  const at = process.argv.indexOf("--" + name);
  return resolve(at < 0 ? standard : process.argv[at + 1]);
};
const engine = option("engine", join(top, "build/wasm-engine/bin"));
const modules = option("modules", join(top, "host_tools/judge/view/web/node_modules"));
const out = option("out", here);

for (const [file, remedy] of [[join(engine, "engine.wasm"), "cmake --preset wasm-engine && cmake --build --preset wasm-engine"],
  [modules, "npm ci in host_tools/judge/view/web"]]) {
  if (!existsSync(file)) {
    console.error(`cusp-engine: ${file} is missing: ${remedy}`);
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
  alias: { "engine-module": join(engine, "engine.mjs") }, external: ["node:*"], minifySyntax: true, minifyWhitespace: true,
  logLevel: "warning",
});
writeTypes();
copyFileSync(join(engine, "engine.wasm"), join(dist, "engine.wasm"));
copyFileSync(join(top, "LICENSE"), join(out, "LICENSE"));
if (out !== here) for (const file of ["package.json", "README.md", "example.mjs"]) copyFileSync(join(here, file), join(out, file));

// index.d.ts, and engine.d.ts to which it refers.
function writeTypes() {
  const program = typescript.createProgram([join(here, "index.ts"), join(here, "engine_module.d.ts")], {
    target: typescript.ScriptTarget.ES2022, lib: ["lib.es2022.d.ts", "lib.dom.d.ts"], strict: true, declaration: true,
    emitDeclarationOnly: true, module: typescript.ModuleKind.ESNext, types: [], skipLibCheck: true,
    moduleResolution: typescript.ModuleResolutionKind.Bundler,
  });
  const faults = typescript.getPreEmitDiagnostics(program);
  if (faults.length > 0) {
    console.error(typescript.formatDiagnostics(faults, { getCurrentDirectory: () => here, getCanonicalFileName: (f) => f, getNewLine: () => "\n" }));
    process.exit(1);
  }
  program.emit(undefined, (file, text) => {
    const name = file.split("/").at(-1);
    if (name === "index.d.ts" || name === "engine.d.ts") {
      writeFileSync(join(dist, name), text.replaceAll('"./engine"', '"./engine.js"'));
    }
  });
}
