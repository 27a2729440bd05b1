// p-values of differences whose variance is partly estimated, and the two stages of a test.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>

#include "check/constants.h"
#include "math/functions.h"
#include "math/statistics.h"

namespace crescent::check {

/// Degrees of freedom of an estimated variance v whose own variance is w (Satterthwaite 1946).
inline double freedom(double v, double w) {
    if (w == 0) return 1e12;
    const double ratio = v / std::sqrt(w);  // squares of the peak of a density may overflow
    return std::isfinite(ratio) ? std::clamp(2 * ratio * ratio, 0.5, 1e12) : 0.5;
}

/// Twice the exponent of Bennett's inequality (1962): a sum of independent terms with total variance v, none more than
/// b above its mean, exceeds its expectation by d with probability at most exp(-z2 / 2). It holds at every count: it is
/// Chernoff's bound for a Poisson count and d^2 / v for many terms. If v has nu degrees of freedom, z2 decreases as for
/// Student's t.
inline double bennett_z2(double d, double v, double b, double nu) {
    if (!(d > 0) || !std::isfinite(v)) return 0;  // an infinite variance allows any difference
    v = std::max(v, 1e-30);
    const double x = b * d / v;
    const double z2 = x < 1e-4 ? d * d / v : 2 * v / (b * b) * ((1 + x) * math::log1p(x) - x);
    return nu * math::log1p(z2 / nu);
}
/// Two-sided.
inline double bennett_p(double z2) { return std::min(1.0, 2 * math::exp(-z2 / 2)); }

/// Mean and variance of the mean of replicates, where one draw changes a replicate by `jump`. The variance is at least
/// `least_jumps`^2 of a jump: a count that is n in most replicates and n + 1 in a few sometimes shows no spread, and
/// Student's t would then be infinite. doubt: variance of that variance, for normal replicates.
template <class Values> struct ReplicateMean {
    double mean = 0, variance = 0, doubt = 0;
    ReplicateMean(const Values& y, double jump) {
        const double n = static_cast<double>(y.size());
        for (double v : y) mean += v / n;
        for (double v : y) variance += (v - mean) * (v - mean) / (n * (n - 1));
        variance += least_jumps * least_jumps * jump * jump / n;
        doubt = 2 * variance * variance / (n - 1);
    }
};

/// Two-sided Student p of a difference d beyond its floor, of variance v with nu degrees of freedom.
inline double student_p_of(double d, double v, double nu) {
    return d > 0 && std::isfinite(v) ? student_two_sided(std::min(nu, 1e6), d / std::sqrt(v + 1e-30)) : 1;
}
/// One-sided: the probability that a normal variable exceeds its mean by d.
inline double normal_p_of(double d, double v) { return d > 0 ? normal_two_sided(d / std::sqrt(v + 1e-30)) / 2 : 1; }

// ---- The two stages of a test: the member of each family with the least p, and a second test of the same member.
// `visit_all` visits every member of all families; an answer has a family, a member, a difference and a p.

/// For one family, with the number of its members.
template <class Answer> struct LeastOf {
    Answer answer{};
    double members = 0;
    double p() const { return std::min(1.0, answer.p * members); }
};

template <class Answer, class VisitAll> auto least_by_family(const VisitAll& visit_all) {
    std::map<decltype(Answer::family), LeastOf<Answer>> out;
    visit_all([&](const Answer& a) {
        LeastOf<Answer>& entry = out[a.family];
        if (entry.members++ == 0 || a.p < entry.answer.p) entry.answer = a;
    });
    return out;
}

/// With p = 1 if the member does not exist any more.
template <class Answer, class VisitAll> Answer same_member(const VisitAll& visit_all, const Answer& first) {
    Answer out = first;
    out.p = 1;
    visit_all([&](const Answer& a) {
        if (a.family == first.family && a.member == first.member) out = a;
    });
    return out;
}

/// The one-sided p of `second` for a difference with the sign of the first one.
template <class Answer> double one_sided(const Answer& first, const Answer& second) {
    return (second.difference > 0) == (first.difference > 0) ? second.p / 2 : 1;
}

}  // namespace crescent::check
