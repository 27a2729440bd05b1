// The user's sampler elsewhere: a program for `crescent check --exec`, which runs the same code with the f of the surface
// that it was checked on, unless the code has its own; and what is to be filled in to write it in C++ or Python.
import { directions, domainOf } from "./domains";
import { Ground, grounds } from "./templates";
import { isShader } from "./wgsl";

export const exports: [string, string][] = [["program", "a program, and its command"], ["cpp", "the frame of a C++ struct"], ["python", "the frame of a Python file"]];

const rho_d = 0.5, rho_s = 0.4; // src/check/sources/cases.cpp, case_setup

/** f of a surface, without the cosine, as in src/scene/lobes. `at` has a default, so that it is not counted as used. */
function brdf({ lobe, lambert, sharpness }: Ground): string {
  const diffuse = lambert ? `${rho_d} / Math.PI` : "", head = "// f of the surface, 1/sr, without the cosine.\nfunction f(wo, wi, at = {}) {\n  if (!(wi[2] > 0)) return 0;\n";
  const sum = (gloss: string): string => (diffuse ? `${diffuse} + ${gloss}` : gloss);
  if (lobe === "phong") return `${head}  const s = at.s ?? ${sharpness}, cos = Math.max(-wo[0] * wi[0] - wo[1] * wi[1] + wo[2] * wi[2], 0);
  return ${sum(`${rho_s} * (s + 2) / (2 * Math.PI) * Math.pow(cos, s)`)};\n}\n`;
  if (lobe === "ggx") return `${head}  const alpha = at.alpha ?? ${sharpness};
  const x = wo[0] + wi[0], y = wo[1] + wi[1], z = wo[2] + wi[2], m2 = z * z / (x * x + y * y + z * z);
  const t = 1 + (alpha * alpha - 1) * m2, D = alpha * alpha / (Math.PI * t * t);
  const g = (c) => 2 / (1 + Math.sqrt(1 + alpha * alpha * (1 - c * c) / (c * c)));
  return ${sum(`${rho_s} * D * g(wo[2]) * g(wi[2]) / (4 * wo[2] * wi[2])`)};\n}\n`;
  return `${head}  return ${diffuse};\n}\n`;
}

/** The code with the f of this ground. Under one disk light, f L would be needed: there is none. */
function withBrdf(code: string, ground: string): string {
  const on = grounds[ground];
  return !on || on.light !== "fill" || /\b(function|const|let)\s+f\b/.test(code) ? code : `${code.trimEnd()}\n\n${brdf(on)}`;
}

/** The code with the answers to its requests. */
function program(code: string, about: string, answers: string): string {
  return `// sampler.mjs, for
//   crescent check --exec 'node sampler.mjs'
// ${about}

${code.trimEnd()}

// ---- Answers of crescent's protocol, docs/samplers.md.
{
const count = typeof numbers === "number" ? numbers : 2;
${answers}
let rest = "";
process.stdin.setEncoding("utf8").on("data", (text) => {
  const lines = (rest + text).split("\\n");
  rest = lines.pop();
  if (lines.length > 0) process.stdout.write(lines.map(answer).join("\\n") + "\\n");
});
}
`;
}

const answersOfDirections = `const functions = [sample, pdf, ...(typeof f === "function" ? [f] : [])];
const uses = functions.some((one) => one.length > 2) ? " uses=s,alpha,rho_d,rho_s,lights" : "";

function contextOf(v) {
  const three = (k) => [v[k], v[k + 1], v[k + 2]];
  if (v.length === 0) return undefined;
  const lights = [];
  for (let k = 0; k < v[6]; ++k) {
    const a = 7 + 18 * k;
    lights.push({ kind: ["disk", "sphere", "rectangle"][v[a]], radius: v[a + 1], radiance: three(a + 2), position: three(a + 5),
      normal: three(a + 8), edge_u: three(a + 11), edge_v: three(a + 14), shines: v[a + 17] === 1 });
  }
  return { s: v[0], alpha: v[1], rho_d: three(2), rho_s: v[5], lights };
}
function answer(line) {
  const [verb, ...words] = line.split(" ");
  if (verb === "hello") return "hello 2 sampler u=" + count + " domain=hemisphere real=f64" + uses;
  const v = words.map(Number);
  if (verb === "sample") {
    const d = sample(v.slice(0, 3), v.slice(3, 3 + count), contextOf(v.slice(3 + count)));
    return d ? [...d.wi, d.pdf].join(" ") : "0 0 1 0";
  }
  const [wo, wi] = [v.slice(0, 3), v.slice(3, 6)];
  if (verb === "pdf") return String(pdf(wo, wi, contextOf(v.slice(6))));
  return typeof f === "function" ? String(f(wo, wi, contextOf(v.slice(6)))) : "-";
}`;

/** Of the points of a domain. */
function coordinatesOf(domain: string): number {
  const known: Record<string, number> = { line: 1, set: 1, disk: 2, square: 2, triangle: 2 };
  return domain.split(" x ").reduce((sum, part) => sum + (known[part.replace(/:.*/, "")] ?? 3), 0);
}

const answersOfPoints = (domain: string): string => `const coordinates = ${coordinatesOf(domain)}, point = (v) => (coordinates === 1 ? v[0] : v);

function answer(line) {
  const [verb, ...words] = line.split(" ");
  if (verb === "hello") return "hello 2 sampler u=" + count + " domain=" + domain + " real=f64";
  const v = words.map(Number);
  if (verb === "sample") {
    const d = sample(v);
    return (d ? [d.x, d.pdf].flat() : Array(coordinates + 1).fill(0)).join(" ");
  }
  if (verb === "pdf") return String(pdf(point(v)));
  return typeof f === "function" ? String(f(point(v))) : "-";
}`;

/** The code as comments, for who writes it in another language. */
const commented = (code: string, mark: string): string => code.trimEnd().split("\n").map((line) => `${mark} ${line}`.trimEnd()).join("\n");

const cpp = (code: string, language: string): string => `// sampler.h: the frame of a sampler, to be filled in. Check it by crescent/gtest.h or crescent/check.h:
//   EXPECT_THAT(Sampler{}, crescent::IsARightSampler());
//   crescent::check_sampler("sampler", Sampler{});
// Local frame, n = +z; w_o is given, w_i is drawn, both leave the surface; pdf in 1/sr.
#pragma once

#include <array>
#include <optional>

struct Sampler {
    using Vec3 = std::array<double, 3>;
    struct Drawn {
        Vec3 wi;
        double pdf;
    };

    // u: as many numbers in [0, 1) as the sampler takes, 1 to 8. nullopt: nothing is drawn.
    std::optional<Drawn> sample(const Vec3& wo, const std::array<double, 2>& u) const;
    double pdf(const Vec3& wo, const Vec3& wi) const;
    // The BRDF without the cosine, 1/sr; leave it out if there is none.
    double f(const Vec3& wo, const Vec3& wi) const;
};

// The same in ${language}:
${commented(code, "//")}
`;

const python = (code: string, language: string): string => `# sampler.py: the frame of a sampler, to be filled in. Check it:
#   crescent check sampler.py:sampler
# Local frame, n = +z; w_o is given, w_i is drawn, both leave the surface; pdf in 1/sr. Arrays have a row for each draw.
import crescent


def sample(wo, u):  # wo[n, 3], u[n, 2] in [0, 1): wi[n, 3] and pdf[n], 0 where nothing is drawn
    raise NotImplementedError


def pdf(wo, wi):  # wo[n, 3], wi[n, 3]: pdf[n]
    raise NotImplementedError


sampler = crescent.Sampler(sample, pdf, name="sampler")

# The same in ${language}:
${commented(code, "#")}
`;

const cppOfPoints = (domain: string, code: string): string => `// sampler.h: the frame of a sampler, to be filled in. Check it by crescent/gtest.h or crescent/check.h:
//   EXPECT_THAT(sampler, crescent::IsARightSampler());
//   crescent::check_sampler("sampler", sampler);
// Domain and density: docs/domains.md.
#pragma once

#include <crescent/check.h>
#include <span>

// u: as many numbers in [0, 1) as the sampler takes. Writes the point and returns its density, 0 if nothing is drawn.
double sample(std::span<const double> u, std::span<double> x);
double pdf(std::span<const double> x);

inline const crescent::PointSampler sampler{.domain = ${JSON.stringify(domain)}, .sample = sample, .pdf = pdf};

// The same in JavaScript:
${commented(code, "//")}
`;

const rowsOf = (domain: string): string => (coordinatesOf(domain) === 1 ? "x[n]" : `x[n, ${coordinatesOf(domain)}]`);
const pythonOfPoints = (domain: string, code: string): string => `# sampler.py: the frame of a sampler, to be filled in. Check it:
#   crescent check sampler.py
# Domain and density: docs/domains.md. Arrays have a row for each draw.
domain = ${JSON.stringify(domain)}


def sample(u):  # u[n, 2] in [0, 1): ${rowsOf(domain)} and pdf[n], 0 where nothing is drawn
    raise NotImplementedError


def pdf(x):  # ${rowsOf(domain)}: pdf[n]
    raise NotImplementedError

# The same in JavaScript:
${commented(code, "#")}
`;

/** The sampler in this format, with the f of this ground (apps/web/templates.ts). */
export function exported(format: string, code: string, ground: string): { name: string; text: string } {
  const wgsl = isShader(code), domain = domainOf(code);
  if (domain !== directions) {
    if (format === "cpp") return { name: "sampler.h", text: cppOfPoints(domain, code) };
    if (format === "python") return { name: "sampler.py", text: pythonOfPoints(domain, code) };
    return { name: "sampler.mjs", text: program(code, `Points of the domain ${domain}, docs/domains.md.`, answersOfPoints(domain)) };
  }
  const whole = wgsl ? code : withBrdf(code, ground), language = wgsl ? "WGSL" : "JavaScript";
  if (format === "cpp") return { name: "sampler.h", text: cpp(whole, language) };
  if (format === "python") return { name: "sampler.py", text: python(whole, language) };
  if (wgsl) return { name: "sampler.wgsl", text: `// crescent check sampler.wgsl\n${code}` };
  const about = "Local frame, n = +z; w_o is given, w_i is drawn; pdf in 1/sr.";
  return { name: "sampler.mjs", text: program(whole, about, answersOfDirections) };
}
