// The user's sampler elsewhere: a program for `crescent check --exec`, which runs the same code, and skeletons in C++
// and Python with the code to translate next to them.

export const exports: [string, string][] = [["program", "a program for node, and its command"], ["cpp", "a C++ struct"], ["python", "a Python function"]];

const numbersOf = (code: string): number => Number(/^\s*const numbers = (\d)/m.exec(code)?.[1] ?? 2);
const usesContext = (code: string): boolean => /function\s+(sample|pdf)\s*\([^)]*,[^)]*,/.test(code);
const commented = (code: string, mark: string, indent = ""): string => code.trimEnd().split("\n").map((line) => `${indent}${mark} ${line}`.trimEnd()).join("\n");

function program(code: string): string {
  const context = usesContext(code), numbers = numbersOf(code);
  const hello = context ? `hello 3 sampler u=${numbers} domain=hemisphere real=f64 uses=s,alpha,rho_d,rho_s,lights` : `hello 2 sampler u=${numbers} domain=hemisphere real=f64`;
  return `// sampler.mjs, for
//   crescent check --exec 'node sampler.mjs'
// Local frame, n = +z; w_o is given, w_i is drawn; pdf in 1/sr.

${code.trimEnd()}

// ---- Answers of crescent's protocol, docs/samplers.md.

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
  if (verb === "hello") return "${hello}";
  const v = words.map(Number);
  if (verb === "sample") {
    const d = sample(v.slice(0, 3), v.slice(3, ${3 + numbers}), contextOf(v.slice(${3 + numbers})));
    return d ? [...d.wi, d.pdf].join(" ") : "0 0 1 0";
  }
  const [wo, wi] = [v.slice(0, 3), v.slice(3, 6)];
  if (verb === "pdf") return String(pdf(wo, wi, contextOf(v.slice(6))));
  return typeof f === "function" ? String(f(wo, wi, contextOf(v.slice(6)))) : "-";
}
let rest = "";
process.stdin.setEncoding("utf8").on("data", (text) => {
  const lines = (rest + text).split("\\n");
  rest = lines.pop();
  if (lines.length > 0) process.stdout.write(lines.map(answer).join("\\n") + "\\n");
});
`;
}

function cpp(code: string): string {
  const numbers = numbersOf(code);
  return `// sampler.h: the sampler as a struct for crescent::check_sampler and in a renderer. Translate the lines of JavaScript.
// Check it: EXPECT_THAT(Sampler{}, crescent::IsARightSampler()), or with crescent/check.h
//   crescent::check_sampler("sampler", Sampler{})
#include <array>
#include <cmath>
#include <optional>

struct Sampler {
    struct Drawn {
        std::array<double, 3> wi;
        double pdf;  // 1/sr
    };
${usesContext(code) ? "    double s = 32, alpha = 0.3;  // of the surface: at.s, at.alpha\n" : ""}
    std::optional<Drawn> sample(std::array<double, 3> wo, std::array<double, ${numbers}> u) const;  // empty: nothing is drawn
    double pdf(std::array<double, 3> wo, std::array<double, 3> wi) const;
};

${commented(code, "//")}
`;
}

function python(code: string): string {
  const numbers = numbersOf(code), context = usesContext(code), third = context ? ", ctx" : "";
  return `# sampler.py: the sampler on arrays. Translate the lines of JavaScript. Check it:
#   crescent check sampler.py:sampler
import numpy as np
import crescent


def sample(wo, u${third}):  # wo[n, 3], u[n, ${numbers}]${context ? ", ctx.s[n], ctx.alpha[n], ctx.lights" : ""}
    raise NotImplementedError  # return wi[n, 3], pdf[n]


def pdf(wo, wi${third}):  # wo[n, 3], wi[n, 3]
    raise NotImplementedError  # return pdf[n], 1/sr


sampler = crescent.Sampler(sample, pdf, u=${numbers}${context ? ', uses=("s", "alpha", "lights")' : ""})

${commented(code, "#")}
`;
}

export function exported(format: string, code: string): { name: string; text: string } {
  if (format === "cpp") return { name: "sampler.h", text: cpp(code) };
  if (format === "python") return { name: "sampler.py", text: python(code) };
  return { name: "sampler.mjs", text: program(code) };
}
