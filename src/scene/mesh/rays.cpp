// Traversal of the instances. A ray hits an instance if it meets the box of the instance and hits its mesh; the hit is
// at the t of the mesh, or where the ray enters the box if this is larger, so that the tree never changes a result
// (see bvh.h). Rays are transformed in double precision and rounded once.
#include "scene/mesh/rays.h"

#include <cmath>

#include "scene/mesh/bvh_build.h"
#include "scene/mesh/bvh_tree.h"

namespace crescent {

namespace {

double largest(Vec3d v) { return std::fmax(std::fmax(std::fabs(v.x), std::fabs(v.y)), std::fabs(v.z)); }

/// An instance as it is traced.
struct Placed {
    Affine to_mesh;  // from the scene's space about its origin to the normalised space of the mesh
    Bounds box;      // about the origin
    double stretch;  // at most so many m in the scene per unit of the normalised space
    const Bvh* bvh;
};

}  // namespace

struct Rays::Made {
    std::vector<Placed> placed;
    BvhTree tree;
    std::vector<LeafBoxes> leaf_boxes;  // of the tree
    double reach = 0;                   // largest coordinate of all boxes, m
    double condition = 1;               // largest product of the stretches of a transform and of its inverse

    /// A mesh in its own space is off by at most 6 u of the reach of the ray's origin there, and the rounding of the
    /// transformed ray; here by that times the stretch of both transforms.
    float error(Vec3d x) const { return static_cast<float>(16 * unit_roundoff * condition * (largest(x) + reach)); }
    BoxRay box_ray(Vec3d x, Vec3d d) const { return {as<float>(x), as<float>(d), error(x)}; }

    /// Moves the nearest hit of one instance into `best` if it is nearer there.
    void take(const Bvh& bvh, std::uint32_t index, const BoxRay& boxes, Vec3d x, Vec3d d, float t_max,
        bool any_hit_only, MeshHit& best) const {
        const float entry = boxes.enters(placed[index].box, t_max);
        if (!(entry < t_max) || entry > best.t) return;
        const Vec3f o = as<float>(placed[index].to_mesh.point(x)), to = as<float>(placed[index].to_mesh.vector(d));
        TriangleHit hit{best.t};
        if (any_hit_only) hit = bvh.closest_of_all(o, to, t_max);
        else bvh.closest(o, to, t_max, hit);
        if (hit.triangle == no_item) return;
        const float t = std::fmax(hit.t, entry);
        if (t < t_max && (t < best.t || (t == best.t && index < best.instance)))
            best = {.t = t, .instance = index, .triangle = hit.triangle, .u = hit.u, .v = hit.v};
    }
};

Rays::Rays(std::vector<MeshInstance> instances, Vec3d origin) : instances_(std::move(instances)) {
    auto content = std::make_shared<Made>();
    std::vector<Bounds> boxes;
    for (const MeshInstance& instance : instances_) {
        const Bvh& bvh = instance.pack->bvh;
        const Affine to_scene = translation(-origin).after(instance.to_world.after(bvh.to_file()));
        const Affine to_mesh = to_scene.inverse();
        Bounds box;
        for (unsigned corner = 0; corner < 8; ++corner) {
            const auto side = [&](unsigned k, float low, float high) {
                return static_cast<double>(corner >> k & 1 ? high : low);
            };
            const Bounds& bounds = bvh.bounds();
            box.add(as<float>(to_scene.point({side(0, bounds.low.x, bounds.high.x),
                side(1, bounds.low.y, bounds.high.y), side(2, bounds.low.z, bounds.high.z)})));
        }
        content->reach = std::fmax(content->reach, std::fmax(largest(widen(box.low)), largest(widen(box.high))));
        content->condition = std::fmax(content->condition, to_scene.stretch() * to_mesh.stretch());
        content->placed.push_back({to_mesh, box, to_scene.stretch(), &bvh});
        boxes.push_back(box);
    }
    content->tree = build_tree(boxes);
    for (const Leaf& leaf : content->tree.leaves) {
        LeafBoxes& out = content->leaf_boxes.emplace_back();
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t item = 0; item < group; ++item) {
                const Bounds box = leaf[item] == no_item ? Bounds{} : boxes[leaf[item]];  // an empty one is never met
                out[0][k][item] = axis_of(box.low, k);
                out[1][k][item] = axis_of(box.high, k);
            }
    }
    content_ = std::move(content);
}

/// Compiled as the caller is (see bvh_tree.h).
struct Rays::Traversal {
    [[gnu::always_inline]] static bool occluded(const Made& content, Vec3f x, Vec3f d, float t_max) {
        const Vec3d wide_x = widen(x), wide_d = widen(d);
        const BoxRay boxes = content.box_ray(wide_x, wide_d);
        const auto hides = [&](std::size_t leaf) __attribute__((always_inline)) {
            for (unsigned bits = boxes.meets(content.leaf_boxes[leaf], t_max); bits; bits &= bits - 1) {
                const auto item = static_cast<std::size_t>(std::countr_zero(bits));
                const Placed& instance = content.placed[content.tree.leaves[leaf][item]];
                const Vec3f o = as<float>(instance.to_mesh.point(wide_x)),
                            to = as<float>(instance.to_mesh.vector(wide_d));
                if (instance.bvh->occluded(o, to, t_max)) return true;
            }
            return false;
        };
        if (content.tree.leaves.size() == 1) return hides(0);
        return visit_leaves(content.tree.nodes, boxes, t_max, hides, [](std::size_t) {});
    }

#ifdef CRESCENT_EIGHT_LANES
    CRESCENT_EIGHT_LANES static bool occluded_wide(const Made& content, Vec3f x, Vec3f d, float t_max) {
        return occluded(content, x, d, t_max);
    }
#endif
};

bool Rays::occluded(Vec3f x, Vec3f d, float t_max) const {
    if (empty()) return false;
#ifdef CRESCENT_EIGHT_LANES
    if (has_eight_lanes) return Traversal::occluded_wide(*content_, x, d, t_max);
#endif
    return Traversal::occluded(*content_, x, d, t_max);
}

MeshHit Rays::closest(Vec3d x, Vec3d d, float t_max) const {
    MeshHit best;
    if (empty()) return best;
    const BoxRay boxes = content_->box_ray(x, d);
    float nearest = t_max;
    const auto test = [&](std::size_t leaf) {
        for (const std::uint32_t i : content_->tree.leaves[leaf])
            if (i != no_item) content_->take(*content_->placed[i].bvh, i, boxes, x, d, t_max, false, best);
        nearest = std::fmin(nearest, best.t);
        return false;
    };
    if (content_->tree.leaves.size() == 1) test(0);
    else visit_leaves(content_->tree.nodes, boxes, nearest, test, [](std::size_t) {});
    return best;
}

MeshHit Rays::closest_of_all(Vec3d x, Vec3d d, float t_max) const {
    MeshHit best;
    for (std::uint32_t i = 0; i < instances_.size(); ++i)
        content_->take(instances_[i].pack->bvh, i, content_->box_ray(x, d), x, d, t_max, true, best);
    return best;
}

float Rays::error(Vec3f x) const { return content_ ? content_->error(widen(x)) : 0; }

double Rays::offset(std::uint32_t instance, Vec3d x) const {
    // In the mesh's space, from an origin on the surface (R = 2, see bvh.cpp): 12 u along each sheared axis, so 17 u
    // along the normal; 2 u along the ray; sqrt(3) u each for the rounding of the ray's origin and of the corners. In
    // the scene: sqrt(3) u |x| for the rounding of x.
    return unit_roundoff * (24 * content_->placed[instance].stretch + 2 * largest(x));
}

}  // namespace crescent
