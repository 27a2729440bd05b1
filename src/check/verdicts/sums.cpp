// normalised and density, by sums over all draws: mass (h = 1), bridge, slope, centre. A deviation is compared with its
// standard error and a floor.
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
        out += known_to(e, l) / h * std::fabs(values_in(e, l, h)[q]);
    }
    return out;
}

}  // namespace

Values unmet_variance(const Evidence& e) {
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

ReplicateMean<Replicates> replicate_mean(const Evidence& e, int integrand) {
    const Observations& o = e.observations;
    const auto q = static_cast<std::size_t>(integrand);
    Replicates y;
    for (std::size_t k = 0; k < y.size(); ++k) y[k] = o.by_set[q][k] * replicate_sets / o.scrambled;
    const double one_draw = std::sqrt(o.sums[q].square / std::max(o.sums[mass].sum, 1.0));
    return {y, one_draw * replicate_sets / o.scrambled};
}

double floor_of_sum(const Evidence& e, int integrand) {
    const auto q = static_cast<std::size_t>(integrand);
    const Sums& s = e.observations.sums[q];
    const double n = e.observations.independent;
    // Rounding always to one side changes h by half a step on average.
    const double known_to = e.integrals.known_to[q] + rounding_of_sum(e, q) + e.plan.per_step[q] / 2;
    // The integral of p lacks what its points do not resolve, where this share of the draws is.
    const double unresolved = integrand == mass ? e.observations.share_unresolved() : 0;
    if (integrand < slope)
        return detection_floor * std::max(s.sum / n, e.integrals.sums[q].value) + known_to + unresolved;
    return detection_floor * std::sqrt(s.square / n) + (integrand == slope ? ulp : 0) + known_to;
}

bool draws_vary(const Evidence& e, int integrand) {
    return integrand != mass || e.observations.sums[mass].sum < e.observations.independent;
}

double drawn_variance(const Evidence& e, int integrand) {
    const Sums& s = e.observations.sums[static_cast<std::size_t>(integrand)];
    const double n = e.observations.independent, mean = s.sum / n;
    return draws_vary(e, integrand) ? std::max(s.square / n - mean * mean, 0.0) / n : least_spread * least_spread;
}

void test_sums(const Evidence& e, const Visit& visit) {
    if (!e.source.has_density()) return;
    const Observations& o = e.observations;
    const double n = o.independent;
    const Values unmet = unmet_variance(e);
    for (int q = 0; q < integrands; ++q) {
        const auto index = static_cast<std::size_t>(q);
        const Estimate& claimed = e.integrals.sums[index];
        const double mean = o.sums[index].sum / n;
        const double floor = floor_of_sum(e, q);
        Answer a{.family = sum_kinds[q].family,
            .member = q >= centre_x ? q - centre_x : 0,
            .difference = mean - claimed.value,
            .sd = 0,
            .floor = floor,
            .p = 1,
            .expected = claimed.value};
        const double v = drawn_variance(e, q) + claimed.variance;
        a.sd = std::sqrt(v);
        a.claimed = claimed.variance / (v + 1e-300);
        const double beyond = std::fabs(a.difference) - floor, nu = freedom(v, claimed.doubt);
        const bool vary = draws_vary(e, q);
        a.p = vary ? bennett_p(bennett_z2(beyond, v, 1 / n, nu)) : student_p_of(beyond, v, nu);
        visit(a);
        if (o.scrambled == 0 || !vary) continue;
        const ReplicateMean<Replicates> sets = replicate_mean(e, q);
        a.family = sum_kinds[q].by_sets;
        a.difference = sets.mean - claimed.value;
        const double w = sets.variance + claimed.variance + unmet[index] / o.scrambled;
        a.sd = std::sqrt(w);
        a.claimed = claimed.variance / (w + 1e-300);
        a.p = student_p_of(std::fabs(a.difference) - floor, w,
            freedom(w, claimed.doubt + 2 * sets.variance * sets.variance / (replicate_sets - 1)));
        visit(a);
    }
}

}  // namespace crescent::check
