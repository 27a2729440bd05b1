// What distribution do my draws have? Moments, shares, spread, support and a map of the draws at each w_o, each number
// with its 95 % interval. Draws alone are looked at: neither p nor f is evaluated.
#pragma once

#include <array>
#include <optional>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/progress.h"
#include "check/sources/sampler_adapter.h"

namespace crescent::check {

/// A number with its 95 % interval.
struct Interval {
    double value = 0, low = 0, high = 0;
};

/// Of one technique at one w_o. Angles in radians, solid angles in sr.
struct Description {
    std::string arm, check_case;
    int technique = 0, techniques = 1;
    std::uint64_t draws = 0, invalid = 0;   // invalid: numbers that are no direction; left out of all that follows
    Interval above, below, delta, nothing;  // shares of the draws: directions on either side, delta parts, none
    std::uint64_t directions = 0;           // draws that all that follows is of
    std::array<Interval, 3> mean{};         // of x, y, z
    Interval length;                        // of the mean vector: 1 if all directions are one, 0 if they balance
    double theta = 0, phi = 0;              // of the mean direction
    double direction_error = 0;             // half angle of the cone that holds the mean direction
    std::array<Interval, 6> second{};       // means of xx, yy, zz, xy, xz, yz
    std::array<Interval, 3> within{};       // angle about the mean direction that holds 50, 90, 99 %
    Interval solid_angle;                   // of the densest cells that hold 95 %
    Interval effective;                     // 1 / integral of p^2, the solid angle of an even density as concentrated
    std::vector<double> theta_edges;        // of the map, radians; sectors are even from phi = 0 on
    int sectors = 0;
    std::vector<Interval> map;  // share of the draws by bin, rings first
};

/// Seed and number of draws at each w_o, fewer for programs, plugins and Python.
struct DescribeSettings {
    std::uint32_t seed = 1;
    std::uint32_t draws = 1u << 16, draws_of_limited = 1u << 14;
};

/// One for each technique of each case; baselines are left out.
std::vector<Description> describe(
    std::span<const CheckCase> check_cases, const DescribeSettings& settings, ProgressMonitor& monitor);

/// For a terminal of 80 columns.
std::string description_text(const Description& d);
nlohmann::ordered_json description_json(std::span<const Description> all);

}  // namespace crescent::check
