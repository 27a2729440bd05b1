// The list of tests. Each is E[h(draw)] = integral of h p for one h, or another small test. Tests of one kind form a
// family, whose p-value is the least of its members times their number.
#pragma once

#include <algorithm>
#include <functional>
#include <limits>
#include <string_view>

#include "check/estimate/observations.h"
#include "check/verdicts/statistics.h"

namespace crescent::check {

enum class Family {
    values,     // unusable numbers
    corners,    // the same at corners of u, w_o and w_i
    mass,       // h = 1
    mass_sets,  // the same by replicates; likewise below
    bridge,     // h = q / (p + q)
    bridge_sets,
    slope,  // h (ln p - median)
    slope_sets,
    centre,  // h (x - mean), y and z likewise
    centre_sets,
    node,  // share of h in one half of a node
    node_sets,
    band,           // share of h in a band of theta or phi
    depth,          // sum of squares over all nodes of one depth
    delta_share,    // draws of a delta part against the stated probability
    delta_scatter,  // too many directions for delta parts
    delta_weight,   // draws of one delta part with several weights
    pointwise,      // pdf with the draw against pdf(w)
    zero,           // p = 0 at a draw
    weight,         // weight with the draw against f cos / pdf
    jacobian,       // p against the derivatives of sample(u)
    repeats,        // repeated directions
    state,          // the same u gives another draw, alone or in another batch
    support,        // f cos where p is 0
    mean,           // bridged weights against the integral of f cos
    reference_f,    // f against its reference value
    mis,            // weights of combined techniques sum to 1
    albedo,         // more light is reflected than arrives
    reciprocity,
    delta_direction,  // directions of delta parts against the index and the reverse path
    families
};

/// Name in reports and JSON, and the verdict that a failure makes wrong.
struct FamilyInfo {
    std::string_view name, verdict;
};
const FamilyInfo& info(Family family);
/// Whether the family uses f.
bool is_of_f(Family family);

/// The result of one test at some stage.
struct Answer {
    Family family = Family::values;
    int member = 0;         // channel, axis, node, band or depth
    double difference = 0;  // left side less right side
    double sd = 0, floor = 0;
    double p = 1;            // two-sided
    double expected = 0;     // right side
    double claim_share = 0;  // share of the variance that is due to the integrals
};

using Visit = std::function<void(const Answer&)>;

/// The data of the tests: the plan and both sides of (1).
struct Evidence {
    const Source& source;
    const Plan& plan;
    const Integrals& integrals;
    const Observations& observations;
    /// The draws of a second sampler. The right side is then the mean over the draws of both, which holds if they have
    /// one distribution.
    const Observations* second = nullptr;
    /// Nodes with fewer expected draws are not tested.
    double fewest_draws = least_count;

    /// Whether there is a right side: a density, or draws of a second sampler.
    bool has_density() const { return second || source.has_density(); }
    /// Number of draws of which the right side is the mean; infinite for integrals.
    double pooled_draws() const {
        return second ? observations.independent + second->independent : std::numeric_limits<double>::infinity();
    }
};

/// Calls `visit` for every member of the families of whole sums, nodes and bands: all that compares how the draws are
/// distributed.
void test_distribution(const Evidence& e, const Visit& visit);

/// How well h p of a leaf is known: as well as a tabulated p, and as the arithmetic of the sampler allows. Where
/// rounding makes p 0 or too small, the draws show how much it may be.
inline double uncertainty_of(const Evidence& e, std::size_t leaf) {
    const LeafIntegral& x = e.integrals.leaves[leaf];
    return x.tabulation_error +
        x.rounding * std::max(x.bridge.value, e.observations.leaves[leaf] / e.observations.independent);
}

}  // namespace crescent::check
