// normalised: p integrates to one, or to one less the share of samples that draw nothing.
#include <cmath>
#include <fmt/format.h>

#include "verdicts/verdict_kind.h"

namespace crescent::inline verdicts {

namespace {

/// More than chance allows; the share that draws nothing is itself an estimate.
bool is_off(const TrialContext& work, int technique, double excess) {
    const Density& d = work.density(technique);
    if (!(excess > 0) || !(d.nothing > 0)) return excess > 0;
    const double n = static_cast<double>(work.first(technique).draws.size());
    const double se =
        work.subject.draws_at_will() ? std::max(d.nothing_se, 1e-7) : std::sqrt(d.nothing * (1 - d.nothing) / n);
    return student_p(excess / se, 15) < work.settings.screen * work.settings.confirm;
}

Verdict judge(TrialContext& work) {
    if (!work.traits.has_pdf) return work.verdict("normalised", State::skipped, "There is no pdf(w) to integrate.");
    Verdict v = work.verdict("normalised", State::right, "");
    for (int t = 0; t < work.subject.techniques(); ++t) {
        const Density& d = work.density(t);
        constexpr double allowed = 1e-4;
        const auto granted = [&](const Integral& m) {
            return allowed + d.doubts + std::max((m.settled ? 1 : 2) * m.error, 5 * m.second_se);
        };
        const auto excess_of = [&](const Integral& m) {  // what the cubature and its audit leave of the difference
            const double sum = m.value + d.nothing, looked = m.second + d.nothing;
            return std::max(std::min(std::fabs(sum - 1), std::fabs(looked - 1)) - granted(m), 0.0);
        };
        const bool second = is_off(work, t, excess_of(d.mass)) && d.second && excess_of(*d.second) < excess_of(d.mass);
        const Integral& mass = second ? *d.second : d.mass;  // the one closer to a right sampler
        const double sum = mass.value + d.nothing;
        const std::string tag = work.subject.techniques() > 1 ? fmt::format("_{}", t + 1) : "";
        if (d.doubts > 0) v.evidence["table_known_to" + tag] = d.doubts;
        v.evidence["integral" + tag] = mass.value;
        v.evidence["quadrature_error" + tag] = mass.error;
        v.evidence["evaluations" + tag] = mass.evaluations;
        v.evidence["audit" + tag] = mass.second;
        v.evidence["audit_se" + tag] = mass.second_se;
        if (d.second) v.evidence["second_quadrature" + tag] = second ? d.mass.value : d.second->value;
        v.evidence["unseen" + tag] = granted(mass);
        v.evidence["drawn_nothing" + tag] = d.nothing;
        v.evidence["drawn_nothing_se" + tag] = d.nothing_se;
        v.evidence["drawn_delta" + tag] = d.delta;
        const char* rest = d.delta == 0 ? "draw nothing"
            : d.delta == d.nothing      ? "are of delta parts"
                                        : "draw nothing or a delta part";
        const std::string told = d.nothing > 0
            ? fmt::format("p integrates to {:.6f} over the sphere and {:.6f} of the samples {}, together {:.6f}",
                  mass.value, d.nothing, rest, sum)
            : fmt::format("p integrates to {:.6f} over the sphere", mass.value);
        ++work.tally.tests;
        if (!std::isfinite(sum) || is_off(work, t, excess_of(mass))) {
            v.state = State::wrong;
            v.say = told + fmt::format(", not to 1: every weight is off by {:+.3g} %.", 100 * (1 / sum - 1));
            return v;
        }
        if (mass.sampled && mass.error < 0.02) {
            v.say = told +
                fmt::format(", known to {:.2g}: {}", mass.error,
                    work.scatter().pdf()
                        ? fmt::format("the mean of p over {} points; each is a random estimate.", mass.evaluations)
                        : fmt::format("p is a table of more cells than were asked for; {} points were. --full sums "
                                      "every cell.",
                              mass.evaluations));
            continue;
        }
        if (!mass.settled && mass.error > allowed && v.state == State::right) {
            v.state = State::inconclusive;
            v.say = told +
                fmt::format(", but the quadrature itself is only good to {:.2g} after {} evaluations.", mass.error,
                    mass.evaluations);
            v.settle = work.settings.full
                ? "More evaluations (TestSettings::evaluations), or a p that jumps along fewer curves."
                : "--full, with twelve times as many evaluations.";
        }
        if (v.state == State::right && d.doubts > allowed) {
            v.say = told + fmt::format(": one, as far as the table tells, which is known to {:.2g}.", d.doubts);
            if (d.doubts > 0.05) v.state = State::inconclusive, v.settle = "A finer table.";
        } else if (v.state == State::right) {
            v.say = told + ": one, as a density must.";
        }
    }
    return v;
}

/// Of each technique the share that draws nothing.
std::uint64_t tests(const Trial& t) { return static_cast<std::uint64_t>(t.subject->techniques()); }

}  // namespace

constinit const VerdictKind kinds::normalised = {
    .question = "does p integrate to one?", .judge = judge, .tests = tests, .asked_of_other_seeds = true};

}  // namespace crescent::inline verdicts
