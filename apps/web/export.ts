// The user's sampler elsewhere: a program for `crescent check --exec`, which runs the same code, and its translation
// into C++ and Python. Each has the f of the surface that the sampler was checked on, unless the code has its own.
import { Program, understood } from "./kinds";
import { Ground, grounds } from "./templates";
import { cppMembers } from "./to_cpp";
import { pythonCode } from "./to_python";

export const exports: [string, string][] = [["program", "a program for node, and its command"], ["cpp", "a C++ struct"], ["python", "a Python function"]];

const numbersOf = (code: string): number => Number(/^\s*const numbers = (\d)/m.exec(code)?.[1] ?? 2);
const usesContext = (code: string): boolean => understood(code).context;
const rho_d = 0.5, rho_s = 0.4; // src/check/sources/cases.cpp, case_setup

/** f of a surface, without the cosine, as in src/scene/lobes. */
function brdf({ lobe, lambert, sharpness }: Ground, context: boolean): string {
  const diffuse = lambert ? `${rho_d} / Math.PI` : "", head = `// f of the surface, 1/sr, without the cosine.\nfunction f(wo, wi${context ? ", at" : ""}) {\n  if (!(wi[2] > 0)) return 0;\n`;
  const sum = (gloss: string): string => (diffuse ? `${diffuse} + ${gloss}` : gloss);
  if (lobe === "phong") {
    const s = context ? "at.s" : String(sharpness);
    return `${head}  const cos = Math.max(-wo[0] * wi[0] - wo[1] * wi[1] + wo[2] * wi[2], 0);\n  return ${sum(`${rho_s} * (${s} + 2) / (2 * Math.PI) * Math.pow(cos, ${s})`)};\n}\n`;
  }
  if (lobe === "ggx") return `${head}  const alpha = ${context ? "at.alpha" : sharpness};
  const x = wo[0] + wi[0], y = wo[1] + wi[1], z = wo[2] + wi[2], m2 = z * z / (x * x + y * y + z * z);
  const t = 1 + (alpha * alpha - 1) * m2, D = alpha * alpha / (Math.PI * t * t);
  const g = (c) => 2 / (1 + Math.sqrt(1 + alpha * alpha * (1 - c * c) / (c * c)));
  return ${sum(`${rho_s} * D * g(wo[2]) * g(wi[2]) / (4 * wo[2] * wi[2])`)};\n}\n`;
  return `${head}  return ${diffuse};\n}\n`;
}
/** The code with the f of this ground. Under one disk light, f L would be needed: there is none. */
function withBrdf(code: string, ground: string): string {
  const on = grounds[ground];
  return !on || on.light !== "fill" || /\b(function|const|let)\s+f\b/.test(code) ? code : `${code.trimEnd()}\n\n${brdf(on, usesContext(code))}`;
}

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

const values = (three: readonly number[]): string => `{${three.map((x) => x.toPrecision(17).replace(/\.?0+$/, "")).join(", ")}}`;
/** The direction at theta and phi degrees, times r. */
function polar(theta: number, phi: number, r: number): number[] {
  const t = (theta * Math.PI) / 180, p = (phi * Math.PI) / 180;
  return [r * Math.sin(t) * Math.cos(p), r * Math.sin(t) * Math.sin(p), r * Math.cos(t)];
}

/** What the third argument is in C++: a member with the surface of the ground, and its light (src/check/sources/cases.cpp, light_named). */
function cppSurface(p: Program, { lobe, lambert, sharpness, light }: Ground): string {
  if (!p.context) return "";
  const lit = p.uses.includes("lights"), d = lambert ? rho_d : 0, s = lobe === "ggx" ? 32 : sharpness, alpha = lobe === "ggx" ? sharpness : 0.3;
  const disk = light === "disk" ? `{{"disk", 0.5, {20, 20, 20}, ${values(polar(35, 20, 2))}, ${values(polar(20, 60, -1))}, {}, {}, true}}` : "{}";
  return `${lit ? `    struct Light {
        std::string kind;  // "disk", "sphere", "rectangle"
        double radius;     // m
        Vec3 radiance;     // W/(sr m²)
        Vec3 position, normal, edge_u, edge_v;  // m, in the local frame
        bool shines;       // it faces the point
    };
` : ""}    struct Surface {
        double s, alpha;
        Vec3 rho_d;
        double rho_s;
${lit ? "        std::vector<Light> lights;\n" : ""}    };
    Surface surface{${s}, ${alpha}, {${d}, ${d}, ${d}}, ${lobe ? rho_s : 0}${lit ? `, ${disk}` : ""}};

`;
}

function cpp(code: string, ground: string): string {
  const p = understood(withBrdf(code, ground)), members = cppMembers(p), on = grounds[ground] ?? grounds["lambert"]!;
  const body = cppSurface(p, on) + members, has = (words: string): boolean => body.includes(words);
  const headers = ["<algorithm>", "<array>", "<cmath>", ...(has("std::size_t") ? ["<cstddef>"] : []), ...(has("numeric_limits") ? ["<limits>"] : []), "<numbers>", "<optional>",
    ...(has("logic_error") ? ["<stdexcept>"] : []), ...(has("std::string") ? ["<string>"] : []), ...(has("invoke_result") ? ["<type_traits>"] : []), ...(has("std::vector") ? ["<vector>"] : [])];
  return `// sampler.h: a sampler from crescent's page, translated from JavaScript. Check it by crescent/gtest.h or crescent/check.h:
//   EXPECT_THAT(Sampler{}, crescent::IsARightSampler());
//   crescent::check_sampler("sampler", Sampler{});
// Local frame, n = +z; w_o is given, w_i is drawn, both leave the surface; pdf in 1/sr.
#pragma once

${headers.map((name) => `#include ${name}`).join("\n")}

struct Sampler {
    using Vec3 = std::array<double, 3>;
    struct Drawn {
        Vec3 wi;
        double pdf;
    };

${body}
};
`;
}

function python(code: string, ground: string): string {
  const p = understood(withBrdf(code, ground)), uses = p.context && p.uses.length > 0, lit = p.uses.includes("lights");
  const call = (name: string, second: string): string => `${name}(wo[i], ${second}[i]${(p.functions.get(name)?.parameters.length ?? 2) > 2 ? (uses ? ", surface(ctx, i)" : ", None") : ""})`;
  const third = uses ? ", ctx" : "", names = ["pdf", ...(p.functions.has("f") ? ["f"] : [])];
  const fields = p.uses.filter((name) => name !== "lights").map((name) => `${name}=ctx.${name}[i]`);
  const light = ["radius", "radiance", "position", "normal", "edge_u", "edge_v", "shines"].map((name) => `${name}=all.${name}[i, k]`);
  return `# sampler.py: a sampler from crescent's page, translated from JavaScript. Check it:
#   crescent check sampler.py:sampler
# Local frame, n = +z; w_o is given, w_i is drawn, both leave the surface; pdf in 1/sr.
${uses ? "from types import SimpleNamespace\n\n" : ""}import numpy as np

import crescent


${pythonCode(p).trim()}


# ---- On arrays.

${lit ? `
def lights(ctx, i):  # of row i
    all = ctx.lights
    return [SimpleNamespace(kind=all.kind[k], ${light.slice(0, 4).join(", ")},
                            ${light.slice(4).join(", ")})
            for k in range(len(all.kind))]

` : ""}${uses ? `
def surface(ctx, i):  # of row i
    return SimpleNamespace(${[...fields, ...(lit ? ["lights=lights(ctx, i)"] : [])].join(", ")})

` : ""}
def sample_rows(wo, u${third}):  # wo[n, 3], u[n, ${p.numbers}]
    wi, density = np.tile([0.0, 0.0, 1.0], (len(wo), 1)), np.zeros(len(wo))
    with np.errstate(all="ignore"):
        for i in range(len(wo)):
            drawn = ${call("sample", "u")}
            if drawn is not None:
                wi[i], density[i] = drawn
    return wi, density  # 0: nothing is drawn

${names.map((name) => `
def ${name}_rows(wo, wi${third}):  # wo[n, 3], wi[n, 3]
    with np.errstate(all="ignore"):
        return np.array([${call(name, "wi")} for i in range(len(wo))], float)
`).join("\n")}

sampler = crescent.Sampler(${["sample_rows", ...names.map((name) => `${name}_rows`)].join(", ")}, u=${p.numbers}${uses ? `, uses=(${p.uses.map((name) => `"${name}",`).join(" ")})` : ""}, name="sampler", serial=True)
`;
}

/** The sampler in this format, with the f of this ground (apps/web/templates.ts). */
export function exported(format: string, code: string, ground: string): { name: string; text: string } {
  if (format === "cpp") return { name: "sampler.h", text: cpp(code, ground) };
  if (format === "python") return { name: "sampler.py", text: python(code, ground) };
  return { name: "sampler.mjs", text: program(withBrdf(code, ground)) };
}
