// Bundles the pages: one HTML file each, script (deflated) and style inside, and a policy that forbids every request.
//
//   node build.mjs --out FOLDER [--core CORE.wasm] [--engine FOLDER --client CLIENT.ts] [--compare FOLDER]
//
// src/NAME_page.ts (or .tsx), NAME.html, page.css and NAME.css make FOLDER/NAME.html. --core: the firmware's core in WebAssembly, which
// `import wasm from "core-wasm"` gives as base64 ("" without). --engine: engine.mjs and engine.wasm of the preset wasm-engine, and the
// planners' client, host_tools/cam/engine/npm/page_client.ts: studio.html holds the planners then. `import text from "worker:./x.ts"` gives the bundle of
// a worker as text. --compare: exit status 1 where a page of that folder, unpacked, is not the same byte for byte.
import { createHash } from "node:crypto";
import { existsSync, mkdirSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { deflateRawSync, inflateRawSync } from "node:zlib";
import { build } from "esbuild";

const here = dirname(fileURLToPath(import.meta.url));
const option = (name) => {
  const at = process.argv.indexOf("--" + name);
  return at < 0 ? "" : process.argv[at + 1];
};
const out = resolve(option("out") || "out");
const core = option("core"), engine = option("engine"), client = option("client");

const settings = {
  bundle: true, minify: true, format: "iife", target: "es2022", write: false, legalComments: "none",
  absWorkingDir: here, loader: { ".css": "text", ".ngc": "text" }, jsx: "automatic", jsxImportSource: "preact",
};

async function bundled(entry) {
  const result = await build({ ...settings, entryPoints: [entry], plugins: [inlined] });
  return result.outputFiles[0].text;
}

// Imports that are bundled as text.
const inlined = {
  name: "inlined",
  setup(build) {
    build.onResolve({ filter: /^worker:/ }, (a) => ({ path: resolve(a.resolveDir, a.path.slice(7)), namespace: "worker" }));
    build.onLoad({ filter: /.*/, namespace: "worker" }, async (a) => ({ contents: await bundled(a.path), loader: "text" }));
    build.onResolve({ filter: /^(core-wasm|licences)$/ }, (a) => ({ path: a.path, namespace: "inlined" }));
    build.onLoad({ filter: /^core-wasm$/, namespace: "inlined" }, () => ({
      contents: core ? readFileSync(core).toString("base64") : "", loader: "text",
    }));
    build.onResolve({ filter: /^engine-(wasm|client|module)$/ }, (a) => a.path === "engine-wasm" ? { path: a.path, namespace: "inlined" }
      : { path: a.path === "engine-module" ? resolve(engine, "engine.mjs") : client ? resolve(client) : join(here, "src/engine/no_client.ts") });
    build.onLoad({ filter: /^engine-wasm$/, namespace: "inlined" }, () => ({
      contents: engine ? deflateRawSync(readFileSync(join(engine, "engine.wasm")), { level: 9 }).toString("base64") : "", loader: "text",
    }));
    build.onLoad({ filter: /^licences$/, namespace: "inlined" }, () => ({ contents: licences(), loader: "text" }));
  },
};

// The licences of bundled packages.
function licences() {
  return ["@preact/signals", "preact", "smol-toml", "three", "uplot"].map((name) => {
    const folder = join(here, "node_modules", name);
    const { version } = JSON.parse(readFileSync(join(folder, "package.json"), "utf8"));
    return `${name} ${version}\n\n${readFileSync(join(folder, "LICENSE"), "utf8").trim()}\n`;
  }).join("\n\n");
}

const hash = (text) => `'sha256-${createHash("sha256").update(text).digest("base64")}'`;

// Requests that the page may make: the studio asks the server that it comes from, which a file has not.
const requests = { studio: " connect-src 'self';" };

// `start` unpacks `script` and runs it; the content security policy permits these two.
function page(name, start, script, style) {
  for (const closing of ["</script", "<!--"]) {
    if (start.toLowerCase().includes(closing)) throw new Error(`${name}: the script holds ${closing}`);
  }
  const policy = `default-src 'none'; script-src ${hash(start)} ${hash(script)} 'wasm-unsafe-eval' blob:; style-src ${hash(style)};${requests[name] ?? ""} ` +
    "worker-src blob:; img-src data: blob:; base-uri 'none'; form-action 'none'";
  return readFileSync(join(here, name + ".html"), "utf8")
    .replace("@POLICY@", () => policy)
    .replace("@STYLE@", () => style)
    .replace("@PACKED_SCRIPT@", () => deflateRawSync(script, { level: 9 }).toString("base64"))
    .replace("@START@", () => start);
}

// A page with its script unpacked: versions of zlib deflate one script to different bytes.
const unpacked = (page) => page.replace(/(id="packed-script">)([^<]*)/, (_, tag, packed) =>
  tag + inflateRawSync(Buffer.from(packed, "base64")).toString());

mkdirSync(out, { recursive: true });
writeFileSync(join(out, "LICENCES.txt"), licences());
const start = (await bundled(join(here, "src", "start.ts"))).trim();
const pages = {};
for (const name of ["view", "playground", "studio"]) {
  const entry = ["ts", "tsx"].map((ending) => join(here, "src", `${name}_page.${ending}`)).find(existsSync) ?? "";
  pages[name] = "";
  if (entry) {
    const style = ["node_modules/uplot/dist/uPlot.min.css", "page.css", name + ".css"].filter((file) => existsSync(join(here, file)))
      .map((file) => readFileSync(join(here, file), "utf8").trim()).join("\n");
    pages[name] = page(name, start, (await bundled(entry)).trim(), style);
    writeFileSync(join(out, name + ".html"), pages[name]);
    console.log(`${name}.html ${(pages[name].length / 1024).toFixed(0)} KiB`);
  }
}
if (option("compare")) {
  for (const name of readdirSync(option("compare")).filter((file) => file.endsWith(".html")).map((file) => file.slice(0, -5))) {
    if (unpacked(readFileSync(join(option("compare"), name + ".html"), "utf8")) === unpacked(pages[name] ?? "")) {
      console.log(`${name}.html is what the sources make`);
      continue;
    }
    console.error(`${name}.html in ${option("compare")} is not what the sources make: cmake --build --preset dev --target view_bundle`);
    process.exitCode = 1;
  }
}
