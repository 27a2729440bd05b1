// --plan: how many renders of each side, at how many samples, a view needs; from the variance of the baseline alone.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "compare/suite/suite.h"

namespace crescent::inline comparison {

/// Samples of a render over those of a render of the baseline, for which the plan states renders.
inline constexpr std::array<double, 3> plan_samples = {0.25, 1, 4};

/// How many renders a view needs to find its smallest difference, from the variance of its baseline.
struct ViewPlan {
    std::string name, region;  // the region that needs the most renders
    std::size_t renders = 0;   // of the baseline
    std::optional<double> spp;
    double smallest = 0, mean = 0;
    double deviation = 0;                                // of the mean of one render
    std::array<std::optional<std::size_t>, 3> needed{};  // of each side, at plan_samples
    std::string why;                                     // why nothing can be stated; "" if it can
};

/// Returns the plan of each view, by name. Reads every baseline; throws InputError if a file cannot be compared.
std::vector<ViewPlan> plan_renders(const Suite& suite, ProgressMonitor& monitor);
/// Returns the plans as a table for the terminal.
std::string render_plan_text(const Suite& suite, const std::vector<ViewPlan>& plans);
/// Returns the plans as JSON.
std::string render_plan_json(const Suite& suite, const std::vector<ViewPlan>& plans);

}  // namespace crescent::inline comparison
