// node bench/page.mjs CRESCENT BUILD: Msamples/s of one thread, the page's module in this node beside the program's SSE4
// code, in turn, the best of 3. A sample is one draw of one geometry pixel; primary rays are traced in both.
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";

const [crescent, build] = process.argv.slice(2);
const root = join(dirname(new URL(import.meta.url).pathname), "..");
const experiment = "experiments/gallery.toml", n = 64, times = 3;

/** The program on one thread: arm -> Msamples/s, and how many samples each arm draws. */
function native() {
  const out = mkdtempSync(join(tmpdir(), "crescent-"));
  const set = ["uniform", "cosine", "phong"].flatMap((arm) => ["--set", `arms.${arm}.n=[${n}]`]);
  execFileSync(crescent, ["run", join(root, experiment), "--isa", "sse4", "--threads", "1", "--seeds", "1", "--only", "films", "--quiet", ...set, "--out", out]);
  const { arms } = JSON.parse(readFileSync(join(out, "timing.json"), "utf8"));
  rmSync(out, { recursive: true });
  return arms.filter((a) => a.n === n && a.s === 32);
}

const { Door } = await import(join(build, "door.mjs"));
const door = new Door(await WebAssembly.compile(readFileSync(join(build, "crescent.wasm"))));
const d = door.ask("open", { file: experiment, text: readFileSync(join(root, experiment), "utf8"), set: [], published: "" });

/** Seconds of all tiles of one arm. */
function page(arm) {
  const start = performance.now();
  for (let y0 = 0; y0 < d.height; y0 += 64)
    for (let x0 = 0; x0 < d.width; x0 += 64) door.number("tile", arm, n, x0, y0, Math.min(x0 + 64, d.width), Math.min(y0 + 64, d.height));
  return (performance.now() - start) / 1000;
}

const best = {};
for (let turn = 0; turn < times; ++turn)
  for (const a of native()) {
    const index = d.arms.findIndex((arm) => arm.name === a.arm), seconds = page(index);
    const here = (best[a.arm] ??= { program: 0, page: 0 });
    here.program = Math.max(here.program, a.samples / a.seconds / 1e6);
    here.page = Math.max(here.page, a.samples / seconds / 1e6);
  }
console.log("| arm | page, one thread | program, SSE4, one thread | page / program |\n|---|---|---|---|");
for (const [arm, { program, page: here }] of Object.entries(best))
  console.log(`| ${arm} | ${here.toFixed(1)} | ${program.toFixed(1)} | ${(here / program).toFixed(2)} |`);
