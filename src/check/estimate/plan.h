// The choices made before any test: the tree of the sphere and its densities, the step of the sampler's arithmetic, and
// the constants of the test functions. Both stages use the same plan, so that stage 2 tests the hypothesis found by
// stage 1.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "check/constants.h"
#include "check/estimate/budget.h"
#include "samplers/domains/sphere_chart.h"
#include "check/estimate/source.h"
#include "check/estimate/stream.h"

namespace crescent::check {

// ---- The tree for one density: dyadic cuts of the chart where p varies, where the pilot draws disagree with it and
// where mass is. Each leaf has a density q_l, from which the test functions are made.

/// A point with p there.
struct DensityPoint {
    ChartPoint place;
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
    /// Whether p > 0 at a point or draw while the tree grew; otherwise q is that of half a draw in the pilot.
    bool has_mass = false;
    bool edge = false;        // it has mass, and a neighbour has a q that differs by more than `alike`
    double resolvable_p = 0;  // the largest p that its points resolve, see `heaviest_point`
};

class Tree {
public:
    /// `pilots`: the directions among `draws` pilot draws. `hints`: other points with p. step: of the sampler's
    /// arithmetic, as an angle.
    Tree(Source& source, std::vector<DensityPoint> pilots, std::uint32_t draws, std::vector<DensityPoint> hints,
        double step, const CheckBudget& budget, const StreamKey& key);

    const std::vector<TreeNode>& nodes() const { return nodes_; }
    const std::vector<Leaf>& leaves() const { return leaves_; }
    /// The leaf that contains a point.
    std::size_t find(ChartPoint point) const {
        std::uint32_t i = start_of(point);
        for (std::uint32_t next; (next = cuts_[i].next(point)) != i; i = next) {}
        return cuts_[i].leaf;
    }
    /// The leaves of many points. Several paths are followed at once, so that the memory accesses of one do not wait
    /// for those of another.
    void find(std::span<const ChartPoint> points, std::span<std::uint32_t> leaves) const;
    const ChartRect& rect(const Leaf& leaf) const { return nodes_[static_cast<std::size_t>(leaf.node)].rect; }
    /// The share of the points of an integral that each leaf gets: a part evenly, the rest by the spread of p, with
    /// more at edges.
    std::vector<double> shares_of_points() const;
    int depth() const { return depth_; }
    std::size_t rows() const { return rows_; }

private:
    /// A node as the search needs it. A leaf is its own child, and its cut is NaN.
    struct Cut {
        double cut;
        std::uint32_t child : 31, along_phi : 1;
        std::uint32_t leaf;
        std::uint32_t next(ChartPoint point) const { return child + ((along_phi ? point.phi : point.t) >= cut); }
    };
    std::vector<TreeNode> nodes_;
    std::vector<Leaf> leaves_;
    std::vector<Cut> cuts_;
    /// Shortens the search: a grid over the rectangle of a node has for each cell the deepest node that contains it, or
    /// the grid of that node if there are many leaves below it. Cuts are dyadic, so that the search ends in the same
    /// leaf.
    struct Grid {
        double t0, phi0, cells_per_t, cells_per_phi;
        std::uint32_t first;  // of its entries in `starts_`
    };
    static constexpr std::uint32_t cells = 32, is_grid = 1u << 31;
    std::vector<Grid> grids_;
    std::vector<std::uint32_t> starts_;  // a node, or is_grid and a grid
    int depth_ = 0;
    std::size_t rows_ = 0;
    /// The entry of a point in a grid.
    std::uint32_t start_in(std::uint32_t grid, ChartPoint point) const {
        const auto cell = [](double x) {
            return static_cast<std::uint32_t>(std::min(std::max(0.0, x), cells - 1.0));  // 0 for NaN
        };
        const Grid& g = grids_[grid];
        const std::uint32_t t = cell((point.t - g.t0) * g.cells_per_t),
                            phi = cell((point.phi - g.phi0) * g.cells_per_phi);
        return starts_[g.first + t * cells + phi];
    }
    std::uint32_t start_of(ChartPoint point) const {
        std::uint32_t start = start_in(0, point);
        while (start & is_grid) start = start_in(start & ~is_grid, point);
        return start;
    }
    friend class StartGrids;
    void number_leaves();
    void find_edges();
    void set_resolvable_p(double direction_share, double points);
    friend class TreeGrowth;
};

// ---- The plan.

/// The test functions h of whole sums, in the order of their integrals.
enum Integrand : int { mass, bridge, slope, centre_x, centre_y, centre_z, integrands };

/// Values of all h at one direction.
using Values = std::array<double, integrands>;

struct Plan {
    Tree tree;
    double step = 0;                      // of the sampler's arithmetic, as an angle; 0: none found
    double median_log_p = 0;              // over the pilot draws
    Vec3d middle{};                       // their mean direction
    std::array<double, 3> mean_weight{};  // their mean weight by channel
    Values per_step{};                    // change of h by a local step of the arithmetic, mean over pilot draws
    bool estimates = false;               // p is a random estimate, so h does not depend on it
    std::uint32_t direction_count = 0, draw_count = 0;  // pilot draws that are directions; all pilot draws

    /// h = q / (p + q), in [0, 1] (the bridge of Meng and Wong 1996), and h times the quantities of the other sums.
    Values values(const Leaf& leaf, Vec3d w, double p) const {
        const double density = estimates ? leaf.q : p;
        const double h = leaf.q / (density + leaf.q);
        return {1, h, density > 0 ? h * (log_of(density) - median_log_p) : 0, h * (w.x - middle.x),
            h * (w.y - middle.y), h * (w.z - middle.z)};
    }
    /// A bound of h: it is 1/2 if it does not depend on p.
    double largest_h() const { return estimates ? 0.5 : 1; }
    /// Whether the points of the leaf resolve p, see `heaviest_point`.
    bool resolves(const Leaf& leaf, double p) const { return estimates || !(p > leaf.resolvable_p); }
    /// Whether the sampler computes in single precision, as it declares or as the step of its directions shows: that of
    /// an angle is angle_per_step ulp, here to a factor of 4.
    bool in_single(const Source& source) const { return source.single() || step >= angle_per_step * ulp / 4; }
    /// ln p to 1e-9. A series of few terms suffices, because the tests hold for any function of p: with m in
    /// [0.71, 1.42) and s = (m - 1) / (m + 1), ln m = 2 (s + s^3 / 3 + s^5 / 5 + ...).
    static double log_of(double p) {
        constexpr double ln2 = 0.6931471805599453;
        constexpr std::uint64_t of_mantissa = (std::uint64_t{1} << 52) - 1;
        const auto bits = std::bit_cast<std::uint64_t>(p);
        constexpr std::uint64_t root_half = 0x3fe6a09e667f3bcdu;  // bits of sqrt(1/2), from which m begins
        const std::uint64_t offset = bits - root_half;
        const auto exponent = static_cast<double>(static_cast<std::int64_t>(offset) >> 52);
        const double m = std::bit_cast<double>((offset & of_mantissa) + root_half), s = (m - 1) / (m + 1), s2 = s * s;
        return exponent * ln2 + 2 * s * (1 + s2 * (1.0 / 3 + s2 * (1.0 / 5 + s2 * (1.0 / 7 + s2 * (1.0 / 9)))));
    }
};

/// Makes the pilot draws and builds the tree.
Plan make_plan(Source& source, const CheckBudget& budget, StreamKey key, std::vector<DensityPoint> hints = {});

/// The step of the lattice that contains n values; 0 if there is none. With few equal pairs: (equal pairs) / (pairs
/// within g) = step / (2 g). With many: the median gap between distinct values.
double step_of(std::vector<double> values);
/// The step of the arithmetic that produced these directions, as an angle.
double step_of_directions(std::span<const Vec3d> directions);

}  // namespace crescent::check
