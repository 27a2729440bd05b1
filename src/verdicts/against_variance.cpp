// The variances of two samplers beside one another, with the interval of their ratio.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "math/functions.h"
#include "verdicts/judge.h"
#include "verdicts/ordered.h"

namespace crescent::inline verdicts {

namespace {

/// Says which of two variances is smaller, as far as the interval of their ratio tells.
void tell_ratio(Verdict& v, double ratio, double log_se) {
    const double spread = math::exp(1.959964 * log_se);
    v.evidence["ratio"] = ratio;
    v.evidence["interval"] = {ratio / spread, ratio * spread};
    const char* who = ratio / spread > 1 ? "B is better here"
        : ratio * spread < 1             ? "A is better here"
                                         : "No telling which is better here";
    v.say += fmt::format("{}: the variance of A is {:.4g} times that of B (95 %: {:.4g} to {:.4g}).", who, ratio,
        ratio / spread, ratio * spread);
}

constexpr const char* settles_a_tail = "An arm whose p falls off no faster than f L cos, or more draws (--full).";

/// Of one group of draws: sums of X_A, X_A^2 and X_A^2 p_A / p_B.
struct Sums {
    double n = 0, x = 0, square = 0, other = 0;
    double log_ratio() const {
        const double mean2 = sqr(x / n);
        return math::log((square / n - mean2) / (other / n - mean2));
    }
};

/// f is known at A's draws alone, and B has none of its own: E[X_B^2] = E[X_A^2 p_A / p_B] over A's draws. The interval
/// is a jackknife's over twenty groups (Quenouille 1956).
Verdict variance_over_draws(const TrialContext& a, const TrialContext& b, Verdict v) {
    constexpr std::size_t groups = 20;
    const SampleBatch& batch = a.first(0);
    const std::vector<double>& x = a.first_weights(false);
    std::vector<double> p(x.size()), others(x.size());
    for (int t = 0; t < b.subject.techniques(); ++t) {
        const std::vector<double> of_one = b.pdf_of_drawn(t, batch.draws);
        for (std::size_t i = 0; i < p.size(); ++i) p[i] += of_one[i];
    }
    std::vector<Sums> of(groups);
    double lost = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        if (x[i] > 0 && !(p[i] > 0)) ++lost;
        others[i] = x[i] > 0 && p[i] > 0 ? sqr(x[i]) * batch.draws[i].pdf / p[i] : 0;
        Sums& s = of[i % groups];
        ++s.n, s.x += x[i], s.square += sqr(x[i]), s.other += others[i];
    }
    if (b.subject.techniques() > 1) {
        v.state = State::skipped;
        v.say = "f is known at A's draws alone, and B weighs two draws by MIS: its variance does not follow from them.";
        return v;
    }
    const auto testable = [&](std::span<const double> values) {
        return mean_is_testable(spread(values), tail_of(values), ExpectedBehaviour{});
    };
    if (lost > 0 || !testable(x) || !testable(others)) {
        v.state = State::inconclusive;
        v.say = lost > 0
            ? fmt::format("p of B is 0 at {:.0f} of A's {} draws that carry light: B never finds that.", lost, x.size())
            : "A or B has a heavy tail: the variance is not known.";
        v.settle = settles_a_tail;
        return v;
    }
    Sums all;
    for (const Sums& s : of) all.n += s.n, all.x += s.x, all.square += s.square, all.other += s.other;
    const double va = all.square / all.n - sqr(all.x / all.n), vb = all.other / all.n - sqr(all.x / all.n);
    v.evidence["variance_a"] = va;
    v.evidence["variance_b"] = vb;
    const double alike = 1e-9 * all.square / all.n;
    if (!(va > alike) || !(vb > alike)) {
        v.say = fmt::format("The variances are {:.4g} and {:.4g}.", std::max(va, 0.0), std::max(vb, 0.0));
        return v;
    }
    double square = 0;
    const double whole = all.log_ratio();
    for (const Sums& s : of)
        square += sqr(Sums{all.n - s.n, all.x - s.x, all.square - s.square, all.other - s.other}.log_ratio() - whole);
    tell_ratio(v, math::exp(whole), std::sqrt(square * (groups - 1) / groups));
    v.say += " f is known at A's draws alone; these tell of B by p_A / p_B.";
    return v;
}

}  // namespace

Verdict ratio_of_variances(const TrialContext& a, const TrialContext& b) {
    Verdict v = a.verdict("variance", State::right, "");
    if (!a.subject.has_drawn_f()) {
        v.state = State::skipped;
        v.say = a.subject.draws_at_will() ? "There is no f, hence no variance of f L cos / p."
                                          : "The file of A has no column f, hence there are no weights f L cos / p.";
        return v;
    }
    if (!b.subject.has_f()) {
        if (!a.subject.has_f()) return variance_over_draws(a, b, std::move(v));
        v.state = State::skipped;
        v.say = "B has no f, hence no variance of f L cos / p.";
        return v;
    }
    const Efficiency ea = measure_efficiency(a, 0), eb = measure_efficiency(b, 0);
    v.evidence["variance_a"] = ea.variance;
    v.evidence["variance_b"] = eb.variance;
    for (const auto& [e, who] : {std::pair(&ea, "A"), {&eb, "B"}})
        if (e->heavy) {
            v.state = State::inconclusive;
            v.say += fmt::format("{}{} has a heavy tail, or one that no draw met: its variance is not known.",
                v.say.empty() ? "" : " ", who);
            v.settle = settles_a_tail;
        }
    if (v.state == State::inconclusive) return v;
    if (!(ea.variance > 0) || !(eb.variance > 0)) {
        v.say = fmt::format("The variances are {:.4g} and {:.4g}.", ea.variance, eb.variance);
        return v;
    }
    tell_ratio(v, ea.variance / eb.variance, math::hypot(ea.relative_se, eb.relative_se));
    return v;
}

}  // namespace crescent::inline verdicts
