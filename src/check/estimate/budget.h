// How much is evaluated at one w_o. None of this changes what a verdict means, only what it can see.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

namespace crescent::check {

/// Sets of scrambled Sobol points. 32: a t-test at 1e-8 needs t = 7.7, and sets of 8192 points still gain.
inline constexpr int replicate_sets = 32;

/// What is evaluated up to one look: points of the integrals, independent draws, draws of the scrambled Sobol sets in
/// all.
struct Look {
    std::uint32_t points = 0, independent = 0, scrambled = 0;

    /// A point costs one evaluation of p, an independent draw is followed by one, a scrambled draw stands alone.
    double cost() const { return points + 2.0 * independent + scrambled; }
    Look times(std::uint32_t n) const { return {points * n, independent * n, scrambled * n}; }
    Look divided_by(std::uint32_t n) const { return {points / n, independent / n, scrambled / n}; }
};

/// So many evaluations of scrambled draws at most. Sobol sets have a power of two points each: a third more in a set
/// would raise its variance.
inline std::uint32_t scrambled_of(double evaluations) {
    return replicate_sets * std::bit_floor(static_cast<std::uint32_t>(std::max(evaluations, 0.0) / replicate_sets));
}

/// The look that costs no more than so many evaluations: scrambled draws get 0.36 to 0.18 of them, points and
/// independent draws share the rest evenly.
inline Look look_of(double evaluations) {
    const double most = std::max(evaluations, 0.0);
    Look out;
    out.scrambled = scrambled_of(0.36 * most);
    out.independent = static_cast<std::uint32_t>((most - out.scrambled) / 4);
    out.points = static_cast<std::uint32_t>(most - out.scrambled - 2.0 * out.independent);
    return out;
}

/// At a w_o where nothing is suspected at most `evaluations` are made, small tests included. A confirmation costs about
/// as many again. Its parts are fixed shares of it, at 1.2 M: 2^14 pilot draws (a leaf of mass 2e-4 has three of
/// them), 4096 leaves, 2^16 draws whose weights are looked at.
struct CheckBudget {
    double evaluations = 1.2e6;
    int looks = 2;  // each eight times the one before
    /// Stop, too, at the first look at which every target is met within what leaves a verdict open (inconclusive_at).
    bool stop_when_conclusive = false;

    /// A look where draws and points are all that is evaluated.
    Look look(int i) const { return look_of(0.75 * evaluations).divided_by(1u << 3 * (looks - 1 - i)); }
    /// Pilot draws shape the tree alone.
    std::uint32_t pilot() const { return part(73); }
    /// Of them, those at which the steps of the arithmetic are measured, by 1 to 18 draws for each number.
    std::uint32_t of_steps() const { return part(1172); }
    /// At least so many; more until the integrals are known to a quarter of the detection floor. A leaf costs 8.
    int leaves() const { return static_cast<int>(part(293)); }
    int most_leaves() const { return static_cast<int>(part(72)); }
    /// Points of the integrals, about.
    std::uint32_t points() const { return part(4.8); }
    /// Draws at which f is evaluated.
    std::uint32_t of_f() const { return part(18.3); }
    /// Draws that are moved for the sizes that are stated, and what they cost. With half as many, what a rotation of a
    /// lobe on both sides changes is not known to a third.
    std::uint32_t of_sizes() const { return std::max(part(335), 1024u); }
    double cost_of_sizes() const { return 8.0 * of_sizes(); }

    /// In process.
    static CheckBudget quick() { return {}; }
    /// Through pipes and Python.
    static CheckBudget limited(double evaluations = 4e5) { return {evaluations}; }
    static CheckBudget thorough() { return {6.4e6, 3}; }

private:
    std::uint32_t part(double of) const { return static_cast<std::uint32_t>(evaluations / of); }
};

/// Points at which lost light is measured, in the leaves where p was 0 at one: about so many, two a leaf at least.
inline constexpr double points_of_lost = 2048;
/// Draws and points of one batch: what is in memory at a time, and what a pipe is filled with.
inline constexpr std::uint32_t batch_size = 4096;
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
/// The tree is grown a second time, from what points and draws have met, where so many points know the integral of p
/// worse than this. Of fewer points, which err as 1 / n, less is asked: a second tree costs 0.4 of a small budget.
inline constexpr double regrow_from = 2e-3, regrow_points = 0x1p15;
/// p may vary by this factor within a leaf and count as alike: the pairs of points cover the rest.
inline constexpr double alike = 2;

}  // namespace crescent::check
