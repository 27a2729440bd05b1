// A factor by bins, where there is no warp at hand, or several u reach one direction: draws weighed by 1 / (c g) must
// come to the mass that p has in each bin.
#include <algorithm>
#include <cmath>

#include "math/functions.h"
#include "verdicts/diagnosis.h"
#include "verdicts/ordered.h"

namespace crescent::inline verdicts {

namespace {

constexpr double close = 2e-3;  // relative

/// Draws in each bin weighed by 1 / g, beside the mass that p has there.
struct Binned {
    std::vector<double> sum, squares, count;
    double constant = 1, relative_se = 0, statistic = 0, degrees = 0, off = 0;
};

Binned weigh(const Density& d, const SampleBatch& b, const Factor& factor) {
    Binned out;
    out.sum.resize(d.mass.bins.size());
    out.squares = out.count = out.sum;
    const double n = static_cast<double>(b.draws.size());
    double total = 0, squares = 0;
    for (std::size_t i = 0; i < b.draws.size(); ++i) {
        if (is_null_sample(b.draws[i], b.pdf[i])) continue;
        const double g = factor.g(b.draws[i].wi);
        if (!(g > 0) || !std::isfinite(g)) continue;
        const std::size_t bin = d.bin_of(d.map.coordinates(b.draws[i].wi));
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
        const double variance =
            std::max(out.squares[k] / sqr(out.constant), due / n) + sqr(3 * d.mass.bin_errors[k]) + sqr(close * due);
        out.statistic += sqr(seen - due) / variance;
        out.off += std::fabs(seen - due);
        ++out.degrees;
    }
    return out;
}

}  // namespace

std::optional<Diagnosis> diagnose_by_bins(const TrialContext& work, int technique) {
    const Density& d = work.density(technique);
    const SampleBatch& b = work.first(technique);
    if (!(d.mass.value > 0) || !std::isfinite(d.mass.value)) return {};
    const Factor one{"a constant", [](Vec3d) { return 1.0; }};
    const Binned as_is = weigh(d, b, one);
    if (as_is.degrees < 8) return {};
    const double norm = std::fabs(as_is.constant - 1);
    const bool shape = as_is.statistic > 3 * as_is.degrees;
    if (!shape && norm < std::max(0.005, 6 * as_is.relative_se)) return {};
    for (const Factor& factor : usual_factors(work)) {
        const Binned by = weigh(d, b, factor);
        // NaN where the factor is none of the w_i that were drawn.
        if (!(by.statistic <= 1.5 * by.degrees) || !(by.constant > 0) || by.degrees < 8) continue;
        if (shape &&
            (factor.name == "a constant" ||
                by.off > 0.1 * as_is.off + 2 / std::sqrt(static_cast<double>(b.draws.size()))))
            continue;
        if (!shape && factor.name != "a constant") continue;
        return Diagnosis{factor.name, by.constant, shape ? std::max(1 - by.off / as_is.off, 0.0) : 1,
            "what is drawn is pdf(w) times " + factor_text(work, factor.name, by.constant), factor.g};
    }
    return {};
}

/// c g p must come to what is drawn: a p that is right on half of the sphere and drawn nowhere else is not off by 2
/// there.
bool comes_to_one(const TrialContext& work, int technique, const Diagnosis& found) {
    if (!found.g) return false;
    const Binned by = weigh(work.density(technique), work.first(technique), {found.name, found.g});
    return std::fabs(by.constant / found.constant - 1) < 2e-3 + 5 * by.relative_se;
}

}  // namespace crescent::inline verdicts
