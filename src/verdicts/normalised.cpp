// normalised: p integrates to one, or to one less the share of samples that draw nothing.
#include "verdicts/normalised.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "stats/p_values.h"
#include "trials/trial_context.h"
#include "verdicts/verdict_kind.h"
#include "warps/jacobian.h"
#include "warps/reach.h"

namespace crescent::inline verdicts {

namespace {

/// Standard error of the share that draws nothing, which is itself an estimate.
double doubt_of_nothing(const TrialContext& work, int technique) {
    const Density& d = work.density(technique);
    if (!(d.nothing > 0)) return 0;
    const double n = static_cast<double>(work.first(technique).draws.size());
    return work.subject.draws_at_will() ? std::max(d.nothing_se, 1e-7) : std::sqrt(d.nothing * (1 - d.nothing) / n);
}

/// The chance of so much where the doubt is all that is the matter; 0 of any excess where there is none.
double chance_of(const TrialContext& work, int technique, double excess) {
    if (!(excess > 0)) return 1;
    const double se = doubt_of_nothing(work, technique);
    return se > 0 ? student_p(excess / se, 15) : 0;
}

/// More than chance allows.
bool is_off(const TrialContext& work, int technique, double excess) {
    return chance_of(work, technique, excess) < work.settings.screen * work.settings.confirm;
}

/// What the difference from one may be before p is called wrong.
double granted(const Density& d, const Integral& m) {
    return granted_mass + d.tabulation_error + std::max((m.settled ? 1 : 2) * m.error, 5 * m.second_se);
}

/// What the cubature and its audit leave of the difference.
double excess(const Density& d, const Integral& m) {
    const double sum = m.value + d.nothing, looked = m.second + d.nothing;
    return std::max(std::min(std::fabs(sum - 1), std::fabs(looked - 1)) - granted(d, m), 0.0);
}

/// Of two quadratures the one closer to a right sampler.
const Integral& mass_of(const TrialContext& work, int technique) {
    const Density& d = work.density(technique);
    const bool second =
        is_off(work, technique, excess(d, d.mass)) && d.second && excess(d, *d.second) < excess(d, d.mass);
    return second ? *d.second : d.mass;
}

void note(const Density& d, const Integral& mass, double doubt, const std::string& tag, Verdict& v) {
    if (d.tabulation_error > 0) v.evidence["table_known_to" + tag] = d.tabulation_error;
    v.evidence["integral" + tag] = mass.value;
    v.evidence["quadrature_error" + tag] = mass.error;
    v.evidence["evaluations" + tag] = mass.evaluations;
    v.evidence["audit" + tag] = mass.second;
    v.evidence["audit_se" + tag] = mass.second_se;
    if (d.second) v.evidence["second_quadrature" + tag] = &mass == &d.mass ? d.second->value : d.mass.value;
    constexpr double z = 4;  // beyond which chance is no excuse
    v.evidence["unseen" + tag] = granted(d, mass) + z * doubt;
    v.evidence["drawn_nothing" + tag] = d.nothing;
    v.evidence["drawn_nothing_se" + tag] = d.nothing_se;
    v.evidence["drawn_delta" + tag] = d.delta;
}

std::string told(const Density& d, const Integral& mass) {
    const auto number = [](double m) { return m < 1e6 ? fmt::format("{:.6f}", m) : fmt::format("{:.4g}", m); };
    const std::string integral = "p integrates to " + number(mass.value) + " over the sphere";
    if (!(d.nothing > 0)) return integral;
    const char* rest = d.delta == 0 ? "draw nothing"
        : d.delta == d.nothing      ? "are of delta parts by their q"
                                    : "draw nothing or a delta part";
    return integral +
        fmt::format(" and {:.6f} of the samples {}, together {}", d.nothing, rest, number(mass.value + d.nothing));
}

/// p |J| over points of u: where one u leads to each direction its mean is the integral of p over what is drawn.
struct AlongTheWarp {
    double mean = 0, se = 1;
    bool is_one() const { return se < 6e-4 && std::fabs(mean - 1) < std::max(granted_mass, 2.5 * se); }
};

/// p |J| at the first draws by central differences of 2^-18, which fit between the seams of most tables: of a warp in
/// double precision.
std::vector<double> by_fine_steps(const TrialContext& work, int technique) {
    constexpr std::size_t points = 1500;
    constexpr double h = 0x1p-18;
    const SampleBatch& b = work.first(technique);
    std::vector<std::size_t> of;
    std::vector<Numbers> u;
    for (std::size_t i = 0; i < b.u.size() && of.size() < points; ++i) {
        const Numbers& c = b.u[i];
        if (!(b.draws[i].pdf > 0) || std::min({c.x, c.y, 1 - c.x, 1 - c.y}) <= h) continue;
        of.push_back(i);
        u.insert(u.end(), 4, c);
        u[u.size() - 4].x += h, u[u.size() - 3].x -= h, u[u.size() - 2].y += h, u[u.size() - 1].y -= h;
    }
    std::vector<Draw> w(u.size());
    work.subject.sample(technique, work.trial.wo, u, w);
    std::vector<double> out;
    for (std::size_t i = 0; i < of.size(); ++i) {
        const std::span<const Draw> d = std::span(w).subspan(4 * i, 4);
        if (std::ranges::any_of(d, [](const Draw& at) { return !(at.pdf > 0); })) continue;
        out.push_back(b.draws[of[i]].pdf * length(cross(d[0].wi - d[1].wi, d[2].wi - d[3].wi)) / (4 * h * h));
    }
    return out;
}

AlongTheWarp along_the_warp(const TrialContext& work, int technique) {
    constexpr double one_to_one = 0.1, in_double = 0x1p-40;  // and rounding of a table's cells
    constexpr std::size_t enough = 400;
    std::vector<double> all;
    for (const WarpPoint& at : study_warp(work, technique).points) all.push_back(at.p_jacobian);
    if (!all.empty() && work.traits.numbers == 2 && work.direction_resolution() < in_double)
        all = by_fine_steps(work, technique);
    double n = 0, sum = 0, squares = 0;
    for (double p_j : all) {
        if (std::fabs(p_j - 1) > one_to_one) continue;
        ++n, sum += p_j, squares += sqr(p_j - 1);
    }
    if (all.size() < enough || n < 0.97 * static_cast<double>(all.size())) return {};
    const double mean = sum / n;
    return {mean, std::sqrt(std::max(squares / n - sqr(mean - 1), 0.0) / n)};
}

/// One, as far as the share that draws nothing is known.
void tell_one(const TrialContext& work, int technique, const Density& d, const Integral& mass, Verdict& v) {
    const double doubt = doubt_of_nothing(work, technique);
    v.say = told(d, mass) + ": one, as a density must.";
    if (!(doubt > granted_mass)) return;
    v.say = told(d, mass) + fmt::format(", the share that draws nothing known to {:.2g}: one.", doubt);
    constexpr double seldom = 10;  // times the level of an accusation
    if (chance_of(work, technique, excess(d, mass)) >= seldom * work.settings.screen * work.settings.confirm) return;
    v.state = State::inconclusive;
    v.say = told(d, mass) + fmt::format(", where the share that draws nothing is only known to {:.2g}.", doubt);
    v.settle = work.settings.full ? "More draws (TestSettings::draws)." : "--full, with sixteen times as many draws.";
}

/// Where the cubature is known badly: one over what is drawn, by the warp, and next to nothing of p elsewhere; says so.
bool is_one_by_the_warp(const TrialContext& work, int technique, const Density& d, const Integral& mass, Verdict& v) {
    constexpr double little = 2e-3, not_much = 4e-3, rough = 0.2;  // that may lie where nothing is drawn
    if (!(mass.error < rough)) return false;
    const AlongTheWarp warp = along_the_warp(work, technique);
    if (!warp.is_one()) return false;
    const std::string suffix = work.suffix(technique);
    const std::string one = fmt::format("known to {:.2g}, and to {:.5f} +- {:.2g} {}by the warp", mass.error, warp.mean,
        warp.se, d.nothing > 0 ? "of what is drawn, " : "over what is drawn, ");
    v.evidence["along_the_warp" + suffix] = {{"mean", warp.mean}, {"se", warp.se}};
    if (mass.error < little) {
        v.say = told(d, mass) + ", " + one + ": one.";
        return true;
    }
    const Reach reach = reach_of_draws(work, technique);
    v.evidence["reach" + suffix] = {{"directions", reach.looked_at}, {"no_u_found", reach.unknown + reach.empty},
        {"no_draw_near", reach.empty}, {"at_most", reach.share}};
    if (reach.empty > 0 || !(reach.share < not_much)) return false;
    v.say = told(d, mass) +
        fmt::format(
            ", {}: one. Of {} directions in proportion to p, a u was found to lead to all but {}, so that at "
            "most {:.2g} of p lies where nothing is drawn.",
            one, reach.looked_at, reach.unknown, reach.share);
    return true;
}

/// A sum that passes: one, or known too badly to say so.
void tell_sum(const TrialContext& work, int technique, const Density& d, const Integral& mass, Verdict& v) {
    if (mass.sampled && mass.error < 0.02) {
        v.say = told(d, mass) +
            fmt::format(", known to {:.2g}: {}", mass.error,
                work.scatter().pdf()
                    ? fmt::format("the mean of p over {} points; each is a random estimate.", mass.evaluations)
                    : fmt::format(
                          "p is a table of more cells than were asked for; {} points were. --full sums every cell.",
                          mass.evaluations));
        return;
    }
    if (v.state != State::right) return;  // an earlier technique has been told of
    if (!mass.settled && mass.error > granted_mass) {
        if (is_one_by_the_warp(work, technique, d, mass, v)) return;
        v.state = State::inconclusive;
        v.say = told(d, mass) +
            fmt::format(", but the quadrature itself is only good to {:.2g} after {} evaluations.", mass.error,
                mass.evaluations);
        v.settle = work.settings.full
            ? "More evaluations (TestSettings::evaluations), or a p that jumps along fewer curves."
            : "--full, with twelve times as many evaluations.";
    } else if (d.tabulation_error > granted_mass) {
        v.say = told(d, mass) +
            fmt::format(": one, as far as the table tells, which is known to {:.2g}.", d.tabulation_error);
        if (d.tabulation_error > 0.05) v.state = State::inconclusive, v.settle = "A finer table.";
    } else {
        tell_one(work, technique, d, mass, v);
    }
}

Verdict judge_normalised(TrialContext& work) {
    if (!work.traits.has_pdf) return work.verdict("normalised", State::skipped, "There is no pdf(w) to integrate.");
    Verdict v = work.verdict("normalised", State::right, "");
    for (int t = 0; t < work.subject.techniques(); ++t) {
        const Density& d = work.density(t);
        const Integral& mass = mass_of(work, t);
        note(d, mass, doubt_of_nothing(work, t), work.suffix(t), v);
        ++work.test_counts.tests;
        if (const double sum = mass.value + d.nothing; !std::isfinite(sum) || is_off(work, t, excess(d, mass))) {
            v.state = State::wrong;
            if (!std::isfinite(sum)) {
                v.say = "p is not finite everywhere: it has no integral.";
                return v;
            }
            v.say = told(d, mass) +
                (d.nothing < 1
                        ? fmt::format(", not to 1: weights are off by {:+.3g} % on average.", 100 * (1 / sum - 1))
                        : d.delta > 0 ? ", not to 1: delta parts say that they take every draw: p is to be 0."
                                      : ", not to 1: p is to be 0 where nothing is drawn.");
            return v;
        }
        tell_sum(work, t, d, mass, v);
    }
    return v;
}

/// Of each technique the share that draws nothing.
std::uint64_t tests_of_normalised(const Trial& t) { return static_cast<std::uint64_t>(t.subject->techniques()); }

}  // namespace

constinit const VerdictKind kinds::normalised = {.question = "does p integrate to one?",
    .judge = judge_normalised,
    .tests = tests_of_normalised,
    .asked_of_other_seeds = true};

}  // namespace crescent::inline verdicts
