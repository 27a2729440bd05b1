// Rays against the triangles of one mesh: a hierarchy of boxes (BVH) with eight children per node and four triangles
// per leaf, and the watertight test of Woop, Benthin, Wald 2013, "Watertight Ray/Triangle Intersection". Single
// precision.
//
// A ray hits a triangle if it meets the triangle's own box and the watertight test accepts it at 0 < t < t_max, where t
// is that of the watertight test, or that at which the ray enters the box if this is larger. Both tests are defined
// operation by operation in IEEE single precision without fused multiply-add, and the test of a box is monotone: a ray
// that meets a box meets every box around it, and enters it no later. So the hierarchy never changes a result, which is
// that of testing every triangle: any tree, any order and any instruction set give the same bits.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>

#include "base/vec.h"
#include "scene/mesh/affine.h"

namespace crescent {

using Triangle = std::array<std::uint32_t, 3>;  // indices of its corners, counterclockwise seen from the front

inline constexpr float infinity = std::numeric_limits<float>::infinity();
inline constexpr double unit_roundoff = 0x1p-24;  // of single precision: the largest relative error of one operation

/// A box along the axes; empty if low > high.
struct Bounds {
    Vec3f low{infinity, infinity, infinity}, high{-infinity, -infinity, -infinity};

    void add(Vec3f p) { add(Bounds{p, p}); }
    /// An empty box adds nothing.
    void add(const Bounds& b) {
        const auto smaller = [](float x, float y) { return y < x ? y : x; };
        const auto larger = [](float x, float y) { return y > x ? y : x; };
        low = {smaller(low.x, b.low.x), smaller(low.y, b.low.y), smaller(low.z, b.low.z)};
        high = {larger(high.x, b.high.x), larger(high.y, b.high.y), larger(high.z, b.high.z)};
    }
};

inline constexpr std::uint32_t no_item = 0xffffffff;

/// Where a ray meets a triangle: corner 0 has the weight 1 - u - v, corners 1 and 2 have u and v.
struct TriangleHit {
    float t = infinity;  // in units of d
    std::uint32_t triangle = no_item;
    float u = 0, v = 0;
};

class Bvh {
public:
    Bvh() = default;
    Bvh(std::span<const Vec3f> positions, std::span<const Triangle> triangles);

    /// Rays are given in the mesh's normalised space, see center() and scale(). Returns whether a triangle is hit.
    bool occluded(Vec3f o, Vec3f d, float t_max) const;
    /// Returns the nearest hit with 0 < t < t_max; of equal t the triangle of the least index.
    TriangleHit closest(Vec3f o, Vec3f d, float t_max) const;
    /// Replaces `best` by a hit that is nearer, or as near with a lower index.
    void closest(Vec3f o, Vec3f d, float t_max, TriangleHit& best) const;
    /// The same by testing every triangle, for tests.
    TriangleHit closest_of_all(Vec3f o, Vec3f d, float t_max) const;

    /// A position p of the mesh is (p - center) / scale here; the scale is a power of two, so that the largest
    /// coordinate is at most 1 and at least 1/2 (or all are 0).
    Vec3f center() const { return center_; }
    float scale() const { return scale_; }
    /// Returns the transform from normalised space to the mesh's own.
    Affine to_file() const {
        const double s = static_cast<double>(scale_);
        return translation(widen(center_)).after(scaling({s, s, s}));
    }
    /// The box in normalised space.
    const Bounds& bounds() const { return bounds_; }
    std::size_t bytes() const;

    /// How far a triangle of this test may be from the triangle of the file, in normalised space, for a ray whose
    /// origin has no coordinate above `reach`: the bound that boxes are widened by and that origins on a surface keep
    /// from it. Derived in bvh.cpp.
    static constexpr float error(float reach) { return static_cast<float>(8 * unit_roundoff) * (reach + 1); }

private:
    struct Made;
    struct Traversal;
    std::shared_ptr<const Made> content_;
    Vec3f center_{};
    float scale_ = 1;
    Bounds bounds_;
};

}  // namespace crescent
