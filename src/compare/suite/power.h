// How many renders a test of a mean needs to find a difference, from the variance of one render's mean.
#pragma once

#include <cstddef>
#include <optional>

namespace crescent::inline comparison {

/// What is known of the mean of a region before more renders are made.
struct RegionPower {
    double mean = 0;                        // of Y
    double variance_a = 0, variance_b = 0;  // of the mean of one render of each side; in pairs a: of a difference
    bool paired = false;
    double missed = 0;  // difference that rare events could hide, times the renders of a side
};

/// The difference that a test with `renders` renders of each side finds with a probability of 90 %.
double detectable_with(const RegionPower& power, std::size_t renders, double level);

/// The smallest number of renders of each side with which a relative difference `smallest` is found; nothing above
/// 100 000.
std::optional<std::size_t> renders_needed(const RegionPower& power, double smallest, double level);

}  // namespace crescent::inline comparison
