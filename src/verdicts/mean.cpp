// mean: whether the mean of the weights X = f L cos / p is the integral, where the tail allows the question.
#include <cmath>
#include <fmt/format.h>

#include "stats/moments.h"
#include "trials/delta.h"
#include "trials/trial_context.h"
#include "trials/unmet.h"
#include "trials/weights.h"
#include "verdicts/mean_lights.h"
#include "verdicts/verdict_kind.h"

namespace crescent::inline verdicts {

namespace {

/// A tail that allows no test of the mean.
void tell_heavy(const Spread& s, const Integral& expected, std::size_t draws, Verdict& v) {
    v.state = State::inconclusive;
    v.settle = "The same as for the tail.";
    v.say = fmt::format(
        "inconclusive: heavy tail. {} samples read {:.5g} where quadrature says {:.5g}. A z-test would accuse a right "
        "sampler as readily as a wrong one.",
        draws, s.mean, expected.value);
}

/// The mean beside the integral: how far off where it is wrong, else how likely.
std::string told(const Spread& s, const Integral& expected, double p, bool wrong) {
    const std::optional<double> z = told_z(s, expected);
    const std::string off = expected.value > 0 ? fmt::format("{:+.3g} %", 100 * (s.mean / expected.value - 1))
                                               : fmt::format("off by {:.3g}", s.mean - expected.value);
    const std::string both =
        fmt::format("The mean of f L cos / p is {:.6g}, quadrature says {:.6g}: ", s.mean, expected.value);
    if (wrong)
        return both + off + (z ? fmt::format(", z = {:.4g}", *z) : " where every weight is alike") +
            ", and again on a fresh seed. The estimator is biased.";
    constexpr double far = 3;  // by the draws' spread alone; p grants what the integral is known to
    if (z && std::fabs(*z) > far && p > 0.1)
        return both + off + fmt::format(", as far as the integral is known, to {:.2g}.", expected.error);
    return both + (z ? fmt::format("z = {:.2f}, p = {:.3g}.", *z, p) : off + " where every weight is alike.");
}

/// Both stages of the test, and without a pdf the same under lights from other sides.
void judge_mean(const TrialContext& work, const Spread& s, const Integral& expected, Verdict& v) {
    const double p = mean_p(s, expected);
    if (const std::optional<double> z = told_z(s, expected)) v.evidence["z"] = *z;
    v.evidence["p"] = p;
    if (has_unmet_tail(work, false)) {
        const std::size_t draws = work.first_weights(false).size();
        v.say = fmt::format("{} samples read {:.6g} where quadrature says {:.6g}. ", draws, s.mean, expected.value);
        tell_unmet(v, work.unmet(false), expected, draws);
        return;
    }
    const bool wrong = mean_fails(work, p, expected, false);
    if (!wrong && !work.traits.has_pdf && directions_are_off(work, v)) return;
    v.state = wrong ? State::wrong : State::right;
    v.say = told(s, expected, p, wrong);
    if (!wrong && !work.traits.has_pdf)
        v.say += fmt::format(" So it is under {} lights from other sides.", v.evidence["lights"].get<std::size_t>());
    if (wrong && weighs_by_estimates(work)) v.state = State::inconclusive, v.settle = weight_of_estimates;
}

Verdict judge_mean(TrialContext& work) {
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
    if (mean_is_testable(s, tail_of(x), work.trial.theory)) judge_mean(work, s, expected, v);
    else if (work.traits.has_pdf || !directions_are_off(work, v)) tell_heavy(s, expected, x.size(), v);
    return v;
}

/// Without a pdf(w) under lights from several sides too.
std::uint64_t tests_of_mean(const Trial& t) { return t.subject->has_f() ? t.subject->traits().has_pdf ? 1 : 2 : 0; }

}  // namespace

constinit const VerdictKind kinds::mean = {.question = "is the mean of X the integral?",
    .judge = judge_mean,
    .tests = tests_of_mean,
    .asked_of_other_seeds = true,
    .may_stay_open = true,
    .needs_variance = true,
    .of_all_light = true};

}  // namespace crescent::inline verdicts
