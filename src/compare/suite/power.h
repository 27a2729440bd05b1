// How large a difference of means a test finds with a probability of 90 %, and how many renders it needs.
#pragma once

#include <cstddef>
#include <optional>

#include "math/hypotheses.h"

namespace crescent::inline comparison {

/// The difference that a repetition of the test finds with a probability of 90 % at this level, if the error of a mean
/// is known from an estimate with `estimate_df` degrees of freedom alone. The estimate may be too small by chance, and
/// so may that of the repetition: the difference is larger than detectable() has it (by a fifth for 8 renders of each
/// side), and infinite for too few degrees of freedom.
double found_difference(const Welch& test, double estimate_df, double level);

/// What is known of the mean of a region before more renders are made.
struct RegionPower {
    double mean = 0;                        // of Y
    double variance_a = 0, variance_b = 0;  // of the mean of one render of each side; in pairs a: of a difference
    double estimate_df = 0;                 // degrees of freedom with which they are known
    bool paired = false;
    double missed = 0;  // difference that rare events could hide, times the renders of a side
};

/// The difference that a test with `renders` renders of each side finds with a probability of 90 %.
double detectable_with(const RegionPower& power, std::size_t renders, double level);

/// The smallest number of renders of each side with which a relative difference `smallest` is found; nothing above
/// 100 000.
std::optional<std::size_t> renders_needed(const RegionPower& power, double smallest, double level);

}  // namespace crescent::inline comparison
