// One pixel and its single samples, for figures that explain an estimate and for tests. Local frame of its surface
// point, n = +z. The samples are those of the films: the same random numbers, the same bits.
//
//   X = w f L cos / p    w is 1, except for samplers with two techniques
//
// L and f are luminances: L is Y of the light's radiance, and f is the share of it that is reflected, per sr, in light
// of that colour. Radiance in W/(sr m^2), f in 1/sr, angles in degrees.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/vec.h"
#include "render/shading_points.h"
#include "samplers/sampler.h"

namespace crescent {

/// One draw. X = 0 if the direction is below the horizon or nothing was drawn.
struct PixelSample {
    Vec2<float> u{};
    Vec3<float> wi{};
    float pdf = 0, f = 0, light = 0, cos = 0;
    float weight = 1;  // of multiple importance sampling
    float x = 0;
    int disk = -1;                    // index of the light that was met; -1: none
    bool meets_surroundings = false;  // light that varies was met: that of the sky, or of a triangle that emits
    int technique = 0;

    /// Returns whether it met more than the fill.
    bool meets_light() const { return disk >= 0 || meets_surroundings; }
};

/// A light as the surface point sees it.
struct PixelLight {
    std::string name;
    Vec3d towards{};            // unit, to its centre
    double angular_radius = 0;  // degrees, across the line of sight: atan(radius / distance)
    double light = 0;           // Y of its radiance
    std::vector<Vec3d> rim;     // unit directions to its outline, in order
    bool faces = false;         // whether its emitting side faces the surface
};

/// One pixel of a scene and each of its samples. Directions are unit vectors of the world; values in the units of
/// films. Immutable: any thread may call it.
class OpenPixel {
public:
    /// Throws Bug if pixel (i, j), counted from the bottom-left, sees nothing.
    OpenPixel(const Scene& scene, int i, int j);

    /// The pixel, counted from the bottom-left; the index of its shape in Scene::shapes(); the hit of its primary ray,
    /// with the material there; the unit direction to the camera.
    int i() const { return i_; }
    int j() const { return j_; }
    int shape() const { return static_cast<int>(shading_points_.shape[0]); }
    const Hit& hit() const { return hit_; }
    const Surface& surface() const { return surface_; }
    Vec3d wo() const { return wo_; }
    Vec3d mirror() const;  // R
    const std::vector<PixelLight>& lights() const { return lights_; }
    double fill() const { return fill_; }  // Y

    /// Returns the light that a direction meets before any body; -1: none, it sees the fill or light that varies.
    int disk_met(Vec3d wi) const;
    /// Returns whether a direction meets a light, an emitting triangle or the sky before any body.
    bool meets_light(Vec3d wi) const;
    /// Returns Y of the light from that direction.
    double light(Vec3d wi) const;
    /// Returns the BRDF in 1/sr for the light of a disk, or for the fill (-1); 0 below the horizon or the triangle.
    double f(Vec3d wi, int disk = -1) const;
    /// Returns a sampler's density in 1/sr at a direction; for a sampler with two techniques, that of the first.
    double pdf(std::string_view sampler, Vec3d wi) const;

    /// Returns the first n samples of a sampler in order; for one with two techniques, 2 n in pairs. `sampler`: a name
    /// of samplers/all.h.
    std::vector<PixelSample> samples(std::string_view sampler, std::uint64_t n, std::uint32_t seed) const;

private:
    ShadingPoint<float> aimed_from() const;  // points into local_
    int i_, j_;
    ShadingPoints shading_points_;
    Hit hit_;
    Surface surface_;
    Vec3d wo_{};
    std::vector<PixelLight> lights_;
    double fill_ = 0;
    std::vector<LocalDisk<float>> local_;
    std::vector<LocalLight<float>> others_;
};

/// Returns the mean of X over the first 1, 2, ... draws; a pair of two techniques is one draw.
std::vector<double> running_mean(const std::vector<PixelSample>& samples);

}  // namespace crescent
