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

struct ViewPlan {
    std::string name, region;  // the region that needs the most renders
    std::size_t renders = 0;   // of the baseline
    std::optional<double> spp;
    double smallest = 0, mean = 0;
    double deviation = 0;                                // of the mean of one render
    std::array<std::optional<std::size_t>, 3> needed{};  // of each side, at plan_samples
    std::string why;                                     // why nothing can be stated; "" if it can
};

std::vector<ViewPlan> plan_renders(const Suite& suite, ProgressMonitor& monitor);
std::string render_plan_text(const Suite& suite, const std::vector<ViewPlan>& plans);
std::string render_plan_json(const Suite& suite, const std::vector<ViewPlan>& plans);

}  // namespace crescent::inline comparison
