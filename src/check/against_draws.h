// Draws of two samplers on one tree, and a test whether they come from one distribution: E_A[h] = E_B[h] for every test
// function h of a tree that is grown from the pilot draws of both. The density is evaluated only to decide whether a
// draw below the surface is valid.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "check/constants.h"
#include "check/decide/check_at.h"
#include "check/estimate/observations.h"
#include "check/verdict.h"
#include "check/verdicts/statistics.h"

namespace crescent::check {

/// One of the two samplers at its w_o, with its own streams. `other` may have p where this sampler has none.
struct AgainstSide {
    const CheckCase& check_case;
    const SamplerAdapter& other;
    StreamKey key;
};

/// The tree, directions and delta parts that both samplers share.
struct CommonTree {
    Tree tree;
    double step = 0;  // of the less precise arithmetic, as an angle
    Vec3d middle{};
    double log_q = 0;                         // mean of ln q over the mass of the tree
    std::vector<Vec3d> delta_directions;      // of both samplers
    std::vector<DeltaPart> delta_a, delta_b;  // of the pilot draws
    std::vector<Vec3d> drawn;                 // some pilot directions of each sampler
};

/// Built from pilot draws of each sampler.
CommonTree common_tree(const AgainstSide& a, const AgainstSide& b, const CheckBudget& budget);

/// Quantities of a draw whose means are compared.
enum AgainstSum : int { log_density, mean_x, mean_y, mean_z, against_sums };

/// The draws of one sampler in one stage.
struct AgainstDraws {
    double independent = 0, scrambled = 0;
    std::vector<double> leaves;  // number of directions by leaf
    std::vector<double> kinds;   // number of draws: no sample, directions, each delta direction
    std::array<Sums, against_sums> sums;
    std::array<Replicates, against_sums> by_set{};
    std::vector<Replicates> node_by_set;
    std::vector<double> x;          // weights f L cos / p of the first draws; luminance
    bool has_weights = true;        // whether each of these draws has a weight
    double invalid = 0, first = 0;  // unusable draws
};

/// Adds draws up to a look, and weights of the first `of_f`.
void draw_on(const AgainstSide& side, const CommonTree& common, const Look& to, std::uint32_t of_f, AgainstDraws& d);

/// One test applied to both samplers.
struct AgainstAnswer {
    /// The compared quantity.
    enum Family { kinds, sums, sums_by_sets, nodes, nodes_by_sets, families } family;
    int member = 0;
    double difference = 0, sd = 0, floor = 0, p = 1;  // share of A less share of B, or difference of the means
};
std::string_view name_of(AgainstAnswer::Family family);
void test_against(const CommonTree& common, const AgainstDraws& a, const AgainstDraws& b,
    const std::function<void(const AgainstAnswer&)>& visit);

/// Sizes that the test detects with the stated power: a part of the distribution of one sampler that the other never
/// draws, at nine of ten places, and a distance between the mean directions.
struct AgainstSizes {
    std::optional<double> part, distance;
};
/// level: of each test.
AgainstSizes sizes_against(const CommonTree& common, const AgainstDraws& a, const AgainstDraws& b, double level);

// ---- f and variances of two samplers.

/// The inputs of a comparison at one w_o.
struct AgainstCase {
    const AgainstSide &a, &b;
    const CommonTree& common;
    const AgainstDraws &draws_a, &draws_b;
    const CheckAt &own_a, &own_b;  // checks of each sampler alone
    std::uint32_t of_f = 0;
    Levels levels;
    bool expect_same = false;
};

/// Tests whether f is the same at directions over the whole sphere and at draws of either sampler, and q times weight
/// of each delta part.
void compare_f(const AgainstCase& c, Verdict& v);
/// Var X_A / Var X_B if both estimate the same integral and neither sampler is wrong. of_f: result of compare_f().
void compare_variances(const AgainstCase& c, const Verdict& of_f, Verdict& v);

}  // namespace crescent::check
