// The variances of two samplers beside one another, with the interval of their ratio.
#include "against/against_variance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "math/functions.h"
#include "stats/moments.h"
#include "stats/p_values.h"
#include "trials/trial_context.h"
#include "trials/weights.h"
#include "verdicts/efficiency.h"
#include "verdicts/judge.h"
#include "verdicts/verdict_kind.h"

namespace crescent::inline against {

namespace {

constexpr double alike_to = 0.01;  // of a variance: less does not decide between samplers

/// The ratio with its 95 % interval, and which is smaller where both stages of the test say so.
void tell_ratio(Verdict& v, double ratio, double log_se, bool differ) {
    const double low = ratio * math::exp(-1.959964 * log_se), high = ratio * math::exp(1.959964 * log_se);
    v.evidence["ratio"] = ratio;
    v.evidence["interval"] = {low, high};
    const bool alike = low > 1 - alike_to && high < 1 + alike_to;
    const bool ranked = differ && !alike && std::fabs(ratio - 1) > alike_to;
    v.evidence["better"] = !ranked ? "none" : ratio > 1 ? "B" : "A";
    const char* who = alike ? "The variances are alike to 1 %"
        : !ranked           ? "No telling which is better here"
        : ratio > 1         ? "B is better here"
                            : "A is better here";
    v.say +=
        fmt::format("{}: the variance of A is {:.4g} times that of B (95 %: {:.4g} to {:.4g}).", who, ratio, low, high);
}

constexpr const char* settles_a_tail = "An arm whose p falls off no faster than f L cos, or more draws (--full).";

/// Of one group of draws: sums of X_A, X_A^2 and X_A^2 p_A / p_B.
struct Sums {
    double n = 0, x = 0, square = 0, other = 0;
    double variance() const { return square / n - sqr(x / n); }
    double of_other() const { return other / n - sqr(x / n); }
    double log_ratio() const { return math::log(variance() / of_other()); }
    Sums operator+(const Sums& s) const { return {n + s.n, x + s.x, square + s.square, other + s.other}; }
    Sums operator-(const Sums& s) const { return {n - s.n, x - s.x, square - s.square, other - s.other}; }
};

constexpr std::size_t groups = 20;

/// A's draws in twenty groups, with what they tell of B.
struct Reweighed {
    std::vector<Sums> of = std::vector<Sums>(groups);
    std::vector<double> x, others;
    double lost = 0;  // draws with light at which p of B is 0
    Sums all() const {
        Sums sum;
        for (const Sums& s : of) sum = sum + s;
        return sum;
    }
    /// Of the log ratio, by the jackknife (Quenouille 1956).
    double log_se() const {
        const Sums whole = all();
        double square = 0;
        for (const Sums& s : of) square += sqr((whole - s).log_ratio() - whole.log_ratio());
        return std::sqrt(square * (groups - 1) / groups);
    }
    bool ranks() const { return all().variance() > spread_of_alike() && all().of_other() > spread_of_alike(); }
    double spread_of_alike() const { return 1e-9 * all().square / all().n; }
};

Reweighed reweigh(const TrialContext& a, const TrialContext& b, const SampleBatch& batch) {
    Reweighed out;
    out.x = a.weights(std::span(&batch, 1), false);
    const std::vector<double> p = b.pdf_of_drawn(0, batch.draws);
    for (std::size_t i = 0; i < out.x.size(); ++i) {
        const double x = out.x[i];
        if (x > 0 && !(p[i] > 0)) ++out.lost;
        out.others.push_back(x > 0 && p[i] > 0 ? sqr(x) * batch.draws[i].pdf / p[i] : 0);
        Sums& s = out.of[i % groups];
        s = s + Sums{1, x, sqr(x), out.others.back()};
    }
    return out;
}

/// f is known at A's draws alone, and B has none of its own: E[X_B^2] = E[X_A^2 p_A / p_B] over A's draws.
Verdict variance_over_draws(const TrialContext& a, const TrialContext& b, Verdict v) {
    const bool known = a.traits.has_pdf && b.traits.has_pdf;
    if (!known || b.subject.techniques() > 1) {
        v.state = State::skipped;
        v.say = known
            ? "f is known at A's draws alone, and B weighs two draws by MIS: its variance does not follow from them."
            : "f is known at A's draws alone, and there is no p_A / p_B, by which these would tell of B.";
        return v;
    }
    const Reweighed first = reweigh(a, b, a.first(0));
    const auto testable = [&](std::span<const double> values) {
        return mean_is_testable(spread(values), tail_of(values), ExpectedBehaviour{});
    };
    if (first.lost > 0 || !testable(first.x) || !testable(first.others)) {
        v.state = State::inconclusive;
        v.say = first.lost > 0
            ? fmt::format("p of B is 0 at {:.0f} of A's {} draws that carry light: B never finds that.", first.lost,
                  first.x.size())
            : "A or B has a heavy tail: the variance is not known.";
        v.settle = settles_a_tail;
        return v;
    }
    const Sums all = first.all();
    v.evidence["variance_a"] = all.variance();
    v.evidence["variance_b"] = all.of_other();
    if (!first.ranks()) {
        v.say = fmt::format(
            "The variances are {:.4g} and {:.4g}.", std::max(all.variance(), 0.0), std::max(all.of_other(), 0.0));
        return v;
    }
    const auto p_of = [](const Reweighed& r) {
        return r.ranks() ? student_p(std::fabs(r.all().log_ratio()) / std::max(r.log_se(), 1e-9), groups - 1) : 1.0;
    };
    const bool differ = a.fails(p_of(first), [&](int round) { return p_of(reweigh(a, b, a.draw(0, round))); });
    tell_ratio(v, math::exp(all.log_ratio()), first.log_se(), differ);
    v.say += " f is known at A's draws alone; these tell of B by p_A / p_B.";
    return v;
}

/// Mean and variance of one sampler's weights, with their standard errors.
struct Moments {
    Spread of;
    double variance = 0, variance_se = 0;
    /// No more than p itself is granted.
    bool none(double times) const { return of.sd <= times * 1e-4 * std::fabs(of.mean); }
};

Moments moments(std::span<const double> x) {
    Moments out{spread(x), 0, 0};
    double m4 = 0;
    for (double v : x) m4 += sqr(sqr(v - out.of.mean)) / out.of.n;
    out.variance = sqr(out.of.sd);
    // The second term is what the mean costs: alone where two values come equally often.
    out.variance_se = std::sqrt(
        std::max(m4 - sqr(out.variance), 0.0) / out.of.n + 2 * sqr(out.variance / std::max(out.of.n - 1, 1.0)));
    return out;
}

using Both = std::array<Moments, 2>;

Both drawn(const TrialContext& a, const TrialContext& b, int round) {
    Both out;
    for (std::size_t k = 0; k < 2; ++k) {
        const TrialContext& work = k == 0 ? a : b;
        if (round == 0) {
            out[k] = moments(work.first_weights(false));
            continue;
        }
        std::vector<SampleBatch> fresh;
        for (int t = 0; t < work.subject.techniques(); ++t) fresh.push_back(work.draw(t, round));
        out[k] = moments(work.weights(fresh, false));
    }
    return out;
}

/// Of equal means, 1e-4 granted as everywhere.
double means_p(const Both& m) {
    const double granted = 1e-4 * std::max(std::fabs(m[0].of.mean), std::fabs(m[1].of.mean)),
                 off = std::max(std::fabs(m[0].of.mean - m[1].of.mean) - 2 * granted, 0.0),
                 se = math::hypot(m[0].of.sd / std::sqrt(m[0].of.n), m[1].of.sd / std::sqrt(m[1].of.n));
    return off > 0 ? normal_p(off / std::max(se, 1e-300)) : 1;
}

/// Of equal variances: of their difference, whose law is symmetric where the samplers are alike, so that a heavy tail
/// makes it fail less often, not more (Efron 1969).
double variances_p(const Both& m) {
    return normal_p(
        std::fabs(m[0].variance - m[1].variance) / std::max(math::hypot(m[0].variance_se, m[1].variance_se), 1e-300));
}

/// What one sampler's own verdicts say against a ratio of its variance.
std::optional<std::string> own_fault(TrialContext& work, const char* who) {
    for (const VerdictKind* kind : judged_alone())
        if (const Verdict v = kind->judge(work); v.state == State::wrong)
            return fmt::format("{} is wrong itself, by {}: {}", who, v.name, v.say);
    return {};
}

Verdict skipped(Verdict v, std::string say) {
    v.state = State::skipped;
    v.say = std::move(say);
    return v;
}

/// Where neither tail is heavy.
void rank(Verdict& v, const TrialContext& a, const TrialContext& b) {
    const Both first = drawn(a, b, 0);
    const auto of = [&](auto p) { return a.fails(p(first), [&](int round) { return p(drawn(a, b, round)); }); };
    if (of(means_p)) {
        v = skipped(std::move(v),
            fmt::format(
                "The means of their weights differ ({:.6g} and {:.6g}): they are not of one integral, and their "
                "variances are not ranked.",
                first[0].of.mean, first[1].of.mean));
        return;
    }
    const bool none_a = first[0].none(1), none_b = first[1].none(1);
    if (first[0].none(2) && first[1].none(2)) {
        v.evidence["better"] = "none";
        v.say = "Neither has a variance: the weights of each are all alike.";
    } else if (none_a || none_b) {
        v.evidence["better"] = none_a ? "A" : "B";
        v.say = fmt::format("{} is better here: its weights are all alike; the variance of {} is {:.4g}.",
            none_a ? "A" : "B", none_a ? "B" : "A", first[none_a ? 1 : 0].variance);
    } else {
        tell_ratio(v, first[0].variance / first[1].variance,
            math::hypot(first[0].variance_se / first[0].variance, first[1].variance_se / first[1].variance),
            of(variances_p));
    }
}

}  // namespace

std::span<const VerdictKind* const> judged_alone() {
    static constexpr std::array kinds = {
        &kinds::support, &kinds::normalised, &kinds::density, &kinds::identity, &kinds::mean};
    return kinds;
}

Verdict ratio_of_variances(TrialContext& a, TrialContext& b, const Verdict& of_f) {
    Verdict v = a.verdict("variance", State::right, "");
    if (of_f.evidence.contains("same") && !of_f.evidence["same"].get<bool>())
        return skipped(std::move(v), "They are not of one f: a ratio of variances would be of two integrals.");
    if (!a.subject.has_drawn_f())
        return skipped(std::move(v),
            a.subject.draws_at_will() ? "There is no f, hence no variance of f L cos / p."
                                      : "The file of A has no column f, hence there are no weights f L cos / p.");
    if (!b.subject.has_drawn_f() && a.subject.has_f())
        return skipped(std::move(v), "B has no f, hence no variance of f L cos / p.");
    for (const auto& [work, who] : {std::pair(&a, "A"), {&b, "B"}})
        if (work->subject.has_drawn_f() && !work->weighs())
            return skipped(std::move(v),
                fmt::format(
                    "{} has neither a pdf(w) nor a weight with its draws (weight=yes), hence no variance.", who));
    for (const auto& [work, who] : {std::pair(&a, "A"), {&b, "B"}})
        if (const std::optional<std::string> fault = own_fault(*work, who))
            return skipped(std::move(v), *fault + " The variance of a wrong sampler is not ranked.");
    if (!b.subject.has_drawn_f()) return variance_over_draws(a, b, std::move(v));
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
    if (v.state == State::right) rank(v, a, b);
    return v;
}

}  // namespace crescent::inline against
