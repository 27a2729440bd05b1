// node hashes.mjs BUNDLE MODULE FILE...: what hashes.ts says of these experiments.
import { readFileSync } from "node:fs";
const [bundle, module, ...files] = process.argv.slice(2);
(0, eval)(readFileSync(bundle, "utf8"));
const compiled = await WebAssembly.compile(readFileSync(module));
for (const file of files) for (const line of globalThis.crescentHashes(compiled, file, readFileSync(file, "utf8"))) console.log(line);
