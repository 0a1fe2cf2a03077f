// The builds of both npm packages share options, tools, dist/ and types.
import { existsSync, mkdirSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const web = join(dirname(fileURLToPath(import.meta.url)), "../web");

// The folder or file that --name gives, else the standard one.
export function option(name, standard) {
  const at = process.argv.indexOf("--" + name);
  return resolve(at < 0 ? standard : process.argv[at + 1]);
}

// An empty dist/ in `out`, and esbuild and typescript out of --modules: by default those of web/. Ends the process where a
// file is missing: `needed` has pairs of a file and what makes it.
export function begin(name, out, needed) {
  const modules = option("modules", join(web, "node_modules"));
  for (const [file, remedy] of [...needed, [modules, "npm ci in host_tools/judge/view/web"]]) {
    if (!existsSync(file)) {
      console.error(`${name}: ${file} is missing: ${remedy}`);
      process.exit(2);
    }
  }
  const require = createRequire(join(modules, "x.js"));
  const dist = join(out, "dist");
  rmSync(dist, { recursive: true, force: true });
  mkdirSync(dist, { recursive: true });
  return { dist, buildSync: require("esbuild").buildSync, typescript: require("typescript") };
}

// Writes the types of `sources` that `names` keeps, with paths changed from `path` to `becomes`. Ends the process where one of
// the sources has a fault.
export function writeTypes({ dist, typescript }, here, sources, names, path, becomes) {
  const program = typescript.createProgram(sources.map((file) => join(here, file)), {
    target: typescript.ScriptTarget.ES2022, lib: ["lib.es2022.d.ts", "lib.dom.d.ts"], strict: true, declaration: true,
    emitDeclarationOnly: true, module: typescript.ModuleKind.ESNext, types: [], skipLibCheck: true,
    moduleResolution: typescript.ModuleResolutionKind.Bundler,
  });
  // the types of node's own modules are not among those of web/
  const faults = typescript.getPreEmitDiagnostics(program).filter((fault) => !String(fault.messageText).includes("'node:"));
  if (faults.length > 0) {
    console.error(typescript.formatDiagnostics(faults, { getCurrentDirectory: () => here, getCanonicalFileName: (f) => f, getNewLine: () => "\n" }));
    process.exit(1);
  }
  program.emit(undefined, (file, text) => {
    const name = file.split("/").at(-1);
    if (names.includes(name)) {
      writeFileSync(join(dist, name), text.replaceAll(path, becomes));
    }
  });
}
