// Builds dist/ of the package: script, types, module and licence. `npm pack` calls it.
//
//   node build.mjs [--out FOLDER] [--core CORE.wasm] [--modules FOLDER/node_modules]
//
// --out: a whole package there, not dist/ here. --core: build/wasm's by default. --modules: where esbuild and
// typescript are: ../web/node_modules by default, which `npm ci` in ../web fills.
import { copyFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { begin, option, writeTypes } from "./package_build.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const top = join(here, "../../../..");
const core = option("core", join(top, "build/wasm/bin/cusp_core.wasm"));
const out = option("out", here);

const build = begin("cusp-core", out, [[core, "cmake --preset wasm && cmake --build --preset wasm"]]);
build.buildSync({
  entryPoints: [join(here, "index.ts")], outfile: join(build.dist, "index.js"), bundle: true, format: "esm", target: "es2022",
  external: ["node:*"], logLevel: "warning",
});
writeTypes(build, here, ["index.ts"], ["index.d.ts", "core.d.ts"], "../web/src/core/core", "./core.js");
copyFileSync(core, join(build.dist, "cusp_core.wasm"));
copyFileSync(join(top, "LICENSE"), join(out, "LICENSE"));
if (out !== here) for (const file of ["package.json", "README.md"]) copyFileSync(join(here, file), join(out, file));
