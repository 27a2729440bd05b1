// A factor by bins, where there is no warp at hand, or several u reach one direction: draws weighed by 1 / (c g) must
// come to the mass that p has in each bin.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "diagnosis/diagnosis.h"
#include "math/functions.h"
#include "stats/p_values.h"
#include "trials/contrasts.h"
#include "trials/trial_context.h"

namespace crescent::inline diagnosis {

namespace {

constexpr double close = 2e-3;  // relative

/// Draws in each bin weighed by 1 / g, beside the mass that p has there.
struct Binned {
    std::vector<double> sum, squares, count, variance;
    double constant = 1, relative_se = 0, statistic = 0, degrees = 0;
};

Binned weigh(const TrialContext& work, int technique, const Factor& factor) {
    const Density& d = work.density(technique);
    const SampleBatch& b = work.first(technique);
    Binned out;
    out.sum.resize(d.mass.bins.size());
    out.squares = out.count = out.variance = out.sum;
    const std::vector<Vec2d>& at = work.coordinates_of(b, d.map);
    const double n = static_cast<double>(b.draws.size());
    double total = 0, squares = 0;
    for (std::size_t i = 0; i < b.draws.size(); ++i) {
        work.subject.make_way(1);
        if (is_null_sample(b.draws[i], b.pdf[i])) continue;
        const double g = factor.g(b.draws[i].wi);
        if (!(g > 0) || !std::isfinite(g)) continue;
        const std::size_t bin = d.bin_of(at[i]);
        out.sum[bin] += 1 / (g * n);
        out.squares[bin] += sqr(1 / (g * n));
        ++out.count[bin];
        total += 1 / (g * n);
        squares += sqr(1 / (g * n));
    }
    out.constant = total / d.mass.value;
    out.relative_se = std::sqrt(std::max(squares - sqr(total) / n, 0.0)) / total;
    for (std::size_t k = 0; k < out.sum.size(); ++k) {
        if (out.count[k] < 10 && d.mass.bins[k] * n < 10) continue;
        const double seen = out.sum[k] / out.constant, due = d.mass.bins[k];
        out.variance[k] =
            std::max(out.squares[k] / sqr(out.constant), due / n) + sqr(3 * d.mass.bin_errors[k]) + sqr(close * due);
        out.statistic += sqr(seen - due) / out.variance[k];
        ++out.degrees;
    }
    return out;
}

}  // namespace

namespace {

/// Ratios by the warp that hold for a constant c: 1 / |J| is no more than what is drawn, whatever else reaches there.
struct ByWarp {
    std::vector<double> known;  // ascending
    double mean = 0;            // over what is claimed
    bool whole = false;         // one u alone reaches each direction: they are what is drawn, over what is claimed
    bool denies = false;        // c
};

ByWarp look_at_warp(const TrialContext& work, int technique, const Binned& as_is) {
    ByWarp out;
    double inverse = 0, beyond = 0;
    const double c = as_is.constant, off = std::fabs(math::log(c));
    for (const Ratio& r : drawn_over_claimed(work, technique)) {
        if (!(r.value > 0) || !std::isfinite(r.value) || r.error > 0.05) continue;
        out.known.push_back(r.value);
        inverse += 1 / r.value;
        beyond += math::log(r.value / c) > may_differ(off, r.error) + 3 * as_is.relative_se;
    }
    const double n = static_cast<double>(out.known.size());
    if (n < 100) return out;
    std::sort(out.known.begin(), out.known.end());
    out.mean = n / inverse;
    out.whole = std::fabs(c / out.mean - 1) < 0.01 + 5 * as_is.relative_se;
    out.denies = out.whole || beyond > 0.1 * n;
    return out;
}

/// Along rings and along sectors, where a spread shows that hides among all bins: draws over c p are one there too.
bool is_even(const Density& d, const Binned& by) {
    constexpr double least_p = 1e-4;
    const std::size_t sectors = static_cast<std::size_t>(d.sectors), rings = by.sum.size() / sectors;
    const auto agrees = [&](std::size_t groups, auto&& group_of) {
        std::vector<double> off(groups), variance(groups);
        for (std::size_t k = 0; k < by.sum.size(); ++k) {
            if (!(by.variance[k] > 0)) continue;
            off[group_of(k)] += by.sum[k] / by.constant - d.mass.bins[k];
            variance[group_of(k)] += by.variance[k];
        }
        double statistic = 0, degrees = -1;
        for (std::size_t g = 0; g < groups; ++g)
            if (variance[g] > 0) statistic += sqr(off[g]) / variance[g], ++degrees;
        return degrees < 1 || chi_squared_p(statistic, degrees) > least_p;
    };
    return agrees(rings, [&](std::size_t k) { return k / sectors; }) &&
        agrees(sectors, [&](std::size_t k) { return k % sectors; });
}

/// Bins tell a constant from what varies about it only so far: a spread that adds half to their chi-square would show.
bool bins_show_a_constant(const TrialContext& work, int technique, const Binned& as_is) {
    const double n = static_cast<double>(work.first(technique).draws.size());
    const double unseen = std::sqrt(0.5 * as_is.degrees / n);
    return !name_of_constant(work, as_is.constant).empty() || std::fabs(math::log(as_is.constant)) > 4 * unseen;
}

/// What no constant changes: where along p the draws fall. Each is a standard normal deviate where p is off by one.
bool contrasts_differ(const TrialContext& work, int technique) {
    constexpr double most = 3;
    const Contrasts z = contrasts_of(work, work.density(technique), work.first(technique));
    return std::any_of(z.begin(), z.end(), [](double v) { return std::fabs(v) > most; });
}

/// What is left of the difference, in amplitude: chi-square beyond its degrees goes with its square.
double unexplained(const Binned& by, const Binned& as_is) {
    return std::sqrt(std::max(by.statistic - by.degrees, 0.0) / (as_is.statistic - as_is.degrees));
}
/// The same at most, by two standard errors of the chi-square.
double left_of(const Binned& by, const Binned& as_is) {
    return std::sqrt(
        (std::max(by.statistic - by.degrees, 0.0) + 2 * std::sqrt(2 * by.degrees)) / (as_is.statistic - as_is.degrees));
}

/// Bins tell a factor from one that is nearly it, of other coordinates, by its constant alone.
bool is_known(const TrialContext& work, const Binned& by) {
    const double known_to = std::max(close, 3 * by.relative_se);
    return std::fabs(math::log(by.constant)) < known_to || !name_of_constant(work, by.constant, known_to).empty();
}

}  // namespace

std::optional<Diagnosis> diagnose_by_bins(const TrialContext& work, int technique) {
    const Density& d = work.density(technique);
    if (!(d.mass.value > 0) || !std::isfinite(d.mass.value)) return {};
    const Factor one{"a constant", [](Vec3d) { return 1.0; }};
    const Binned as_is = weigh(work, technique, one);
    if (as_is.degrees < 8) return {};
    const double norm = std::fabs(as_is.constant - 1);
    const bool shape = as_is.statistic > 3 * as_is.degrees;
    if (!shape && norm < std::max(0.005, 6 * as_is.relative_se)) return {};
    for (const Factor& factor : usual_factors(work)) {
        const Binned by = weigh(work, technique, factor);
        // NaN where the factor is none of the w_i that were drawn.
        if (!(by.statistic <= 1.5 * by.degrees) || !(by.constant > 0) || by.degrees < 8) continue;
        if (shape &&
            (factor.name == "a constant" || left_of(by, as_is) > 0.3 || !is_even(d, by) || !is_known(work, by)))
            continue;
        if (!shape && factor.name != "a constant") continue;
        if (!shape &&
            (look_at_warp(work, technique, by).denies || !bins_show_a_constant(work, technique, by) ||
                !is_even(d, by) || contrasts_differ(work, technique)))
            return {};
        return Diagnosis{factor.name, by.constant, shape ? 1 - unexplained(by, as_is) : 1,
            "what is drawn is pdf(w) times " + factor_text(work, factor.name, by.constant), factor.g};
    }
    return {};
}

/// c g p must come to what is drawn: a p that is right on half of the sphere and drawn nowhere else is not off by 2
/// there.
bool comes_to_one(const TrialContext& work, int technique, const Diagnosis& found) {
    if (!found.g) return false;
    const Binned by = weigh(work, technique, {found.name, found.g});
    return std::fabs(by.constant / found.constant - 1) < 2e-3 + 5 * by.relative_se;
}

std::string spread_told(const TrialContext& work, Verdict& v) {
    constexpr double telling = 1e6;  // of a ratio: beyond it only how far is of use, not its digits
    if (!work.traits.has_pdf || v.name == "mean" || v.name == "physics") return "";
    std::string out;
    for (int t = 0; t < work.subject.techniques() && out.empty(); ++t) {
        const double mass = work.density(t).mass.value;
        if (!(mass > 0) || !std::isfinite(mass)) continue;
        const Binned by = weigh(work, t, {"a constant", [](Vec3d) { return 1.0; }});
        const ByWarp warp = look_at_warp(work, t, by);
        const auto quantile = [&](double q) {
            return warp.known[static_cast<std::size_t>(q * static_cast<double>(warp.known.size() - 1))];
        };
        const bool spread = warp.whole && quantile(0.95) / quantile(0.05) > 1 + 2 * close;
        const double mean = warp.whole ? warp.mean : by.constant, known_to = warp.whole ? 0 : 3 * by.relative_se;
        if (!spread && std::fabs(mean - 1) < close + known_to) continue;
        v.evidence["drawn_over_claimed"] = mean;
        out = mean > telling ? ": what is drawn is more than a million times pdf(w) on average"
            : mean > 0       ? fmt::format(": what is drawn is pdf(w) times {:.5g} on average", mean)
                             : ": nothing is drawn";
        if (!warp.whole) continue;
        v.evidence["drawn_over_claimed_5_percent"] = quantile(0.05);
        v.evidence["drawn_over_claimed_95_percent"] = quantile(0.95);
        const auto [least, most] = std::pair(quantile(0.05), quantile(0.95));
        if (most > telling) out += ", and more than a million times at some directions";
        else if (least < 1 / telling) out += ", and less than a millionth at some directions";
        else out += fmt::format(", {:.5g} to {:.5g} at nine of ten directions", least, most);
    }
    return out;
}

}  // namespace crescent::inline diagnosis
