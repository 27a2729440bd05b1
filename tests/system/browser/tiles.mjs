// node tiles.mjs API MODULE EXPERIMENT: the film of a sample count is the same whether its tiles were seen before or
// not, and what is kept of tiles is limited.
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
  return { api, info: api.json("open", { file: experiment, text, set, published: "" }) };
}

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
console.log(`of the tiles of 1920 x 1080 pixels, ${Math.round((seen.size - before) / 1e6)} MB are kept`);
