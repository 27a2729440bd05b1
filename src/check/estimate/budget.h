// The number of evaluations at one w_o. These numbers change only the detectable size of a fault, not the meaning of a
// verdict.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

namespace crescent::check {

/// Sets of scrambled Sobol points. 32: a t-test at 1e-8 needs t = 7.7, and sets of 8192 points still gain.
inline constexpr int replicate_sets = 32;

/// The evaluations up to one look: points of the integrals, independent draws, and draws of all scrambled Sobol sets.
struct Look {
    std::uint32_t points = 0, independent = 0, scrambled = 0;

    /// A point costs one evaluation of p, an independent draw is followed by one, a scrambled draw needs none.
    double cost() const { return points + 2.0 * independent + scrambled; }
    Look times(std::uint32_t n) const { return {points * n, independent * n, scrambled * n}; }
    Look divided_by(std::uint32_t n) const { return {points / n, independent / n, scrambled / n}; }
};

/// The largest number of scrambled draws within a number of evaluations. Each Sobol set has a power of two points: a
/// third more points in a set would raise its variance.
inline std::uint32_t scrambled_of(double evaluations) {
    return replicate_sets * std::bit_floor(static_cast<std::uint32_t>(std::max(evaluations, 0.0) / replicate_sets));
}

/// The largest look within a number of evaluations: 0.36 to 0.18 of them are scrambled draws; points and independent
/// draws share the rest equally.
inline Look look_of(double evaluations) {
    const double available = std::max(evaluations, 0.0);
    Look out;
    out.scrambled = scrambled_of(0.36 * available);
    out.independent = static_cast<std::uint32_t>((available - out.scrambled) / 4);
    out.points = static_cast<std::uint32_t>(available - out.scrambled - 2.0 * out.independent);
    return out;
}

/// At a w_o without a suspected fault there are at most `evaluations`, including the small tests. A confirmation costs
/// about as many again. The parts are fixed shares, at 1.2 M: 2^14 pilot draws (three of them in a leaf of mass 2e-4),
/// 4096 leaves, 2^16 draws whose weights are used.
struct CheckBudget {
    double evaluations = 1.2e6;
    int looks = 2;  // each eight times the one before
    /// Whether to stop also at the first look at which every target is met within the limit of an inconclusive verdict
    /// (inconclusive_at).
    bool stop_when_conclusive = false;
    /// Up to so many evaluations a check goes on after its looks, as long as a size is too large (`further_looks`).
    double most_evaluations = 0;

    /// A look whose only evaluations are draws and points.
    Look look(int i) const { return look_of(0.75 * evaluations).divided_by(1u << 3 * (looks - 1 - i)); }
    /// Pilot draws, used only to shape the tree.
    std::uint32_t pilot() const { return part(73); }
    /// Pilot draws at which the step of the arithmetic is measured, with 1 to 18 draws for each number.
    std::uint32_t step_draws() const { return part(1172); }
    /// Least number of leaves; more are made until the integrals are known to a quarter of the detection floor. A leaf
    /// costs 8 evaluations.
    int leaves() const { return static_cast<int>(part(293)); }
    int most_leaves() const { return static_cast<int>(part(72)); }
    /// Approximate number of points of the integrals.
    std::uint32_t points() const { return part(4.8); }
    /// Draws at which f is evaluated.
    std::uint32_t f_draws() const { return part(18.3); }
    /// Draws that are rotated to compute the stated sizes. With half as many, the effect of a rotation of a lobe on
    /// both sides has an error of more than a third.
    std::uint32_t size_draws() const { return std::max(part(335), 1024u); }
    double cost_of_sizes() const { return 8.0 * size_draws(); }

    /// For samplers in process.
    static CheckBudget quick() { return {}; }
    /// For samplers behind pipes and in Python.
    static CheckBudget limited(double evaluations = 4e5) { return {evaluations}; }
    static CheckBudget thorough() { return {6.4e6, 3}; }

private:
    std::uint32_t part(double divisor) const { return static_cast<std::uint32_t>(evaluations / divisor); }
};

/// Approximate number of points at which lost light is measured, in the leaves with a point where p was 0; at least two
/// for each leaf.
inline constexpr double points_of_lost = 2048;
/// Draws and points in one batch: held in memory at a time, and sent to a pipe without waiting; of a sampler whose
/// query costs much by itself.
inline constexpr std::uint32_t batch_size = 4096, large_batch_size = 1u << 15;
/// Nodes above this depth are tested with replicates; deeper ones have too few draws in each. Memory: 2^11 nodes.
inline constexpr int replicated_depth = 10;
/// All nodes of the tree down to this depth always exist.
inline constexpr int even_depth = 8;
/// Points of a leaf at which p is evaluated to decide whether to cut it.
inline constexpr int points_per_leaf = 8;
/// Weight of an empty and flat leaf, so that it gets points too: a share of its mass in the score of the tree, and a
/// share of its score in the number of points.
inline constexpr double worth_of_mass = 0.02, worth_of_score = 0.01;
/// Share of the points of the integrals that is spread evenly over the leaves.
inline constexpr double even_points = 0.2;
/// Preference for a cut across the wider side of a leaf.
inline constexpr double wider_side = 1.5;
/// A point with this much mass indicates that the tree missed something: a typical point has 1 / 2^15.
inline constexpr double heavy_point = 1e-3;
/// The points of a leaf resolve p where one of them has at most this share of all p, or where p is at most so many
/// times its mean in the leaf. Beyond, p may have a pole, such as p ~ d^(-1/2) at the rim of a sphere sampled by area:
/// p^2 has no finite integral there, so points alone have no finite variance.
inline constexpr double heaviest_point = 0x1p-9, far_above = 16;
/// The tree is built a second time, from all points and draws so far, if the relative error of the integral of p with
/// `regrow_points` points is above `regrow_from`. With fewer points, whose error decreases as 1 / n, the limit is
/// higher: a second tree costs 0.4 of a small budget.
inline constexpr double regrow_from = 2e-3, regrow_points = 0x1p15;
/// Values of p within this factor count as alike within a leaf: the pairs of points cover the remaining variation.
inline constexpr double alike = 2;

}  // namespace crescent::check
