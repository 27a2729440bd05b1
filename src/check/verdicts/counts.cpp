// identity and valid, from counts of single draws: values, pointwise, zero, weight, and repeated directions.
#include <algorithm>
#include <cmath>
#include <functional>

#include "check/estimate/sort.h"
#include "check/constants.h"
#include "check/verdicts/questions.h"
#include "check/verdicts/statistics.h"

namespace crescent::check {

namespace {

/// Fails for more than a share of the draws, and more than a few. per: number of draws that each counted one
/// represents.
void test_share(
    Family family, const Count& count, double trials, double tolerated, const Visit& visit, double per = 1) {
    const double times = per * static_cast<double>(count.times);
    visit({.family = family,
        .member = 0,
        .difference = trials > 0 ? times / trials : 0,
        .sd = 0,
        .floor = tolerated,
        .p = times > tolerated * trials + tolerated_breaks ? 0.0 : 1.0,
        .expected = 0});
}

/// Equal keys side by side. Keys are hashes: the lower half of their bits separates nearly all.
std::vector<Observations::Met> grouped_by_key(std::vector<Observations::Met> met) {
    const auto lower = [](const Observations::Met& m) { return m.key & ((std::uint64_t{1} << 33) - 1); };
    sort_by_key(met, lower);
    for (auto first = met.begin(), last = first; first != met.end(); first = last) {
        while (last != met.end() && lower(*last) == lower(*first)) ++last;
        if (last - first > 1) std::ranges::sort(first, last, {}, &Observations::Met::key);
    }
    return met;
}

/// Pairs of equal directions compared with the number that the lattice of the arithmetic causes: N^2 / 2 pairs, of
/// which a step^2 of the sphere contains the integral of p^2 = E[p]. In single precision a small disk about an axis is
/// one direction (`one_direction`), which is then drawn N p times.
void test_repeats(const Evidence& e, const Visit& visit) {
    const Observations& o = e.observations;
    const std::vector<Observations::Met> met = grouped_by_key(o.met);
    const double least = e.source.traits.bits == 53 ? 0x1p-53 : ulp;
    const double step = std::max(e.plan.step / angle_per_step, least);
    const bool single = e.plan.in_single(e.source);
    double equal = 0, expected = o.independent * step * step * o.mean_p / 2;
    for (std::size_t k = 0, end = 0; k < met.size(); k = end) {
        while (end < met.size() && met[end].key == met[k].key) ++end;
        const double again = static_cast<double>(end - k - 1);
        equal += again;
        if (single) expected += std::min(again, o.independent * met[k].p * one_direction);
    }
    visit({.family = Family::repeats,
        .member = 0,
        .difference = equal,
        .sd = std::sqrt(expected),
        .floor = repeats_floor,
        .p = equal > repeats_floor + repeats_factor * expected ? 0.0 : 1.0,
        .expected = expected});
}

}  // namespace

void test_counts(const Evidence& e, const Visit& visit) {
    const DrawChecks& c = e.observations.checks;
    const double followed = static_cast<double>(c.followed);
    // All rows of a file were tested before.
    const std::uint64_t of_draws = e.source.recorded() ? 0 : c.invalid.times;
    const double invalid = static_cast<double>(of_draws + e.source.invalid().count());
    visit({.family = Family::values,
        .member = 0,
        .difference = invalid,
        .sd = 0,
        .floor = 0,
        .p = invalid > 0 ? 0.0 : 1.0,
        .expected = 0});
    const double per =
        static_cast<double>(c.differing) / static_cast<double>(std::max<std::uint64_t>(c.differing_compared, 1));
    test_share(Family::pointwise, c.pointwise, followed, tolerated_share, visit, std::max(per, 1.0));
    test_share(Family::zero, c.zero, followed, tolerated_zeros, visit, std::max(per, 1.0));
    test_share(Family::weight, c.weight, static_cast<double>(c.weights), tolerated_share, visit);
    test_share(Family::reference_f, c.reference_f, static_cast<double>(c.weights), tolerated_share, visit);
    if (!e.source.traits.delta) test_repeats(e, visit);
}

// ---- density and identity of delta parts: each is drawn as often as stated, with one weight, and there are few of
// them.

namespace {

/// A number that identifies a part at both stages: direction, q and weight to three decimals.
int member_of(const DeltaPart& p) {
    std::size_t h = 0;
    for (double v : {p.wi.x, p.wi.y, p.wi.z, p.q, p.weight.x, p.weight.y, p.weight.z})
        h = h * 1099511628211u + std::hash<long long>{}(std::llround(v * 1e3));
    return static_cast<int>((h ^ h >> 16) & 0x7fffffff);
}

/// Compares the draws of a part with q by Bennett's inequality, which holds at every count.
void test_delta_share(const DeltaPart& p, double n, const Visit& visit) {
    const double share = static_cast<double>(p.drawn) / n, floor = detection_floor * p.q, v = p.q * (1 - p.q) / n;
    Answer a{.family = Family::delta_share,
        .member = member_of(p),
        .difference = share - p.q,
        .sd = std::sqrt(std::max(v, 0.0)),
        .floor = floor,
        .p = 1,
        .expected = p.q};
    a.p = bennett_p(bennett_z2(std::fabs(a.difference) - floor, std::max(v, 0.0), 1 / n, 1e12));
    visit(a);
}

}  // namespace

void test_deltas(const Evidence& e, const Visit& visit) {
    const Observations& o = e.observations;
    if (o.deltas.empty()) return;
    double sum = 0, otherwise = 0;
    for (const DeltaPart& p : o.deltas.parts(o.independent)) {
        test_delta_share(p, o.independent, visit);
        sum += p.q;
        otherwise += static_cast<double>(p.otherwise);
    }
    const bool certain = sum > 1 + same_number;
    visit({.family = Family::delta_share,
        .member = -1,
        .difference = sum - 1,
        .sd = 0,
        .floor = same_number,
        .p = certain ? 0.0 : 1.0,
        .expected = 1});
    visit({.family = Family::delta_scatter,
        .member = 0,
        .difference = o.deltas.scattered() ? 1.0 : 0.0,
        .sd = 0,
        .floor = 0,
        .p = o.deltas.scattered() ? 0.0 : 1.0,
        .expected = 0});
    visit({.family = Family::delta_weight,
        .member = 0,
        .difference = otherwise,
        .sd = 0,
        .floor = tolerated_breaks,
        .p = otherwise > tolerated_breaks ? 0.0 : 1.0,
        .expected = 0});
}

}  // namespace crescent::check
