// What the page exports of its templates and exercises, and what the same code gives in JavaScript.
import "../../../apps/web/vendor/codemirror/editor"; // in the page, scripts of their own
import { exercises } from "../../../apps/web/exercises";
import { exported } from "../../../apps/web/export";
import { grounds, templates } from "../../../apps/web/templates";
import { checked } from "./exercises";

interface Given { code: string; ground: string }
interface Exported { name: string; python: string; cpp: string; states: Record<string, string>; rows: (number | null)[][] }
const { sqrt } = Math, disk = { // the light of the ground `lit`: src/check/sources/cases.cpp
  kind: "disk", radius: 0.5, radiance: [20, 20, 20], shines: true, edge_u: [0, 0, 0], edge_v: [0, 0, 0],
  position: [2 * sqrt(1 - 0.6710100716628343) * 0.9396926207859084, 2 * sqrt(1 - 0.6710100716628343) * 0.3420201433256687, 2 * sqrt(0.6710100716628343)],
  normal: [-0.3420201433256687 * 0.5, -0.3420201433256687 * sqrt(0.75), -0.9396926207859084],
};
/** w_o and u of the draws that are compared, and directions for the pdf. */
export const given = Array.from({ length: 64 }, (_, k) => {
  const part = (step: number): number => (0.5 + k * step) % 1, z = 0.05 + 0.95 * part(0.618034), r = sqrt(1 - z * z), phi = 2 * Math.PI * part(0.414214);
  return { wo: [r * Math.cos(phi), r * Math.sin(phi), z], u: [part(0.754878), part(0.569840), part(0.321928)] };
});

/** A cosine lobe by every form that is translated. */
const forms = `const table = [1, 2, 3], lambda = half(2);
let sum = 0;
for (let i = 0; i < table.length; i++) { if (i === 1) continue; sum += table[i]; }
const [x0, y0] = [0.25, table[2]], int = (x) => Math.trunc(x);
function half(x) { return x / 2; }
/* the root
 * by Newton's method */
function root(a) {
  if (!(a > 0)) return 0;
  let x = a > 1 ? a : 1, k = 0;
  do { x = 0.5 * (x + a / x); } while (++k < 60);
  return x;
}
function sample(wo, u) {
  const [a, b] = u, r = root(a), z = root(1 - a);
  let phi, steps = 0;
  phi = 2 * Math.PI * b;
  for (let i = 0, j = 10; i < j; i += 1, --j) { if (steps % 2 == 1) { steps++; continue; } steps += 1; }
  while (true) { if (steps-- <= 0) break; }
  const flip = (p) => { const q = -p; return -q; };
  const wi = [r * Math.cos(phi), r * Math.sin(phi), z].map((w, i) => i === 2 ? flip(w) : w * lambda);
  if (sum !== 4 || y0 > 3 && x0 < 0 || int(2.5) !== 2) return null;
  else if (z < 0) { return null; } else { const r = 2; { const r = 3; wi[0] *= r / 3; } wi[1] *= r / 2; }
  const drawn = { wi, pdf: pdf(wo, wi) }, { wi: w } = drawn;
  return w[2] > 1 ? null : { wi: w, pdf: drawn.pdf };
}
function pdf(wo, [x, y, z]) {
  const above = z > 0 && !(z > 2), p = Math.max(z, 0) / Math.PI;
  return above ? p : 0;
}
`;

/** The draws of the code for `given`, and its pdf and f for each w_o and the next: null where nothing is drawn. */
function rowsOf({ code, ground }: Given): (number | null)[][] {
  const { sample, pdf } = new Function(`"use strict";\n${code}\nreturn { sample, pdf };`)() as Record<"sample" | "pdf", (...all: unknown[]) => unknown>;
  const { lobe, sharpness, light } = grounds[ground]!, at = { s: lobe === "ggx" ? 32 : sharpness, alpha: lobe === "ggx" ? sharpness : 0.3, lights: light === "disk" ? [disk] : [] };
  return given.map(({ wo, u }, k) => {
    const drawn = sample!(wo, u, at) as { wi: number[]; pdf: number } | null;
    return [...(drawn ? [...drawn.wi, drawn.pdf] : [null, null, null, null]), pdf!(wo, given[(k + 1) % given.length]!.wo, at) as number];
  });
}

export function exportsOf(module: WebAssembly.Module): Exported[] {
  const all: [string, Given][] = [...Object.entries(templates), ...exercises.map((one): [string, Given] => [one.name, one]), ["forms", { code: forms, ground: "lambert" }]];
  return all.map(([name, { code, ground }]) => ({
    name: name.replaceAll("-", "_"), python: exported("python", code, ground).text, cpp: exported("cpp", code, ground).text, rows: rowsOf({ code, ground }),
    states: Object.fromEntries(checked(module, code, ground, [[60, 0]]).verdicts.map((v) => [v.name, v.state])),
  }));
}

/** What must be said of code that has no translation: nothing of it is left out silently. */
export function partly(): { python: string; cpp: string } {
  const code = `const cosines = [];
function sample(wo, u) {
  // a comment
  console.log(u);
  const z = Math.sqrt(u[0]), r = Math.sqrt(1 - u[0]);
  switch (z) { default: }
  return { wi: [r, 0, z], pdf: z / Math.PI };
}
function pdf(wo, wi) {
  const p = Math.random();
  return p;
}
`;
  return { python: exported("python", code, "lambert").text, cpp: exported("cpp", code, "lambert").text };
}
