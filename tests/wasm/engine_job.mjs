// Plans, verifies and simulates a job in WebAssembly: engine_package.py compares the answer with the program.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { plan, simulate, verify } from "cusp-engine";

const { folder, job, files: names, figures } = JSON.parse(readFileSync(0, "utf8"));
const files = new Map(names.map((name) => [name, readFileSync(join(folder, name))]));
const text = readFileSync(join(folder, job), "utf8");
const answer = {};
for (const { name, gcode } of await plan(text, files, { name: job })) {
  answer[name] = { gcode };
  if (figures) {
    const after = [...files.keys()].filter((file) => file in answer);
    answer[name].verify = (await verify(text, gcode, files, { name: job, after })).stats;
    answer[name].sim = (await simulate(gcode)).stats;
  }
  files.set(name, gcode);
}
process.stdout.write(JSON.stringify(answer));
