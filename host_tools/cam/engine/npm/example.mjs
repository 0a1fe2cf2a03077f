// From a mesh to verified G-code: node example.mjs part.stl part.ngc
import { readFileSync, writeFileSync } from "node:fs";
import { plan, simulate, suggest, verify } from "cusp-engine";

const [part, output] = process.argv.slice(2);
const files = { "part.stl": readFileSync(part) };

const { job, said } = await suggest(["part.stl"], ["flat:6", "ball:4"], files, { scallop: 0.05 });
console.log(said.join("\n"));
const [program] = await plan(job, files, { progress: ({ share, text }) => process.stderr.write(`\r${text} ${Math.round(100 * share)} %\x1b[K`) });
const { holds, broken } = await verify(job, program.gcode, files);
const { stats } = await simulate(program.gcode);
console.log(`${program.summary}${holds ? "all bounds hold" : broken.join("\n")}, ${Math.round(stats.duration_s)} s on the mill`);
writeFileSync(output, program.gcode);
