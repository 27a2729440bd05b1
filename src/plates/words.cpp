// Names, axes and formulas are those of ArmInfo for the arm's sampler, formulas set by base/formula.h. {fmt} prints
// numbers, which are then given a true minus and powers of ten as superscripts.
#include "plates/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "arms/info.h"
#include "base/formula.h"
#include "experiment/arm_facts.h"
#include "math/functions.h"
#include "plates/canvas.h"

namespace crescent::plates {

namespace {

std::string formula_of(const std::string& arm, const Experiment& e, const crescent::formula::Value& value = {}) {
    const ArmInfo* info = find_arm_info(sampler_of(arm, e));
    if (!info) return "p(ω) of a sampler from outside";
    const std::string line = crescent::formula::pango(info->formula, value);
    return info->techniques > 1 ? line : "p(ω) = " + line;
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
    const ArmInfo* info = sampler_of(arm, e) == arm ? find_arm_info(arm) : nullptr;
    return escaped(info ? std::string(info->label) : arm);
}

std::string axis_of(const std::string& arm, const Experiment& e) {
    const ArmInfo* info = find_arm_info(sampler_of(arm, e));
    return !info || info->about == PdfAxis::none ? "" : info->about == PdfAxis::normal ? "n" : "R";
}

std::string density_formula(const std::string& arm, const Experiment& e) { return formula_of(arm, e); }

std::string density_formula_at(const std::string& arm, double s, const Experiment& e) {
    return formula_of(arm, e, {'s', number(s), number(s + 1)});
}

std::string runs_label(const std::vector<RunKey>& runs, const Experiment& e, bool with_n) {
    std::string label = distinct(runs, [&](const RunKey& r) { return arm_name(r.arm, e); });
    const auto n_of = [&](const RunKey& r) {
        const ArmPlan* arm = e.find_arm(r.arm);
        return fmt::format("{}{}", r.n, arm && techniques_of(*arm) > 1 ? " pairs" : "");
    };
    if (with_n) label += " N=" + distinct(runs, n_of);
    std::vector<RunKey> telling;
    std::ranges::copy_if(runs, std::back_inserter(telling), [&](const RunKey& r) { return tells_s(r.arm, r.s, e); });
    return telling.empty() ? label : label + " s=" + distinct(telling, [](const RunKey& r) { return number(r.s); });
}

std::string reference_words(const Experiment& e) {
    const ReferencePlan& r = e.reference;
    if (r.kind == ReferenceKind::quadrature) return "by quadrature, no samples";
    return fmt::format("lobe {} spp, lights {} spp, seed {}", r.lobe_spp, r.disk_spp, r.seed);
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
