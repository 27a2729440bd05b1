// The films of an experiment as the page makes them, tile by tile and assembled: one line per film, as film_hashes
// prints them. Bundled for node and for browsers.
import { Api, pixelsOf } from "../../../apps/web/api";
import { Described } from "../../../apps/web/model";

export function hashes(module: WebAssembly.Module, file: string, text: string): string[] {
  const worker = new Api(module), page = new Api(module), opening = { file, text, set: [], published: "" };
  worker.json("open", opening);
  const d = page.json<Described>("open", opening), lines: string[] = [];
  const side = 48; // none of the program's own
  d.arms.forEach((arm, index) => {
    for (const n of arm.n) {
      page.number("begin", 0, index, n);
      for (let y0 = 0; y0 < d.height; y0 += side)
        for (let x0 = 0; x0 < d.width; x0 += side) {
          const box = { x0, y0, x1: Math.min(x0 + side, d.width), y1: Math.min(y0 + side, d.height) };
          page.give(worker.bytes("tile", 4 * (10 * pixelsOf(box) + 1), index, n, box.x0, box.y0, box.x1, box.y1));
          page.number("put", 0, box.x0, box.y0, box.x1, box.y1);
        }
      lines.push(`${file} ${arm.name} n=${n} ${page.say("hash_of", undefined, 0)}`);
    }
  });
  worker.say("prepare_reference");
  page.number("film_buffer", -1);
  for (let y0 = 0; y0 < d.height; y0 += side) {
    const box = { x0: 0, y0, x1: d.width, y1: Math.min(y0 + side, d.height) };
    page.give(worker.bytes("reference_tile", 20 * pixelsOf(box), 0, y0, d.width, box.y1));
    page.number("put_reference", 0, y0, d.width, box.y1);
  }
  lines.push(`${file} quadrature ${page.say("hash_of", undefined, -1)}`);
  return lines;
}

(globalThis as unknown as { crescentHashes: typeof hashes }).crescentHashes = hashes;
