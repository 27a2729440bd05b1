// node exports.mjs BUNDLE MODULE FOLDER: writes into it what the page exports, NAME.py and NAME.h; draws.cpp, which prints
// what the C++ gives; and expected.json, for exports.py.
import { readFileSync, writeFileSync } from "node:fs";
const [bundle, compiled, folder] = process.argv.slice(2);
const { exportsOf, given, partly } = await import(bundle);
const all = exportsOf(await WebAssembly.compile(readFileSync(compiled))), write = (name, text) => writeFileSync(`${folder}/${name}`, text);
for (const { name, python, cpp } of all) write(`${name}.py`, python), write(`${name}.h`, cpp);
const headers = new Set(all.flatMap(({ cpp }) => cpp.match(/^#include <.*>$/gm)));
const number = (x) => (Number.isInteger(x) ? `${x}.0` : String(x)), row = ({ wo, u }) => `{{${wo.map(number)}}, {${u.map(number)}}}`;
write("draws.cpp", `${[...headers].join("\n")}
#include <cstdio>
#include "check/user.h"
struct Given { std::array<double, 3> wo, u; };
constexpr std::array<Given, ${given.length}> given{{${given.map(row).join(",\n")}}};
template <class S> void print(const char* name) {
    static_assert(crescent::user::Checkable<S>);
    const S s;
    for (std::size_t k = 0; k < given.size(); ++k) {
        const auto& [wo, u] = given[k];
        const double p = s.pdf(wo, given[(k + 1) % given.size()].wo);
        const auto drawn = [&] { if constexpr (requires { s.sample(wo, u); }) return s.sample(wo, u); else return s.sample(wo, {u[0], u[1]}); }();
        if (drawn) std::printf("%s %.17g %.17g %.17g %.17g %.17g\\n", name, drawn->wi[0], drawn->wi[1], drawn->wi[2], drawn->pdf, p);
        else std::printf("%s - - - - %.17g\\n", name, p);
    }
}
${all.map(({ name, cpp }) => `namespace of_${name} {\n${cpp.replace("#pragma once", "")}}`).join("\n")}
int main() {
${all.map(({ name }) => `    print<of_${name}::Sampler>("${name}");`).join("\n")}
}
`);
write("expected.json", JSON.stringify(Object.fromEntries(all.map(({ name, states, rows }) => [name, { states, rows }]))));
const { python, cpp } = partly();
for (const text of [python, cpp])
  for (const words of [/line 1: .* has no translation/, /line 4: console.log\(\) has no translation/, /line 6: a switch statement has no translation/, /line 10: Math.random of 0 arguments has no translation/, /a comment/])
    if (!words.test(text)) throw new Error(`no ${words} in\n${text}`);
