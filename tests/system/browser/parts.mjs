// node parts.mjs DOOR MODULE EXPERIMENT: what begins a reference, and furnaces, come in parts; none does more than it may.
// The film of a sample count is the same whether its tiles were seen before or not, and so is the reference in parts and at once.
import { readFileSync } from "node:fs";
const [file, compiled, experiment] = process.argv.slice(2);
const { Api } = await import(file);
const module = await WebAssembly.compile(readFileSync(compiled));
const text = readFileSync(experiment, "utf8");

function hold(is, words) { if (!is) throw new Error(words); }

/** An instance with the experiment as it is set, and what it says of it. */
function opened(set = []) {
  const api = new Api(module);
  api.number("keep_points", 300_000);
  return { api, info: api.ask("open", { file: experiment, text, set, published: "" }) };
}

/** The work of each part of a question. */
function parts(api, call, request) {
  const all = [];
  api.number("worked");
  for (let response = api.ask(call, request); ; response = api.ask("go_on")) {
    all.push(api.number("worked"));
    if (!response.more) return all;
  }
}

const most = opened().api.number("most_of_part");
const lobes = [[], ...["ggx", "beckmann"].map((lobe) => [`sphere.brdf="${lobe}"`, "sphere.alpha=0.05"])];
for (const [k, least] of [5, 50, 50].entries()) {
  const { api } = opened(lobes[k]), all = parts(api, "prepare_reference");
  hold(all.length >= least && Math.max(...all) <= most, `${lobes[k]}: a reference begins with ${all.length} parts of up to ${Math.max(...all)} samples`);
}

/** Bytes of a box, where no call pauses where `at_once`. */
function reference(at_once) {
  const Instance = WebAssembly.Instance;
  if (at_once) WebAssembly.Instance = function (of, imports) { return new Instance(of, { ...imports, api: { ...imports.api, pause() {} } }); };
  const { api } = opened();
  WebAssembly.Instance = Instance;
  const all = parts(api, "prepare_reference");
  hold((all.length === 1) === at_once, `${all.length} parts`);
  return Buffer.from(api.bytes("reference_tile", 20 * 64, 448, 256, 512, 257)).toString("hex");
}
hold(reference(true) === reference(false), "the reference is another one in parts");

const furnaces = parts(opened().api, "furnaces_of", { n: 65536, name: "" });
hold(furnaces.length === 7 && Math.max(...furnaces) <= most, `three furnaces in parts of ${furnaces} samples`);

const { api, info } = opened(), again = opened().api;
const side = 64, tile = (of, n, [x, y]) => Buffer.from(of.bytes("tile", 4 * (10 * side * side + 1), 0, n, x, y, x + side, y + side)).toString("hex");
const boxes = [];
for (let y = 0; y + side <= info.height; y += side) for (let x = 0; x + side <= info.width; x += side) boxes.push([x, y]);
for (const box of boxes) tile(api, 1, box);
const other = boxes[boxes.length >> 1];
hold([boxes[0], other].every((box) => tile(api, 4, box) === tile(again, 4, box)), "a tile that was seen before is another one");

/** The largest size of an instance, in bytes, after all tiles of an image were seen once. */
const seen = opened(["image.width=1920", "image.height=1080"]).api, before = seen.size;
for (let y = 0; y + side <= 1080; y += side) for (let x = 0; x + side <= 1920; x += side) tile(seen, 1, [x, y]);
hold(seen.size - before < 100e6, `${seen.size - before} bytes are kept of tiles`);
console.log(`references and furnaces in parts; of the tiles of 1920 x 1080 pixels, ${Math.round((seen.size - before) / 1e6)} MB are kept`);
