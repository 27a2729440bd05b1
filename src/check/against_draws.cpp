// The draws of both samplers, counted by the code that counts those of one.
#include "check/against_draws.h"

#include <algorithm>
#include <cmath>

#include "check/constants.h"
#include "check/estimate/observations.h"
#include "check/verdicts/density.h"
#include "check/verdicts/questions.h"

namespace crescent::check {

namespace {

constexpr double same_delta_direction = 1e-4;  // distance of unit vectors
constexpr std::size_t most_directions = 256;   // of the pilot draws of one sampler that are kept

/// One technique of a side, and the source whose density decides which draws below the surface count: its own, or that
/// of the other sampler if only that has one.
class TechniqueSource {
public:
    TechniqueSource(const AgainstSide& side, int technique)
        : source(*side.check_case.adapter, technique, side.check_case.wo, side.check_case.light),
          other_(side.other, 0, side.check_case.wo, side.check_case.light) {}
    Source source;
    Source& lower_source() { return source.has_density() || !other_.has_density() ? source : other_; }

private:
    Source other_;
};

struct Pilots {
    std::vector<Vec3d> directions;
    std::vector<DeltaPart> deltas;
    std::uint32_t draws = 0;
};

/// Pilot draws of all techniques.
Pilots draw_pilots(const AgainstSide& side, const CheckBudget& budget) {
    Pilots out;
    DeltaParts deltas;
    for (int t = 0; t < side.check_case.adapter->techniques(); ++t) {
        TechniqueSource technique(side, t);
        Source& source = technique.source;
        StreamKey key = side.key;
        key.purpose = Purpose::pilot;
        key.technique = static_cast<std::uint8_t>(t);
        const std::uint32_t count = source.available(key, budget.pilot());
        std::vector<PrimarySample> u;
        std::vector<Draw> draws;
        for (std::uint32_t first = 0; first < count; first += batch_size) {
            u.resize(std::min(batch_size, count - first));
            draws.assign(u.size(), {});
            source.draw(key, first, u, draws);
            for (Vec3d w : usable_draws(source, draws, &technique.lower_source()).w)
                out.directions.push_back(normalize(w));
            for (const Draw& d : draws)
                if (d.delta > 0 && d.delta <= 1) deltas.add(d, weight_by_channel(d, source.channels()));
        }
        out.draws += count;
    }
    out.deltas = deltas.parts(out.draws);
    return out;
}

/// The delta direction of a part; the number of directions if it is none of them.
std::size_t delta_index(std::span<const Vec3d> directions, Vec3d w) {
    const auto match =
        std::ranges::find_if(directions, [w](Vec3d direction) { return length(w - direction) < same_delta_direction; });
    return static_cast<std::size_t>(match - directions.begin());
}

/// Mean of ln q over the mass of the tree.
double mean_log_q(const Tree& tree) {
    double sum = 0, total = 0;
    for (const Leaf& leaf : tree.leaves()) {
        const double m = leaf.q * tree.rect(leaf).area();
        sum += m * Plan::log_of(leaf.q);
        total += m;
    }
    return sum / total;
}

}  // namespace

CommonPlan common_plan(const AgainstSide& a, const AgainstSide& b, const CheckBudget& budget) {
    Pilots pilots_a = draw_pilots(a, budget), pilots_b = draw_pilots(b, budget);
    std::vector<Vec3d> delta_directions, directions;
    for (const Pilots* pilots : {&pilots_a, &pilots_b})
        for (const DeltaPart& part : pilots->deltas)
            if (delta_index(delta_directions, part.wi) == delta_directions.size()) delta_directions.push_back(part.wi);
    for (std::size_t i = 0; i < most_directions; ++i)
        for (const Pilots* pilots : {&pilots_a, &pilots_b})
            if (i < pilots->directions.size()) directions.push_back(pilots->directions[i]);
    std::vector<DensityPoint> points;
    const double count = static_cast<double>(pilots_a.directions.size() + pilots_b.directions.size());
    Vec3d middle{};
    for (const Pilots* pilots : {&pilots_a, &pilots_b})
        for (Vec3d w : pilots->directions) {
            points.push_back({to_chart(w), 1});
            middle = middle + w * (1 / count);
        }
    const double step = std::max(step_of_directions(pilots_a.directions), step_of_directions(pilots_b.directions));
    Source source(*a.check_case.adapter, 0, a.check_case.wo, a.check_case.light);
    source.by_draws = true;
    StreamKey key = a.key;
    key.purpose = Purpose::tree;
    const std::uint32_t draws = pilots_a.draws + pilots_b.draws;
    Plan plan{.tree = Tree(source, std::move(points), draws, {}, step, budget, key),
        .step = step,
        .median_log_p = 0,
        .middle = middle,
        .mean_weight = {},
        .per_step = {0, 0, step, step, step, step},
        .estimates = true,
        .direction_count = static_cast<std::uint32_t>(count),
        .draw_count = draws};
    plan.median_log_p = mean_log_q(plan.tree);
    return {.plan = std::move(plan),
        .delta_directions = std::move(delta_directions),
        .delta_a = std::move(pilots_a.deltas),
        .delta_b = std::move(pilots_b.deltas),
        .directions = std::move(directions)};
}

void draw_on(
    const AgainstSide& side, const CommonPlan& common, const Look& target, std::uint32_t f_draws, SamplerDraws& d) {
    d.techniques.resize(static_cast<std::size_t>(side.check_case.adapter->techniques()));
    d.total = {};
    d.delta_draws.assign(common.delta_directions.size(), 0);
    for (std::size_t t = 0; t < d.techniques.size(); ++t) {
        TechniqueSource technique(side, static_cast<int>(t));
        StreamKey key = side.key;
        key.technique = static_cast<std::uint8_t>(t);
        Observations& observations = d.techniques[t];
        observe_draws(technique.source, technique.lower_source(), common.plan, target, f_draws, key, observations);
        add_technique(observations, d.total);
        for (const DeltaPart& part : observations.deltas.parts(observations.independent))
            if (const std::size_t k = delta_index(common.delta_directions, part.wi); k < d.delta_draws.size())
                d.delta_draws[k] += static_cast<double>(part.draws);
    }
}

Integrals pooled_integrals(const Plan& plan, const Observations& a, const Observations& b) {
    const double n = a.independent + b.independent, h = plan.largest_h();
    Integrals out;
    for (std::size_t q = 0; q < integrands; ++q) out.sums[q].value = (a.sums[q].sum + b.sums[q].sum) / n;
    out.leaves.resize(plan.tree.leaves().size());
    for (std::size_t l = 0; l < out.leaves.size(); ++l) {
        out.leaves[l].bridge.value = (a.leaves[l] + b.leaves[l]) / n;
        out.leaves[l].second = h * out.leaves[l].bridge.value;
    }
    for (std::size_t i = 0; i < out.second_by_band.size(); ++i) {
        out.bridge_by_band[i].value = (a.bands[i] + b.bands[i]) / n;
        out.second_by_band[i] = h * out.bridge_by_band[i].value;
    }
    return out;
}

Integrals shares_of_draws(const Observations& draws) {
    Integrals out;
    const double n = draws.independent;
    for (const float count : draws.counts) {
        LeafIntegral& leaf = out.leaves.emplace_back();
        leaf.mass.value = static_cast<double>(count) / n;
        leaf.mass.variance = leaf.mass.value / n;
    }
    return out;
}

AgainstEvidence::AgainstEvidence(
    const AgainstSide& a, const CommonPlan& common, const SamplerDraws& draws_a, const SamplerDraws& draws_b)
    : common_(common),
      a_(draws_a),
      b_(draws_b),
      source_(*a.check_case.adapter, 0, a.check_case.wo, a.check_case.light),
      integrals_(pooled_integrals(common.plan, draws_a.total, draws_b.total)) {}

VisitAll AgainstEvidence::tests() const {
    return [this](const Visit& visit) {
        test_distribution(evidence(), visit);
        test_delta_shares(visit);
    };
}

void AgainstEvidence::test_delta_shares(const Visit& visit) const {
    const double n = a_.total.independent, pooled = n + b_.total.independent;
    for (std::size_t k = 0; k < a_.delta_draws.size(); ++k) {
        const double share = (a_.delta_draws[k] + b_.delta_draws[k]) / pooled, draw_share = a_.delta_draws[k] / n;
        const NodeSums part{.draw_mean = draw_share, .claim = share, .second = share},
            remainder{.draw_mean = 1 - draw_share, .claim = 1 - share, .second = 1 - share};
        const NodeSplit s = split_between(part, remainder, n, detection_floor * std::min(share, 1 - share), pooled);
        visit(answer_of(Family::delta_share, static_cast<int>(k), s, s.z2(1 / n), 1));
    }
}

}  // namespace crescent::check
