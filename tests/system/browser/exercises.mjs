// node exercises.mjs BUNDLE MODULE: see exercises.ts.
import { readFileSync } from "node:fs";
const [bundle, compiled] = process.argv.slice(2);
const { exerciseLines } = await import(bundle);
for (const line of exerciseLines(await WebAssembly.compile(readFileSync(compiled)))) console.log(line);
