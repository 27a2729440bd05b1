// What is around the shading points of a scene beside its bodies and its lights of one radiance: an image sky. Single
// precision, positions relative to the scene's origin, lengths in m.
#pragma once

#include <cstdint>
#include <optional>

#include "base/vec.h"
#include "scene/sky.h"

namespace crescent::inline scene {

struct Surroundings {
    std::optional<SkyMap> sky;
    Vec3f eye{};  // the camera
};

// ---- The functions that kernels and samplers call for one direction at a time.

/// Writes the radiance of the sky in direction d of the world, or in a texel if that is known; 0 without a sky.
void sky_radiance(const Surroundings& around, std::uint32_t texel, Vec3f d, float* rgb);

/// The density of the sky's sampler at direction d of the world, 1/sr.
double sky_pdf(const Surroundings& around, Vec3d d);

/// Draws a direction of the sky; pdf 0 without a sky.
SkyDraw sample_sky(const Surroundings& around, double u, double v);

}  // namespace crescent::inline scene
