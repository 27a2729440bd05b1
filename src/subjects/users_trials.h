// What a user's sampler is tried on; list.h has the same of the built-in arms.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "subjects/subject.h"

namespace crescent::inline subjects {

/// w_o of one's own: theta and azimuth in degrees.
using Grid = std::vector<std::pair<double, double>>;

/// A user's sampler over the grid of w_o under an even light, with uniform and cosine beside it where it has a
/// BRDF.
/// A sampler whose draws and p are the same whatever w_o is, and that has no BRDF, as that of an environment light, is
/// judged once.
std::vector<Trial> trials_of_subject(
    const std::shared_ptr<const JudgedSampler>& subject, bool full, const Grid& grid = {});
/// The same at one w_o.
Trial trial_of_subject(const std::shared_ptr<const JudgedSampler>& subject, double theta, double azimuth);

}  // namespace crescent::inline subjects
