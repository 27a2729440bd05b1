// tail: how heavy the weights X = f L cos / p are. mean: whether their mean is the integral, where the tail allows the
// question.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "math/functions.h"
#include "stats/tail.h"
#include "verdicts/delta.h"
#include "verdicts/ordered.h"

namespace crescent::inline verdicts {

namespace {

WeightPicture picture(const TrialContext& work, const std::vector<double>& x, const std::optional<Tail>& tail) {
    WeightPicture out;
    out.arm = work.trial.arm;
    out.trial = work.trial.text();
    double low = 1e300, high = 0;
    for (double v : x) {
        if (v > 0) low = std::min(low, v), high = std::max(high, v);
        else ++out.zeros;
    }
    if (high > 0) {
        const double from = math::log10(low) - 0.05, to = math::log10(high) + 0.05;
        constexpr int bins = 48;
        for (int i = 0; i <= bins; ++i) out.log10_edges.push_back(from + (to - from) * i / bins);
        out.counts.assign(bins, 0);
        for (double v : x)
            if (v > 0)
                ++out.counts[static_cast<std::size_t>(
                    std::clamp((math::log10(v) - from) / (to - from) * bins, 0.0, bins - 1.0))];
    }
    if (tail && tail->exceedances + 1 < x.size()) {
        out.k = tail->k;
        out.exceedances = static_cast<double>(tail->exceedances);
        std::vector<double> largest = x;
        std::sort(largest.begin(), largest.end(), std::greater<>());
        out.threshold = largest[tail->exceedances];
        const double median = largest[tail->exceedances / 2] - out.threshold;
        out.sigma = std::fabs(out.k) < 1e-6 ? median / math::log(2.0) : out.k * median / (math::exp2(out.k) - 1);
    }
    std::vector<Vec3d> wi;
    const double azimuth = math::atan2(work.trial.wo.y, work.trial.wo.x) * 180 / pi;
    for (int i = -89; i <= 89; ++i) wi.push_back(tilt(i, azimuth));
    out.rose_p = work.any_pdf(wi);
    const std::vector<double> f = work.f(wi, true);
    for (std::size_t i = 0; i < wi.size(); ++i) out.rose_f.push_back(f[i] * wi[i].z * work.trial.light(wi[i]));
    return out;
}

/// Where a recorded file has no more to give, and where sixteen times as many can be asked for.
std::string more_draws(const TrialContext& work) {
    const std::size_t n = work.first(0).draws.size();
    if (!work.subject.draws_at_will()) return fmt::format("More samples in the file than these {}", n);
    return work.rigour.full ? fmt::format("More draws than {} (TestSettings::draws)", n)
                            : fmt::format("--full, with sixteen times as many draws as these {}", n);
}

std::string samples_for(double sd, double mean) {
    const double n = sqr(sd / mean) / 1e-4;
    return fmt::format("{:.3g}", std::max(n, 1.0));
}

}  // namespace

Spread spread(std::span<const double> x) {
    Spread s;
    s.n = static_cast<double>(x.size());
    for (double v : x) {
        s.mean += v / s.n;
        s.largest = std::max(s.largest, v);
    }
    double m2 = 0, m3 = 0;
    for (double v : x) {
        const double d = v - s.mean;
        m2 += d * d;
        m3 += d * d * d;
    }
    s.sd = std::sqrt(m2 / std::max(s.n - 1, 1.0));
    s.skew = s.sd > 0 ? m3 / s.n / (s.sd * s.sd * s.sd) : 0;
    return s;
}

double johnson_t(const Spread& s, double expected) {
    const double d = s.mean - expected;
    if (!(s.sd > 1e-7 * std::fabs(expected)))
        return std::fabs(d) <= 1e-5 * std::fabs(expected) ? 0 : 1e9;  // every sample alike
    const double corrected = d + s.skew * s.sd / (6 * s.n) + s.skew / (3 * s.sd) * d * d;
    return corrected * std::sqrt(s.n) / s.sd;
}

std::optional<Tail> tail_of(std::span<const double> x) {
    const std::size_t length = std::min(tail_length(x.size()) + 1, x.size());
    std::vector<double> largest(x.begin(), x.end());
    std::partial_sort(
        largest.begin(), largest.begin() + static_cast<std::ptrdiff_t>(length), largest.end(), std::greater<>());
    return fit_tail(std::span<const double>(largest).first(length));
}

/// A tail with k >= 1/2 has a largest weight of the order of sqrt(n) means; one of a few means among thousands is
/// bounded, whatever a fit to the few weights that stand out may say.
bool is_bounded(const Spread& s) { return s.n >= 1000 && s.largest <= std::min(4.0, 0.1 * std::sqrt(s.n)) * s.mean; }

bool mean_is_testable(const Spread& s, const std::optional<Tail>& tail, const ExpectedBehaviour& theory) {
    const bool infinite = theory.tail_k && *theory.tail_k >= 0.5;
    const bool seen = s.skew < 0 || s.skew / std::sqrt(s.n) < 0.1;  // rare large weights have been met often enough
    return !infinite && seen && (!tail || tail->k + 2 * tail->se < 0.5 || is_bounded(s));
}

double mean_p(const Spread& s, const Integral& expected) {
    constexpr double allowed =
        1e-4;  // relative: what normalised and identity allow p itself, float rounding of a sharp lobe included
    const double doubt = expected.error + allowed * std::fabs(expected.value);
    const double off = std::max(std::fabs(s.mean - expected.value) - doubt, 0.0);
    if (!(s.sd > 1e-7 * std::fabs(expected.value))) return off > 0 ? 0 : 1;  // every sample alike: no chance is in it
    if (std::fabs(s.skew) / std::sqrt(s.n) > 0.1)
        return std::min(2 * math::exp(-0.5 * s.n * off * off / (sqr(s.sd) + s.largest * off / 3 + 1e-300)), 1.0);
    const double z = std::fabs(johnson_t(s, expected.value)) - doubt / std::max(s.sd / std::sqrt(s.n), 1e-300);
    return normal_p(std::max(z, 0.0));
}

bool mean_fails(const TrialContext& work, double p, const Integral& expected, bool even) {
    return work.fails(p, [&](int round) {
        std::vector<SampleBatch> fresh;
        for (int t = 0; t < work.subject.techniques(); ++t) fresh.push_back(work.draw(t, round));
        const std::vector<double> x = work.weights(fresh, even);
        const double p_fresh = mean_p(spread(x), expected);
        return p_fresh < work.rigour.confirm && look_for_unmet(work, x, even).heavy ? 1.0 : p_fresh;
    });
}

constexpr const char* no_weights =
    "There is neither a pdf nor a weight with the draws, hence nothing to weigh them by.";

Verdict judge_tail(TrialContext& work) {
    if (!work.subject.has_drawn_f())
        return work.verdict("tail", State::skipped, "There is no BRDF, hence no weights f L cos / p.");
    if (!work.weighs()) return work.verdict("tail", State::skipped, no_weights);
    std::vector<double> x = work.first_weights(false);
    const Spread s = spread(x);
    const std::optional<Tail> tail = tail_of(x);
    const double highest = *std::max_element(x.begin(), x.end());
    const ExpectedBehaviour& theory = work.trial.theory;
    Verdict v = work.verdict("tail", State::right, "");
    if (work.rigour.pictures) work.pictures.push_back(picture(work, x, tail));
    v.evidence["relative_sd"] = s.mean > 0 ? s.sd / s.mean : 0;
    v.evidence["largest_over_mean"] = s.mean > 0 ? highest / s.mean : 0;
    if (theory.bounded) v.evidence["theory"] = "bounded";
    if (theory.tail_k) v.evidence["theory_k"] = *theory.tail_k;
    const bool infinite = theory.tail_k && *theory.tail_k >= 0.5;
    if (!tail) {
        v.say = "The largest weights are all alike: no tail to speak of. ";
    } else {
        v.evidence["k"] = tail->k;
        v.evidence["se"] = tail->se;
        v.evidence["exceedances"] = tail->exceedances;
        v.say =
            fmt::format("k-hat = {:.3f} +- {:.3f} over the {} largest weights", tail->k, tail->se, tail->exceedances);
        if (theory.tail_k) v.say += fmt::format(" (theory: {:.3f})", *theory.tail_k);
        v.say += ". ";
    }
    const bool bounded = !infinite && is_bounded(s);
    if (bounded)
        v.say +=
            fmt::format("The largest of {} weights is {:.3g} means: they are bounded. ", x.size(), s.largest / s.mean);
    if (!infinite && work.subject.has_f() && mean_is_testable(s, tail, theory) && has_unmet_tail(work, false)) {
        v.evidence["samples_for_1_percent"] = "not known";
        tell_unmet(v, work.unmet(false), due_mean(work, false), x.size());
    } else if (!bounded && (infinite || (tail && tail->k - 2 * tail->se >= 0.5))) {
        v.state = State::inconclusive;
        v.evidence["samples_for_1_percent"] = "no finite answer";
        v.say += infinite || !theory.bounded ? "Heavy tail: the variance is infinite or looks so, no number of samples "
                                               "gives 1 %, and no interval means anything."
                                             : "Heavy tail at this number of samples; the weight is bounded, so the "
                                               "variance is finite, but it is not seen yet.";
        v.settle = infinite ? "No number of draws: an arm whose p falls off no faster than f L cos."
                            : more_draws(work) + ", or an arm whose p falls off no faster than f L cos.";
    } else if (!bounded && tail && tail->k + 2 * tail->se >= 0.5) {
        v.state = State::inconclusive;
        v.evidence["samples_for_1_percent"] = "not known";
        v.say += "Too close to 1/2 to tell whether the variance is finite.";
        v.settle = more_draws(work) + ".";
    } else {
        v.evidence["samples_for_1_percent"] = std::stod(samples_for(s.sd, s.mean > 0 ? s.mean : 1));
        v.say += fmt::format(
            "The variance is finite: about {} samples give 1 %.", samples_for(s.sd, s.mean > 0 ? s.mean : 1));
    }
    return v;
}

Verdict judge_mean(const TrialContext& work) {
    if (!work.subject.has_f())
        return work.verdict("mean", State::skipped,
            work.subject.has_drawn_f() ? "f is known at the draws alone: there is no integral to compare the mean with."
                                       : "There is no BRDF, hence no integral to compare the mean with.");
    if (!work.weighs()) return work.verdict("mean", State::skipped, no_weights);
    Verdict v = work.verdict("mean", State::right, "");
    const Integral expected = due_mean(work, false);
    const std::vector<double>& x = work.first_weights(false);
    const Spread s = spread(x);
    v.evidence["mean"] = s.mean;
    v.evidence["standard_error"] = s.sd / std::sqrt(s.n);
    v.evidence["quadrature"] = expected.value;
    v.evidence["quadrature_error"] = expected.error;
    v.evidence["skewness"] = s.skew;
    if (!mean_is_testable(s, tail_of(x), work.trial.theory)) {
        v.state = State::inconclusive;
        v.settle = "What settles the tail.";
        v.say = fmt::format(
            "inconclusive: heavy tail. {} samples read {:.5g} where quadrature says {:.5g}; a z-test would accuse a "
            "right sampler as readily as a wrong one.",
            x.size(), s.mean, expected.value);
        return v;
    }
    const double z = johnson_t(s, expected.value), p = mean_p(s, expected);
    v.evidence["z"] = z;
    v.evidence["p"] = p;
    if (has_unmet_tail(work, false)) {
        v.say = fmt::format("{} samples read {:.6g} where quadrature says {:.6g}. ", x.size(), s.mean, expected.value);
        tell_unmet(v, work.unmet(false), expected, x.size());
        return v;
    }
    const bool wrong = mean_fails(work, p, expected, false);
    v.state = wrong ? State::wrong : State::right;
    v.say = wrong ? fmt::format(
                        "The mean of f L cos / p is {:.6g}, quadrature says {:.6g}: z = {:.2f}, and again on a fresh "
                        "seed. The estimator is biased.",
                        s.mean, expected.value, z)
                  : fmt::format("The mean of f L cos / p is {:.6g}, quadrature says {:.6g}: z = {:.2f}, p = {:.3g}.",
                        s.mean, expected.value, z, p);
    return v;
}

}  // namespace crescent::inline verdicts
