// A tree of the sphere for one density, built before any test: dyadic cuts of the chart where p varies, where the pilot
// draws disagree with it and where mass is. Each leaf has a density q_l, from which the test functions are made.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "check/estimate/budget.h"
#include "check/estimate/chart.h"
#include "check/estimate/source.h"
#include "check/estimate/stream.h"

namespace crescent::check {

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

}  // namespace crescent::check
