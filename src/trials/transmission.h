// What lies under the surface.
#pragma once

#include <vector>

#include "trials/draws.h"

namespace crescent::inline trials {

/// What light from direction b, under the surface, gives to all directions above: int f(a, b) cos a da. See
/// transmission.cpp.
Integral from_below(const Draws& work, Vec3d b);
/// Up to three directions under the surface that the sampler draws, the one of the highest pdf first.
std::vector<Vec3d> drawn_below(const Draws& work);

}  // namespace crescent::inline trials
