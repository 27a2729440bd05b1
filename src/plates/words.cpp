#include "plates/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "math/functions.h"
#include "plates/canvas.h"

namespace crescent::plates {

namespace {

struct Sampler {
    const char *word, *name, *axis, *formula;
};
// Densities in 1/sr, weights for the arms that combine two; {s1} stands for s + 1 and {s} for s.
constexpr Sampler samplers[] = {
    {"uniform", "Uniform", "n", "p(ω) = 1/(2π)"},
    {"cosine", "Cosine", "n", "p(ω) = (n·ω)/π"},
    {"phong", "Phong-IS", "R", "p(ω) = {s1}/(2π) (ω·R)<sup>{s}</sup>"},
    {"mixture", "Mixture", "", "p = q p<sub>phong</sub> + (1−q) p<sub>cosine</sub>"},
    {"mis-balance", "MIS, balance", "", "w<sub>i</sub> = p<sub>i</sub> / (p<sub>1</sub> + p<sub>2</sub>)"},
    {"mis-power", "MIS, power", "",
        "w<sub>i</sub> = p<sub>i</sub><sup>2</sup> / (p<sub>1</sub><sup>2</sup> + p<sub>2</sub><sup>2</sup>)"},
    {"light-solid-angle", "NEE, by angle", "", "p(ω) = 1/(2π (1 − cos β))"},
    {"light-area", "NEE, by area", "", "p(ω) = |y − x|<sup>2</sup>/(π r<sup>2</sup> cos θ<sub>l</sub>)"},
    {"blinn", "Blinn", "", "p(ω) = {s1}/(2π) (n·m)<sup>{s}</sup>/(4 ω<sub>o</sub>·m)"},
    {"ggx-d", "GGX D", "", "p(ω) = D(m) (n·m)/(4 ω<sub>o</sub>·m)"},
    {"ggx-vndf", "GGX VNDF", "", "p(ω) = G<sub>1</sub>(ω<sub>o</sub>) D(m)/(4 n·ω<sub>o</sub>)"},
};

const Sampler* find(const std::string& word) {
    for (const Sampler& s : samplers) {
        if (word == s.word) return &s;
    }
    return nullptr;
}

void replace(std::string& text, const std::string& what, const std::string& by) {
    if (auto at = text.find(what); at != std::string::npos) text.replace(at, what.size(), by);
}

std::string formula(const std::string& arm, const Experiment& e, const std::string& s, const std::string& s1) {
    std::string word = sampler_of(arm, e);
    const Sampler* known = find(word);
    if (!known) return "sampler " + escaped(word.empty() ? arm : word);
    std::string text = known->formula;
    replace(text, "{s1}", s1);
    replace(text, "{s}", s);
    return text;
}

// The distinct values in order of appearance, joined by " | ".
template <class F> std::string distinct(const std::vector<RunKey>& runs, F text) {
    std::vector<std::string> seen;
    for (const RunKey& r : runs) {
        std::string t = text(r);
        if (std::find(seen.begin(), seen.end(), t) == seen.end()) seen.push_back(t);
    }
    return joined(seen, " | ");
}

std::string not_finite_word(double v) { return std::isnan(v) ? "not a number" : v > 0 ? "∞" : "−∞"; }

// A number as printf leaves it, with a true minus and its power of ten set as one.
std::string typeset(std::string text) {
    if (auto e = text.find('e'); e != std::string::npos) {
        int power = std::stoi(text.substr(e + 1));
        std::string exponent = (power < 0 ? "−" : "") + std::to_string(std::abs(power));
        text = text.substr(0, e) + "·10<sup>" + exponent + "</sup>";
    }
    if (text[0] == '-') text.replace(0, 1, "−");
    return text;
}

}  // namespace

std::string joined(const std::vector<std::string>& parts, std::string_view between) {
    std::string all;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (i > 0) all += between;
        all += parts[i];
    }
    return all;
}

RunKey key_of(const PlateRun& run, const Experiment& e) { return {run.arm, run.n, run.s > 0 ? run.s : e.s(), e.seed}; }

std::vector<RunKey> keys_of(const PlatePlan& plan, const Experiment& e) {
    std::vector<RunKey> keys;
    for (const PlateRun& r : plan.runs) keys.push_back(key_of(r, e));
    return keys;
}

std::string sampler_of(const std::string& arm, const Experiment& e) {
    for (const ArmPlan& a : e.arms) {
        if (a.name == arm) return a.sampler;
    }
    return {};
}

std::string arm_name(const std::string& arm, const Experiment& e) {
    const Sampler* known = sampler_of(arm, e) == arm ? find(arm) : nullptr;
    return known ? known->name : escaped(arm);
}

std::string axis_of(const std::string& arm, const Experiment& e) {
    const Sampler* known = find(sampler_of(arm, e));
    return known ? known->axis : "";
}

std::string density_formula(const std::string& arm, const Experiment& e) { return formula(arm, e, "s", "(s+1)"); }

std::string density_formula_at(const std::string& arm, double s, const Experiment& e) {
    return formula(arm, e, number(s), number(s + 1));
}

std::string runs_label(const std::vector<RunKey>& runs, const Experiment& e, bool with_n) {
    std::string label = distinct(runs, [&](const RunKey& r) { return arm_name(r.arm, e); });
    if (with_n) label += " N=" + distinct(runs, [](const RunKey& r) { return fmt::format("{}", r.n); });
    return label + " s=" + distinct(runs, [](const RunKey& r) { return number(r.s); });
}

std::string reference_words(const Experiment& e) {
    const ReferencePlan& r = e.reference;
    if (r.kind == ReferenceKind::quadrature) return "by quadrature, no samples";
    return fmt::format("lobe {} spp, disk {} spp, seed {}", r.lobe_spp, r.disk_spp, r.seed);
}

std::string number(double v, int digits) {
    if (!std::isfinite(v)) return not_finite_word(v);
    return typeset(fmt::format("{:.{}g}", v, digits));
}

std::string figure(double v, int digits) {
    if (!std::isfinite(v)) return not_finite_word(v);
    if (v == 0) return "0";
    const double unit = math::pow(10.0, digits - 1);  // from here on all the digits stand before the point
    if (std::abs(v) >= unit - 0.05 && std::abs(v) < 1e7) return typeset(fmt::format("{:.0f}", v));
    std::string text = typeset(fmt::format("{:#.{}g}", v, digits));
    if (text.back() == '.') text.pop_back();
    return text;
}
std::string count(std::uint64_t v) {
    std::string digits = std::to_string(v), out;
    for (std::size_t i = 0; i < digits.size(); ++i) {
        if (i > 0 && (digits.size() - i) % 3 == 0 && digits.size() > 4) out += "\u2009";
        out += digits[i];
    }
    return out;
}

}  // namespace crescent::plates
