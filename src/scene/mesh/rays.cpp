// Traversal of the instances. A ray hits an instance if it meets the box of the instance and hits its mesh; the hit is
// at the t of the mesh, or where the ray enters the box if this is larger, so that the tree never changes a result
// (see bvh.h). Rays are transformed in double precision and rounded once.
#include "scene/mesh/rays.h"

#include <cmath>

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
    auto made = std::make_shared<Made>();
    std::vector<Bounds> boxes;
    for (const MeshInstance& instance : instances_) {
        const Bvh& bvh = instance.pack->bvh;
        const Affine whole = translation(-origin).after(instance.to_world.after(bvh.to_file()));
        const Affine back = whole.inverse();
        Bounds box;
        for (unsigned corner = 0; corner < 8; ++corner) {
            const auto side = [&](unsigned k, float low, float high) {
                return static_cast<double>(corner >> k & 1 ? high : low);
            };
            const Bounds& bounds = bvh.bounds();
            box.add(as<float>(whole.point({side(0, bounds.low.x, bounds.high.x), side(1, bounds.low.y, bounds.high.y),
                side(2, bounds.low.z, bounds.high.z)})));
        }
        made->reach = std::fmax(made->reach, std::fmax(largest(widen(box.low)), largest(widen(box.high))));
        made->condition = std::fmax(made->condition, whole.stretch() * back.stretch());
        made->placed.push_back({back, box, whole.stretch(), &bvh});
        boxes.push_back(box);
    }
    made->tree = build_tree(boxes);
    for (const Leaf& leaf : made->tree.leaves) {
        LeafBoxes& out = made->leaf_boxes.emplace_back();
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t item = 0; item < group; ++item) {
                const Bounds box = leaf[item] == no_item ? Bounds{} : boxes[leaf[item]];  // an empty one is never met
                out[0][k][item] = axis_of(box.low, k);
                out[1][k][item] = axis_of(box.high, k);
            }
    }
    made_ = std::move(made);
}

/// Compiled as the caller is (see bvh_tree.h).
struct Rays::Traversal {
    [[gnu::always_inline]] static bool occluded(const Made& made, Vec3f x, Vec3f d, float t_max) {
        const Vec3d wide_x = widen(x), wide_d = widen(d);
        const BoxRay boxes = made.box_ray(wide_x, wide_d);
        const auto hides = [&](std::size_t leaf) __attribute__((always_inline)) {
            for (unsigned met = boxes.meets(made.leaf_boxes[leaf], t_max); met; met &= met - 1) {
                const auto item = static_cast<std::size_t>(std::countr_zero(met));
                const Placed& placed = made.placed[made.tree.leaves[leaf][item]];
                const Vec3f o = as<float>(placed.to_mesh.point(wide_x)), to = as<float>(placed.to_mesh.vector(wide_d));
                if (placed.bvh->occluded(o, to, t_max)) return true;
            }
            return false;
        };
        if (made.tree.leaves.size() == 1) return hides(0);
        return visit_leaves(made.tree.nodes, boxes, t_max, hides, [](std::size_t) {});
    }

#ifdef CRESCENT_EIGHT_LANES
    CRESCENT_EIGHT_LANES static bool occluded_wide(const Made& made, Vec3f x, Vec3f d, float t_max) {
        return occluded(made, x, d, t_max);
    }
#endif
};

bool Rays::occluded(Vec3f x, Vec3f d, float t_max) const {
    if (empty()) return false;
#ifdef CRESCENT_EIGHT_LANES
    if (has_eight_lanes) return Traversal::occluded_wide(*made_, x, d, t_max);
#endif
    return Traversal::occluded(*made_, x, d, t_max);
}

MeshHit Rays::closest(Vec3d x, Vec3d d, float t_max) const {
    MeshHit best;
    if (empty()) return best;
    const BoxRay boxes = made_->box_ray(x, d);
    float nearest = t_max;
    const auto test = [&](std::size_t leaf) {
        for (const std::uint32_t i : made_->tree.leaves[leaf])
            if (i != no_item) made_->take(*made_->placed[i].bvh, i, boxes, x, d, t_max, false, best);
        nearest = std::fmin(nearest, best.t);
        return false;
    };
    if (made_->tree.leaves.size() == 1) test(0);
    else visit_leaves(made_->tree.nodes, boxes, nearest, test, [](std::size_t) {});
    return best;
}

MeshHit Rays::closest_of_all(Vec3d x, Vec3d d, float t_max) const {
    MeshHit best;
    for (std::uint32_t i = 0; i < instances_.size(); ++i)
        made_->take(instances_[i].pack->bvh, i, made_->box_ray(x, d), x, d, t_max, true, best);
    return best;
}

float Rays::error(Vec3f x) const { return made_ ? made_->error(widen(x)) : 0; }

double Rays::offset(std::uint32_t instance, Vec3d x) const {
    // In the mesh's space, from an origin on the surface (R = 2, see bvh.cpp): 12 u along each sheared axis, so 17 u
    // along the normal; 2 u along the ray; sqrt(3) u each for the rounding of the ray's origin and of the corners. In
    // the scene: sqrt(3) u |x| for the rounding of x.
    return unit_roundoff * (24 * made_->placed[instance].stretch + 2 * largest(x));
}

}  // namespace crescent
