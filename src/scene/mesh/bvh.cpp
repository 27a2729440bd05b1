// Traversal and the two tests. The errors of the watertight test, with u = 2^-24, all coordinates of the mesh at most 1
// and those of the origin at most r, so that a corner relative to the origin is at most R = r + 1 along each axis:
//
//   corner - origin                   u R        sheared x = fl(A_x - fl(S_x A_z)), |S_x| <= 1
//   S_x = fl(d_x / d_z), times A_z    u R
//   error of A_z, times S_x           u R
//   product                           u R
//   difference, at most 2 R           2 u R
//
// together 6 u R along each of the two sheared axes. The sign of an edge function fl(fl(a b) - fl(c d)) is right or the
// function is 0, since rounding is monotone, and 0 counts as inside for both triangles of an edge. So a ray that meets
// the surface whose corners are moved by at most 6 u R hits a triangle, and no ray passes between two triangles. Boxes
// are widened by e = 8 u R: 6 u R, and the rounding of o + e and o - e.
#include "scene/mesh/bvh.h"

#include <optional>

#include "scene/mesh/bvh_build.h"
#include "scene/mesh/bvh_tree.h"

namespace crescent {

namespace {

/// Four triangles, by axis, corner and triangle.
struct alignas(16) Block {
    std::array<std::array<std::array<float, group>, 3>, 3> corner;
    Leaf triangle;
};

/// A ray as triangles are tested with: sheared so that it runs along its longest axis z.
struct TriangleRay {
    std::size_t kx, ky, kz;
    float ox, oy, oz, sx, sy, sz;

    TriangleRay(Vec3f o, Vec3f d) {
        const float x = std::fabs(d.x), y = std::fabs(d.y), z = std::fabs(d.z);
        kz = x > y ? (x > z ? 0 : 2) : (y > z ? 1 : 2);
        const std::array from = {o.x, o.y, o.z}, to = {d.x, d.y, d.z};
        const float component = to[kz];
        constexpr std::array<std::size_t, 4> next_axis = {1, 2, 0, 1};
        kx = next_axis[component < 0 ? kz + 1 : kz];
        ky = next_axis[component < 0 ? kz : kz + 1];
        ox = from[kx];
        oy = from[ky];
        oz = from[kz];
        sx = to[kx] / component;
        sy = to[ky] / component;
        sz = 1 / component;
    }

    struct Hits {
        unsigned bits;
        F4 t, u, v;
    };
    /// Returns which triangles of a block are met at 0 < t < t_max.
    [[gnu::always_inline]] Hits hits(const Block& block, float t_max) const {
        const auto corner = [&](std::size_t k) __attribute__((always_inline)) {
            const F4 z = std::bit_cast<F4>(block.corner[kz][k]) - all4(oz);
            const F4 x = (std::bit_cast<F4>(block.corner[kx][k]) - all4(ox)) - all4(sx) * z;
            const F4 y = (std::bit_cast<F4>(block.corner[ky][k]) - all4(oy)) - all4(sy) * z;
            return std::array{x, y, all4(sz) * z};
        };
        const auto [ax, ay, az] = corner(0);
        const auto [bx, by, bz] = corner(1);
        const auto [cx, cy, cz] = corner(2);
        const F4 u = cx * by - cy * bx, v = ax * cy - ay * cx, w = bx * ay - by * ax;
        const F4 low = minimum(u, minimum(v, w)), high = maximum(u, maximum(v, w)), det = (u + v) + w;
        const F4 zero = all4(0);
        const I4 is_inside = ((low >= zero) | (high <= zero)) & (det != zero);
        if (bits_of(is_inside) == 0) return {.bits = 0, .t = zero, .u = zero, .v = zero};
        const F4 t = ((u * az + v * bz) + w * cz) / det;
        return {.bits = bits_of(is_inside & (t > zero) & (t < all4(t_max))), .t = t, .u = v / det, .v = w / det};
    }
};

/// Returns the box of a triangle in a block.
[[gnu::always_inline]] inline Bounds box_of(const Block& block, std::size_t lane) {
    Bounds box;
    for (std::size_t k = 0; k < 3; ++k)
        box.add(Vec3f{block.corner[0][k][lane], block.corner[1][k][lane], block.corner[2][k][lane]});
    return box;
}

/// Returns the t of a triangle that the watertight test accepts: infinity if its box is not met or t is not below
/// t_max.
[[gnu::always_inline]] inline float t_in_box(
    const Block& block, std::size_t lane, float t, const BoxRay& boxes, float t_max) {
    const float entry = std::fmax(t, boxes.enters(box_of(block, lane), t_max));
    return entry < t_max ? entry : infinity;
}

/// Takes a triangle of a block that is nearer, or as near with a lower index.
[[gnu::always_inline]] inline void take(
    const Block& block, const BoxRay& boxes, const TriangleRay& ray, float t_max, TriangleHit& best) {
    const auto hits = ray.hits(block, t_max);
    for (unsigned bits = hits.bits; bits; bits &= bits - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
        const float t = t_in_box(block, lane, hits.t[lane], boxes, t_max);
        if (t < best.t || (t == best.t && t < infinity && block.triangle[lane] < best.triangle))
            best = {.t = t, .triangle = block.triangle[lane], .u = hits.u[lane], .v = hits.v[lane]};
    }
}

}  // namespace

struct Bvh::Made {
    HugeVector<BvhNode> nodes;
    HugeVector<Block> blocks;

    void fetch(std::size_t block) const {
        const char* address = reinterpret_cast<const char*>(&blocks[block]);
        for (const std::size_t line : {0, 64, 128}) __builtin_prefetch(address + line);
    }
};

Bvh::Bvh(std::span<const Vec3f> positions, std::span<const Triangle> triangles) {
    Bounds bounds;
    for (const Triangle& t : triangles)
        for (const std::uint32_t k : t) bounds.add(positions[k]);
    if (triangles.empty()) return;
    center_ = 0.5f * bounds.low + 0.5f * bounds.high;
    const float half = std::fmax(largest_of(bounds.low - center_), largest_of(bounds.high - center_));
    int exponent = 0;
    if (half > 0) {
        std::frexp(half, &exponent);
        scale_ = std::ldexp(1.0f, exponent);
    }
    const auto local = [&](std::uint32_t k) {
        const Vec3f p = positions[k] - center_;
        return Vec3f{p.x / scale_, p.y / scale_, p.z / scale_};
    };
    std::vector<Bounds> boxes(triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i)
        for (const std::uint32_t k : triangles[i]) boxes[i].add(local(k));
    for (const Bounds& b : boxes) bounds_.add(b);
    auto content = std::make_shared<Made>();
    BvhTree tree = build_tree(boxes);
    content->nodes = std::move(tree.nodes);
    content->blocks.resize(tree.leaves.size());
    for (std::size_t i = 0; i < tree.leaves.size(); ++i) {
        const Leaf& leaf = tree.leaves[i];
        Block& block = content->blocks[i];
        block.triangle = leaf;
        for (std::size_t lane = 0; lane < group; ++lane)
            for (std::size_t k = 0; k < 3; ++k) {
                // An absent triangle is a point, whose edge functions are 0: never hit.
                const Vec3f p = leaf[lane] == no_item ? Vec3f{} : local(triangles[leaf[lane]][k]);
                for (std::size_t axis = 0; axis < 3; ++axis) block.corner[axis][k][lane] = axis_of(p, axis);
            }
    }
    content_ = std::move(content);
}

/// The two traversals, compiled as the caller is (see bvh_tree.h).
struct Bvh::Traversal {
    [[gnu::always_inline]] static bool occluded(const Made& content, Vec3f o, Vec3f d, float t_max) {
        const BoxRay boxes(o, d, error(largest_of(o)));
        std::optional<TriangleRay> ray;  // many rays meet no leaf
        const auto hides = [&](std::size_t leaf) __attribute__((always_inline)) {
            if (!ray) ray.emplace(o, d);
            const Block& block = content.blocks[leaf];
            const auto hits = ray->hits(block, t_max);
            for (unsigned bits = hits.bits; bits; bits &= bits - 1) {
                const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
                if (t_in_box(block, lane, hits.t[lane], boxes, t_max) < infinity) return true;
            }
            return false;
        };
        const auto fetch = [&](std::size_t leaf) __attribute__((always_inline)) { content.fetch(leaf); };
        return visit_leaves(content.nodes, boxes, t_max, hides, fetch);
    }

    [[gnu::always_inline]] static void closest(const Made& content, Vec3f o, Vec3f d, float t_max, TriangleHit& best) {
        const BoxRay boxes(o, d, error(largest_of(o)));
        const TriangleRay ray(o, d);
        float nearest = std::fmin(t_max, best.t);
        const auto test = [&](std::size_t leaf) __attribute__((always_inline)) {
            take(content.blocks[leaf], boxes, ray, t_max, best);
            nearest = std::fmin(nearest, best.t);
            return false;
        };
        const auto fetch = [&](std::size_t leaf) __attribute__((always_inline)) { content.fetch(leaf); };
        visit_leaves(content.nodes, boxes, nearest, test, fetch);
    }

#ifdef CRESCENT_EIGHT_LANES
    CRESCENT_EIGHT_LANES static bool occluded_wide(const Made& content, Vec3f o, Vec3f d, float t_max) {
        return occluded(content, o, d, t_max);
    }
    CRESCENT_EIGHT_LANES static void closest_wide(
        const Made& content, Vec3f o, Vec3f d, float t_max, TriangleHit& best) {
        closest(content, o, d, t_max, best);
    }
#endif
};

bool Bvh::occluded(Vec3f o, Vec3f d, float t_max) const {
    if (!content_) return false;
#ifdef CRESCENT_EIGHT_LANES
    if (has_eight_lanes) return Traversal::occluded_wide(*content_, o, d, t_max);
#endif
    return Traversal::occluded(*content_, o, d, t_max);
}

void Bvh::closest(Vec3f o, Vec3f d, float t_max, TriangleHit& best) const {
    if (!content_) return;
#ifdef CRESCENT_EIGHT_LANES
    if (has_eight_lanes) return Traversal::closest_wide(*content_, o, d, t_max, best);
#endif
    Traversal::closest(*content_, o, d, t_max, best);
}

TriangleHit Bvh::closest(Vec3f o, Vec3f d, float t_max) const {
    TriangleHit best;
    closest(o, d, t_max, best);
    return best;
}

TriangleHit Bvh::closest_of_all(Vec3f o, Vec3f d, float t_max) const {
    TriangleHit best;
    for (std::size_t i = 0; content_ && i < content_->blocks.size(); ++i)
        take(content_->blocks[i], BoxRay(o, d, error(largest_of(o))), TriangleRay(o, d), t_max, best);
    return best;
}

std::size_t Bvh::bytes() const {
    return content_ ? content_->nodes.size() * sizeof(BvhNode) + content_->blocks.size() * sizeof(Block) : 0;
}

}  // namespace crescent
