// Tests at one w_o other than the identity E[h(w)] = integral of h p: numbers at the corners of u, repeated u, p
// against the derivatives of sample(u). Only the test points are random.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "check/verdicts/questions.h"

namespace crescent::check {

/// A description of the fault of a draw; none if it is usable.
std::optional<const char*> fault_of(const Draw& d, const Traits& traits);

/// A small test that failed.
struct SmallFault {
    Family family = Family::corners;
    double times = 0, trials = 0;  // number of failures, number of tests
    double size = 0;               // relative, if it has one
    Example first{};
    const char* what = "";      // begins a sentence
    std::optional<Vec3d> wo{};  // of the first, if it is not a w_o of the call
    std::string place{};        // of the first in a file
};

/// All rows of a file of draws, independent of the test that uses them.
std::optional<SmallFault> rows_of_file(const Source& source);
/// u at 0, next to 0, at quarters and next to 1, in every two numbers and in every corner: samplers divide by 0 there.
std::optional<SmallFault> corners_of_u(Source& source);
/// The same u in another order, in other batches and alone.
std::optional<SmallFault> same_u_again(Source& source, const StreamKey& key);
/// pdf(w) and f(w) of the same directions in blocks of other sizes: a program may mix up the rows of a block.
std::optional<SmallFault> same_answers_again(Source& source, const StreamKey& key);
/// The values of the number that chooses a branch which lead to the same direction as a draw, its other numbers
/// unchanged: disjoint intervals, of which short ones may be missing.
struct Branch {
    int number = -1;  // index of that number; -1: none chooses
    std::vector<std::pair<double, double>> intervals;
    double length() const {
        double sum = 0;
        for (const auto& [from, to] : intervals) sum += to - from;
        return sum;
    }
};
/// The density of the map at a few points where its derivatives are known to `jacobian_error`, and p there, both in
/// 1/sr. Other u may map to the same direction, so `density` is a part of the density there.
struct MapDensity {
    PrimarySample u;
    Draw draw;
    double p = 0, density = 0, error = 0;  // error: relative error of `density`
    Branch branch{};
};
std::vector<MapDensity> map_densities(Source& source, const StreamKey& key);
/// Tests that p |dw/du| of the branch of a draw is at least the probability of that branch.
std::optional<SmallFault> jacobian(Source& source, const StreamKey& key);
/// Random numbers of which few bits are used: a draw moves with large changes of u, and does not move with its last
/// bits.
std::optional<SmallFault> few_bits(Source& source, const StreamKey& key);
/// Draws on a curve, which no density draws: at nearly all u no two random numbers move the draw apart, as if one
/// number is used twice (decide/curve.cpp).
std::optional<SmallFault> draws_on_curve(Source& source, const StreamKey& key);
/// Random numbers that change no draw.
std::vector<int> numbers_without_effect(Source& source, const StreamKey& key);

/// The share of the draws that a step of 2^-24 of one of their numbers moves to another place, and what that changes in
/// the whole sums. All 0 for a sampler that asks for finer numbers.
struct ResolutionEffect {
    double share = 0;
    Values sums{};
};
ResolutionEffect resolution_effect(Source& source, const Plan& plan, StreamKey key);
/// Whether the resolution may cause a deviation of the density, of so many draws.
bool explains(const ResolutionEffect& effect, const Answer& answer, double draws);

/// All of them.
std::vector<SmallFault> small_tests(Source& source, const StreamKey& key);

// ---- Directions of delta parts: a smooth boundary reflects, and refracts by the stated index (Snell); a thin wall
// transmits straight; the reverse path returns to w_o with the same power (Helmholtz).

/// Compares the directions with the stated index, if there is one.
std::optional<SmallFault> refraction(const Source& source, const std::vector<DeltaPart>& parts, const StreamKey& key);
/// Tests that draws at w_i of a part return to w_o with the power that reciprocity requires.
std::optional<SmallFault> reverse_path(const Source& source, const std::vector<DeltaPart>& parts, const StreamKey& key);

}  // namespace crescent::check
