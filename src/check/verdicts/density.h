// density, at every scale: nodes of the tree, all nodes of one depth together, and bands of theta and of phi.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "check/estimate/plan.h"
#include "check/verdicts/questions.h"

namespace crescent::check {

// Each calls `visit` for every member of its families.
void test_nodes(const Evidence& e, const Visit& visit);
void test_bands(const Evidence& e, const Visit& visit);

/// O and C of every node, from its leaves, and the division of its h between its halves.
struct NodeSums {
    double draw_mean = 0, claim = 0, second = 0, solid_angle = 0, variance = 0, doubt = 0, largest = 0, uncertainty = 0;
};
std::vector<NodeSums> node_sums(const Evidence& e);
NodeSums& operator+=(NodeSums& to, const NodeSums& other);
/// The test of a part given the whole.
struct NodeSplit {
    double share = 0;       // of h p in the part
    double difference = 0;  // of the part, given the whole
    double floor = 0, variance = 0, doubt = 0, claim_variance = 0;
    double smaller_half = 0;  // expected draws
    double one_draw = 0;      // weight of one draw: E[h^2] / E[h]
    double visible = 1;       // as for a whole sum
    /// Twice Bennett's exponent of the difference beyond its floor. largest: largest single term.
    double z2(double largest) const;
};
/// The answer of a part. whole: what was drawn of the whole.
Answer answer_of(Family family, int member, const NodeSplit& split, double z2, double whole);
/// The tolerance of a cut, in shares of the node's draws: the detection floor of its smaller half, and the draws that
/// rounding by the node's step moves across the cut and across the other edges of the node.
double floor_of_cut(const TreeNode& node, double share);
/// Divides a whole into a part `a` and the rest `b`. n: number of draws. floor: tolerance in shares of the draws of the
/// whole. pooled: as in `Evidence`.
NodeSplit split_between(const NodeSums& a, const NodeSums& b, double n, double floor,
    double pooled = std::numeric_limits<double>::infinity());
NodeSplit split_of(const Evidence& e, const std::vector<NodeSums>& sums, std::size_t node);

}  // namespace crescent::check
