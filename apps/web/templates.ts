// What a user's sampler starts from. Local frame, n = +z; w_o is given, w_i is drawn, both leave the surface; u in
// [0, 1); pdf in 1/sr.

/** A surface on which a sampler is tested, and the light: apps/web/user_sampler.cpp. */
export interface Ground { lobe: string; lambert: boolean; sharpness: number; light: "fill" | "disk" }
export const grounds: Readonly<Record<string, Ground & { words: string }>> = {
  lambert: { words: "Lambert", lobe: "", lambert: true, sharpness: 32, light: "fill" },
  phong: { words: "Phong, s = 32", lobe: "phong", lambert: false, sharpness: 32, light: "fill" },
  both: { words: "Lambert + Phong, s = 32", lobe: "phong", lambert: true, sharpness: 32, light: "fill" },
  ggx: { words: "GGX, alpha = 0.3", lobe: "ggx", lambert: false, sharpness: 0.3, light: "fill" },
  lit: { words: "Lambert under a disk light", lobe: "", lambert: true, sharpness: 32, light: "disk" },
};

export interface Template { title: string; ground: string; code: string }

const basis = `// Two directions at right angles to r.
function basis(r) {
  const h = Math.abs(r[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0];
  const a = [r[1] * h[2] - r[2] * h[1], r[2] * h[0] - r[0] * h[2], r[0] * h[1] - r[1] * h[0]];
  const l = Math.sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
  const t = [a[0] / l, a[1] / l, a[2] / l];
  return [t, [r[1] * t[2] - r[2] * t[1], r[2] * t[0] - r[0] * t[2], r[0] * t[1] - r[1] * t[0]]];
}
`;
const phongPdf = `function pdf(wo, wi, at) {
  const cos = -wo[0] * wi[0] - wo[1] * wi[1] + wo[2] * wi[2];
  return cos > 0 ? (at.s + 1) / (2 * Math.PI) * Math.pow(cos, at.s) : 0;
}
`;
const ggx = `function stretched(w, alpha) {
  const x = alpha * w[0], y = alpha * w[1], l = Math.sqrt(x * x + y * y + w[2] * w[2]);
  return [x / l, y / l, w[2] / l];
}
function D(m, alpha) {
  const t = 1 + (alpha * alpha - 1) * m[2] * m[2];
  return alpha * alpha / (Math.PI * t * t);
}
function G1(w, alpha) {
  const tan2 = (1 - w[2] * w[2]) / (w[2] * w[2]);
  return 2 / (1 + Math.sqrt(1 + alpha * alpha * tan2));
}
`;
const light = `// The pdf of a point of the disk, per area, becomes one per solid angle: r^2 / cos at the light.
function perSolidAngle(light, wi) {
  const c = light.position, n = light.normal;
  const down = wi[0] * n[0] + wi[1] * n[1] + wi[2] * n[2];
  const t = (c[0] * n[0] + c[1] * n[1] + c[2] * n[2]) / down;
  const x = t * wi[0] - c[0], y = t * wi[1] - c[1], z = t * wi[2] - c[2];
  if (!(t > 0) || !(down < 0) || x * x + y * y + z * z > light.radius * light.radius) return 0;
  return t * t / (-down * Math.PI * light.radius * light.radius);
}
`;

export const templates: Readonly<Record<string, Template>> = {
  uniform: {
    title: "uniform", ground: "lambert",
    code: `function sample(wo, u) {
  const z = u[0], r = Math.sqrt(1 - z * z), phi = 2 * Math.PI * u[1];
  return { wi: [r * Math.cos(phi), r * Math.sin(phi), z], pdf: 1 / (2 * Math.PI) };
}

function pdf(wo, wi) {
  return wi[2] > 0 ? 1 / (2 * Math.PI) : 0;
}
`,
  },
  cosine: {
    title: "cosine", ground: "lambert",
    code: `function sample(wo, u) {
  const r = Math.sqrt(u[0]), phi = 2 * Math.PI * u[1], z = Math.sqrt(1 - u[0]);
  return { wi: [r * Math.cos(phi), r * Math.sin(phi), z], pdf: z / Math.PI };
}

function pdf(wo, wi) {
  return wi[2] > 0 ? wi[2] / Math.PI : 0;
}
`,
  },
  phong: {
    title: "Phong lobe", ground: "phong",
    code: `${basis}
// at.s is the exponent of the surface, at.alpha its roughness.
function sample(wo, u, at) {
  const r = [-wo[0], -wo[1], wo[2]];
  const [t, b] = basis(r);
  const cos = Math.pow(1 - u[0], 1 / (at.s + 1)), sin = Math.sqrt(1 - cos * cos), phi = 2 * Math.PI * u[1];
  const x = sin * Math.cos(phi), y = sin * Math.sin(phi);
  const wi = [x * t[0] + y * b[0] + cos * r[0], x * t[1] + y * b[1] + cos * r[1], x * t[2] + y * b[2] + cos * r[2]];
  return { wi, pdf: (at.s + 1) / (2 * Math.PI) * Math.pow(cos, at.s) };
}

${phongPdf}`,
  },
  ggx: {
    title: "GGX visible normals", ground: "ggx",
    code: `${ggx}
// Dupuy and Benyoub 2023: a point of a spherical cap in the stretched space.
function sample(wo, u, at) {
  const alpha = at.alpha, v = stretched(wo, alpha);
  const z = (1 - u[0]) * (1 + v[2]) - v[2], sin = Math.sqrt(Math.max(0, 1 - z * z)), phi = 2 * Math.PI * u[1];
  const h = [sin * Math.cos(phi) + v[0], sin * Math.sin(phi) + v[1], z + v[2]];
  const m = [alpha * h[0], alpha * h[1], Math.max(h[2], 1e-12)];
  const l = Math.sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]), n = [m[0] / l, m[1] / l, m[2] / l];
  const d = 2 * (wo[0] * n[0] + wo[1] * n[1] + wo[2] * n[2]);
  const wi = [d * n[0] - wo[0], d * n[1] - wo[1], d * n[2] - wo[2]];
  return { wi, pdf: wi[2] > 0 ? G1(wo, alpha) * D(n, alpha) / (4 * wo[2]) : 0 };
}

function pdf(wo, wi, at) {
  if (!(wi[2] > 0)) return 0;
  const x = wo[0] + wi[0], y = wo[1] + wi[1], z = wo[2] + wi[2], l = Math.sqrt(x * x + y * y + z * z);
  return G1(wo, at.alpha) * D([x / l, y / l, z / l], at.alpha) / (4 * wo[2]);
}
`,
  },
  mixture: {
    title: "mixture of cosine and Phong", ground: "both",
    code: `const numbers = 3; // of a sample: two for the direction, one for the choice
const q = 0.5; // the probability of the lobe

${basis}
function lobe(wo, wi, s) {
  const cos = -wo[0] * wi[0] - wo[1] * wi[1] + wo[2] * wi[2];
  return cos > 0 ? (s + 1) / (2 * Math.PI) * Math.pow(cos, s) : 0;
}

function sample(wo, u, at) {
  const phi = 2 * Math.PI * u[1];
  if (u[2] >= q) {
    const r = Math.sqrt(u[0]);
    const wi = [r * Math.cos(phi), r * Math.sin(phi), Math.sqrt(1 - u[0])];
    return { wi, pdf: pdf(wo, wi, at) };
  }
  const r = [-wo[0], -wo[1], wo[2]];
  const [t, b] = basis(r);
  const cos = Math.pow(1 - u[0], 1 / (at.s + 1)), sin = Math.sqrt(1 - cos * cos);
  const x = sin * Math.cos(phi), y = sin * Math.sin(phi);
  const wi = [x * t[0] + y * b[0] + cos * r[0], x * t[1] + y * b[1] + cos * r[1], x * t[2] + y * b[2] + cos * r[2]];
  return { wi, pdf: pdf(wo, wi, at) };
}

function pdf(wo, wi, at) {
  return q * lobe(wo, wi, at.s) + (1 - q) * (wi[2] > 0 ? wi[2] / Math.PI : 0);
}
`,
  },
  light: {
    title: "a disk light", ground: "lit",
    code: `${light}
// at.lights has kind, position, normal, radius and radiance of each light, as the surface point sees it.
function sample(wo, u, at) {
  const light = at.lights[0];
  if (!light || !light.shines) return null; // nothing is drawn
  const n = light.normal, s = n[2] >= 0 ? 1 : -1, a = -1 / (s + n[2]), k = n[0] * n[1] * a;
  const t = [1 + s * n[0] * n[0] * a, s * k, -s * n[0]], b = [k, s + n[1] * n[1] * a, -n[1]];
  const r = light.radius * Math.sqrt(u[0]), phi = 2 * Math.PI * u[1], x = r * Math.cos(phi), y = r * Math.sin(phi);
  const p = light.position.map((c, i) => c + x * t[i] + y * b[i]);
  const l = Math.sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]), wi = [p[0] / l, p[1] / l, p[2] / l];
  const down = wi[0] * n[0] + wi[1] * n[1] + wi[2] * n[2];
  return { wi, pdf: l * l / (-down * Math.PI * light.radius * light.radius) };
}

function pdf(wo, wi, at) {
  const light = at.lights[0];
  return light && light.shines ? perSolidAngle(light, wi) : 0;
}
`,
  },
};
