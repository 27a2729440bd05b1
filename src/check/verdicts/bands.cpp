// density, by bands of theta and of phi at every scale: the share of h in a band.
#include <array>
#include <cmath>

#include "check/constants.h"
#include "check/verdicts/questions.h"
#include "check/verdicts/statistics.h"

namespace crescent::check {

namespace {

/// Sums of a band, and the share of the draws that rounding may move across its edges.
struct Band {
    NodeSums sums;
    double moved = 0;
};

/// Adds the uncertainty of the leaves that overlap a band: their points may miss as much in the band as in the whole
/// leaf, and rounding may move their draws across its edges.
void add_leaves(const Evidence& e, ByBand<Band>& to) {
    const Tree& tree = e.plan.tree;
    const double all = e.integrals.sums[bridge].value;
    for (std::size_t l = 0; l < tree.leaves().size(); ++l) {
        const ChartRect& r = tree.rect(tree.leaves()[l]);
        const TreeNode& node = tree.nodes()[static_cast<std::size_t>(tree.leaves()[l].node)];
        const LeafIntegral& leaf = e.integrals.leaves[l];
        for (std::size_t axis = 0; axis < chart_axes; ++axis) {
            const bool along_phi = axis == 1;
            const double per = bands / axis_length[axis];
            const double from = (along_phi ? r.phi0 : r.t0) * per, past = (along_phi ? r.phi1 : r.t1) * per;
            const double moved = std::min(node.step / (r.width(along_phi) + 1e-300), 1.0);
            for (double k = std::floor(from); k < past; ++k) {
                Band& band = to[axis * bands + static_cast<std::size_t>(k)];
                band.sums.variance += leaf.bridge.variance, band.sums.doubt += leaf.bridge.doubt;
                band.sums.known_to += known_to(e, l);
                band.sums.largest =
                    std::max({band.sums.largest, 1 / e.observations.independent, leaf.per_point * tree.leaves()[l].q});
                if (from <= k || past >= k + 1) band.moved += moved * leaf.bridge.value / all;
            }
        }
    }
}

ByBand<Band> bands_of(const Evidence& e) {
    ByBand<Band> out;
    for (std::size_t i = 0; i < out.size(); ++i) {
        const Estimate& claimed = e.integrals.bridge_by_band[i];
        NodeSums& s = out[i].sums;
        s.drawn = e.observations.bands[i] / e.observations.independent, s.claimed = claimed.value;
        s.second = e.integrals.second_by_band[i], s.variance = claimed.variance, s.doubt = claimed.doubt;
    }
    add_leaves(e, out);
    return out;
}

}  // namespace

void test_bands(const Evidence& e, const Visit& visit) {
    if (!e.source.has_density()) return;
    const double n = e.observations.independent;
    const ByBand<Band> finest = bands_of(e);
    for (std::size_t axis = 0; axis < chart_axes; ++axis)
        for (std::size_t width = 1; width < bands; width *= 2)
            for (std::size_t first = 0; first < bands; first += width) {
                Band inside, outside;
                for (std::size_t k = 0; k < bands; ++k) {
                    Band& to = k >= first && k < first + width ? inside : outside;
                    const Band& from = finest[axis * bands + k];
                    to.sums += from.sums, to.moved += from.moved;
                }
                const NodeSums &a = inside.sums, &b = outside.sums;
                if (std::min(a.drawn + b.drawn, a.claimed + b.claimed) * n < e.least) continue;
                const double share = a.claimed / (a.claimed + b.claimed);
                const NodeSplit s = split_between(a, b, n, detection_floor * std::min(share, 1 - share) + inside.moved);
                const double z2 = bennett_z2(std::fabs(s.difference) - s.floor, s.variance,
                    std::max(a.largest, b.largest), freedom(s.variance, s.doubt));
                visit({Family::band, band_member(axis, first, width), s.difference, std::sqrt(s.variance), s.floor,
                    bennett_p(z2), s.share * (a.drawn + b.drawn), s.claim_variance / (s.variance + 1e-300)});
            }
}

}  // namespace crescent::check
