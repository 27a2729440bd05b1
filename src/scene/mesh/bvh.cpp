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
//
// The slabs of a box (Ize 2013, "Robust BVH Ray Traversal") have three roundings each, a relative error of 3 u on both
// sides; the far end is multiplied by 1 + 8 u. All operations are monotone: a box around another is met if that is.
#include "scene/mesh/bvh.h"

#include <bit>
#include <cmath>
#include <utility>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include "base/errors.h"

namespace crescent::inline scene {

namespace {

// Four lanes, as the compilers' vector extension: the same IEEE operations on every machine.
using F4 = float __attribute__((vector_size(16)));
using I4 = std::int32_t __attribute__((vector_size(16)));

F4 load(const std::array<float, 4>& from) { return std::bit_cast<F4>(from); }
F4 all(float x) { return F4{x, x, x, x}; }
F4 least(F4 a, F4 b) {
#ifdef __SSE2__
    return _mm_min_ps(a, b);
#else
    return a < b ? a : b;
#endif
}
F4 most(F4 a, F4 b) {
#ifdef __SSE2__
    return _mm_max_ps(a, b);
#else
    return a > b ? a : b;
#endif
}
unsigned bits(I4 mask) {
#ifdef __SSE2__
    return static_cast<unsigned>(_mm_movemask_ps(std::bit_cast<__m128>(mask)));
#else
    return (mask[0] & 1) | (mask[1] & 2) | (mask[2] & 4) | (mask[3] & 8);
#endif
}

constexpr float far_factor = 1 + 8 * static_cast<float>(unit_roundoff);

float axis(Vec3f v, std::size_t k) { return k == 0 ? v.x : k == 1 ? v.y : v.z; }
float largest(Vec3f v) { return std::fmax(std::fmax(std::fabs(v.x), std::fabs(v.y)), std::fabs(v.z)); }

/// A ray as triangles are tested with: sheared so that it runs along its longest axis z.
struct TriangleRay {
    std::size_t kx, ky, kz;
    float ox, oy, oz, sx, sy, sz;

    TriangleRay(Vec3f o, Vec3f d) {
        const float x = std::fabs(d.x), y = std::fabs(d.y), z = std::fabs(d.z);
        kz = x > y ? (x > z ? 0 : 2) : (y > z ? 1 : 2);
        kx = (kz + 1) % 3, ky = (kz + 2) % 3;
        const float along = axis(d, kz);
        if (along < 0) std::swap(kx, ky);
        ox = axis(o, kx), oy = axis(o, ky), oz = axis(o, kz);
        sx = axis(d, kx) / along, sy = axis(d, ky) / along, sz = 1 / along;
    }

    struct Hits {
        unsigned met;
        F4 t, u, v;
    };
    /// Returns which triangles of a block are met at 0 < t < t_max.
    Hits hits(const Bvh::Block& block, float t_max) const {
        const auto corner = [&](std::size_t k) {
            const F4 z = load(block.corner[kz][k]) - all(oz);
            const F4 x = (load(block.corner[kx][k]) - all(ox)) - all(sx) * z;
            const F4 y = (load(block.corner[ky][k]) - all(oy)) - all(sy) * z;
            return std::array{x, y, all(sz) * z};
        };
        const auto [ax, ay, az] = corner(0);
        const auto [bx, by, bz] = corner(1);
        const auto [cx, cy, cz] = corner(2);
        const F4 u = cx * by - cy * bx, v = ax * cy - ay * cx, w = bx * ay - by * ax;
        const F4 low = least(u, least(v, w)), high = most(u, most(v, w)), det = (u + v) + w;
        const F4 zero = all(0);
        const I4 inside = ((low >= zero) | (high <= zero)) & (det != zero);
        if (bits(inside) == 0) return {0, zero, zero, zero};
        const F4 t = ((u * az + v * bz) + w * cz) / det;
        return {bits(inside & (t > zero) & (t < all(t_max))), t, v / det, w / det};
    }
};

/// Returns the box of a triangle in a block.
Bounds box_of(const Bvh::Block& block, std::size_t lane) {
    Bounds box;
    for (std::size_t k = 0; k < 3; ++k)
        box.add(Vec3f{block.corner[0][k][lane], block.corner[1][k][lane], block.corner[2][k][lane]});
    return box;
}

/// Returns where a ray enters a box, at least 0, and where it leaves it.
std::pair<float, float> through(const BoxRay& ray, const Bounds& box) {
    float near = 0, far = infinity;
    for (std::size_t k = 0; k < 3; ++k) {
        const float a = (axis(box.low, k) - ray.above[k]) * ray.inverse[k];
        const float b = (axis(box.high, k) - ray.below[k]) * ray.inverse[k];
        near = std::fmax(near, std::fmin(a, b)), far = std::fmin(far, std::fmax(a, b));
    }
    return {near, far};
}

}  // namespace

BoxRay::BoxRay(Vec3f o, Vec3f d, float e) {
    for (std::size_t k = 0; k < 3; ++k) {
        const float x = axis(d, k);
        inverse[k] = 1 / (std::fabs(x) < 1e-18f ? std::copysign(1e-18f, x) : x);
        above[k] = axis(o, k) + e, below[k] = axis(o, k) - e;
    }
}

unsigned BoxRay::meets(const BvhNode& node, float t_max, std::array<float, 4>& at) const {
    F4 near = all(0), far = all(t_max);
    for (std::size_t k = 0; k < 3; ++k) {
        const F4 a = (load(node.low[k]) - all(above[k])) * all(inverse[k]);
        const F4 b = (load(node.high[k]) - all(below[k])) * all(inverse[k]);
        const bool forward = inverse[k] > 0;
        near = most(near, forward ? a : b), far = least(far, forward ? b : a);
    }
    at = std::bit_cast<std::array<float, 4>>(near);
    return bits(near <= far * all(far_factor));
}

bool BoxRay::meets(const Bounds& box, float t_max) const {
    const auto [near, far] = through(*this, box);
    return near <= std::fmin(far, t_max) * far_factor;
}

float BoxRay::enters(const Bounds& box) const { return through(*this, box).first; }

Bvh::Bvh(std::span<const Vec3f> positions, std::span<const Triangle> triangles) {
    Bounds whole;
    for (const Triangle& t : triangles)
        for (const std::uint32_t k : t) whole.add(positions[k]);
    if (triangles.empty()) return;
    center_ = 0.5f * whole.low + 0.5f * whole.high;
    const float half = std::fmax(largest(whole.low - center_), largest(whole.high - center_));
    int exponent = 0;
    if (half > 0) std::frexp(half, &exponent), scale_ = std::ldexp(1.0f, exponent);
    const auto local = [&](std::uint32_t k) {
        const Vec3f p = positions[k] - center_;
        return Vec3f{p.x / scale_, p.y / scale_, p.z / scale_};
    };
    std::vector<Bounds> boxes(triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i)
        for (const std::uint32_t k : triangles[i]) boxes[i].add(local(k));
    tree_ = build_tree(boxes);
    for (const Bounds& b : boxes) bounds_.add(b);
    blocks_.resize(tree_.leaves.size());
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
        const Leaf& leaf = tree_.leaves[i];
        blocks_[i].triangle = leaf;
        for (std::size_t lane = 0; lane < 4; ++lane)
            for (std::size_t k = 0; k < 3; ++k) {
                // An absent triangle is a point, whose edge functions are 0: never hit.
                const Vec3f p = leaf[lane] == no_item ? Vec3f{} : local(triangles[leaf[lane]][k]);
                blocks_[i].corner[0][k][lane] = p.x;
                blocks_[i].corner[1][k][lane] = p.y;
                blocks_[i].corner[2][k][lane] = p.z;
            }
    }
    tree_.leaves = {};
}

bool Bvh::occluded(Vec3f o, Vec3f d, float t_max) const {
    if (tree_.nodes.empty()) return false;
    const BoxRay boxes(o, d, error(largest(o)));
    const TriangleRay ray(o, d);
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
            const Block& block = blocks_[static_cast<std::size_t>(~at)];
            const auto hits = ray.hits(block, t_max);
            for (unsigned met = hits.met; met; met &= met - 1) {
                const Bounds box = box_of(block, static_cast<std::size_t>(std::countr_zero(met)));
                if (boxes.meets(box, t_max) && boxes.enters(box) < t_max) return true;
            }
        }
        if (size == 0) return false;
        at = stack[--size];
    }
}

namespace {

/// Takes a triangle of a block that is nearer, or as near with a lower index.
void take(const Bvh::Block& block, const BoxRay& boxes, const TriangleRay& ray, float t_max, TriangleHit& best) {
    const auto hits = ray.hits(block, t_max);
    for (unsigned met = hits.met; met; met &= met - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(met));
        const Bounds box = box_of(block, lane);
        const float t = std::fmax(hits.t[lane], boxes.enters(box));
        if (!boxes.meets(box, t_max) || !(t < t_max)) continue;
        if (t < best.t || (t == best.t && block.triangle[lane] < best.triangle))
            best = {t, block.triangle[lane], hits.u[lane], hits.v[lane]};
    }
}

}  // namespace

void Bvh::closest(Vec3f o, Vec3f d, float t_max, TriangleHit& best) const {
    if (tree_.nodes.empty()) return;
    const BoxRay boxes(o, d, error(largest(o)));
    const TriangleRay ray(o, d);
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
            take(blocks_[static_cast<std::size_t>(~next.at)], boxes, ray, t_max, best);
        }
        do {
            if (size == 0) return;
            next = stack[--size];
        } while (next.t > best.t);
    }
}

TriangleHit Bvh::closest(Vec3f o, Vec3f d, float t_max) const {
    TriangleHit best;
    closest(o, d, t_max, best);
    return best;
}

TriangleHit Bvh::closest_of_all(Vec3f o, Vec3f d, float t_max) const {
    TriangleHit best;
    for (const Block& block : blocks_) take(block, BoxRay(o, d, error(largest(o))), TriangleRay(o, d), t_max, best);
    return best;
}

std::size_t Bvh::bytes() const { return tree_.nodes.size() * sizeof(BvhNode) + blocks_.size() * sizeof(Block); }

}  // namespace crescent::inline scene
