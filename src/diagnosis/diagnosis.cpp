// A factor explains the ratios where, up to one constant, nine of ten of them are it to 0.2 %, to a fiftieth of how far
// they are from one, and what they are known to. The density that is drawn is 1 / |J| where one u alone reaches a
// direction; where there is no warp at hand, or several u reach one direction, bins tell: draws weighed by 1 / (c g)
// must come to the mass that p has in each bin.
#include "diagnosis/diagnosis.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "math/functions.h"
#include "stats/quantiles.h"
#include "trials/trial_context.h"
#include "warps/jacobian.h"

namespace crescent::inline diagnosis {

namespace {

constexpr double close_to_one = 2e-3;       // relative
constexpr double most_ratios = 0.9;         // of all ratios
constexpr std::size_t fewest_ratios = 100;  // ratios

/// Mean without the largest tenth.
double trimmed(std::vector<double> v) {
    std::sort(v.begin(), v.end());
    v.resize(std::max<std::size_t>(v.size() * 9 / 10, 1));
    double sum = 0;
    for (double x : v) sum += x;
    return sum / static_cast<double>(v.size());
}

std::vector<double> sizes(std::span<const double> v, double middle) {
    std::vector<double> out;
    for (double x : v) out.push_back(std::fabs(x - middle));
    return out;
}

struct Fitted {
    bool fits = false;
    double constant = 1, left = 0, all = 0;  // trimmed means of |log|
};

/// Whether a factor with the constant 1 explains most of a few ratios: what does not is not tried on all.
bool may_be_whole(const Factor& factor, std::span<const Ratio> ratios) {
    std::size_t inside = 0, tried = 0;
    for (std::size_t i = 0; i < ratios.size(); i += 1 + ratios.size() / 64, ++tried)
        inside += std::fabs(ratios[i].value / factor.g(ratios[i].wi) - 1) <= close_to_one + 2 * ratios[i].error;
    return 4 * inside >= 3 * tried;
}

Fitted fit(const TrialContext& work, const Factor& factor, std::span<const Ratio> ratios) {
    work.subject.make_way(4 * ratios.size());
    if (factor.whole && !may_be_whole(factor, ratios)) return {};
    std::vector<double> logs, raw, errors;
    for (const Ratio& r : ratios) {
        const double g = factor.g(r.wi);
        if (!(g > 0) || !std::isfinite(g)) continue;
        logs.push_back(math::log(r.value / g));
        raw.push_back(math::log(r.value));
        errors.push_back(r.error);
    }
    if (logs.size() < ratios.size() * 9 / 10) return {};
    const double middle = median_of(logs), all = trimmed(sizes(raw, 0));
    std::size_t inside = 0;
    for (std::size_t i = 0; i < logs.size(); ++i) inside += std::fabs(logs[i] - middle) <= may_differ(all, errors[i]);
    return {static_cast<double>(inside) >= most_ratios * static_cast<double>(ratios.size()), math::exp(middle),
        trimmed(sizes(logs, middle)), all};
}

}  // namespace

bool mostly_one(std::span<const Ratio> ratios) {
    std::size_t one = 0;
    for (const Ratio& r : ratios) one += std::fabs(r.value - 1) <= 1e-3 + 2 * r.error;
    return 2 * one >= ratios.size();
}

double may_differ(double all, double error) {
    return std::min(close_to_one, 0.02 * all) + std::min(2 * error, 0.1 * all);
}

namespace {

/// "eta^2" where a constant across the surface is a power of it.
void name_eta(const TrialContext& work, Diagnosis& d) {
    if (d.name != "a constant" || !work.traits.eta || !(work.traits.eta->x > 0)) return;
    const double power = math::log(d.constant) / math::log(work.traits.eta->x), even = 2 * std::round(power / 2);
    if (even == 0 || !(std::fabs(power - even) < 0.02)) return;
    d.name = "eta^2";
    d.means = fmt::format("a constant {:.5g} = eta^{:g}", d.constant, even);
}

/// What is right on one side of the surface and off by a factor on the other.
std::optional<Diagnosis> explain_one_side(const TrialContext& work, std::span<const Ratio> ratios) {
    const Vec3d wo = work.trial.wo;
    for (bool across : {true, false}) {
        std::vector<Ratio> off, right;
        for (const Ratio& r : ratios) (((r.wi.z * wo.z < 0) == across) ? off : right).push_back(r);
        std::size_t one = 0;
        for (const Ratio& r : right) one += std::fabs(r.value - 1) <= close_to_one + 2 * r.error;
        // Few may be on the side that is right, as at the normal of glass: what it comes to is looked at with every
        // draw.
        if (off.size() < fewest_ratios / 4 || right.empty() || mostly_one(off)) continue;
        if (static_cast<double>(one) < most_ratios * static_cast<double>(right.size())) continue;
        for (const Factor& factor : factors_of_side(work, across)) {
            const Fitted f = fit(work, factor, off);
            if (!f.fits || !(f.all > 0)) continue;
            Diagnosis d{factor.name, f.constant, std::clamp(1 - f.left / f.all, 0.0, 1.0),
                factor_text(work, factor.name, f.constant), {}};
            if (across) name_eta(work, d);
            if (d.name == "a constant" && name_of_constant(work, d.constant).empty()) {
                if (work.traits.eta || !across) continue;
                const double index = math::exp(0.5 * std::fabs(math::log(d.constant)));
                d.means +=
                    fmt::format(", which is eta^2 or 1/eta^2 where the index, that was not told, is {:.4g},", index);
            }
            d.name += across ? " across the surface" : " on this side of the surface";
            d.means += across ? " across the surface" : " on this side of the surface";
            d.g = [across, wo, g = factor.g, c = f.constant](
                      Vec3d w) { return (w.z * wo.z < 0) == across ? g(w) : 1 / c; };
            return d;
        }
    }
    return {};
}

/// A constant above the surface and another below it, each of nine of ten ratios there.
std::optional<Diagnosis> explain_by_sides(const TrialContext& work, std::span<const Ratio> ratios) {
    const Factor plain{"a constant", [](Vec3d) { return 1.0; }};
    std::vector<Ratio> above, below;
    for (const Ratio& r : ratios) (r.wi.z > 0 ? above : below).push_back(r);
    if (std::min(above.size(), below.size()) < fewest_ratios / 4) return {};
    const Fitted a = fit(work, plain, above), b = fit(work, plain, below);
    if (!a.fits || !b.fits || !(a.all + b.all > 0)) return {};
    if (std::fabs(math::log(a.constant / b.constant)) < 2 * close_to_one) return {};
    const double na = static_cast<double>(above.size()), nb = static_cast<double>(below.size());
    return Diagnosis{"a constant on either side", 1,
        std::clamp(1 - (na * a.left + nb * b.left) / (na * a.all + nb * b.all), 0.0, 1.0),
        fmt::format("{:.5g} above the surface and {:.5g} below it", a.constant, b.constant),
        [a = a.constant, b = b.constant](Vec3d w) { return w.z > 0 ? a : b; }};
}

}  // namespace

std::optional<Diagnosis> explain(const TrialContext& work, std::span<const Ratio> ratios) {
    if (ratios.size() < fewest_ratios) return {};
    if (work.whole())
        if (std::optional<Diagnosis> found = explain_one_side(work, ratios)) return found;
    if (mostly_one(ratios)) return {};
    std::optional<Diagnosis> best;
    std::vector<Factor> factors = usual_factors(work);
    add_whole_factors(factors, work);
    for (const Factor& factor : factors) {
        const Fitted f = fit(work, factor, ratios);
        if (!f.fits || !(f.all > 0)) continue;
        if (factor.whole && std::fabs(math::log(f.constant)) > may_differ(f.all, 0)) continue;
        const Diagnosis now{factor.name, f.constant, std::clamp(1 - f.left / f.all, 0.0, 1.0),
            factor_text(work, factor.name, f.constant), factor.g};
        const bool plain = std::fabs(now.constant - 1) < close_to_one;
        if (!best || (plain && std::fabs(best->constant - 1) >= close_to_one)) best = now;
        if (factor.name == "a constant") break;
    }
    if (best && best->name == "a constant" && std::fabs(best->constant - 1) < close_to_one) return {};
    if (!best && work.whole()) best = explain_by_sides(work, ratios);
    if (best) return best;
    for (const Factor& factor : fitted_factors(work, ratios)) {
        const Fitted f = fit(work, factor, ratios);
        if (!f.fits || !(f.all > 0)) continue;
        if (factor.whole && std::fabs(math::log(f.constant)) > may_differ(f.all, 0)) continue;
        return Diagnosis{factor.name, f.constant, std::clamp(1 - f.left / f.all, 0.0, 1.0),
            factor_text(work, factor.name, f.constant) + factor.details, factor.g};
    }
    return {};
}

namespace {

/// A factor with an unknown constant may be chance: weights cut off are 1 / cos up to some constant.
bool is_told_apart(const TrialContext& work, const Diagnosis& found) {
    return found.name == "a constant" || found.name.ends_with("surface") ||
        std::fabs(found.constant - 1) < close_to_one || !name_of_constant(work, found.constant).empty();
}

}  // namespace

std::optional<Diagnosis> diagnose_identity(const TrialContext& work, int technique) {
    const SampleBatch& b = work.first(technique);
    const std::size_t n = std::min<std::size_t>(b.draws.size(), 4096);
    std::vector<Ratio> pdf, weight, f;
    std::vector<Vec3d> wi;
    for (std::size_t i = 0; i < n; ++i)
        if (const Draw& d = b.draws[i]; d.pdf > 0 && work.counts(d.wi)) wi.push_back(d.wi);
    const std::vector<double> truth = work.subject.has_true_f() ? work.f(wi, true) : std::vector<double>(wi.size());
    const std::vector<double>& value = work.f_of_drawn(b);
    if (std::optional<Diagnosis> found = exchanged_channels(work, b, n)) return found;
    if (std::optional<Diagnosis> found = scaled_channels(work, b, n)) return found;
    const bool grey = !channels_differ(work, b, n);
    for (std::size_t i = 0, k = 0; i < n; ++i) {
        const Draw& d = b.draws[i];
        if (!(d.pdf > 0) || !work.counts(d.wi)) continue;
        pdf.push_back({d.wi, d.pdf / b.pdf[i], 0});
        if (d.weight && grey) weight.push_back({d.wi, *d.weight * d.pdf / (value[i] * std::fabs(d.wi.z)), 0});
        if (work.subject.has_true_f()) f.push_back({d.wi, value[i] / truth[k], 0});
        ++k;
    }
    for (const auto& [all, what] : {std::pair(&pdf, "the pdf with a draw is pdf(w) times "),
             {&weight, "the weight is f cos / p times "}, {&f, "f is what it ought to be times "}})
        if (std::optional<Diagnosis> found = explain(work, usable(*all)); found && is_told_apart(work, *found)) {
            found->means = what + found->means;
            return found;
        }
    return {};
}

namespace {

void tell(const TrialContext& work, Verdict& v, const std::optional<Diagnosis>& found) {
    if (!found) {
        v.say += " None of the usual factors explains it" + spread_told(work, v) + ".";
        v.evidence["diagnosis"] = "none";
        return;
    }
    v.say += fmt::format(" What explains it, {:.3g} % of it: {}.", 100 * found->explained, found->means);
    v.evidence["diagnosis"] = found->name;
    v.evidence["diagnosis_says"] = found->means;
    v.evidence["diagnosis_constant"] = found->constant;
    v.evidence["diagnosis_explains"] = found->explained;
}

}  // namespace

void diagnose(const TrialContext& work, std::span<Verdict> verdicts) {
    if (work.scatter().any() || !work.traits.has_pdf) return;  // ratios of single answers say nothing
    std::string first;
    std::optional<Diagnosis> density, identity;
    for (Verdict& v : verdicts) {
        const bool of_density = v.name == "normalised" || v.name == "density", of_identity = v.name == "identity";
        const bool follows = !first.empty() && v.name == "physics" && v.evidence.contains("furnace_expected");
        if (v.state != State::wrong || !(of_density || of_identity || follows || v.name == "mean")) continue;
        if (v.evidence.contains("answered_otherwise")) continue;  // a state: no factor is looked for
        if (!first.empty()) {
            v.say += fmt::format(" See {}, which comes first.", first);
            if (density || identity) v.evidence["diagnosis"] = (density ? density : identity)->name;
            continue;
        }
        for (int t = 0; t < work.subject.techniques() && !density && !identity; ++t) {
            if (!of_identity) density = diagnose_density(work, t);
            if (!density) identity = diagnose_identity(work, t);
            if (of_identity && !identity) density = diagnose_density(work, t);
            if (!density && !identity) density = diagnose_lobes(work, t);
        }
        // What delta parts take too much of, the rest lacks: by a constant.
        const bool rest_alone = density ? density->name == "a constant" : !identity;
        if (rest_alone && v.evidence.contains("parts_off"))
            density = Diagnosis{
                "the chooser's probability", 1, 1, "the parts are chosen with other probabilities than q", {}};
        tell(work, v, density ? density : identity);
        first = v.name;
    }
}

}  // namespace crescent::inline diagnosis
