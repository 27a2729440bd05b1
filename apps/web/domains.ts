// Samplers of points of other domains than directions (docs/domains.md): the domain that code declares, and what such
// samplers start from.
import { Template } from "./templates";

/** The domain of all other samplers of the page. */
export const directions = "hemisphere";

/** The domain that the code declares by a line such as `const domain = "disk";`; WGSL, which has no texts, declares none. */
export function domainOf(code: string): string {
  return /^[ \t]*(?:const|let|var)[ \t]+domain[ \t]*=[ \t]*(["'`])([^"'`\n]*)\1/m.exec(code)?.[2] ?? directions;
}

/** The code as the body of a function, which returns what a worker takes of it (apps/web/user.ts). */
export function returning(code: string): string {
  const names = ["sample", "pdf", "f", "numbers"].map((name) => `${name}: typeof ${name} === "undefined" ? undefined : ${name}`);
  return `${code}\n;return { ${names.join(", ")}, domain: ${JSON.stringify(domainOf(code))} };`;
}

const points = (title: string, code: string): Template => ({ title, ground: "lambert", code });

/** By their domains. Points are arrays of coordinates, or a number where there is one. */
export const pointTemplates: Readonly<Record<string, Template>> = {
  disk: points("a lens", `const domain = "disk"; // x, y in the unit disk; pdf per area

function sample(u) {
  const r = Math.sqrt(u[0]), phi = 2 * Math.PI * u[1];
  return { x: [r * Math.cos(phi), r * Math.sin(phi)], pdf: 1 / Math.PI };
}

function pdf(x) {
  return 1 / Math.PI;
}
`),
  square: points("a bilinear density", `const domain = "square"; // coordinates in [0, 1]^2; pdf per area
const w = [0.2, 0.6]; // p at the left and at the right, up to a factor

function sample(u) {
  const a = w[0], b = w[1], d = b - a;
  const x = (Math.sqrt(a * a + u[0] * (b * b - a * a)) - a) / d;
  return { x: [x, u[1]], pdf: pdf([x, u[1]]) };
}

function pdf(x) {
  return (w[0] + (w[1] - w[0]) * x[0]) / (0.5 * (w[0] + w[1]));
}
`),
  cube: points("a density that falls off upwards", `const domain = "cube"; // coordinates in [0, 1]^3; pdf per volume
const numbers = 3; // of a sample

function sample(u) {
  const z = 1 - Math.sqrt(1 - u[2]);
  return { x: [u[0], u[1], z], pdf: 2 * (1 - z) };
}

function pdf(x) {
  return 2 * (1 - x[2]);
}
`),
  triangle: points("a point of a triangle", `const domain = "triangle"; // barycentric b0, b1 >= 0, b0 + b1 <= 1; pdf per area of that triangle, 1/2

function sample(u) {
  const r = Math.sqrt(u[0]);
  return { x: [1 - r, r * (1 - u[1])], pdf: 2 };
}

function pdf(x) {
  return 2;
}
`),
  "line:-1,1": points("a tent filter", `const domain = "line:-1,1"; // x in [-1, 1]; pdf per length

function sample(u) {
  const x = u[0] < 0.5 ? Math.sqrt(2 * u[0]) - 1 : 1 - Math.sqrt(2 * (1 - u[0]));
  return { x, pdf: pdf(x) };
}

function pdf(x) {
  return Math.max(0, 1 - Math.abs(x));
}
`),
  "line:0,inf": points("a free flight", `const domain = "line:0,inf"; // a distance; pdf per length
const sigma = 1.7; // 1/m

function sample(u) {
  const x = -Math.log1p(-u[0]) / sigma;
  return { x, pdf: pdf(x) };
}

function pdf(x) {
  return sigma * Math.exp(-sigma * x);
}

// The integrand, if there is one: then mean, tail and efficiency are tested, too.
function f(x) {
  return 0.8 * sigma * Math.exp(-sigma * x);
}
`),
  "set:8": points("a choice by power", `const domain = "set:8"; // an entry from 0 to 7; pdf is its probability
const power = [3, 1, 4, 1, 5, 9, 2, 6], total = power.reduce((sum, one) => sum + one, 0);

function sample(u) {
  let k = 0, below = 0;
  while (k < 7 && u[0] * total >= below + power[k]) below += power[k++];
  return { x: k, pdf: power[k] / total };
}

function pdf(x) {
  return power[x] / total;
}
`),
  "set:2 x hemisphere": points("a lobe and a direction", `const domain = "set:2 x hemisphere"; // an entry, then a direction; pdf is a probability times 1/sr
const numbers = 3, q = 0.3; // the probability of entry 0, which is uniform; entry 1 has a cosine lobe

function sample(u) {
  const lobe = u[2] < q ? 0 : 1, z = lobe === 0 ? u[0] : Math.sqrt(u[0]);
  const r = Math.sqrt(1 - z * z), phi = 2 * Math.PI * u[1], x = [lobe, r * Math.cos(phi), r * Math.sin(phi), z];
  return { x, pdf: pdf(x) };
}

function pdf(x) {
  return x[0] === 0 ? q / (2 * Math.PI) : (1 - q) * x[3] / Math.PI;
}
`),
};
