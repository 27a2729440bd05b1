// node verdicts.mjs DOOR MODULE JSON THETA: verdicts that pause are those that do not, for six planted faults; and those
// of an arm are in every digit what `crescent check ARM --wo THETA --json JSON` says. No part does more than it may.
import { readFileSync } from "node:fs";
import { isDeepStrictEqual } from "node:util";
const [file, compiled, native, angle] = process.argv.slice(2);
const { Api } = await import(file);
const module = await WebAssembly.compile(readFileSync(compiled));
const Instance = WebAssembly.Instance;

/** What it says, and the work of each of its parts. */
function checked(sampler, theta, evaluations) {
  const api = new Api(module), parts = [];
  let response = api.ask("checked", { sampler, theta, evaluations });
  for (; response.more; response = api.ask("go_on")) parts.push(api.number("worked"));
  return { response, parts: [...parts, api.number("worked")] };
}

/** The same in one part. */
function whole(sampler, theta, evaluations) {
  WebAssembly.Instance = function (of, imports) { return new Instance(of, { ...imports, api: { ...imports.api, pause() {} } }); };
  const { response, parts } = checked(sampler, theta, evaluations);
  WebAssembly.Instance = Instance;
  if (parts.length !== 1) throw new Error(`${sampler} was to be checked at once, not in ${parts.length} parts`);
  return response;
}

function hold(is, words) { if (!is) throw new Error(words); }

const most = new Api(module).number("most_of_part");
const faults = ["sqrt forgotten", "pdf off by 1 %", "phi over half a turn", "cosine", "cosine folded in twice", "s+2 for s+1 in the pdf"];
for (const name of faults) {
  const { response, parts } = checked(name, 45, 300_000);
  hold(parts.length > 10 && Math.max(...parts) <= most, `${name}: ${parts.length} parts, of ${Math.max(...parts)} samples, not ${most}`);
  hold(isDeepStrictEqual(response, whole(name, 45, 300_000)), `${name} is checked otherwise in ${parts.length} parts`);
}
const { verdicts } = JSON.parse(readFileSync(native, "utf8")), arm = verdicts[0].arm;
let compared = 0;
for (const { case: at, verdicts: of } of checked(arm, Number(angle)).response.cases)
  for (const { name, state, say, evidence } of of) {
    const there = verdicts.find((v) => v.case === at && v.name === name);
    hold(there && isDeepStrictEqual({ state, say, evidence }, { state: there.state, say: there.say, evidence: there.evidence }),
      `${arm}, ${at}, ${name}: ${JSON.stringify({ state, say, evidence })}, not ${JSON.stringify(there)}`);
    ++compared;
  }
hold(compared === verdicts.filter((v) => v.name !== "efficiency").length, `${compared} verdicts of ${verdicts.length}`);
console.log(`${faults.length} samplers in parts as at once, ${compared} verdicts of ${arm} as from the program`);
