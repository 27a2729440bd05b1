// Twelve samplers to check, eleven with one planted fault of a kind that public bug reports show. `repair`: what is
// replaced, and by what; the code of the exercise has the first. The page checks both; no verdict is typed in here.
import { templates } from "./templates";

export interface Exercise {
  name: string; title: string; minutes: number; ground: string; task: string; code: string;
  hints: readonly [string, string, string];
  repair?: readonly [string, string]; // none: the answer is that there is no fault
}

const phong = templates["phong"]!.code, ggx = templates["ggx"]!.code, mixture = templates["mixture"]!.code;
function broken(code: string, [fault, right]: readonly [string, string]): string {
  if (!code.includes(right)) throw new Error(`an exercise repairs ${right}, which its sampler does not have`);
  return code.replace(right, () => fault);
}

const sky = `// The sky: luminances over azimuth (8) and height (4 bands of equal solid angle), the horizon first.
const sky = [
  [6, 9, 4, 2, 1, 1, 2, 3],
  [4, 5, 2, 1, 1, 1, 1, 2],
  [2, 2, 1, 1, 1, 1, 1, 1],
  [1, 1, 1, 1, 1, 1, 1, 1],
];
const cell = 2 * Math.PI / 32; // sr
let total = 0;
for (const row of sky) for (const value of row) total += value;

function sample(wo, u) {
  let left = u[0] * total, i = 0, j = 0;
  while (left >= sky[j][i] && !(i === 7 && j === 3)) {
    left -= sky[j][i];
    if (++i === 8) { i = 0; ++j; }
  }
  const phi = 2 * Math.PI * (i + left / sky[j][i]) / 8, z = (j + u[1]) / 4, r = Math.sqrt(1 - z * z);
  return { wi: [r * Math.cos(phi), r * Math.sin(phi), z], pdf: sky[j][i] / total / cell };
}

function pdf(wo, wi) {
  if (!(wi[2] > 0)) return 0;
  let turn = Math.atan2(wi[1], wi[0]) / (2 * Math.PI);
  if (turn < 0) turn += 1;
  const i = Math.min(7, Math.floor(8 * turn)), j = Math.min(3, Math.floor(4 * wi[2]));
  return sky[j][i] / total / cell;
}
`;

const cone = `const angle = 0.21; // of the cone about the normal, rad
const numbers = 3;
const one = 2 * Math.sin(angle / 2) ** 2; // 1 - cos(angle)
const short = (x) => Math.round(256 * x) / 256; // as bfloat16 has numbers from 1/2 to 1

// Half of the draws go into the cone, the others follow the cosine.
function sample(wo, u) {
  const phi = 2 * Math.PI * u[1], z = u[2] < 0.5 ? 1 - u[0] * one : Math.sqrt(1 - u[0]), r = Math.sqrt(1 - z * z);
  const wi = [r * Math.cos(phi), r * Math.sin(phi), z];
  return { wi, pdf: pdf(wo, wi) };
}

function pdf(wo, wi) {
  if (!(wi[2] > 0)) return 0;
  const size = 2 * Math.PI * one;
  return 0.5 * wi[2] / Math.PI + (1 - wi[2] <= one ? 0.5 / size : 0);
}
`;

const ellipse = `const a = 0.8, b = 0.3; // a lobe that is wide along x and narrow along y

function sample(wo, u) {
  const r = Math.sqrt(u[0]), phi = 2 * Math.PI * u[1];
  const x = a * r * Math.cos(phi), y = b * r * Math.sin(phi), z = Math.sqrt(1 - u[0]);
  const l = Math.sqrt(x * x + y * y + z * z), wi = [x / l, y / l, z / l];
  return { wi, pdf: pdf(wo, wi) };
}

// A cosine lobe stretched by a and b.
function pdf(wo, wi) {
  if (!(wi[2] > 0)) return 0;
  const t = wi[0] * wi[0] / (a * a) + wi[1] * wi[1] / (b * b) + wi[2] * wi[2];
  return wi[2] / (Math.PI * a * b * t * t);
}
`;

const mis = `const numbers = 3;
const q = 0.3; // the probability of the uniform technique

function sample(wo, u) {
  const phi = 2 * Math.PI * u[1], z = u[2] < q ? u[0] : Math.sqrt(1 - u[0]), r = Math.sqrt(1 - z * z);
  const wi = [r * Math.cos(phi), r * Math.sin(phi), z];
  return { wi, pdf: pdf(wo, wi) };
}

// One sample, the balance heuristic: f cos / (q p_uniform + (1 - q) p_cosine).
function pdf(wo, wi) {
  if (!(wi[2] > 0)) return 0;
  return q / (2 * Math.PI) + (1 - q) * wi[2] / Math.PI;
}
`;

const power = `// Directions about the normal by a power of the cosine, to put more samples where a Lambert surface reflects most.
const k = 4;

function sample(wo, u) {
  const z = Math.pow(1 - u[0], 1 / (k + 1)), r = Math.sqrt(1 - z * z), phi = 2 * Math.PI * u[1];
  return { wi: [r * Math.cos(phi), r * Math.sin(phi), z], pdf: pdf(wo, [0, 0, z]) };
}

function pdf(wo, wi) {
  return wi[2] > 0 ? (k + 1) / (2 * Math.PI) * Math.pow(wi[2], k) : 0;
}
`;

interface Plan { name: string; title: string; minutes: number; ground: string; task: string; right: string; repair: readonly [string, string]; hints: readonly [string, string, string] }

const planned: readonly Plan[] = [
  {
    name: "cosine-for-uniform", title: "Too many at the top", minutes: 5, ground: "lambert", right: templates["cosine"]!.code,
    task: "This sampler is meant for a Lambert surface. Its draws look plausible, and its pdf integrates to 1.",
    repair: ["const r = Math.sqrt(1 - u[0] * u[0]), phi = 2 * Math.PI * u[1], z = u[0];", "const r = Math.sqrt(u[0]), phi = 2 * Math.PI * u[1], z = Math.sqrt(1 - u[0]);"],
    hints: ["A pdf can integrate to 1 and still be that of other draws.", "Compare where the draws are dense with where the pdf is large: one of the two does not depend on the height.", "Draws with z = u[0] are uniform over the hemisphere; the pdf is that of a cosine."],
  },
  {
    name: "missing-jacobian", title: "Half a vector", minutes: 8, ground: "ggx", right: ggx,
    task: "GGX visible normals. The normals m are drawn by the right density; the sampler has to state that of w_i.",
    repair: ["G1(wo, at.alpha) * D([x / l, y / l, z / l], at.alpha) * (wo[0] * x + wo[1] * y + wo[2] * z) / l / wo[2]", "G1(wo, at.alpha) * D([x / l, y / l, z / l], at.alpha) / (4 * wo[2])"],
    hints: ["Look at what sample states and at what pdf states for the same direction.", "pdf(w_i) is the density of m. A mirror turns twice as fast as its normal.", "dm / dwi = 1 / (4 w_o.m): multiply the density of m by it, and w_o.m cancels."],
  },
  {
    name: "half-a-turn", title: "One side is dark", minutes: 5, ground: "lambert", right: templates["uniform"]!.code,
    task: "The uniform hemisphere, for a Lambert surface.",
    repair: ["phi = Math.PI * u[1];", "phi = 2 * Math.PI * u[1];"],
    hints: ["Turn the hemisphere to draws over what the pdf implies.", "Half of the hemisphere gets twice its draws, the other half none: what angle runs over half of its range?", "phi needs a whole turn, 2 pi."],
  },
  {
    name: "wrong-side", title: "The lobe on the wrong side", minutes: 5, ground: "phong", right: phong,
    task: "A Phong lobe about the mirror direction. The pictures of this renderer show a highlight in the right place, and noise everywhere else.",
    repair: ["const r = [wo[0], wo[1], wo[2]];", "const r = [-wo[0], -wo[1], wo[2]];"],
    hints: ["At the normal nothing is wrong. Move w_o.", "The draws lie on the side of w_o, and the pdf on the other.", "w_o leaves the surface: its mirror direction is (-x, -y, z)."],
  },
  {
    name: "eta-squared", title: "A constant too many", minutes: 5, ground: "lambert", right: templates["cosine"]!.code,
    task: "A cosine sampler, taken over from code that refracts: radiance scales with the square of the index there.",
    repair: ["wi[2] / Math.PI / (1.5 * 1.5) : 0", "wi[2] / Math.PI : 0"],
    hints: ["Which verdict speaks of the integral of a pdf?", "The message names the factor. Is it a square?", "A density of directions on one side of a surface has no eta^2."],
  },
  {
    name: "swapped-axes", title: "Wide or narrow", minutes: 8, ground: "lambert", right: ellipse,
    task: "An anisotropic lobe, wide along x and narrow along y.",
    repair: ["const x = b * r * Math.cos(phi), y = a * r * Math.sin(phi)", "const x = a * r * Math.cos(phi), y = b * r * Math.sin(phi)"],
    hints: ["The draws have the right shape. Do they have the right direction?", "Choose draws over what the pdf implies: too many along one axis, too few along the other.", "sample stretches x by b and y by a."],
  },
  {
    name: "chosen-lobe", title: "Only the chosen one", minutes: 8, ground: "both", right: mixture,
    task: "A mixture of two lobes: one is chosen at random, and draws the direction.",
    repair: ["return { wi, pdf: q * lobe(wo, wi, at.s) };\n}\n\nfunction pdf", "return { wi, pdf: pdf(wo, wi, at) };\n}\n\nfunction pdf"],
    hints: ["Two functions state a density of the same direction.", "The other lobe could have drawn this direction too.", "The density of a mixture is the sum over both lobes, whichever was chosen."],
  },
  {
    name: "float-cone", title: "A narrow cone", minutes: 10, ground: "lambert", right: cone,
    task: "Half of the draws go into a narrow cone. Its solid angle is computed in bfloat16, as some accelerators do.",
    repair: ["size = 2 * Math.PI * (1 - short(Math.cos(angle)));", "size = 2 * Math.PI * one;"],
    hints: ["How large is 1 - cos(0.21)?", "bfloat16 has steps of 0.004 below 1, and the cone has 0.022.", "1 - cos x = 2 sin^2(x / 2) loses nothing: it is there already, as one."],
  },
  {
    name: "mirrored-sky", title: "The sun rises in the west", minutes: 8, ground: "lambert", right: sky,
    task: "A sky that is sampled by its table.",
    repair: ["let turn = -Math.atan2(wi[1], wi[0])", "let turn = Math.atan2(wi[1], wi[0])"],
    hints: ["The bright part of the pdf and the crowd of the draws are not in one place.", "They are mirror images of one another.", "sample turns by +phi; pdf looks the table up at -phi."],
  },
  {
    name: "unnormalised-table", title: "A table without its last row", minutes: 8, ground: "lambert", right: sky,
    task: "The same sky, with another fault.",
    repair: ["for (const row of sky.slice(0, 3))", "for (const row of sky)"],
    hints: ["What should the entries of a table of probabilities sum to?", "The total does not count every row, so some directions are never drawn.", "total has to include the row at the zenith."],
  },
  {
    name: "mis-weight", title: "Weights of another mixture", minutes: 8, ground: "lambert", right: mis,
    task: "Two techniques, one sample, combined by the balance heuristic.",
    repair: ["return 0.5 / (2 * Math.PI) + 0.5 * wi[2] / Math.PI;", "return q / (2 * Math.PI) + (1 - q) * wi[2] / Math.PI;"],
    hints: ["The pdf integrates to 1.", "How often is the uniform technique chosen, and how often does the pdf say so?", "The weights must be the probabilities by which the techniques are chosen."],
  },
];

export const exercises: readonly Exercise[] = [
  ...planned.map(({ right, repair, ...rest }) => ({ ...rest, repair, code: broken(right, repair) })),
  {
    name: "heavy-tail", title: "Fireflies", minutes: 8, ground: "lambert", code: power,
    task: "This sampler makes fireflies. A colleague says that it must have a bug.",
    hints: ["Which verdicts are wrong, and which only stay open?", "Near the horizon, which falls faster: f cos or p?", "Nothing is wrong: the weight has a heavy tail, and the remedy is another density. Answer that there is no fault."],
  },
];
