// Traversal of the instances. A ray hits an instance if it meets the box of the instance and hits its mesh; the hit is
// at the t of the mesh, or where the ray enters the box if this is larger, so that the tree never changes a result
// (see bvh.h). Rays are transformed in double precision and rounded once.
#include "scene/mesh/rays.h"

#include <array>
#include <bit>
#include <cmath>

namespace crescent::inline scene {

namespace {

double largest(Vec3d v) { return std::fmax(std::fmax(std::fabs(v.x), std::fabs(v.y)), std::fabs(v.z)); }

/// Moves the nearest hit of one instance into `best` if it is nearer there.
void take(const MeshInstance& instance, const Affine& to_mesh, const Bounds& box, const BoxRay& boxes, Vec3d x, Vec3d d,
    float t_max, std::uint32_t index, bool all, MeshHit& best) {
    if (!boxes.meets(box, t_max)) return;
    const Bvh& bvh = instance.pack->bvh;
    const Vec3f o = as<float>(to_mesh.point(x)), to = as<float>(to_mesh.vector(d));
    TriangleHit hit{best.t};
    if (all) hit = bvh.closest_of_all(o, to, t_max);
    else bvh.closest(o, to, t_max, hit);
    if (hit.triangle == no_item) return;
    const float t = std::fmax(hit.t, boxes.enters(box));
    if (t < t_max && (t < best.t || (t == best.t && index < best.instance)))
        best = {t, index, hit.triangle, hit.u, hit.v};
}

}  // namespace

Rays::Rays(std::vector<MeshInstance> instances, Vec3d origin) : instances_(std::move(instances)) {
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
            const Bounds& own = bvh.bounds();
            box.add(as<float>(whole.point(
                {side(0, own.low.x, own.high.x), side(1, own.low.y, own.high.y), side(2, own.low.z, own.high.z)})));
        }
        reach_ = std::fmax(reach_, std::fmax(largest(widen(box.low)), largest(widen(box.high))));
        condition_ = std::fmax(condition_, whole.stretch() * back.stretch());
        placed_.push_back({back, box, whole.stretch()});
        boxes.push_back(box);
    }
    tree_ = build_tree(boxes);
}

BoxRay Rays::box_ray(Vec3d x, Vec3d d) const {
    // A mesh in its own space is off by at most Bvh::error / 8 * 6 and 2 roundings of the transformed ray, all relative
    // to the distance of the ray's origin there; here by that times the stretch of both transforms.
    const double e = 16 * unit_roundoff * condition_ * (largest(x) + reach_);
    return {as<float>(x), as<float>(d), static_cast<float>(e)};
}

bool Rays::occluded(Vec3f x, Vec3f d, float t_max) const {
    if (tree_.nodes.empty()) return false;
    const Vec3d wide_x = widen(x), wide_d = widen(d);
    const BoxRay boxes = box_ray(wide_x, wide_d);
    std::array<std::int32_t, stack_size> stack;
    std::size_t size = 0;
    std::int32_t at = 0;
    for (;;) {
        if (at >= 0) {
            const BvhNode& node = tree_.nodes[static_cast<std::size_t>(at)];
            std::array<float, 4> entry;
            for (unsigned met = boxes.meets(node, t_max, entry); met; met &= met - 1)
                stack[size++] = node.child[static_cast<std::size_t>(std::countr_zero(met))];
        } else {
            for (const std::uint32_t i : tree_.leaves[static_cast<std::size_t>(~at)]) {
                if (i == no_item) break;
                const Placed& placed = placed_[i];
                if (!boxes.meets(placed.box, t_max) || !(boxes.enters(placed.box) < t_max)) continue;
                const Vec3f o = as<float>(placed.to_mesh.point(wide_x)), to = as<float>(placed.to_mesh.vector(wide_d));
                if (instances_[i].pack->bvh.occluded(o, to, t_max)) return true;
            }
        }
        if (size == 0) return false;
        at = stack[--size];
    }
}

MeshHit Rays::closest(Vec3d x, Vec3d d, float t_max) const {
    MeshHit best;
    if (tree_.nodes.empty()) return best;
    const BoxRay boxes = box_ray(x, d);
    struct Entry {
        float t;
        std::int32_t at;
    };
    std::array<Entry, stack_size> stack;
    std::size_t size = 0;
    Entry next{0, 0};
    for (;;) {
        if (next.at >= 0) {
            const BvhNode& node = tree_.nodes[static_cast<std::size_t>(next.at)];
            std::array<float, 4> entry;
            const std::size_t begin = size;
            for (unsigned met = boxes.meets(node, std::fmin(t_max, best.t), entry); met; met &= met - 1) {
                const auto c = static_cast<std::size_t>(std::countr_zero(met));
                std::size_t i = size++;  // the nearest last
                for (; i > begin && stack[i - 1].t < entry[c]; --i) stack[i] = stack[i - 1];
                stack[i] = {entry[c], node.child[c]};
            }
        } else {
            for (const std::uint32_t i : tree_.leaves[static_cast<std::size_t>(~next.at)]) {
                if (i == no_item) break;
                take(instances_[i], placed_[i].to_mesh, placed_[i].box, boxes, x, d, t_max, i, false, best);
            }
        }
        do {
            if (size == 0) return best;
            next = stack[--size];
        } while (next.t > best.t);
    }
}

MeshHit Rays::closest_of_all(Vec3d x, Vec3d d, float t_max) const {
    MeshHit best;
    const BoxRay boxes = box_ray(x, d);
    for (std::uint32_t i = 0; i < instances_.size(); ++i)
        take(instances_[i], placed_[i].to_mesh, placed_[i].box, boxes, x, d, t_max, i, true, best);
    return best;
}

double Rays::offset(std::uint32_t instance, Vec3d x) const {
    // In the mesh's space, from an origin on the surface (R = 2, see bvh.cpp): 12 u along each sheared axis, so 17 u
    // along the normal; 2 u along the ray; sqrt(3) u each for the rounding of the ray's origin and of the corners. In
    // the scene: sqrt(3) u |x| for the rounding of x.
    return unit_roundoff * (24 * placed_[instance].stretch + 2 * largest(x));
}

}  // namespace crescent::inline scene
