// normalised and density, by sums over all draws: mass (h = 1), bridge, slope, centre. A deviation is compared with its
// standard error and a floor.
#include "check/verdicts/sums.h"

#include <cmath>

#include "check/constants.h"
#include "check/verdicts/questions.h"
#include "check/verdicts/statistics.h"

namespace crescent::check {

namespace {

struct Kind {
    Family family, by_sets;
};
constexpr Kind sum_kinds[integrands] = {{Family::mass, Family::mass_sets}, {Family::bridge, Family::bridge_sets},
    {Family::slope, Family::slope_sets}, {Family::centre, Family::centre_sets}, {Family::centre, Family::centre_sets},
    {Family::centre, Family::centre_sets}};

/// The integrands in the middle of a leaf, whose mean of h is given.
Values values_in(const Evidence& e, std::size_t l, double h) {
    const Leaf& leaf = e.plan.tree.leaves()[l];
    const Vec3d offset = from_chart(e.plan.tree.rect(leaf).at(0.5, 0.5)) - e.plan.middle;
    return {1, h, h * (Plan::log_of(leaf.q) - e.plan.median_log_p), h * offset.x, h * offset.y, h * offset.z};
}

/// The effect of rounding of p on a whole sum, for all leaves in which p is not known better.
double rounding_of_sum(const Evidence& e, std::size_t q) {
    double out = 0;
    for (std::size_t l = 0; l < e.integrals.leaves.size(); ++l) {
        const LeafIntegral& leaf = e.integrals.leaves[l];
        if (!(leaf.rounding > 0)) continue;
        const double h = leaf.second > 0 ? leaf.second / leaf.bridge.value : 0.5;
        out += uncertainty_of(e, l) / h * std::fabs(values_in(e, l, h)[q]);
    }
    return out;
}

/// The variance of one draw due to leaves without draws: replicates that all miss them do not show it.
Values missing_variance_of(const Evidence& e) {
    Values out{};
    for (std::size_t l = 0; l < e.integrals.leaves.size(); ++l) {
        const LeafIntegral& leaf = e.integrals.leaves[l];
        if (e.observations.counts[l] > 0 || !(leaf.second > 0)) continue;
        const double h = leaf.second / leaf.bridge.value, share = leaf.bridge.value / h;
        const Values values = values_in(e, l, h);
        for (std::size_t q = 0; q < integrands; ++q) out[q] += share * sqr(values[q] - e.integrals.sums[q].value);
    }
    return out;
}

/// Mean of a whole sum over the replicates.
ReplicateMean<Replicates> replicate_mean(const Observations& o, std::size_t q) {
    Replicates y;
    for (std::size_t k = 0; k < y.size(); ++k) y[k] = o.by_set[q][k] * replicate_sets / o.scrambled;
    const double one_draw = std::sqrt(o.sums[q].square / std::max(o.sums[mass].sum, 1.0));
    return {y, one_draw * replicate_sets / o.scrambled};
}

/// The tolerance of a whole sum: a share of the sum itself (mass, bridge) or of the spread of h (slope, centre), and
/// for a logarithm the rounding of p in single precision.
double floor_of_sum(const Evidence& e, std::size_t q) {
    const Sums& s = e.observations.sums[q];
    const double n = e.observations.independent;
    // Rounding always to one side changes h by half a step on average.
    const double uncertainty = e.integrals.tabulation_error[q] + rounding_of_sum(e, q) + e.plan.per_step[q] / 2;
    // The integral of p lacks what its points do not resolve, where this share of the draws is.
    const double unresolved = q == mass ? e.observations.share_unresolved() : 0;
    if (q < slope) return detection_floor * std::max(s.sum / n, e.integrals.sums[q].value) + uncertainty + unresolved;
    return detection_floor * std::sqrt(s.square / n) + (q == slope ? ulp : 0) + uncertainty;
}

/// Mean and mean square of the values of a sum, over all draws that have one distribution.
struct Moments {
    double mean, square;
};
Moments moments_of(const Evidence& e, std::size_t q) {
    const Sums& first = e.observations.sums[q];
    if (!e.second) return {first.sum / e.observations.independent, first.square / e.observations.independent};
    const Sums& second = e.second->sums[q];
    return {(first.sum + second.sum) / e.pooled_draws(), (first.square + second.square) / e.pooled_draws()};
}

/// False for the mass if every draw is a direction: the draws then add no variance. If none of 2^16 draws at either
/// stage is without a sample, the share of such draws is below the detection floor with probability 1 - 1e-11.
bool draws_vary(const Evidence& e, std::size_t q) { return q != mass || moments_of(e, q).mean < 1; }

/// A bound of a value: ln q, unlike h ln p, has none of its own.
double largest_value(const Evidence& e, std::size_t q) {
    double out = 1;
    if (q != slope || !e.plan.estimates) return out;
    const std::vector<Leaf>& leaves = e.plan.tree.leaves();
    for (std::size_t l = 0; l < leaves.size(); ++l)
        if (e.integrals.leaves[l].bridge.value > 0)
            out = std::max(out, e.plan.largest_h() * std::fabs(Plan::log_of(leaves[l].q) - e.plan.median_log_p));
    return out;
}

SumComparison compare_draws(const Evidence& e, std::size_t q) {
    const double n = e.observations.independent;
    const Estimate& claim = e.integrals.sums[q];
    const Moments moments = moments_of(e, q);
    const bool has_variance = draws_vary(e, q);
    SumComparison out{.difference = e.observations.sums[q].sum / n - claim.value,
        .floor = floor_of_sum(e, q),
        .drawn_variance = has_variance ? std::max(moments.square - moments.mean * moments.mean, 0.0) / n
                                       : least_spread * least_spread,
        .claim_variance = claim.variance,
        .freedom = 0,
        .largest = has_variance ? largest_value(e, q) / n : 0,
        .visible = 1 - n / e.pooled_draws()};
    out.floor *= out.visible;
    out.drawn_variance *= out.visible;
    out.freedom = freedom(out.variance(), claim.doubt);
    return out;
}

/// Draws of a second sampler are compared by its own replicates, so that the whole difference is visible.
std::optional<SumComparison> compare_sets(const Evidence& e, std::size_t q, double missing_variance) {
    const Observations& o = e.observations;
    if (o.scrambled == 0 || (e.second && e.second->scrambled == 0) || !draws_vary(e, q)) return {};
    Estimate claim = e.integrals.sums[q];
    if (e.second) {
        const ReplicateMean<Replicates> sets = replicate_mean(*e.second, q);
        claim = {sets.mean, sets.variance, sets.doubt};
    }
    const ReplicateMean<Replicates> sets = replicate_mean(o, q);
    SumComparison out{.difference = sets.mean - claim.value,
        .floor = floor_of_sum(e, q),
        .drawn_variance = sets.variance + missing_variance / o.scrambled,
        .claim_variance = claim.variance,
        .freedom = 0,
        .largest = 0,
        .visible = 1};
    out.freedom = freedom(out.variance(), claim.doubt + sets.doubt);
    return out;
}

}  // namespace

double SumComparison::p() const {
    const double excess = std::fabs(difference) - floor;
    return largest > 0 ? bennett_p(bennett_z2(excess, variance(), largest, freedom))
                       : student_p_of(excess, variance(), freedom);
}

std::array<WholeSum, integrands> compare_sums(const Evidence& e) {
    const Values missing_variances = missing_variance_of(e);
    std::array<WholeSum, integrands> out;
    for (std::size_t q = 0; q < integrands; ++q)
        out[q] = {compare_draws(e, q), compare_sets(e, q, missing_variances[q])};
    return out;
}

void test_sums(const Evidence& e, const Visit& visit) {
    if (!e.has_density()) return;
    const std::array<WholeSum, integrands> sums = compare_sums(e);
    for (int q = 0; q < integrands; ++q) {
        const auto visit_sum = [&](Family family, const SumComparison& s) {
            visit({.family = family,
                .member = q >= centre_x ? q - centre_x : 0,
                .difference = s.difference,
                .sd = std::sqrt(s.variance()),
                .floor = s.floor,
                .p = s.p(),
                .expected = e.integrals.sums[static_cast<std::size_t>(q)].value,
                .claim_share = s.claim_variance / (s.variance() + 1e-300)});
        };
        const WholeSum& s = sums[static_cast<std::size_t>(q)];
        visit_sum(sum_kinds[q].family, s.by_draws);
        if (s.by_sets) visit_sum(sum_kinds[q].by_sets, *s.by_sets);
    }
}

}  // namespace crescent::check
