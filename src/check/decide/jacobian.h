// p against the derivatives of sample(u): the density of the sampling map at a few points, without noise.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "check/decide/small_tests.h"
#include "check/estimate/source.h"

namespace crescent::check {

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

}  // namespace crescent::check
