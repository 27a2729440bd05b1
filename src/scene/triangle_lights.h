// Emitting triangles as lights: one is chosen by its power, Y(L) times its area, and a point is uniform over it. Double
// precision; positions relative to the scene's origin, lengths in m, radiance in W/(sr m^2).
//
//   p_A = Y(L_k) / sum of Y(L) A over all triangles,  p = p_A r^2 / cos(light),
//
// summed over all triangles that a direction meets, since each of them could have been chosen. Only the front emits:
// the side from which the corners are counterclockwise.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "base/vec.h"
#include "scene/mesh/bvh.h"

namespace crescent {

struct BvhTree;

struct EmittingTriangle {
    std::array<Vec3d, 3> corner;
    Rgb radiance{};
    std::uint32_t instance = 0, triangle = 0;  // as in MeshHit
};

inline constexpr std::uint32_t no_triangle = 0xffffffff;

/// A direction from a point to a triangle, and the density in 1/sr with which it is drawn from there; 0 if the
/// triangle's front does not face the point.
struct TriangleDraw {
    Vec3d w;
    std::uint32_t triangle;
    double pdf;
};

/// Immutable.
class TriangleLights {
public:
    /// In ascending order of instance and triangle.
    explicit TriangleLights(std::vector<EmittingTriangle> triangles);

    const std::vector<EmittingTriangle>& triangles() const { return triangles_; }
    /// Draws a direction from x; u and v in [0, 1). `is_whole`: with the density of all triangles that it meets, else
    /// with that of the drawn one.
    TriangleDraw sample(Vec3d x, double u, double v, bool is_whole = true) const;
    /// The density with which w, of unit length, is drawn from x, except by triangle `but`; 1/sr.
    double pdf(Vec3d x, Vec3d w, std::uint32_t but = no_triangle) const;
    /// Whether w may meet a triangle that is off by at most `error`, m. False only if it meets none.
    bool may_meet(Vec3f x, Vec3f w, float error) const;
    /// The nearest front that w meets; no_triangle: none.
    std::uint32_t nearest(Vec3d x, Vec3d w) const;
    /// How far the plane of a triangle is from x along w, m.
    double distance(std::uint32_t triangle, Vec3d x, Vec3d w) const;
    /// Returns the index of a triangle of an instance whose front d meets; no_triangle: it does not emit there.
    std::uint32_t find(std::uint32_t instance, std::uint32_t triangle, Vec3d d) const;

private:
    /// As it is met and drawn.
    struct Side {
        Vec3d corner, e1, e2, normal;  // normal = e1 x e2, towards the front, twice the area long
    };
    /// Calls work(index, distance) for every front that w meets, in an order that depends on nothing else.
    template <class Work> void each_met(Vec3d x, Vec3d w, Work&& work) const;
    double density(std::uint32_t k, double distance, Vec3d w) const;

    std::vector<EmittingTriangle> triangles_;
    std::vector<Side> sides_;
    std::vector<double> powers_;  // sum of the powers of all triangles up to this one
    std::shared_ptr<const BvhTree> tree_;
    float reach_ = 0;  // the largest coordinate, m
};

}  // namespace crescent
