// support: p reaches wherever f L cos is not 0.
#include <fmt/format.h>

#include "verdicts/verdict_kind.h"

namespace crescent::inline verdicts {

namespace {

std::string shown_direction(Vec3d w) { return fmt::format("({:.9g}, {:.9g}, {:.9g})", w.x, w.y, w.z); }

/// f is not 0 under the surface, and the sampler never goes there.
Verdict unreached_below(const TrialContext& work) {
    const TrialContext::Below& below = work.below();
    Verdict v = work.verdict("support", State::inconclusive,
        fmt::format("f is {:.4g} under the surface, at {}, where the sampler never draws and p is 0: either f "
                    "transmits and none of that light is ever found, or f ought to return 0 there.",
            below.f, shown_direction(below.at)));
    v.settle = "An f that returns 0 under the surface, or a sampler that draws there.";
    v.evidence["f_below"] = below.f;
    return v;
}

/// p is a random estimate that was 0 wherever it was asked over part of f L cos.
Verdict perhaps_lost(const TrialContext& work, double fraction) {
    Verdict v = work.verdict("support", State::inconclusive,
        fmt::format("pdf(w) is a random estimate, and came out as 0 seventeen times over directions that carry {:.4g} "
                    "% of f L cos: it may be 0 there, or may seldom be anything else.",
            100 * fraction));
    v.settle = "A pdf(w) that is not 0 wherever it may be positive.";
    v.evidence["lost_fraction"] = fraction;
    return v;
}

Verdict judge_support(TrialContext& work) {
    if (!work.traits.has_pdf)
        return work.verdict("support", State::skipped, "There is no pdf(w) to tell where it is 0.");
    if (!work.subject.has_f())
        return work.verdict("support", State::skipped, "There is no BRDF to compare the support of p with.");
    if (work.below().transmits && !work.below().reached) return unreached_below(work);
    const Integral all = work.incoming(TrialContext::Where::everywhere, false);
    const Integral lost = work.incoming(TrialContext::Where::lost, false);
    if (!(all.value > 0))
        return work.verdict("support", State::skipped, "f L cos is 0 everywhere: nothing can be lost.");
    const double fraction = lost.value / all.value;
    constexpr double negligible = 1e-6;  // below what a float estimate of the mean can show
    const bool wrong = fraction > negligible;
    if (wrong && work.scatter().pdf()) return perhaps_lost(work, fraction);
    std::string say = wrong
        ? fmt::format("p is 0 over directions that carry {:.4g} % of f L cos: no number of samples ever finds it.",
              100 * fraction)
        : "Wherever f L cos is not 0, p is not 0 either: no light is out of reach.";
    const ExpectedBehaviour& theory = work.trial.theory;
    if (wrong && theory.lost)
        say += fmt::format(" Theory: {:.4g} % of the diffuse part, (1 - cos theta_R)/2; measured: {:.4g} %.",
            100 * *theory.lost, 100 * lost.value / theory.lost_of);
    Verdict v = work.verdict("support", wrong ? State::wrong : State::right, say);
    v.evidence["lost_fraction"] = fraction;
    v.evidence["quadrature_error"] = (lost.error + all.error * fraction) / all.value;
    v.evidence["integral_f_L_cos"] = all.value;
    if (theory.lost) {
        v.evidence["lost_of_diffuse"] = lost.value / theory.lost_of;
        v.evidence["theory_lost_of_diffuse"] = *theory.lost;
    }
    return v;
}

}  // namespace

constinit const VerdictKind kinds::support = {
    .question = "does p reach wherever f L cos is not 0?", .judge = judge_support};

}  // namespace crescent::inline verdicts
