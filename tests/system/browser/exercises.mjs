// node exercises.mjs BUNDLE MODULE PROGRAM: see exercises.ts; writes what the page exports of one template, for node.
import { readFileSync, writeFileSync } from "node:fs";
const [bundle, compiled, program] = process.argv.slice(2);
const { exerciseLines, exported, templates } = await import(bundle);
writeFileSync(program, exported("program", templates.mixture.code, templates.mixture.ground).text);
for (const line of exerciseLines(await WebAssembly.compile(readFileSync(compiled)))) console.log(line);
