// --plan: how many renders of each side, with how many samples, a view needs, from the variance of the baseline only.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "compare/suite/suite.h"
#include "math/statistics.h"

namespace crescent {

/// Returns the difference that a repetition of the test finds with a probability of 90 % at this level, if the error of
/// a mean is known only from an estimate with `estimate_df` degrees of freedom. The estimate may be too small by
/// chance, and so may that of the repetition: the difference is larger than that of detectable() (by a fifth for 8
/// renders of each side), and infinite for too few degrees of freedom.
/// With `information`, of a test that holds at any time, see anytime.h.
double found_difference(const Welch& test, double estimate_df, double level, double information = 0);

/// The noise of the mean of a region, known before more renders exist.
struct RegionPower {
    double mean = 0;                        // of Y
    double variance_a = 0, variance_b = 0;  // of the mean of one render of each side; in pairs a: of a difference
    double estimate_df = 0;                 // degrees of freedom with which they are known
    bool paired = false;
    bool anytime = false;          // of a test that holds at any time
    double hidden_difference = 0;  // difference that rare events could hide, times the renders of a side
};

/// Returns the difference that a test with `renders` renders of each side finds with a probability of 90 %.
double detectable_with(const RegionPower& power, std::size_t renders, double level);

/// The smallest number of renders of each side with which a relative difference `smallest` is found; nothing above
/// 100 000.
std::optional<std::size_t> renders_needed(const RegionPower& power, double smallest, double level);

/// The samples of a render over those of a render of the baseline for which the plan states renders.
inline constexpr std::array<double, 3> plan_samples = {0.25, 1, 4};

/// The renders that a view needs to find its smallest difference, from the variance of its baseline.
struct ViewPlan {
    std::string name, region;  // the region that needs the most renders
    std::size_t renders = 0;   // of the baseline
    std::optional<double> spp;
    double smallest = 0, mean = 0;
    double deviation = 0;                                       // of the mean of one render
    std::array<std::optional<std::size_t>, 3> render_counts{};  // of each side, at plan_samples
    std::string why;                                            // why nothing can be stated; "" if it can
};

/// Returns the plan of each view, by name. Reads every baseline; throws InputError if a file cannot be compared.
std::vector<ViewPlan> plan_renders(const Suite& suite, ProgressMonitor& monitor);
/// Returns the plans as a table for the terminal.
std::string render_plan_text(const Suite& suite, const std::vector<ViewPlan>& plans);
/// Returns the plans as JSON.
std::string render_plan_json(const Suite& suite, const std::vector<ViewPlan>& plans);

}  // namespace crescent
