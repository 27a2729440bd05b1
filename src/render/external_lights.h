// What samplers from outside receive of shading points, and which of their draws are usable.
#pragma once

#include <vector>

#include "render/shading_points.h"
#include "samplers/external_sampler.h"

namespace crescent::inline render {

/// Every light, in the scene's order; empty where there is none or no point.
std::vector<ExternalLight> lights_of(const ShadingPoints& shading_points);

/// Appends each of these lights as shading point `at` sees it.
void add_lights_at(const ShadingPoints& shading_points, std::size_t at, std::vector<ExternalLightAt>& to);

/// Rows at shading point `at`.
ExternalRun run_at(const ShadingPoints& shading_points, std::size_t at, Vec3<double> wo, std::size_t rows);

/// A draw is usable if its direction is of unit length to 1e-4 and its pdf is above 0 and finite also in single
/// precision, in which the estimate is computed. pdf 0, which means that nothing was drawn, is for the caller.
bool is_usable(const Vec3<double>& wi, double pdf);

}  // namespace crescent::inline render
