// node native.mjs PROGRAM: the hashes of the program's films of every experiment of the tree, for apps/web/native.json, which
// the page shows beside its own. tests/system/page.sh holds that file to the program.
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, readdirSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";

const [program] = process.argv.slice(2);
const tree = join(import.meta.dirname ?? dirname(new URL(import.meta.url).pathname), "../..");
const out = mkdtempSync(join(tmpdir(), "crescent-native-"));
const all = {};
for (const name of readdirSync(join(tree, "experiments")).filter((file) => file.endsWith(".toml")).sort()) {
  const words = ["run", `experiments/${name}`, "--seeds", "1", "--only", "metrics", "--quiet", "--out", join(out, name)];
  execFileSync(program, words, { cwd: tree, stdio: ["ignore", "ignore", "inherit"] });
  const { films } = JSON.parse(readFileSync(join(out, name, "metrics.json"), "utf8"));
  all[name.replace(/\.toml$/, "")] = Object.fromEntries(Object.entries(films).filter(([key]) => / n=/.test(key)));
}
rmSync(out, { recursive: true });
console.log(JSON.stringify(all, null, 1));
