// The cases of a user's sampler; cases.h has those of the built-in arms.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "check/sources/sampler_adapter.h"

namespace crescent::inline sources {

/// User-defined w_o: theta and azimuth in degrees.
using Grid = std::vector<std::pair<double, double>>;

/// A user's sampler over the grid of w_o under a uniform light, with uniform and cosine as baselines if it has a BRDF.
/// A sampler without BRDF whose draws and p do not depend on w_o, such as that of an environment light, is checked
/// once.
std::vector<CheckCase> make_user_cases(
    const std::shared_ptr<const SamplerAdapter>& adapter, bool full, const Grid& grid = {});
/// The same at one w_o.
CheckCase make_user_case(const std::shared_ptr<const SamplerAdapter>& adapter, double theta, double azimuth);

}  // namespace crescent::inline sources
