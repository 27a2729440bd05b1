// node tails.mjs API MODULE EXPERIMENT METRICS [SETTING...]: the tails of the page are those of the program's
// metrics.json, of regions of boxes and of objects.
import { readFileSync } from "node:fs";
const [file, compiled, experiment, metrics, ...set] = process.argv.slice(2);
const { Api } = await import(file);
const api = new Api(await WebAssembly.compile(readFileSync(compiled)));
const info = api.json("open", { file: experiment, text: readFileSync(experiment, "utf8"), set, published: "" });
const { runs } = JSON.parse(readFileSync(metrics, "utf8"));
let compared = 0;
for (const { arm, regions } of runs)
  for (const { name, box } of info.regions) {
    if (!regions[name].tail) continue;
    const { k, se } = api.json("tail", { arm, region: name, box });
    const { k: expected, se: error } = regions[name].tail;
    if (k !== expected || se !== error) throw new Error(`${arm} in ${name}: tail index ${k} ± ${se}, the program has ${expected} ± ${error}`);
    ++compared;
  }
if (compared < 4) throw new Error(`only ${compared} tails were compared`);
console.log(`${compared} tails of ${info.regions.length} regions are those of the program`);
