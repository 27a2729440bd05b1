// The tree only saves tests: a box is widened by more than the rounding errors of the test in double precision.
#include "scene/triangle_lights.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "base/errors.h"
#include "scene/mesh/bvh_build.h"
#include "scene/mesh/bvh_tree.h"

namespace crescent {

namespace {

/// Whether a ray meets the box of a leaf, compiled as the caller is (see bvh_tree.h). Leaves are visited if it is met.
[[gnu::always_inline]] inline bool meets_leaf(const BvhTree& tree, Vec3f x, Vec3f w, float error) {
    const auto accept = [](std::size_t) __attribute__((always_inline)) { return true; };
    return visit_leaves(tree.nodes, BoxRay(x, w, error), infinity, accept, [](std::size_t) {});
}
#ifdef CRESCENT_EIGHT_LANES
CRESCENT_EIGHT_LANES bool meets_leaf_wide(const BvhTree& tree, Vec3f x, Vec3f w, float error) {
    return meets_leaf(tree, x, w, error);
}
#endif

}  // namespace

TriangleLights::TriangleLights(std::vector<EmittingTriangle> triangles) : triangles_(std::move(triangles)) {
    std::vector<Bounds> boxes;
    double total = 0;
    for (const EmittingTriangle& t : triangles_) {
        Bounds box;
        for (const Vec3d& corner : t.corner) {
            box.add(as<float>(corner));
            for (const double c : {corner.x, corner.y, corner.z})
                reach_ = std::max(reach_, static_cast<float>(std::fabs(c)));
        }
        boxes.push_back(box);
        const Vec3d e1 = t.corner[1] - t.corner[0], e2 = t.corner[2] - t.corner[0], normal = cross(e1, e2);
        sides_.push_back({t.corner[0], e1, e2, normal});
        total += luminance(t.radiance) * 0.5 * std::sqrt(dot(normal, normal));
        powers_.push_back(total);
    }
    ensure(total > 0, "emitting triangles have power");
    tree_ = std::make_shared<const BvhTree>(build_tree(boxes));
}

double TriangleLights::density(std::uint32_t k, double distance, Vec3d w) const {
    const Vec3d& normal = sides_[k].normal;
    const double cos = -dot(w, normal) / std::sqrt(dot(normal, normal));
    return cos > 0 ? luminance(triangles_[k].radiance) / powers_.back() * distance * distance / cos : 0;
}

TriangleDraw TriangleLights::sample(Vec3d x, double u, double v, bool is_whole) const {
    const double target = u * powers_.back();
    std::uint32_t k = 0;  // the first power above `target`, or the last: without branches, which chance decides
    for (auto remaining = static_cast<std::uint32_t>(powers_.size()) - 1; remaining > 0;) {
        const std::uint32_t half = (remaining + 1) / 2;
        k += half & (0u - static_cast<std::uint32_t>(powers_[k + half - 1] <= target));
        remaining -= half;
    }
    const double low = k > 0 ? powers_[k - 1] : 0;
    const double root = std::sqrt(std::clamp((target - low) / (powers_[k] - low), 0.0, 1.0));
    const Side& side = sides_[k];
    const Vec3d to = side.corner + (root * (1 - v)) * side.e1 + (root * v) * side.e2 - x;
    const double distance = std::sqrt(dot(to, to));
    if (!(distance > 0)) return {{0, 0, 1}, no_triangle, 0};
    const Vec3d w = (1 / distance) * to;
    const double density_here = density(k, distance, w);
    return {w, k, density_here > 0 ? density_here + (is_whole ? pdf(x, w, k) : 0) : 0};
}

template <class Work> void TriangleLights::each_met(Vec3d x, Vec3d w, Work&& work) const {
    const Vec3f o = as<float>(x);
    const float reach = std::max({reach_, std::fabs(o.x), std::fabs(o.y), std::fabs(o.z)});
    const BoxRay ray(o, as<float>(w), 1e-5f * reach);
    const auto test = [&](std::size_t leaf) {
        for (const std::uint32_t k : tree_->leaves[leaf]) {
            if (k == no_item) break;
            // x + t w = corner + a e1 + b e2 by Cramer's rule, times the determinant (Moeller & Trumbore 1997).
            const Side& side = sides_[k];
            const double det = -dot(side.normal, w);
            if (!(det > 0)) continue;  // its back
            const Vec3d from = x - side.corner;
            const double a = -dot(from, cross(side.e2, w)), b = dot(from, cross(side.e1, w)),
                         t = dot(from, side.normal);
            if (a >= 0 && b >= 0 && a + b <= det && t > 0) work(k, t / det);
        }
        return false;
    };
    visit_leaves(tree_->nodes, ray, infinity, test, [](std::size_t) {});
}

bool TriangleLights::may_meet(Vec3f x, Vec3f w, float error) const {
#ifdef CRESCENT_EIGHT_LANES
    if (has_eight_lanes) return meets_leaf_wide(*tree_, x, w, error);
#endif
    return meets_leaf(*tree_, x, w, error);
}

double TriangleLights::pdf(Vec3d x, Vec3d w, std::uint32_t but) const {
    double sum = 0;
    each_met(x, w, [&](std::uint32_t k, double distance) {
        if (k != but) sum += density(k, distance, w);
    });
    return sum;
}

std::uint32_t TriangleLights::nearest(Vec3d x, Vec3d w) const {
    std::uint32_t out = no_triangle;
    double shortest = std::numeric_limits<double>::infinity();
    each_met(x, w, [&](std::uint32_t k, double distance) {
        if (distance < shortest || (distance == shortest && k < out)) {
            shortest = distance;
            out = k;
        }
    });
    return out;
}

double TriangleLights::distance(std::uint32_t k, Vec3d x, Vec3d w) const {
    return dot(sides_[k].normal, sides_[k].corner - x) / dot(sides_[k].normal, w);
}

std::uint32_t TriangleLights::find(std::uint32_t instance, std::uint32_t triangle, Vec3d d) const {
    const auto key = [](const EmittingTriangle& t) { return std::tuple(t.instance, t.triangle); };
    auto match = std::ranges::lower_bound(triangles_, std::tuple(instance, triangle), {}, key);
    for (; match != triangles_.end() && key(*match) == std::tuple(instance, triangle); ++match) {
        const auto k = static_cast<std::uint32_t>(match - triangles_.begin());
        if (dot(sides_[k].normal, d) < 0) return k;
    }
    return no_triangle;
}

}  // namespace crescent
