// node pack.mjs BUILD OUT: the compiled module, the scripts and the experiments -> one file that needs nothing else.
// The policy of the file names its script and its style by their hashes.
import { execFileSync } from "node:child_process";
import { createHash } from "node:crypto";
import { mkdirSync, readFileSync, readdirSync, renameSync, writeFileSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { gzipSync } from "node:zlib";

const [built, out] = process.argv.slice(2), build = resolve(built);
const web = import.meta.dirname ?? dirname(new URL(import.meta.url).pathname);
const experiments = join(web, "../..", "experiments");
const text = (path) => readFileSync(path, "utf8");

function bundle(entry, ...more) {
  const flags = [...more, "--bundle", "--minify", "--format=iife", "--target=es2022", "--charset=utf8", "--legal-comments=none", "--log-level=warning"];
  return execFileSync("esbuild", [join(web, entry), ...flags], { encoding: "utf8" }).trim();
}

/** The api itself, to ask what only the core knows: what each experiment holds. */
async function opened(module) {
  const made = execFileSync("esbuild", [join(web, "api.ts"), "--format=esm", "--target=es2022"], { encoding: "utf8" });
  writeFileSync(join(build, "api.mjs"), made);
  const { Api } = await import(join(build, "api.mjs"));
  return new Api(module);
}

function sources(api) {
  const native = JSON.parse(text(join(web, "native.json")));
  const names = readdirSync(experiments).filter((name) => name.endsWith(".toml")).sort();
  names.sort((a, b) => (b === "gallery.toml") - (a === "gallery.toml"));
  const all = {};
  for (const name of names) {
    const file = `experiments/${name}`, body = text(join(experiments, name));
    const figures = /^published = "(.*?)"/m.exec(body);
    const published = figures ? text(join(experiments, figures[1])) : "";
    const d = api.json("open", { file, text: body, published, set: [] });
    const arms = Object.fromEntries(d.arms.map((arm) => [arm.name, arm.n]));
    const short = name.replace(/\.toml$/, "");
    all[short] = {
      file, title: d.title, text: body, published, arms, regions: d.regions, size: [d.width, d.height], reference: d.reference,
      films: native[short] ?? {},
    };
  }
  return all;
}

const bytes = readFileSync(join(build, "crescent.wasm"));
const api = await opened(await WebAssembly.compile(bytes));
const version = api.say("version_of");
const style = text(join(web, "../../src/output/style.css")).trim() + text(join(web, "page.css")).trim();
const script = bundle("main.ts"), worker = bundle("worker.ts");
const editor = text(join(web, "vendor/codemirror/editor.js")).split(/^(?=\/\/ part )/m).slice(1);
// Inside a script element only these end it.
const inert = (words) => words.replaceAll("</", "<\\/").replaceAll("<!--", "<\\!--");
const hash = (words) => `'sha256-${createHash("sha256").update(words).digest("base64")}'`;
const parts = {
  version, style, script: inert(script), worker: inert(worker),
  editor: editor.map((part) => `<script type="text/plain" class="editor">${inert(part)}</script>`).join("\n"),
  data: JSON.stringify({ version, sources: sources(api) }).replaceAll("<", "\\u003c"),
  module: gzipSync(bytes, { level: 9 }).toString("base64"),
  "script-hash": [script, ...editor].map((words) => hash(inert(words))).join(" "), "style-hash": hash(style),
};
const page = text(join(web, "index.html")).replace(/\{([a-z-]+)\}/g, (_, name) => {
  if (!(name in parts)) throw new Error(`index.html asks for {${name}}`);
  return parts[name];
});
const most = 3_000_000;
if (page.length > most) throw new Error(`the page has ${page.length} bytes, more than ${most}`);
mkdirSync(dirname(out), { recursive: true });
writeFileSync(`${out}.partial`, page);
renameSync(`${out}.partial`, out);
console.log(`${out}: ${Math.round(page.length / 1024)} KiB, module ${Math.round(bytes.length / 1024)} KiB`);
