// node exports.mjs BUNDLE MODULE FOLDER: writes into it the programs that the page exports, NAME.mjs, and expected.json,
// for exports.py.
import { readFileSync, writeFileSync } from "node:fs";
const [bundle, compiled, folder] = process.argv.slice(2);
const { exportsOf } = await import(bundle);
const all = exportsOf(await WebAssembly.compile(readFileSync(compiled)));
for (const { name, program } of all) writeFileSync(`${folder}/${name}.mjs`, program);
writeFileSync(`${folder}/expected.json`, JSON.stringify(Object.fromEntries(all.map(({ name, states }) => [name, states]))));
