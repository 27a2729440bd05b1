// f is compared within the change that a few roundings of the directions cause. Variances are ranked if the test of
// their difference fails at both stages. If f is known only at A's draws, B's variance follows from them by p_A / p_B.
#include "check/against_f.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "check/against_draws.h"
#include "check/constants.h"
#include "check/decide/check_at.h"
#include "check/decide/tail.h"
#include "check/estimate/evaluation_noise.h"
#include "check/estimate/source.h"
#include "math/statistics.h"
#include "output/format.h"

namespace crescent::check {

namespace {

/// Where f of both samplers is known. If A is a file, f is known only at its draws.
struct SharedF {
    std::vector<Vec3d> wi;
    std::vector<double> a, b;
};

std::vector<double> f_at(const SamplerAdapter& adapter, std::span<const Pair> pairs) {
    std::vector<double> out(pairs.size());
    adapter.f(pairs, out);
    return out;
}

bool only_at_draws(const SamplerAdapter& s) { return !s.has_f() && s.has_drawn_f() && !s.can_draw(); }

SharedF f_of_both(const AgainstCase& c) {
    SharedF out;
    const SamplerAdapter &a = *c.a.check_case.adapter, &b = *c.b.check_case.adapter;
    if (only_at_draws(a)) {
        Source source(a, 0, c.a.check_case.wo, c.a.check_case.light);
        StreamKey key = c.a.key;
        key.purpose = Purpose::draws;
        std::vector<PrimarySample> u(source.available(key, c.f_draws));
        std::vector<Draw> draws(u.size());
        source.draw(key, 0, u, draws);
        for (const Draw& d : draws)
            if (d.pdf > 0 && d.f && d.wi.z != 0) {
                out.wi.push_back(normalize(d.wi));
                out.a.push_back(*d.f);
            }
    } else {
        const bool has_lower_draws = std::ranges::any_of(c.common.directions, [](Vec3d w) { return w.z < 0; });
        StreamKey key = c.a.key;
        key.purpose = Purpose::pairs;
        Stream stream(key);
        for (int i = 0; i < 256; ++i) {
            const double t = 0.98 * stream.number();
            out.wi.push_back(from_chart({has_lower_draws && i % 2 ? 2 - t : t, two_pi * stream.number()}));
        }
        out.wi.insert(out.wi.end(), c.common.directions.begin(), c.common.directions.end());
    }
    std::vector<Pair> directions;
    for (Vec3d w : out.wi) directions.push_back({c.a.check_case.wo, w});
    if (out.a.empty()) out.a = f_at(a, directions);
    out.b = f_at(b, directions);
    return out;
}

/// The change of f that rounding in single precision causes there.
double moved_f(const SamplerAdapter& s, Vec3d wo, Vec3d wi, double f) {
    std::vector<Pair> pairs;
    for (int k = 0; k < 6; ++k) {
        const double shift = (k % 2 ? 4 : -4) * ulp;
        const Vec3d offset{k / 2 == 0 ? shift : 0, k / 2 == 1 ? shift : 0, k / 2 == 2 ? shift : 0};
        pairs.push_back({wo, wi + offset});
        pairs.push_back({wo + offset, wi});
    }
    double largest = 0;
    for (double v : f_at(s, pairs))
        if (std::isfinite(v)) largest = std::max(largest, std::fabs(v - f));
    return 2 * largest;
}

void note_difference(const AgainstCase& c, const SharedF& shared_f, Verdict& v) {
    const SamplerAdapter &a = *c.a.check_case.adapter, &b = *c.b.check_case.adapter;
    std::size_t count = 0, worst = 0;
    double largest = 0, sum_a = 0, sum_b = 0;
    for (std::size_t i = 0; i < shared_f.wi.size(); ++i) {
        const double fa = shared_f.a[i], fb = shared_f.b[i], difference = std::fabs(fa - fb),
                     size = std::max(std::fabs(fa), std::fabs(fb));
        sum_a += fa;
        sum_b += fb;
        if (difference <= same_number * size + 1e-30) continue;
        const double file_rounding = only_at_draws(a) ? 4 * ulp * size / std::max(std::fabs(shared_f.wi[i].z), 1e-9)
                                                      : moved_f(a, c.a.check_case.wo, shared_f.wi[i], fa);
        if (difference <= same_number * size + file_rounding + moved_f(b, c.b.check_case.wo, shared_f.wi[i], fb))
            continue;
        ++count;
        if (difference / size > largest) {
            largest = difference / size;
            worst = i;
        }
    }
    v.same = count == 0;
    v.evidence["same"] = *v.same;
    v.evidence["directions"] = shared_f.wi.size();
    v.evidence["differ"] = count;
    if (count == 0) {
        v.sentences = {{"same f",
            fmt::format(
                "f is the same at {} directions{}.", shared_f.wi.size(), only_at_draws(a) ? ", the draws of A" : "")}};
        return;
    }
    const Vec3d w = shared_f.wi[worst];
    v.evidence["largest_relative"] = largest;
    v.evidence["worst_wi"] = {w.x, w.y, w.z};
    v.evidence["f"] = {shared_f.a[worst], shared_f.b[worst]};
    v.sentences = {{"difference of f",
        fmt::format("f differs at {} of {} directions, most at {}: {:.6g} and {:.6g}{}.", count, shared_f.wi.size(),
            direction_text(w), shared_f.a[worst], shared_f.b[worst],
            sum_b > 0 ? fmt::format("; the mean of f over them is {:.4g} times that of B", sum_a / sum_b) : "")}};
}

/// The first delta part whose q times weight differs. A part that has less than one expected draw in the pilot may be
/// missing.
std::string differing_delta(const AgainstCase& c) {
    const auto power = [](const std::vector<DeltaPart>& parts, Vec3d w) {
        Vec3d sum{};
        for (const DeltaPart& p : parts)
            if (length(p.wi - w) < same_number) sum = sum + p.weight * p.q;
        return sum;
    };
    for (Vec3d w : c.common.delta_directions) {
        const Vec3d a = power(c.common.delta_a, w), b = power(c.common.delta_b, w);
        if (length(a - b) <= same_number * std::max({length(a), length(b), 1e-30})) continue;
        return fmt::format("The delta part towards {} differs: q times weight is {:.6g} and {:.6g}.", direction_text(w),
            luminance(a), luminance(b));
    }
    return "";
}

}  // namespace

void compare_f(const AgainstCase& c, Verdict& v) {
    const SamplerAdapter &a = *c.a.check_case.adapter, &b = *c.b.check_case.adapter;
    const auto is_estimate = [](const AgainstSide& side) {
        Source source(*side.check_case.adapter, 0, side.check_case.wo, side.check_case.light);
        return look_for_noise(source, side.key).f();
    };
    if (!(a.has_f() || only_at_draws(a)) || !b.has_f()) {
        v.state = State::skipped;
        v.sentences = {{"no f",
            only_at_draws(a)   ? "f of A is known only at its draws, and B has no f for a comparison."
                : a.can_draw() ? "There is no f to compare."
                               : "The file of A has no column f: there is nothing to compare."}};
    } else if (is_estimate(c.a) || is_estimate(c.b)) {
        v.state = State::skipped;
        v.sentences = {{"estimates", "f is a random estimate: only its mean could be the same."}};
    } else {
        note_difference(c, f_of_both(c), v);
    }
    if (const std::string delta = differing_delta(c); !delta.empty()) {
        v.same = false;
        v.evidence["same"] = false;
        v.sentences.push_back({"delta part", delta});
        v.state = State::right;
    }
    if (c.expect_same && !v.same.value_or(true)) v.state = State::wrong;
}

namespace {

constexpr double alike_variances = 0.01;  // relative: a smaller difference does not matter for the choice of a sampler
constexpr double interval_95 = 1.959964;

/// Moments of weights with their standard errors.
struct WeightMoments {
    double n = 0, mean = 0, variance = 0, variance_se = 0;
    bool heavy = false;
    explicit WeightMoments(std::span<const double> x) {
        const Spread s = crescent::spread(x);
        n = s.n;
        mean = s.mean;
        variance = sqr(s.sd);
        double m4 = 0;
        for (double v : x) m4 += sqr(sqr(v - s.mean)) / n;
        // The second term is the error of the mean. It is the only term if the weights take two values equally often.
        variance_se = std::sqrt(std::max(m4 - sqr(variance), 0.0) / n + 2 * sqr(variance / std::max(n - 1, 1.0)));
        const WeightTail tail = tail_of_weights(x);
        heavy = tail.heavy() || tail.open();
    }
    /// Whether the remaining variance is within the rounding of p.
    bool is_constant(double factor) const { return std::sqrt(variance) <= factor * same_number * std::fabs(mean); }
};

void skip(Verdict& v, std::string message) {
    v.state = State::skipped;
    v.sentences = {{"not ranked", std::move(message)}};
}

/// Adds the ratio with its interval to the verdict, and the smaller variance if both stages agree.
void note_ratio(Verdict& v, double ratio, double log_se, bool differ) {
    const double low = ratio * math::exp(-interval_95 * log_se), high = ratio * math::exp(interval_95 * log_se);
    v.evidence["ratio"] = ratio;
    v.evidence["interval"] = {low, high};
    const bool are_alike = low > 1 - alike_variances && high < 1 + alike_variances;
    const bool is_ranked = differ && !are_alike && std::fabs(ratio - 1) > alike_variances;
    v.evidence["better"] = !is_ranked ? "none" : ratio > 1 ? "B" : "A";
    v.sentences = {{"variance ratio",
        fmt::format("{}: the variance of A is {:.4g} times that of B (95 %: {:.4g} to {:.4g}).",
            are_alike        ? "The variances are alike to 1 %"
                : !is_ranked ? "Neither is shown to be better here"
                : ratio > 1  ? "B is better here"
                             : "A is better here",
            ratio, low, high)}};
}

/// Weights of fresh draws.
std::vector<double> fresh_weights(const AgainstSide& side, const AgainstCase& c) {
    AgainstSide fresh_side = side;
    fresh_side.key.stage = 2;
    SamplerDraws draws;
    draw_on(fresh_side, c.common, {0, c.f_draws, 0}, c.f_draws, draws);
    return draws.total.weights;
}

double variances_p(const WeightMoments& a, const WeightMoments& b) {
    const double se = math::hypot(a.variance_se, b.variance_se);
    return student_p_of(std::fabs(a.variance - b.variance), se * se, 1e6);
}
double means_p(const WeightMoments& a, const WeightMoments& b) {
    const double floor = 2 * same_number * std::max(std::fabs(a.mean), std::fabs(b.mean));
    return student_p_of(std::fabs(a.mean - b.mean) - floor, a.variance / a.n + b.variance / b.n, 1e6);
}

void rank(const AgainstCase& c, const WeightMoments& a, const WeightMoments& b, Verdict& v) {
    const auto differ = [&](auto p) {
        return p(a, b) < c.levels.first &&
            p(WeightMoments(fresh_weights(c.a, c)), WeightMoments(fresh_weights(c.b, c))) < c.levels.second;
    };
    if (differ(means_p))
        return skip(v,
            fmt::format("The means of their weights differ ({:.6g} and {:.6g}): variances of two integrals are not "
                        "ranked.",
                a.mean, b.mean));
    const bool is_constant_a = a.is_constant(1), is_constant_b = b.is_constant(1);
    if (a.is_constant(2) && b.is_constant(2)) {
        v.evidence["better"] = "none";
        v.sentences = {{"no variance", "Neither has a variance: the weights of each are all alike."}};
    } else if (is_constant_a || is_constant_b) {
        v.evidence["better"] = is_constant_a ? "A" : "B";
        v.sentences = {{"variance ratio",
            fmt::format("{} is better here: its weights are all alike; the variance of {} is {:.4g}.",
                is_constant_a ? "A" : "B", is_constant_a ? "B" : "A", is_constant_a ? b.variance : a.variance)}};
    } else {
        note_ratio(v, a.variance / b.variance, math::hypot(a.variance_se / a.variance, b.variance_se / b.variance),
            differ(variances_p));
    }
}

/// Draws of A in twenty groups, reweighted to B by p_A / p_B: E_B[X_B^2] = E_A[X_A^2 p_A / p_B].
struct ReweighedDraws {
    static constexpr std::size_t group_count = 20;
    struct Group {
        double n = 0, x = 0, square = 0, other = 0;
        double variance() const { return square / n - sqr(x / n); }
        double variance_of_other() const { return other / n - sqr(x / n); }
        double log_ratio() const { return math::log(variance() / variance_of_other()); }
        bool varies() const {
            const double threshold = 1e-9 * square / n;
            return variance() > threshold && variance_of_other() > threshold;
        }
    };
    std::array<Group, group_count> groups{};
    Group total{};
    std::vector<double> x, other_squares;
    double lost = 0;  // draws with light where p of B is 0

    ReweighedDraws(const AgainstCase& c, int stage) {
        Source a(*c.a.check_case.adapter, 0, c.a.check_case.wo, c.a.check_case.light),
            b(*c.b.check_case.adapter, 0, c.b.check_case.wo, c.b.check_case.light);
        StreamKey key = c.a.key;
        key.purpose = Purpose::draws;
        key.stage = static_cast<std::uint8_t>(stage);
        std::vector<PrimarySample> u(a.available(key, c.f_draws));
        std::vector<Draw> draws(u.size());
        a.draw(key, 0, u, draws);
        for (std::size_t i = 0; i < draws.size(); ++i) {
            const Draw& d = draws[i];
            const bool is_drawn = d.pdf > 0 && d.f && d.wi.z > 0;
            x.push_back(is_drawn ? *d.f * d.wi.z / d.pdf * c.a.check_case.light(d.wi) : 0);
            const double p = x[i] > 0 ? b.density(d.wi) : 0;
            lost += x[i] > 0 && !(p > 0);
            other_squares.push_back(p > 0 ? sqr(x[i]) * d.pdf / p : 0);
            for (Group* g : {&groups[i % group_count], &total}) {
                ++g->n;
                g->x += x[i];
                g->square += sqr(x[i]);
                g->other += other_squares[i];
            }
        }
    }
    /// Standard error of the log ratio by the jackknife (Quenouille 1956).
    double log_se() const {
        double square = 0;
        for (const Group& g : groups) {
            const Group remainder{.n = total.n - g.n,
                .x = total.x - g.x,
                .square = total.square - g.square,
                .other = total.other - g.other};
            square += sqr(remainder.log_ratio() - total.log_ratio());
        }
        return std::sqrt(square * (group_count - 1) / group_count);
    }
    double p() const {
        return total.varies()
            ? student_p_of(std::fabs(total.log_ratio()), sqr(std::max(log_se(), 1e-9)), group_count - 1)
            : 1;
    }
};

void over_draws_of_a(const AgainstCase& c, Verdict& v) {
    const SamplerAdapter& b = *c.b.check_case.adapter;
    if (!b.traits().has_pdf)
        return skip(v, "f is known only at the draws of A, and B has no pdf(w) to weight them with.");
    if (b.techniques() > 1)
        return skip(v, "f is known only at the draws of A: the variance of a pair of techniques does not follow.");
    const ReweighedDraws first(c, 1);
    if (first.lost > 0 || WeightMoments(first.x).heavy || WeightMoments(first.other_squares).heavy) {
        v.state = State::inconclusive;
        if (first.lost > 0)
            v.sentences = {{"support",
                fmt::format("p of B is 0 at {:.0f} of the {} draws of A with light: B never samples it.", first.lost,
                    first.x.size())}};
        else v.sentences = {{"heavy tail", "A or B has a heavy tail: the variance is not known."}};
        v.next.kind = NextStep::Kind::heavier_pdf;
        return;
    }
    v.evidence["variance_a"] = first.total.variance();
    v.evidence["variance_b"] = first.total.variance_of_other();
    if (!first.total.varies()) {
        v.sentences = {{"variances",
            fmt::format("The variances are {:.4g} and {:.4g}.", std::max(first.total.variance(), 0.0),
                std::max(first.total.variance_of_other(), 0.0))}};
        return;
    }
    note_ratio(v, math::exp(first.total.log_ratio()), first.log_se(),
        first.p() < c.levels.first && ReweighedDraws(c, 2).p() < c.levels.second);
    v.sentences.push_back({"method", "B's follows from the draws of A by p_A / p_B."});
}

/// Whether the check of the sampler alone prevents a variance ratio.
bool is_wrong_itself(const CheckAt& check, const char* who, Verdict& v) {
    static constexpr std::array<std::string_view, 6> blocking_verdicts = {
        "support", "normalised", "density", "identity", "mean", "valid"};
    const auto blocks = [&](Family family) {
        const std::string_view name = info(family).verdict;
        if (std::ranges::find(blocking_verdicts, name) == blocking_verdicts.end()) return false;
        skip(v,
            fmt::format("{} is wrong itself, by {}: the variance of a wrong sampler is not ranked. `crescent check` of "
                        "it alone shows more.",
                who, name));
        return true;
    };
    return std::ranges::any_of(check.findings, [&](const Finding& f) { return blocks(f.first.family); }) ||
        std::ranges::any_of(check.small, [&](const SmallFault& f) { return blocks(f.family); });
}

}  // namespace

void compare_variances(const AgainstCase& c, const Verdict& f_verdict, Verdict& v) {
    const SamplerAdapter &a = *c.a.check_case.adapter, &b = *c.b.check_case.adapter;
    if (!f_verdict.same.value_or(true)) return skip(v, "Their f differ: variances of two integrals are not ranked.");
    if (!a.has_drawn_f())
        return skip(v,
            a.can_draw() ? "There is no f, so f L cos / p has no variance."
                         : "The file of A has no column f, so there are no weights f L cos / p.");
    if (!b.has_drawn_f() && !only_at_draws(a)) return skip(v, "B has no f, so its f L cos / p has no variance.");
    for (const auto& [draws, adapter, who] : {std::tuple(&c.draws_a, &a, "A"), {&c.draws_b, &b, "B"}})
        if (adapter->has_drawn_f() && draws->total.weightless > 0)
            return skip(v,
                fmt::format(
                    "{} has neither a pdf(w) nor a weight with its draws (weight=yes), so it has no variance.", who));
    if (is_wrong_itself(c.check_a, "A", v) || is_wrong_itself(c.check_b, "B", v)) return;
    if (!b.has_drawn_f()) return over_draws_of_a(c, v);
    const WeightMoments moments_a(c.draws_a.total.weights), moments_b(c.draws_b.total.weights);
    v.evidence["variance_a"] = moments_a.variance;
    v.evidence["variance_b"] = moments_b.variance;
    for (const auto& [m, who] : {std::pair(&moments_a, "A"), {&moments_b, "B"}})
        if (m->heavy) {
            v.state = State::inconclusive;
            v.sentences.push_back({"heavy tail", fmt::format("{} has a heavy tail: its variance is not known.", who)});
            v.next.kind = NextStep::Kind::heavier_pdf;
        }
    if (v.state == State::right) rank(c, moments_a, moments_b, v);
}

}  // namespace crescent::check
