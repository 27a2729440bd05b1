// The choices made before any test: the tree and its densities, the step of the sampler's arithmetic, and the constants
// of the test functions. Both stages use the same plan, so that stage 2 tests the hypothesis found by stage 1.
#pragma once

#include <array>
#include <vector>

#include "check/constants.h"
#include "check/estimate/tree.h"

namespace crescent::check {

/// The test functions h of whole sums, in the order of their integrals.
enum Integrand : int { mass, bridge, slope, centre_x, centre_y, centre_z, integrands };

/// Values of all h at one direction.
using Values = std::array<double, integrands>;

struct Plan {
    Tree tree;
    double step = 0;                  // of the sampler's arithmetic, as an angle; 0: none found
    double median_log_p = 0;          // over the pilot draws
    Vec3d middle{};                   // their mean direction
    std::array<double, 3> usual{};    // their mean weight by channel
    Values per_step{};                // change of h by a local step of the arithmetic, mean over pilot draws
    bool estimates = false;           // p is a random estimate, so h does not depend on it
    std::uint32_t drawn = 0, of = 0;  // pilot draws that are directions; all pilot draws

    /// h = q / (p + q), in [0, 1] (the bridge of Meng and Wong 1996), and h times the quantities of the other sums.
    Values values(const Leaf& leaf, Vec3d w, double p) const {
        const double known = estimates ? leaf.q : p;
        const double h = leaf.q / (known + leaf.q);
        return {1, h, known > 0 ? h * (log_of(known) - median_log_p) : 0, h * (w.x - middle.x), h * (w.y - middle.y),
            h * (w.z - middle.z)};
    }
    /// Whether the sampler computes in single precision, as it declares or as the step of its directions shows: that of
    /// an angle is angle_per_step ulp, here to a factor of 4.
    bool in_single(const Source& source) const { return source.single() || step >= angle_per_step * ulp / 4; }
    static double log_of(double p) { return math::log(p); }
};

/// Makes the pilot draws and builds the tree.
Plan make_plan(Source& source, const CheckBudget& budget, StreamKey key, std::vector<DensityPoint> hints = {});

/// The step of the lattice that contains n values; 0 if there is none. With few equal pairs: (equal pairs) / (pairs
/// within g) = step / (2 g). With many: the median gap between distinct values.
double step_of(std::vector<double> values);
/// The step of the arithmetic that produced these directions, as an angle.
double step_of_directions(std::span<const Vec3d> directions);

}  // namespace crescent::check
