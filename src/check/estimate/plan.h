// The choices made before any test: the tree of the sphere and its densities, the step of the sampler's arithmetic, and
// the constants of the test functions. Both stages use the same plan, so that stage 2 tests the hypothesis found by
// stage 1.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "check/constants.h"
#include "check/estimate/budget.h"
#include "check/estimate/chart.h"
#include "check/estimate/source.h"
#include "check/estimate/stream.h"

namespace crescent::check {

// ---- The tree for one density: dyadic cuts of the chart where p varies, where the pilot draws disagree with it and
// where mass is. Each leaf has a density q_l, from which the test functions are made.

/// A point with p there.
struct DensityPoint {
    ChartPoint at;
    double p = 0;
    bool hint = false;  // a point from an earlier tree where p was high: excluded from averages
    double step = -1;   // of a draw: jump of its direction; below 0 if not measured
};

struct TreeNode {
    ChartRect rect;
    int child = -1;  // the second child has the next index; -1: a leaf
    int depth = 0, leaf = -1;
    int row = -1;            // its number among nodes down to `replicated_depth`
    bool along_phi = false;  // of its cut
    double step = 0;         // of the sampler's arithmetic here, as an angle
};

struct Leaf {
    int node = 0;
    int coarse = 0;     // row of its ancestor at `replicated_depth`, or of itself if it is higher
    double q = 0;       // 1/sr; positive
    double spread = 0;  // area times the standard deviation of p over its points
    double score = 0;   // benefit of more leaves here
    double step = 0;    // of its node
    bool met = false;   // p > 0 at a point or draw while the tree grew; otherwise q is that of half a draw in the pilot
    bool edge = false;  // it is met, and a neighbour has a q that differs by more than `alike`
};

class Tree {
public:
    /// `pilots`: the directions among `of` pilot draws. `hints`: other points with p. step: of the sampler's
    /// arithmetic, as an angle.
    Tree(Source& source, std::vector<DensityPoint> pilots, std::uint32_t of, std::vector<DensityPoint> hints,
        double step, const CheckBudget& budget, const StreamKey& key);

    const std::vector<TreeNode>& nodes() const { return nodes_; }
    const std::vector<Leaf>& leaves() const { return leaves_; }
    /// The leaf that contains a point.
    std::size_t find(ChartPoint at) const {
        std::uint32_t i = 0;
        for (std::uint32_t next; (next = cuts_[i].next(at)) != i; i = next) {}
        return cuts_[i].leaf;
    }
    /// The leaves of many points. Several paths are followed at once, so that the memory accesses of one do not wait
    /// for those of another.
    void find(std::span<const ChartPoint> at, std::span<std::uint32_t> leaves) const;
    const ChartRect& rect(const Leaf& leaf) const { return nodes_[static_cast<std::size_t>(leaf.node)].rect; }
    int depth() const { return depth_; }
    std::size_t rows() const { return rows_; }

private:
    /// A node as the search needs it. A leaf is its own child, and its cut is NaN.
    struct Cut {
        double cut;
        std::uint32_t child : 31, along_phi : 1;
        std::uint32_t leaf;
        std::uint32_t next(ChartPoint at) const { return child + ((along_phi ? at.phi : at.t) >= cut); }
    };
    std::vector<TreeNode> nodes_;
    std::vector<Leaf> leaves_;
    std::vector<Cut> cuts_;
    int depth_ = 0;
    std::size_t rows_ = 0;
    void number_leaves();
    void find_edges();
    bool at_edge(const Leaf& leaf) const;
    friend class TreeGrowth;
};

// ---- The plan.

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
