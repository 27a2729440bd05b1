// tail: how heavy the weights X = f L cos / p are.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "math/functions.h"
#include "stats/moments.h"
#include "stats/tail.h"
#include "trials/delta.h"
#include "trials/trial_context.h"
#include "trials/unmet.h"
#include "trials/weights.h"
#include "verdicts/verdict_kind.h"

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
    if (work.traits.has_pdf) out.rose_p = work.any_pdf(wi);
    const std::vector<double> f = work.f(wi, true);
    for (std::size_t i = 0; i < wi.size(); ++i) out.rose_f.push_back(f[i] * wi[i].z * work.trial.light(wi[i]));
    return out;
}

/// Where a recorded file has no more to give, and where sixteen times as many can be asked for.
std::string more_draws(const TrialContext& work) {
    const std::size_t n = work.first(0).draws.size();
    if (!work.subject.draws_at_will()) return fmt::format("More samples in the file than these {}", n);
    return work.settings.full ? fmt::format("More draws than {} (TestSettings::draws)", n)
                              : fmt::format("--full, with sixteen times as many draws as these {}", n);
}

/// Samples whose mean has a standard error of 1 %.
double samples_for_1_percent(double sd, double mean) { return std::max(sqr(sd / mean) / 1e-4, 1.0); }

/// The fit to the largest weights, or that there is nothing to fit.
void tell_fit(const std::optional<Tail>& tail, std::span<const double> x, const ExpectedBehaviour& theory, Verdict& v) {
    if (!tail) {
        const std::size_t times = times_largest(x);
        v.evidence["times_largest"] = times;
        v.say = times == x.size() || times < 20
            ? "The largest weights are all alike: no tail to speak of. "
            : fmt::format("The largest weight was drawn {} times: no tail to speak of. ", times);
        return;
    }
    v.evidence["k"] = tail->k;
    v.evidence["se"] = tail->se;
    v.evidence["exceedances"] = tail->exceedances;
    v.say = fmt::format("k-hat = {:.3f} +- {:.3f} over the {} largest weights", tail->k, tail->se, tail->exceedances);
    if (theory.tail_k) v.say += fmt::format(" (theory: {:.3f})", *theory.tail_k);
    v.say += ". ";
}

/// No finite variance, or none that these draws show.
void tell_heavy(const TrialContext& work, bool infinite, Verdict& v) {
    v.state = State::inconclusive;
    v.evidence["samples_for_1_percent"] = "no finite answer";
    v.say += infinite || !work.trial.theory.bounded
        ? "Heavy tail: the variance is infinite or looks so, no number of samples gives 1 %, and no interval means "
          "anything."
        : "Heavy tail at this number of samples; the weight is bounded, so the variance is finite, but it is not seen "
          "yet.";
    v.settle = infinite ? "No number of draws: an arm whose p falls off no faster than f L cos."
                        : more_draws(work) + ", or an arm whose p falls off no faster than f L cos.";
}

/// Whether the variance is finite, and how many samples give 1 % where it is.
void judge_variance(const TrialContext& work, const Spread& s, const std::optional<Tail>& tail, Verdict& v) {
    const ExpectedBehaviour& theory = work.trial.theory;
    const std::size_t n = work.first_weights(false).size();
    const bool infinite = theory.tail_k && *theory.tail_k >= 0.5, bounded = !infinite && is_bounded(s);
    if (bounded)
        v.say += fmt::format("The largest of {} weights is {:.3g} means: they are bounded. ", n, s.largest / s.mean);
    if (!infinite && work.subject.has_f() && mean_is_testable(s, tail, theory) && has_unmet_tail(work, false)) {
        v.evidence["samples_for_1_percent"] = "not known";
        tell_unmet(v, work.unmet(false), due_mean(work, false), n);
    } else if (!bounded && (infinite || (tail && tail->k - 2 * tail->se >= 0.5))) {
        tell_heavy(work, infinite, v);
    } else if (!bounded && tail && tail->k + 2 * tail->se >= 0.5) {
        v.state = State::inconclusive;
        v.evidence["samples_for_1_percent"] = "not known";
        v.say += "Too close to 1/2 to tell whether the variance is finite.";
        v.settle = more_draws(work) + ".";
    } else {
        const double samples = samples_for_1_percent(s.sd, s.mean > 0 ? s.mean : 1);
        v.evidence["samples_for_1_percent"] = samples;
        v.say += fmt::format("The variance is finite: about {:.3g} samples give 1 %.", samples);
    }
}

Verdict judge_tail(TrialContext& work) {
    if (!work.subject.has_drawn_f())
        return work.verdict("tail", State::skipped, "There is no BRDF, hence no weights f L cos / p.");
    if (!work.weighs()) return work.verdict("tail", State::skipped, no_weights);
    const std::vector<double>& x = work.first_weights(false);
    const Spread s = spread(x);
    const std::optional<Tail> tail = tail_of(x);
    const ExpectedBehaviour& theory = work.trial.theory;
    Verdict v = work.verdict("tail", State::right, "");
    // A program is asked for the picture in any case: what it is asked does not depend on what is written.
    if (work.settings.pictures || work.subject.limited()) work.pictures.push_back(picture(work, x, tail));
    v.evidence["relative_sd"] = s.mean > 0 ? s.sd / s.mean : 0;
    v.evidence["largest_over_mean"] = s.mean > 0 ? s.largest / s.mean : 0;
    if (theory.bounded) v.evidence["theory"] = "bounded";
    if (theory.tail_k) v.evidence["theory_k"] = *theory.tail_k;
    tell_fit(tail, x, theory, v);
    judge_variance(work, s, tail, v);
    return v;
}

}  // namespace

constinit const VerdictKind kinds::tail = {.question = "how heavy is the weight X = f L cos / p?",
    .judge = judge_tail,
    .may_stay_open = true,
    .needs_variance = true};

}  // namespace crescent::inline verdicts
