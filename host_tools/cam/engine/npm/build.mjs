// Builds dist/ of the package: script, types, module and licence. `npm pack` calls it.
//
//   node build.mjs [--out FOLDER] [--engine FOLDER] [--modules FOLDER/node_modules]
//
// --out: a whole package there, not dist/ here. --engine: where engine.mjs and engine.wasm are: build/wasm-engine/bin by
// default. --modules: where esbuild and typescript are: those of host_tools/judge/view/web by default.
import { copyFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { begin, option, writeTypes } from "../../../judge/view/npm/package_build.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const top = join(here, "../../../..");
const engine = option("engine", join(top, "build/wasm-engine/bin"));
const out = option("out", here);

const build = begin("cusp-engine", out,
  [[join(engine, "engine.wasm"), "cmake --preset wasm-engine && cmake --build --preset wasm-engine"]]);
build.buildSync({
  entryPoints: [join(here, "index.ts")], outfile: join(build.dist, "index.js"), bundle: true, format: "esm", target: "es2022",
  alias: { "engine-module": join(engine, "engine.mjs") }, external: ["node:*"], minifySyntax: true, minifyWhitespace: true,
  logLevel: "warning",
});
writeTypes(build, here, ["index.ts", "engine_module.d.ts"], ["index.d.ts", "engine.d.ts"], '"./engine"', '"./engine.js"');
copyFileSync(join(engine, "engine.wasm"), join(build.dist, "engine.wasm"));
copyFileSync(join(top, "LICENSE"), join(out, "LICENSE"));
if (out !== here) for (const file of ["package.json", "README.md", "example.mjs"]) copyFileSync(join(here, file), join(out, file));
