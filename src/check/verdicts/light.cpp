// mean: bridged weights compared with the integral of f cos. support: light where p is 0. physics: the albedo is at
// most 1. All by channel.
#include "check/verdicts/light.h"

#include <algorithm>
#include <cmath>

#include "check/constants.h"
#include "check/decide/tail.h"
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
    const Estimate mean = mean_of(o.mean[c], o.weighted_draws), &expected = e.integrals.light.mean[c];
    const double v = mean.variance + expected.variance, floor = detection_floor * expected.value;
    Answer a{.family = Family::mean,
        .member = channel,
        .difference = mean.value - expected.value,
        .sd = std::sqrt(v),
        .floor = floor,
        .p = 1,
        .expected = expected.value,
        .claim_share = expected.variance / (v + 1e-300)};
    const bool has_bridge = is_bridged(e.source);
    const double largest = has_bridge ? e.plan.mean_weight[c] : 0;  // upper bound of a bridged weight
    if (has_bridge && !(largest > 0)) return;
    a.p = has_bridge ? bennett_p(bennett_z2(
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
    std::vector<WeightSums> weights(nodes.size());
    std::vector<Estimate> expected(nodes.size());
    for (std::size_t i = nodes.size(); i-- > 0;) {
        if (nodes[i].child < 0) {
            const auto l = static_cast<std::size_t>(nodes[i].leaf);
            weights[i] = e.observations.weight_leaves[l][c];
            expected[i] = e.integrals.light.leaves[l][c];
            continue;
        }
        for (int half : {0, 1}) {
            const auto k = static_cast<std::size_t>(nodes[i].child + half);
            weights[i].add(weights[k]);
            expected[i].add(expected[k]);
        }
        const WeightSums& w = weights[i];
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
    const Estimate& integral = e.integrals.light.albedo[c];
    const double total = o.delta_power[c] + integral.value, v = integral.variance;
    Answer a{.family = Family::albedo,
        .member = channel,
        .difference = total - 1,
        .sd = std::sqrt(v),
        .floor = albedo_excess,
        .p = 1,
        .expected = 1,
        .claim_share = 1};
    a.p = student_p_of(total - 1 - albedo_excess, v, freedom(v, integral.doubt));
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
    const bool has_testable_mean = mean_can_be_tested(e);
    for (int c = 0; c < e.source.channels(); ++c) {
        if (has_testable_mean) test_mean(e, c, visit);
        if (has_testable_mean && !e.source.has_density()) test_mean_by_nodes(e, c, visit);
        if (e.source.traits.has_surface()) test_albedo(e, c, visit);
    }
    if (!e.source.has_density() || e.plan.estimates) return;
    const LightIntegrals& l = e.integrals.light;
    const double threshold = lost_light * l.lit.value;
    Answer a{.family = Family::support,
        .member = 0,
        .difference = l.lost.value,
        .sd = std::sqrt(l.lost.variance),
        .floor = threshold,
        .p = 1,
        .expected = l.lit.value,
        .claim_share = 1};
    // If at most `threshold` were lost, the sum over points with contributions of at most b would have a variance of at
    // most b times `threshold`.
    a.p = l.separate_lost.value > threshold
        ? bennett_p(bennett_z2(l.separate_lost.value - threshold, l.largest_lost * threshold, l.largest_lost, 1e12))
        : 1;
    visit(a);
}

}  // namespace crescent::check
