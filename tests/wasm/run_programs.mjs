// Runs programs on the package cusp-core, one after the other, and prints what each gave as a line of JSON.
//
//   node run_programs.mjs PACKAGE/dist/index.js <LIST.json      [{"program": FILE, "settings": FILE or null}, ...]
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

const { simulate } = await import(pathToFileURL(process.argv[2]).href);
for (const { program, settings } of JSON.parse(readFileSync(0, "utf8"))) {
  const started = performance.now();
  const result = await simulate(readFileSync(program, "latin1"), settings ? readFileSync(settings, "utf8") : "");
  console.log(JSON.stringify({ ...result, wall_s: (performance.now() - started) / 1000 }));
}
