// What a user's sampler is tried on; cases.h has the same of the built-in arms.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "check/sources/sampler_adapter.h"

namespace crescent::inline sources {

/// w_o of one's own: theta and azimuth in degrees.
using Grid = std::vector<std::pair<double, double>>;

/// A user's sampler over the grid of w_o under an even light, with uniform and cosine beside it where it has a
/// BRDF.
/// A sampler whose draws and p are the same whatever w_o is, and that has no BRDF, as that of an environment light, is
/// judged once.
std::vector<CheckCase> make_user_cases(
    const std::shared_ptr<const SamplerAdapter>& adapter, bool full, const Grid& grid = {});
/// The same at one w_o.
CheckCase make_user_case(const std::shared_ptr<const SamplerAdapter>& adapter, double theta, double azimuth);

}  // namespace crescent::inline sources
