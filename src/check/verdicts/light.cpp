// mean: bridged weights compared with the integral of f cos. support: light where p is 0. physics: the albedo is at
// most 1. All by channel.
#include <algorithm>
#include <cmath>

#include "check/constants.h"
#include "check/decide/check_at.h"
#include "check/verdicts/questions.h"
#include "check/verdicts/statistics.h"
#include "math/statistics.h"

namespace crescent::check {

namespace {

/// Mean and the variance of that mean.
Estimate mean_of(const Sums& s, double n) {
    const double m = s.sum / n;
    return {m, std::max(s.square / n - m * m, 0.0) / n, 0};
}

void test_mean(const Evidence& e, int channel, const Visit& visit) {
    const auto c = static_cast<std::size_t>(channel);
    const Observations& o = e.observations;
    const Estimate drawn = mean_of(o.mean[c], o.weighted_draws), &expected = e.integrals.light.mean[c];
    const double v = drawn.variance + expected.variance, floor = detection_floor * expected.value;
    Answer a{.family = Family::mean,
        .member = channel,
        .difference = drawn.value - expected.value,
        .sd = std::sqrt(v),
        .floor = floor,
        .p = 1,
        .expected = expected.value,
        .claimed = expected.variance / (v + 1e-300)};
    const bool bridged = is_bridged(e.source);
    const double largest = bridged ? e.plan.usual[c] : 0;  // upper bound of a bridged weight
    if (bridged && !(largest > 0)) return;
    a.p = bridged ? bennett_p(bennett_z2(
                        std::fabs(a.difference) - floor, v, largest / o.weighted_draws, freedom(v, expected.doubt)))
                  : 2 * normal_p_of(std::fabs(a.difference) - floor, v);
    visit(a);
}

/// Without a density only the weights show the distribution of the draws: compares their sum in each node of the upper
/// tree with the integral of f cos there.
void test_mean_by_nodes(const Evidence& e, int channel, const Visit& visit) {
    const std::vector<TreeNode>& nodes = e.plan.tree.nodes();
    const auto c = static_cast<std::size_t>(channel);
    const double n = e.observations.weighted_draws;
    std::vector<WeightSums> drawn(nodes.size());
    std::vector<Estimate> expected(nodes.size());
    for (std::size_t i = nodes.size(); i-- > 0;) {
        if (nodes[i].child < 0) {
            const auto l = static_cast<std::size_t>(nodes[i].leaf);
            drawn[i] = e.observations.weight_leaves[l][c];
            expected[i] = e.integrals.light.leaves[l][c];
            continue;
        }
        for (int half : {0, 1}) {
            const auto k = static_cast<std::size_t>(nodes[i].child + half);
            drawn[i].add(drawn[k]);
            expected[i].add(expected[k]);
        }
        const WeightSums& w = drawn[i];
        if (i == 0 || nodes[i].depth > mean_depth || w.count < mean_draws || w.largest * w.largest * 20 > w.square)
            continue;
        const double mean = w.sum / n, v = std::max(w.square / n - mean * mean, 0.0) / n + expected[i].variance;
        const double floor = detection_floor * expected[i].value;
        Answer a{.family = Family::mean,
            .member = static_cast<int>(3 * i) + channel,
            .difference = mean - expected[i].value,
            .sd = std::sqrt(v),
            .floor = floor,
            .p = 1,
            .expected = expected[i].value};
        a.p = student_p_of(std::fabs(a.difference) - floor, v, freedom(v, expected[i].doubt));
        visit(a);
    }
}

void test_albedo(const Evidence& e, int channel, const Visit& visit) {
    const auto c = static_cast<std::size_t>(channel);
    const Observations& o = e.observations;
    const Estimate& of_density = e.integrals.light.albedo[c];
    const double total = o.delta_power[c] + of_density.value, v = of_density.variance;
    Answer a{.family = Family::albedo,
        .member = channel,
        .difference = total - 1,
        .sd = std::sqrt(v),
        .floor = albedo_excess,
        .p = 1,
        .expected = 1,
        .claimed = 1};
    a.p = student_p_of(total - 1 - albedo_excess, v, freedom(v, of_density.doubt));
    visit(a);
}

}  // namespace

bool tail_may_be_heavy(std::span<const double> weights) {
    double mean = 0, largest = 0;
    for (double x : weights) {
        mean += x / static_cast<double>(weights.size());
        largest = std::max(largest, x);
    }
    if (largest <= bounded_weight * mean) return false;
    const WeightTail tail = tail_of_weights(weights);
    return tail.heavy() || tail.open();
}

bool mean_can_be_tested(const Evidence& e) {
    const Observations& o = e.observations;
    // A mean that is not bridged must have a finite variance.
    return o.weighted_draws > 0 && o.weightless == 0 && (is_bridged(e.source) || !tail_may_be_heavy(o.weights));
}

void test_light(const Evidence& e, const Visit& visit) {
    if (!e.source.has_f() || !(e.integrals.light.points > 0)) return;
    const bool of_mean = mean_can_be_tested(e);
    for (int c = 0; c < e.source.channels(); ++c) {
        if (of_mean) test_mean(e, c, visit);
        if (of_mean && !e.source.has_density()) test_mean_by_nodes(e, c, visit);
        if (e.source.traits.has_surface()) test_albedo(e, c, visit);
    }
    if (!e.source.has_density() || e.plan.estimates) return;
    const LightIntegrals& l = e.integrals.light;
    const double least = lost_light * l.lit.value;
    Answer a{.family = Family::support,
        .member = 0,
        .difference = l.lost.value,
        .sd = std::sqrt(l.lost.variance),
        .floor = least,
        .p = 1,
        .expected = l.lit.value,
        .claimed = 1};
    // If at most `least` were lost, the sum over points with contributions of at most b would have a variance of at
    // most b times `least`.
    a.p = l.lost_again.value > least
        ? bennett_p(bennett_z2(l.lost_again.value - least, l.largest_lost * least, l.largest_lost, 1e12))
        : 1;
    visit(a);
}

}  // namespace crescent::check
