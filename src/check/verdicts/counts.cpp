// identity and valid, from counts of single draws: values, pointwise, zero, weight, and repeated directions.
#include "check/verdicts/counts.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "check/constants.h"
#include "check/estimate/sort.h"
#include "check/verdicts/questions.h"
#include "check/verdicts/statistics.h"

namespace crescent::check {

namespace {

/// Fails for more than a share of the draws, and more than a few. draws_per_count: number of draws that each counted
/// one represents.
void test_share(Family family, const Count& count, double trials, double tolerance, const Visit& visit,
    double draws_per_count = 1) {
    const double times = draws_per_count * static_cast<double>(count.times);
    visit({.family = family,
        .member = 0,
        .difference = trials > 0 ? times / trials : 0,
        .sd = 0,
        .floor = tolerance,
        .p = times > tolerance * trials + tolerated_breaks ? 0.0 : 1.0,
        .expected = 0});
}

/// Equal keys side by side. Keys are hashes: the lower half of their bits separates nearly all.
std::vector<Observations::DirectionKey> grouped_by_key(std::vector<Observations::DirectionKey> keys) {
    const auto lower_bits_of = [](const Observations::DirectionKey& k) {
        return k.key & ((std::uint64_t{1} << 33) - 1);
    };
    sort_by_key(keys, lower_bits_of);
    for (auto first = keys.begin(), last = first; first != keys.end(); first = last) {
        while (last != keys.end() && lower_bits_of(*last) == lower_bits_of(*first)) ++last;
        if (last - first > 1) std::ranges::sort(first, last, {}, &Observations::DirectionKey::key);
    }
    return keys;
}

/// Pairs of equal directions compared with the number that the lattice of the arithmetic causes: N^2 / 2 pairs, of
/// which a step^2 of the sphere contains the integral of p^2 = E[p]. In single precision a small disk about an axis is
/// one direction (`one_direction`), which is then drawn N p times.
void test_repeats(const Evidence& e, const Visit& visit) {
    const Observations& o = e.observations;
    const std::vector<Observations::DirectionKey> keys = grouped_by_key(o.direction_keys);
    const double least_step = e.source.traits.bits == 53 ? 0x1p-53 : ulp;
    const double step = std::max(e.plan.step / angle_per_step, least_step);
    const bool is_single = e.plan.in_single(e.source);
    double equal = 0, expected = o.independent * step * step * o.mean_p / 2;
    for (std::size_t k = 0, end = 0; k < keys.size(); k = end) {
        while (end < keys.size() && keys[end].key == keys[k].key) ++end;
        const double repeats = static_cast<double>(end - k - 1);
        equal += repeats;
        if (is_single) expected += std::min(repeats, o.independent * keys[k].p * one_direction);
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
    const double evaluated_draws = static_cast<double>(c.evaluated_draws);
    // All rows of a file were tested before.
    const std::uint64_t invalid_draws = e.source.recorded() ? 0 : c.invalid.times;
    const double invalid = static_cast<double>(invalid_draws + e.source.invalid().count());
    visit({.family = Family::values,
        .member = 0,
        .difference = invalid,
        .sd = 0,
        .floor = 0,
        .p = invalid > 0 ? 0.0 : 1.0,
        .expected = 0});
    const double draws_per_count =
        static_cast<double>(c.differing_draws) / static_cast<double>(std::max<std::uint64_t>(c.compared_draws, 1));
    test_share(Family::pointwise, c.pointwise, evaluated_draws, tolerated_share, visit, std::max(draws_per_count, 1.0));
    test_share(Family::zero, c.zero, evaluated_draws, tolerated_zeros, visit, std::max(draws_per_count, 1.0));
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
    const double share = static_cast<double>(p.draws) / n, floor = detection_floor * p.q, v = p.q * (1 - p.q) / n;
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
    double sum = 0, other_weights = 0;
    for (const DeltaPart& p : o.deltas.parts(o.independent)) {
        test_delta_share(p, o.independent, visit);
        sum += p.q;
        other_weights += static_cast<double>(p.other_weights);
    }
    const bool exceeds_one = sum > 1 + same_number;
    visit({.family = Family::delta_share,
        .member = -1,
        .difference = sum - 1,
        .sd = 0,
        .floor = same_number,
        .p = exceeds_one ? 0.0 : 1.0,
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
        .difference = other_weights,
        .sd = 0,
        .floor = tolerated_breaks,
        .p = other_weights > tolerated_breaks ? 0.0 : 1.0,
        .expected = 0});
}

}  // namespace crescent::check
