// The distribution of the draws: moments, shares, spread, support and a map of the draws at each w_o, each number with
// its 95 % interval. Only the draws are used: neither p nor f is evaluated.
#pragma once

#include <array>
#include <optional>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/progress.h"
#include "check/sources/check_case.h"

namespace crescent::check {

/// A number with its 95 % interval.
struct Interval {
    double value = 0, low = 0, high = 0;
};

/// The description for one technique at one w_o. Angles in radians, solid angles in sr.
struct Description {
    std::string arm, check_case;
    int technique = 0, techniques = 1;
    std::uint64_t draws = 0, invalid = 0;  // invalid: draws with unusable numbers, excluded from all that follows
    /// Of the draws: directions on either side, delta parts, no sample.
    Interval above_share, below_share, delta_share, empty_share;
    std::uint64_t directions = 0;              // number of draws in all that follows
    std::array<Interval, 3> mean{};            // of x, y, z
    Interval length;                           // of the mean vector: 1 if all directions are equal, 0 if they cancel
    double theta = 0, phi = 0;                 // of the mean direction
    double direction_error = 0;                // half angle of the cone that contains the mean direction
    std::array<Interval, 6> second_moments{};  // means of xx, yy, zz, xy, xz, yz
    std::array<Interval, 3> angles{};          // angle about the mean direction that contains 50, 90, 99 %
    Interval solid_angle;                      // of the densest cells that contain 95 %
    Interval effective_solid_angle;   // 1 / integral of p^2: solid angle of a uniform density with the same integral
    std::vector<double> theta_edges;  // of the map, radians; sectors are uniform from phi = 0 on
    int sectors = 0;
    std::vector<Interval> map;  // share of the draws by bin, rings first
};

/// Seed and number of draws at each w_o; programs, plugins and Python use fewer.
struct DescribeSettings {
    std::uint32_t seed = 1;
    std::uint32_t draws = 1u << 16, limited_draws = 1u << 14;
};

/// One description for each technique of each case, without baselines.
std::vector<Description> describe(
    std::span<const CheckCase> check_cases, const DescribeSettings& settings, ProgressMonitor& monitor);

/// Text for a terminal of 80 columns.
std::string description_text(const Description& d);
nlohmann::ordered_json description_json(std::span<const Description> descriptions);

}  // namespace crescent::check
