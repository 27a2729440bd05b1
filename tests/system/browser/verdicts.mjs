// node verdicts.mjs API MODULE JSON THETA: the verdicts of an arm are in every digit what `crescent check ARM --wo THETA
// --json JSON` says.
import { readFileSync } from "node:fs";
import { isDeepStrictEqual } from "node:util";
const [file, compiled, native, angle] = process.argv.slice(2);
const { Api } = await import(file);
const api = new Api(await WebAssembly.compile(readFileSync(compiled)));

function hold(is, words) { if (!is) throw new Error(words); }

const { verdicts } = JSON.parse(readFileSync(native, "utf8")), arm = verdicts[0].arm;
let compared = 0;
for (const { case: at, verdicts: of } of api.json("checked", { sampler: arm, theta: Number(angle) }).cases)
  for (const { name, state, message, evidence } of of) {
    const there = verdicts.find((v) => v.case === at && v.name === name);
    hold(there && isDeepStrictEqual({ state, message, evidence }, { state: there.state, message: there.message, evidence: there.evidence }),
      `${arm}, ${at}, ${name}: ${JSON.stringify({ state, message, evidence })}, not ${JSON.stringify(there)}`);
    ++compared;
  }
hold(compared === verdicts.filter((v) => v.name !== "efficiency").length, `${compared} verdicts of ${verdicts.length}`);
console.log(`${compared} verdicts of ${arm} as from the program`);
