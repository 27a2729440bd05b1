// density, at every scale: nodes of the tree, all nodes of one depth together, and bands of theta and of phi.
#include "check/verdicts/density.h"

#include <array>
#include <cmath>

#include "check/constants.h"
#include "check/verdicts/questions.h"
#include "check/verdicts/statistics.h"
#include "math/statistics.h"

namespace crescent::check {

// ---- density, at every scale: the share of h in one half of each node, given the whole; and all nodes of one depth
// together, for many small faults. The variance is predicted from the claimed density, so that draws in a half that
// must be empty are fully significant.

NodeSums& operator+=(NodeSums& to, const NodeSums& other) {
    to.draw_mean += other.draw_mean;
    to.claim += other.claim;
    to.second += other.second;
    to.solid_angle += other.solid_angle;
    to.variance += other.variance;
    to.doubt += other.doubt;
    to.uncertainty += other.uncertainty;
    to.largest = std::max(to.largest, other.largest);
    return to;
}

std::vector<NodeSums> node_sums(const Evidence& e) {
    const std::vector<TreeNode>& nodes = e.plan.tree.nodes();
    const Observations& o = e.observations;
    std::vector<NodeSums> out(nodes.size());
    for (std::size_t i = nodes.size(); i-- > 0;) {
        NodeSums& s = out[i];
        if (nodes[i].child < 0) {
            const auto l = static_cast<std::size_t>(nodes[i].leaf);
            const LeafIntegral& c = e.integrals.leaves[l];
            s = {.draw_mean = o.leaves[l] / o.independent,
                .claim = c.bridge.value,
                .second = c.second,
                .solid_angle = c.solid_angle,
                .variance = c.bridge.variance,
                .doubt = c.bridge.doubt,
                .largest = std::max(e.plan.largest_h() / o.independent, c.per_point * e.plan.tree.leaves()[l].q),
                .uncertainty = uncertainty_of(e, l)};
            continue;
        }
        for (int half : {0, 1}) s += out[static_cast<std::size_t>(nodes[i].child + half)];
    }
    return out;
}

double floor_of_cut(const TreeNode& x, double share) {
    const double smaller_share = std::min(share, 1 - share), step = x.step;
    const double moved_share =
        step / x.rect.width(x.along_phi) + smaller_share * step / (x.rect.width(!x.along_phi) + 1e-300);
    return detection_floor * smaller_share + moved_share;
}

NodeSplit split_of(const Evidence& e, const std::vector<NodeSums>& sums, std::size_t node) {
    const TreeNode& x = e.plan.tree.nodes()[node];
    const NodeSums &a = sums[static_cast<std::size_t>(x.child)], &b = sums[static_cast<std::size_t>(x.child) + 1];
    const double share = a.claim / (a.claim + b.claim);
    return split_between(a, b, e.observations.independent, floor_of_cut(x, share), e.pooled_draws());
}

NodeSplit split_between(const NodeSums& a, const NodeSums& b, double n, double floor, double pooled) {
    NodeSums sum = a;
    sum += b;
    NodeSplit out;
    const double r = out.share = a.claim / sum.claim, smaller_share = std::min(r, 1 - r);
    out.difference = a.draw_mean - r * sum.draw_mean;
    // Given the draws of two samplers in the whole and in the part, those of one have a hypergeometric distribution. It
    // is that of a sum of independent indicators (Vatutin and Mikhailov 1982), so that Bennett's inequality holds.
    out.visible = 1 - sum.draw_mean * n / (sum.claim * pooled);
    out.floor = out.visible * sum.draw_mean * (floor + ((1 - r) * a.uncertainty + r * b.uncertainty) / sum.claim);
    const double c2 = sum.claim * sum.claim, to_variance = sum.draw_mean * sum.draw_mean / (c2 * c2);
    out.claim_variance = to_variance * (b.claim * b.claim * a.variance + a.claim * a.claim * b.variance);
    const auto fourth = [](double v) { return v * v * v * v; };
    out.doubt = to_variance * to_variance * (fourth(b.claim) * a.doubt + fourth(a.claim) * b.doubt);
    out.variance = out.visible * sum.draw_mean / sum.claim * ((1 - r) * (1 - r) * a.second + r * r * b.second) / n +
        out.claim_variance;
    out.one_draw = sum.second / sum.claim;
    out.smaller_half = smaller_share * n * c2 / (sum.second + 1e-300);
    return out;
}

double NodeSplit::z2(double largest) const {
    return bennett_z2(std::fabs(difference) - floor, variance, largest, freedom(variance, doubt));
}

Answer answer_of(Family family, int member, const NodeSplit& split, double z2, double whole) {
    return {.family = family,
        .member = member,
        .difference = split.difference,
        .sd = std::sqrt(split.variance),
        .floor = split.floor,
        .p = bennett_p(z2),
        .expected = split.share * whole,
        .claim_share = split.claim_variance / (split.variance + 1e-300)};
}

namespace {

/// Sums over replicates below each node down to the replicated depth, from those of its lowest rows.
std::vector<Replicates> replicates_by_row(const Tree& tree, std::vector<Replicates> out) {
    const std::vector<TreeNode>& nodes = tree.nodes();
    for (std::size_t i = nodes.size(); i-- > 0;) {
        const TreeNode& x = nodes[i];
        if (x.child < 0 || x.depth >= replicated_depth) continue;
        const auto row = [&](int n) { return static_cast<std::size_t>(nodes[static_cast<std::size_t>(n)].row); };
        for (std::size_t k = 0; k < replicate_sets; ++k)
            out[static_cast<std::size_t>(x.row)][k] = out[row(x.child)][k] + out[row(x.child + 1)][k];
    }
    return out;
}

/// The replicates of one sampler by node.
class SplitSets {
public:
    SplitSets(const Tree& tree, const Observations& o)
        : tree_(tree), sets_(replicates_by_row(tree, o.node_by_set)), draw_(replicate_sets / o.scrambled) {}

    /// What the first half of a node has beyond its share.
    ReplicateMean<Replicates> at(std::size_t node, const NodeSplit& s) const {
        const TreeNode& x = tree_.nodes()[node];
        const Replicates &node_sets = sets_[static_cast<std::size_t>(x.row)],
                         &half_sets =
                             sets_[static_cast<std::size_t>(tree_.nodes()[static_cast<std::size_t>(x.child)].row)];
        Replicates y;
        for (std::size_t k = 0; k < y.size(); ++k) y[k] = (half_sets[k] - s.share * node_sets[k]) * draw_;
        return {y, s.one_draw * draw_};
    }

private:
    const Tree& tree_;
    std::vector<Replicates> sets_;
    double draw_;
};

/// Of the draws, and of a second sampler; empty without replicates.
std::vector<SplitSets> split_sets(const Evidence& e) {
    std::vector<SplitSets> out;
    for (const Observations* o : {&e.observations, e.second}) {
        if (!o) continue;
        if (o->scrambled == 0) return {};
        out.emplace_back(e.plan.tree, *o);
    }
    return out;
}

/// draw_mean: the sum over the node, as in `test_nodes`.
Answer answer_of_sets(std::span<const SplitSets> sets, std::size_t node, const NodeSplit& s, double draw_mean) {
    Estimate claim{.value = 0, .variance = s.claim_variance, .doubt = s.doubt};
    for (const SplitSets& second : sets.subspan(1)) {
        const ReplicateMean mean = second.at(node, s);
        claim.add({mean.mean, mean.variance, mean.doubt});
    }
    const ReplicateMean mean = sets[0].at(node, s);
    const double v = mean.variance + claim.variance;
    // Replicates are compared with replicates, so that the whole difference between two samplers is visible.
    Answer a{.family = Family::node_sets,
        .member = static_cast<int>(node),
        .difference = mean.mean - claim.value,
        .sd = std::sqrt(v),
        .floor = s.floor / s.visible,
        .p = 1,
        .expected = s.share * draw_mean,
        .claim_share = claim.variance / (v + 1e-300)};
    a.p = student_p_of(std::fabs(a.difference) - a.floor, v, freedom(v, claim.doubt + mean.doubt));
    return a;
}

/// The least number of draws of a part: expected, drawn, and of a second sampler.
double least_draws(const Evidence& e, double draw_mean, double claim) {
    const double n = e.observations.independent, fewest = std::min(draw_mean, claim) * n;
    return e.second ? std::min(fewest, claim * e.pooled_draws() - draw_mean * n) : fewest;
}

}  // namespace

void test_nodes(const Evidence& e, const Visit& visit) {
    if (!e.has_density()) return;
    const std::vector<TreeNode>& nodes = e.plan.tree.nodes();
    const std::vector<NodeSums> sums = node_sums(e);
    const std::vector<SplitSets> sets = split_sets(e);
    std::vector<double> chi(static_cast<std::size_t>(e.plan.tree.depth()) + 1), degrees(chi.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (nodes[i].child < 0 || least_draws(e, sums[i].draw_mean, sums[i].claim) < e.fewest_draws) continue;
        const NodeSplit s = split_of(e, sums, i);
        const double z2 = s.z2(sums[i].largest);
        visit(answer_of(Family::node, static_cast<int>(i), s, z2, sums[i].draw_mean));
        if (s.smaller_half < e.fewest_draws) continue;
        const auto depth = static_cast<std::size_t>(nodes[i].depth);
        chi[depth] += std::min(z2, 1e6);
        ++degrees[depth];
        // The mean of a replicate must be nearly normal: with fewer draws the tail of Student's t is wrong by orders of
        // magnitude.
        if (!sets.empty() && nodes[i].depth < replicated_depth && s.smaller_half / replicate_sets >= e.fewest_draws)
            visit(answer_of_sets(sets, i, s, sums[i].draw_mean));
    }
    for (std::size_t d = 0; d < chi.size(); ++d)
        if (degrees[d] > 0)
            visit({.family = Family::depth,
                .member = static_cast<int>(d),
                .difference = chi[d] - degrees[d],
                .sd = std::sqrt(2 * degrees[d]),
                .floor = 0,
                .p = chi_squared_p(chi[d], degrees[d]),
                .expected = degrees[d]});
}

// ---- density, by bands of theta and of phi at every scale: the share of h in a band.

namespace {

/// Sums of a band, and the share of the draws that rounding may move across its edges.
struct Band {
    NodeSums sums;
    double moved_share = 0;
};

/// Adds the uncertainty of the leaves that overlap a band: their points may miss as much in the band as in the whole
/// leaf, and rounding may move their draws across its edges.
void add_leaves(const Evidence& e, ByBand<Band>& to) {
    const Tree& tree = e.plan.tree;
    const double total = e.integrals.sums[bridge].value;
    for (std::size_t l = 0; l < tree.leaves().size(); ++l) {
        const ChartRect& r = tree.rect(tree.leaves()[l]);
        const TreeNode& node = tree.nodes()[static_cast<std::size_t>(tree.leaves()[l].node)];
        const LeafIntegral& leaf = e.integrals.leaves[l];
        for (std::size_t axis = 0; axis < chart_axes; ++axis) {
            const bool along_phi = axis == 1;
            const double bands_per_unit = bands / axis_length[axis];
            const double from = (along_phi ? r.phi0 : r.t0) * bands_per_unit,
                         last = (along_phi ? r.phi1 : r.t1) * bands_per_unit;
            const double moved_share = std::min(node.step / (r.width(along_phi) + 1e-300), 1.0);
            for (double k = std::floor(from); k < last; ++k) {
                Band& band = to[axis * bands + static_cast<std::size_t>(k)];
                band.sums.variance += leaf.bridge.variance;
                band.sums.doubt += leaf.bridge.doubt;
                band.sums.uncertainty += uncertainty_of(e, l);
                band.sums.largest = std::max({band.sums.largest, e.plan.largest_h() / e.observations.independent,
                    leaf.per_point * tree.leaves()[l].q});
                if (from <= k || last >= k + 1) band.moved_share += moved_share * leaf.bridge.value / total;
            }
        }
    }
}

ByBand<Band> bands_of(const Evidence& e) {
    ByBand<Band> out;
    for (std::size_t i = 0; i < out.size(); ++i) {
        const Estimate& claim = e.integrals.bridge_by_band[i];
        NodeSums& s = out[i].sums;
        s.draw_mean = e.observations.bands[i] / e.observations.independent;
        s.claim = claim.value;
        s.second = e.integrals.second_by_band[i];
        s.variance = claim.variance;
        s.doubt = claim.doubt;
    }
    add_leaves(e, out);
    return out;
}

}  // namespace

void test_bands(const Evidence& e, const Visit& visit) {
    if (!e.has_density()) return;
    const ByBand<Band> finest = bands_of(e);
    for (std::size_t axis = 0; axis < chart_axes; ++axis)
        for (std::size_t width = 1; width < bands; width *= 2)
            for (std::size_t first = 0; first < bands; first += width) {
                Band band, remainder;
                for (std::size_t k = 0; k < bands; ++k) {
                    Band& to = k >= first && k < first + width ? band : remainder;
                    const Band& from = finest[axis * bands + k];
                    to.sums += from.sums;
                    to.moved_share += from.moved_share;
                }
                const NodeSums &a = band.sums, &b = remainder.sums;
                if (least_draws(e, a.draw_mean + b.draw_mean, a.claim + b.claim) < e.fewest_draws) continue;
                const double share = a.claim / (a.claim + b.claim);
                const NodeSplit s = split_between(a, b, e.observations.independent,
                    detection_floor * std::min(share, 1 - share) + band.moved_share, e.pooled_draws());
                visit(answer_of(Family::band, band_member(axis, first, width), s, s.z2(std::max(a.largest, b.largest)),
                    a.draw_mean + b.draw_mean));
            }
}

}  // namespace crescent::check
