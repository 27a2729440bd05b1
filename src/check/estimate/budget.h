// How much is evaluated at one w_o. None of this changes what a verdict means, only what it can see.
#pragma once

#include <array>
#include <cstdint>

namespace crescent::check {

/// What is evaluated up to one look: points of the integrals, independent draws, draws of the scrambled Sobol sets in
/// all.
struct Look {
    std::uint32_t points = 0, independent = 0, scrambled = 0;
};

/// Numbers of draws and points, cumulative over the looks of a staged budget.
struct CheckBudget {
    /// Pilot draws shape the tree alone. 2^14: a leaf of mass 2e-4 has three of them.
    std::uint32_t pilot = 1u << 14;
    std::array<Look, 3> looks = {Look{1u << 15, 1u << 15, 1u << 15}, Look{1u << 18, 1u << 17, 1u << 18}, Look{}};
    int look_count = 2;
    /// Of the second stage, where a look has less.
    Look again = {1u << 16, 1u << 16, 1u << 16};
    /// Leaves: at least so many; more until the integrals are known to a quarter of the detection floor.
    int leaves = 4096, most_leaves = 32768;
    /// Points and draws at which f is evaluated.
    std::uint32_t of_f = 1u << 16;
    /// Stop at the first look at which every target is met, too.
    bool stop_when_targets_met = false;

    Look last() const { return looks[static_cast<std::size_t>(look_count) - 1]; }

    /// In process: at most 1.5 M evaluations.
    static CheckBudget quick() { return {}; }
    /// Through pipes and Python: at most so many evaluations a w_o.
    static CheckBudget limited(std::size_t /*evaluations*/ = 500000) {
        CheckBudget b;
        b.pilot = 1u << 13;
        b.looks = {Look{1u << 14, 1u << 13, 1u << 14}, Look{1u << 16, 1u << 15, 1u << 16}, Look{}};
        b.again = {1u << 15, 1u << 15, 1u << 15};
        b.leaves = 2048;
        b.most_leaves = 8192;
        b.of_f = 1u << 14;
        return b;
    }
    static CheckBudget thorough() {
        CheckBudget b;
        b.pilot = 1u << 16;
        b.looks = {
            Look{1u << 16, 1u << 16, 1u << 16}, Look{1u << 18, 1u << 18, 1u << 18}, Look{1u << 20, 1u << 20, 1u << 20}};
        b.look_count = 3;
        b.leaves = 8192;
        b.most_leaves = 65536;
        b.of_f = 1u << 18;
        return b;
    }
};

/// Draws and points of one batch: what is in memory at a time, and what a pipe is filled with.
inline constexpr std::uint32_t batch_size = 4096;
/// Sets of scrambled Sobol points. 32: a t-test at 1e-8 needs t = 7.7, and sets of 8192 points still gain.
inline constexpr int replicate_sets = 32;
/// Nodes above this depth are tested with replicates; below they have too few draws in each. Storage: 2^11 nodes.
inline constexpr int replicated_depth = 10;
/// All nodes of the tree down to this depth always exist.
inline constexpr int even_depth = 8;
/// Points at which p is evaluated to decide on a leaf's cut.
inline constexpr int points_per_leaf = 8;
/// What an empty and flat leaf is worth, so that it gets points too: of its mass in the tree's score, of its score in
/// the share of points.
inline constexpr double worth_of_mass = 0.02, worth_of_score = 0.01;
/// Share of the integrals' points that is spread evenly over the leaves.
inline constexpr double even_points = 0.2;
/// How much the wider side of a leaf is preferred for its cut.
inline constexpr double wider_side = 1.5;
/// A point that holds this much mass is where the tree has missed something: a usual one holds 1 / 2^15.
inline constexpr double heavy_point = 1e-3;
/// The tree is grown a second time, from what points and draws have met, where the integral of p is known worse than
/// this.
inline constexpr double regrow_from = 2e-3;
/// p may vary by this factor within a leaf and count as alike: the pairs of points cover the rest.
inline constexpr double alike = 2;

}  // namespace crescent::check
