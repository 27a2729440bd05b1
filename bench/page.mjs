// node bench/page.mjs CRESCENT BUILD: Msamples/s of one thread, the page's module in this node beside the program's SSE4
// code, in turn; the best of 5. A sample is one draw of one geometry pixel; what traces primary rays is not counted, in
// neither. One line of JSON an arm, for bench/page.py.
import { execFileSync, spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";

const [crescent, build] = process.argv.slice(2); // absolute paths
const root = join(dirname(new URL(import.meta.url).pathname), "..");
const experiment = "experiments/gallery.toml", n = 64, times = 5;

/** The program on one thread: what each arm drew at n, and in how long. */
function native() {
  const out = mkdtempSync(join(tmpdir(), "crescent-"));
  const set = ["uniform", "cosine", "phong"].flatMap((arm) => ["--set", `arms.${arm}.n=[${n}]`]);
  const file = join(root, experiment), one = ["--isa", "sse4", "--threads", "1", "--seeds", "1", "--only", "films", "--quiet", "--set", "reference.monte_carlo=false"];
  const { status } = spawnSync(crescent, ["run", file, ...one, ...set, "--out", out], { stdio: ["ignore", "ignore", "inherit"] });
  if (status !== 0 && status !== 1) throw new Error(`${crescent} ended with ${status}`); // 1: an assertion wants another N
  const { arms, provenance } = JSON.parse(readFileSync(join(out, "timing.json"), "utf8"));
  rmSync(out, { recursive: true });
  return { commit: provenance.commit, arms: arms.filter((a) => a.n === n && a.s === 32) };
}

const { Api } = await import(join(build, "api.mjs"));
const module = await WebAssembly.compile(readFileSync(join(build, "crescent.wasm")));
const api = new Api(module);
const d = api.json("open", { file: experiment, text: readFileSync(join(root, experiment), "utf8"), set: [], published: "" });

/** Seconds of all tiles of one call; `before` is called first, uncounted. */
function page(call, given, before) {
  let seconds = 0;
  for (let y0 = 0; y0 < d.height; y0 += 64)
    for (let x0 = 0; x0 < d.width; x0 += 64) {
      const box = [x0, y0, Math.min(x0 + 64, d.width), Math.min(y0 + 64, d.height)];
      before?.(box);
      const start = performance.now();
      api.number(call, ...given, ...box);
      seconds += (performance.now() - start) / 1000;
    }
  return seconds;
}

/** Million draws a second of the page's template "cosine" in JavaScript, film included; the best of 5. */
async function written() {
  const web = join(root, "apps/web"), folder = mkdtempSync(join(tmpdir(), "crescent-"));
  const bundled = (name) => {
    execFileSync("esbuild", [join(web, `${name}.ts`), "--bundle", "--format=esm", "--target=es2022", "--log-level=warning", `--outfile=${join(folder, `${name}.mjs`)}`]);
    return import(join(folder, `${name}.mjs`));
  };
  const [{ userSampler }, { templates }] = [await bundled("user"), await bundled("templates")];
  rmSync(folder, { recursive: true });
  globalThis.self = globalThis;
  const take = userSampler();
  globalThis.crescentUser(new Function(`${templates.cosine.code}; return { sample, pdf };`));
  const user = take(), own = new Api(module, user.calls);
  own.number("user_takes", user.numbers, user.context ? 1 : 0);
  const arms = own.json("open", { file: experiment, text: readFileSync(join(root, experiment), "utf8"), set: ['arms.yours.exec="page"', "arms.yours.n=[16]"], published: "" }).arms;
  const arm = arms.findIndex(({ name }) => name === "yours"), box = [448, 320, 512, 384], draws = 64 * 64 * 16; // all of it on the sphere
  let rate = 0;
  for (let turn = 0; turn < 4 * times; ++turn) {
    const start = performance.now();
    own.number("tile", arm, 16, ...box);
    rate = Math.max(rate, draws / (performance.now() - start) / 1000);
  }
  return rate;
}

const best = {};
let commit = "";
for (let turn = 0; turn < times; ++turn) {
  const program = native();
  commit = program.commit;
  for (const a of program.arms) {
    const arm = d.arms.findIndex(({ name }) => name === a.arm);
    const seconds = page("tile", [arm, n], (box) => api.number("tile", arm, 1, ...box)); // traces the rays, and keeps them
    const here = (best[a.arm] ??= { arm: a.arm, program: 0, page: 0 });
    here.program = Math.max(here.program, a.samples / a.seconds / 1e6);
    here.page = Math.max(here.page, a.samples / seconds / 1e6);
  }
}
for (const row of Object.values(best)) console.log(JSON.stringify(row));
api.say("prepare_reference");
console.log(JSON.stringify({ commit, engine: `node ${process.version}, V8 ${process.versions.v8}`, reference: page("reference_tile", []), written: await written() }));
