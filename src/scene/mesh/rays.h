// Rays against all instances of a scene's meshes: a hierarchy over the instances, each of which tests its mesh in the
// mesh's normalised space. Positions are relative to the scene's origin; lengths in m.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "scene/mesh/affine.h"
#include "scene/mesh/mesh.h"

namespace crescent {

/// A mesh at a place.
struct MeshInstance {
    std::shared_ptr<const MeshPack> pack;
    Affine to_world;
    int mesh = -1;  // index into SceneData::meshes
};

/// Where a ray meets a mesh.
struct MeshHit {
    float t = infinity;                // in units of d
    std::uint32_t instance = no_item;  // index into Rays::instances(); no_item: nothing is hit
    std::uint32_t triangle = no_item;  // index into the mesh's triangles
    float u = 0, v = 0;                // weights of its corners 1 and 2
    bool found() const { return instance != no_item; }
};

class Rays {
public:
    Rays() = default;
    /// Rays are traced from positions relative to `origin`.
    Rays(std::vector<MeshInstance> instances, Vec3d origin);

    bool empty() const { return instances_.empty(); }
    const std::vector<MeshInstance>& instances() const { return instances_; }

    /// Returns whether a triangle is hit at x + t d with 0 < t < t_max.
    bool occluded(Vec3f x, Vec3f d, float t_max) const;
    /// Returns the nearest hit with 0 < t < t_max; of equal t the least instance, then the least triangle.
    MeshHit closest(Vec3f x, Vec3f d, float t_max) const { return closest(widen(x), widen(d), t_max); }
    MeshHit closest(Vec3d x, Vec3d d, float t_max) const;
    /// The same by testing every triangle of every instance, for tests.
    MeshHit closest_of_all(Vec3d x, Vec3d d, float t_max) const;

    /// How far a triangle may be from its place when a ray from x meets it, m.
    float error(Vec3f x) const;
    /// Returns by how much a point x (relative to the origin) of an instance's surface is moved along its normal, so
    /// that no ray from there to that side meets the surface under the point; m.
    double offset(std::uint32_t instance, Vec3d x) const;

private:
    struct Made;
    struct Traversal;
    std::vector<MeshInstance> instances_;
    std::shared_ptr<const Made> content_;
};

}  // namespace crescent
