// Surface points in a white furnace: L_i = 1 over the whole hemisphere, no disk, the viewer straight above unless told
// otherwise.
#pragma once

#include "estimator/shading_points.h"

namespace crescent::inline studies {

/// The material of a shape, with the scene's own s where it has none; lobe_only drops rho_d.
Surface furnace_surface(const SceneData& scene, const Shape& shape, bool lobe_only);

/// `count` alike sites, each with random numbers of its own. X = (cos/p) f.
ShadingPoints furnace_sites(const Surface& surface, std::size_t count, double cos_o = 1);

}  // namespace crescent::inline studies
