// The lights of a scene as samplers from outside receive them.
#pragma once

#include <vector>

#include "render/shading_points.h"
#include "samplers/external_sampler.h"

namespace crescent::inline render {

/// Every light, in the scene's order; empty where there is none or no point.
std::vector<ExternalLight> lights_of(const ShadingPoints& shading_points);

/// Appends each of these lights as shading point `at` sees it.
void add_lights_at(const ShadingPoints& shading_points, std::size_t at, std::vector<ExternalLightAt>& to);

}  // namespace crescent::inline render
