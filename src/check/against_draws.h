// Draws of two samplers on one tree, and whether they come from one distribution: E_A[h] = E_B[h] for every test
// function h of a tree that was grown from the pilot draws of both. No density is evaluated but where it says whether a
// draw below the surface is one.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "check/constants.h"
#include "check/decide/check_at.h"
#include "check/estimate/delta_parts.h"
#include "check/estimate/observations.h"
#include "check/verdict.h"
#include "check/verdicts/statistics.h"

namespace crescent::check {

/// One of the two samplers at its w_o, with streams of its own. `other` may know p where this one does not.
struct AgainstSide {
    const CheckCase& check_case;
    const SamplerAdapter& other;
    StreamKey key;
};

/// What both draw on.
struct CommonGround {
    Tree tree;
    double step = 0;  // of the coarser arithmetic, as an angle
    Vec3d middle{};
    double log_q = 0;                         // mean of ln q over the tree's mass
    std::vector<Vec3d> ways;                  // directions of delta parts
    std::vector<DeltaPart> delta_a, delta_b;  // of the pilot draws
    std::vector<Vec3d> drawn;                 // some of the pilot directions of each
};

/// What both samplers have in common, by pilot draws of each.
CommonGround common_ground(const AgainstSide& a, const AgainstSide& b, const CheckBudget& budget);

/// The quantities of a draw whose means are compared.
enum AgainstSum : int { log_density, mean_x, mean_y, mean_z, against_sums };

/// What one side draws in one stage.
struct AgainstDraws {
    double independent = 0, scrambled = 0;
    std::vector<double> leaves;  // directions, by leaf
    std::vector<double> kinds;   // nothing, directions, each of the ways
    std::array<Sums, against_sums> sums;
    std::array<Replicates, against_sums> by_set{};
    std::vector<Replicates> node_by_set;
    std::vector<double> x;          // weights f L cos / p of the first draws; luminance
    bool weighs = true;             // every one of them has a weight
    double invalid = 0, first = 0;  // draws that cannot be used
};

/// Adds draws up to a look; weights of the first `of_f`.
void draw_on(const AgainstSide& side, const CommonGround& ground, const Look& to, std::uint32_t of_f, AgainstDraws& d);

/// One question to both.
struct AgainstAnswer {
    /// What it compares.
    enum Family { kinds, sums, sums_by_sets, nodes, nodes_by_sets, families } family;
    int member = 0;
    double difference = 0, sd = 0, floor = 0, p = 1;  // share of A less that of B, or mean
};
std::string_view name_of(AgainstAnswer::Family family);
void test_against(const CommonGround& ground, const AgainstDraws& a, const AgainstDraws& b,
    const std::function<void(const AgainstAnswer&)>& visit);

/// What would have been found with the stated power: a part of the draws of one that the other never draws, wherever it
/// lies but for one place in ten, and a distance between the mean directions.
struct AgainstSizes {
    std::optional<double> part, distance;
};
/// level: of each question.
AgainstSizes sizes_against(const CommonGround& ground, const AgainstDraws& a, const AgainstDraws& b, double level);

// ---- f and variances of two samplers.

/// What a comparison at one w_o is made of.
struct AgainstCase {
    const AgainstSide &a, &b;
    const CommonGround& ground;
    const AgainstDraws &draws_a, &draws_b;
    const CheckAt &own_a, &own_b;  // of each by itself
    std::uint32_t of_f = 0;
    Levels levels;
    bool expect_same = false;
};

/// Whether f is the same at directions all over and where either draws, and q times weight of each delta part.
void compare_f(const AgainstCase& c, Verdict& v);
/// Var X_A / Var X_B, where they are of one integral and neither sampler is wrong itself. of_f: what compare_f found.
void compare_variances(const AgainstCase& c, const Verdict& of_f, Verdict& v);

}  // namespace crescent::check
