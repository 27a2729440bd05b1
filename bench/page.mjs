// node bench/page.mjs CRESCENT BUILD: Msamples/s of one thread, the page's module in this node beside the program's SSE4
// code, in turn; the best of 3. A sample is one draw of one geometry pixel; the module traces the primary rays of each
// tile again, the program once a run. One line of JSON an arm, for bench/page.py.
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";

const [crescent, build] = process.argv.slice(2);
const root = join(dirname(new URL(import.meta.url).pathname), "..");
const experiment = "experiments/gallery.toml", n = 64, times = 3;

/** The program on one thread: what each arm drew at n, and in how long. */
function native() {
  const out = mkdtempSync(join(tmpdir(), "crescent-"));
  const set = ["uniform", "cosine", "phong"].flatMap((arm) => ["--set", `arms.${arm}.n=[${n}]`]);
  const file = join(root, experiment), one = ["--isa", "sse4", "--threads", "1", "--seeds", "1", "--only", "films", "--quiet"];
  execFileSync(crescent, ["run", file, ...one, ...set, "--out", out], { stdio: ["ignore", "ignore", "inherit"] });
  const { arms, provenance } = JSON.parse(readFileSync(join(out, "timing.json"), "utf8"));
  rmSync(out, { recursive: true });
  return { commit: provenance.commit, arms: arms.filter((a) => a.n === n && a.s === 32) };
}

const { Door } = await import(join(build, "door.mjs"));
const door = new Door(await WebAssembly.compile(readFileSync(join(build, "crescent.wasm"))));
const d = door.ask("open", { file: experiment, text: readFileSync(join(root, experiment), "utf8"), set: [], published: "" });

/** Seconds of all tiles of one arm, or of the reference. */
function page(call, ...given) {
  const start = performance.now();
  for (let y0 = 0; y0 < d.height; y0 += 64)
    for (let x0 = 0; x0 < d.width; x0 += 64) door.number(call, ...given, x0, y0, Math.min(x0 + 64, d.width), Math.min(y0 + 64, d.height));
  return (performance.now() - start) / 1000;
}

const best = {};
let commit = "";
for (let turn = 0; turn < times; ++turn) {
  const program = native();
  commit = program.commit;
  for (const a of program.arms) {
    const seconds = page("tile", d.arms.findIndex((arm) => arm.name === a.arm), n);
    const here = (best[a.arm] ??= { arm: a.arm, program: 0, page: 0 });
    here.program = Math.max(here.program, a.samples / a.seconds / 1e6);
    here.page = Math.max(here.page, a.samples / seconds / 1e6);
  }
}
for (const row of Object.values(best)) console.log(JSON.stringify(row));
console.log(JSON.stringify({ commit, engine: `node ${process.version}, V8 ${process.versions.v8}`, reference: page("reference_tile") }));
