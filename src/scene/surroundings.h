// What is around the shading points of a scene, besides its bodies and its lights of one radiance: an image sky,
// and meshes, whose triangles hide and may emit. Positions relative to the scene's origin, lengths in m, radiance in
// W/(sr m^2). Kernels and samplers call these functions for one direction at a time; none is inline, because each
// kernel is compiled for its own instruction set and all of them share this code.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "base/vec.h"
#include "scene/mesh/rays.h"
#include "scene/sky.h"
#include "scene/triangle_lights.h"

namespace crescent {

struct Surroundings {
    std::optional<SkyTable> sky;
    std::optional<TriangleLights> triangles;  // those that emit
    Rays rays;
    Vec3f eye{};  // the camera
};

// ---- What a ray from x meets.

/// Of a ray towards a light: the meshes before it.
struct MeshesBefore {
    bool is_hidden = false;  // a triangle that does not emit towards x is met first, or there is no light behind
    std::uint32_t triangle = no_triangle;  // an emitting one that is met first
    float distance = 0;                    // to that
};
/// `light`: how far the nearest light of one radiance is, 1e30 if none is met. `aimed_triangle`: the emitting triangle
/// that the direction was drawn on, which it meets even if rounding moves it past the triangle; no_triangle: none.
MeshesBefore meshes_before(
    const Surroundings& surroundings, Vec3f x, Vec3f d, float light, std::uint32_t aimed_triangle);

/// Writes the radiance of the sky in direction d of the world, or in a texel if that is known; 0 without a sky.
void sky_radiance(const Surroundings& surroundings, std::uint32_t texel, Vec3f d, float* rgb);
/// Writes the radiance of a texel of the sky; 0 of no_texel.
void texel_radiance(const Surroundings& surroundings, std::uint32_t texel, float* rgb);
/// The texel of the sky in direction d of the world; no_texel without a sky.
std::uint32_t sky_texel(const Surroundings& surroundings, Vec3f d);
/// Writes the radiance of an emitting triangle.
void triangle_radiance(const Surroundings& surroundings, std::uint32_t triangle, float* rgb);
/// Returns whether there is a sky, and whether there are meshes.
bool has_sky(const Surroundings& surroundings);
bool has_meshes(const Surroundings& surroundings);

// ---- The samplers: a direction, and its density in 1/sr; 0 where there is nothing to aim at.

/// As many as `out` has room for.
void sample_sky(
    const Surroundings& surroundings, std::span<const double> u, std::span<const double> v, std::span<SkyDraw> out);
/// Of direction d, or of a texel if that is known.
double sky_pdf(const Surroundings& surroundings, std::uint32_t texel, Vec3d d);
/// `is_whole`: the density is that of all triangles that the direction meets, else that of the drawn one.
TriangleDraw sample_triangles(const Surroundings& surroundings, Vec3d x, double u, double v, bool is_whole);
double triangles_pdf(const Surroundings& surroundings, Vec3d x, Vec3d d);

}  // namespace crescent
