// A tree over boxes, and its traversal by a ray: shared by the triangles of a mesh and the instances of a scene. Single
// precision. The test of a box is monotone: a ray that meets a box meets every box around it, and enters it no later.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <span>
#include <utility>
#include <vector>

#ifdef __SSE2__
#include <emmintrin.h>
#endif
#ifdef __linux__
#include <sys/mman.h>
#endif

#include "scene/mesh/bvh.h"

namespace crescent {

// ---- An allocator for large arrays that are read in random order: on Linux in pages of 2 MiB where the system has
// them, because most reads of 4 KiB pages would miss the table of recent translations. Aligned to a cache line.

template <class T> struct HugePages {
    using value_type = T;
    static constexpr std::size_t page = std::size_t{1} << 21, line = 64;

    HugePages() = default;
    template <class U> HugePages(const HugePages<U>&) {}  // NOLINT(google-explicit-constructor): as allocators are

    T* allocate(std::size_t count) {
        const bool is_large = count * sizeof(T) >= page;
        const std::size_t unit = is_large ? page : line, bytes = (count * sizeof(T) + unit - 1) / unit * unit;
        void* memory = std::aligned_alloc(unit, bytes);
        if (!memory) throw std::bad_alloc();
#ifdef __linux__
        if (is_large) static_cast<void>(madvise(memory, bytes, MADV_HUGEPAGE));  // a hint
#endif
        return static_cast<T*>(memory);
    }
    void deallocate(T* memory, std::size_t) { std::free(memory); }
    bool operator==(const HugePages&) const { return true; }
};

template <class T> using HugeVector = std::vector<T, HugePages<T>>;

// ---- The tree.

inline constexpr std::size_t children = 8;  // of a node
inline constexpr std::size_t group = 4;     // items in a leaf

// Lanes, as the compilers' vector extension: the same IEEE operations on every machine.
using F4 = float __attribute__((vector_size(16)));
using I4 = std::int32_t __attribute__((vector_size(16)));
using F8 = float __attribute__((vector_size(32)));
using I8 = std::int32_t __attribute__((vector_size(32)));

// Traversal is compiled twice on x86, with two and with one instruction for eight lanes; the bits are the same. Eight
// lanes are never passed by value, which means different things in the two.
#if defined(__x86_64__) && !defined(__AVX2__)
#define CRESCENT_EIGHT_LANES [[gnu::target("avx2")]]
inline const bool has_eight_lanes = __builtin_cpu_supports("avx2") != 0;
#endif

[[gnu::always_inline]] inline F4 all4(float x) { return F4{x, x, x, x}; }
template <class F> [[gnu::always_inline]] inline F minimum(F a, F b) { return a < b ? a : b; }
template <class F> [[gnu::always_inline]] inline F maximum(F a, F b) { return a > b ? a : b; }
/// Returns a bit for each lane that is not 0.
[[gnu::always_inline]] inline unsigned bits_of(I4 mask) {
#ifdef __SSE2__
    return static_cast<unsigned>(_mm_movemask_ps(std::bit_cast<__m128>(mask)));
#else
    return (mask[0] & 1u) | (mask[1] & 2u) | (mask[2] & 4u) | (mask[3] & 8u);
#endif
}

/// The same for eight lanes.
[[gnu::always_inline]] inline unsigned bits_of(const I8& mask) {
    const auto half = std::bit_cast<std::array<I4, 2>>(mask);
    return bits_of(half[0]) | bits_of(half[1]) << 4;
}

inline float axis_of(Vec3f v, std::size_t k) { return k == 0 ? v.x : k == 1 ? v.y : v.z; }
inline float largest_of(Vec3f v) { return std::fmax(std::fmax(std::fabs(v.x), std::fabs(v.y)), std::fabs(v.z)); }

/// Boxes and what is in them: a node (> 0), a leaf (its complement ~c), or nothing (an empty box).
struct alignas(32) BvhNode {
    std::array<std::array<F8, 3>, 2> side;  // low and high, by axis and child
    std::array<std::int32_t, children> child;
};

using Leaf = std::array<std::uint32_t, group>;       // up to four items; no_item fills it
using LeafBoxes = std::array<std::array<F4, 3>, 2>;  // their boxes: low and high, by axis and item

/// A tree over boxes, built by binned SAH (Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies"),
/// in parallel, with a result that does not depend on threads. Node 0 is the root.
struct BvhTree {
    HugeVector<BvhNode> nodes;
    std::vector<Leaf> leaves;
};

/// The most levels of a tree, see bvh_build.cpp, and the most entries of a stack: seven siblings on each level.
inline constexpr std::size_t most_levels = 80;
inline constexpr std::size_t stack_size = (children - 1) * most_levels + 1;

/// A ray as boxes are tested with: x = o + t d for t >= 0. Slabs as in Ize 2013, "Robust BVH Ray Traversal": each has
/// three roundings on both sides, a relative error of 3 u, for which the far end is multiplied by 1 + 8 u.
class BoxRay {
public:
    /// Boxes are wider by `e` on each side: what the tests of items may be off by, and the rounding of o + e and o - e.
    /// A component of d below 1e-18 counts as that.
    BoxRay(Vec3f o, Vec3f d, float e) {
        for (std::size_t k = 0; k < 3; ++k) {
            const float x = axis_of(d, k), inverse = 1 / (std::fabs(x) < 1e-18f ? std::copysign(1e-18f, x) : x);
            forward_[k] = inverse > 0;
            inverse_[k] = inverse;
            near_[k] = axis_of(o, k) + (forward_[k] ? e : -e);
            far_[k] = axis_of(o, k) - (forward_[k] ? e : -e);
        }
    }

    /// Returns which boxes of a node are met at t <= t_max (a bit for each), and stores where they are entered.
    [[gnu::always_inline]] unsigned meets(
        const BvhNode& node, float t_max, std::array<float, children>& entries) const {
        F8 near = {}, far = near + t_max;
        cut(node.side, near, far);
        entries = std::bit_cast<std::array<float, children>>(near);
        return bits_of(near <= far * far_factor);
    }

    /// The same for the boxes of a leaf's items, which are met at t < t_max.
    [[gnu::always_inline]] unsigned meets(const LeafBoxes& boxes, float t_max) const {
        F4 near = {}, far = near + t_max;
        cut(boxes, near, far);
        return bits_of((near <= far * far_factor) & (near < all4(t_max)));
    }

    /// Returns where one box is entered, at least 0; infinity if it is not met at t <= t_max.
    float enters(const Bounds& box, float t_max) const {
        float near = 0, far = t_max;
        cut<float>({{{box.low.x, box.low.y, box.low.z}, {box.high.x, box.high.y, box.high.z}}}, near, far);
        return near <= far * far_factor ? near : infinity;
    }

private:
    /// Cuts [near, far] to the slabs of boxes, whose low and high sides are given by axis.
    template <class F>
    [[gnu::always_inline]] void cut(const std::array<std::array<F, 3>, 2>& side, F& near, F& far) const {
        for (std::size_t k = 0; k < 3; ++k) {
            const F a = (side[forward_[k] ? 0 : 1][k] - near_[k]) * inverse_[k],
                    b = (side[forward_[k] ? 1 : 0][k] - far_[k]) * inverse_[k];
            near = a > near ? a : near;
            far = b < far ? b : far;
        }
    }

    static constexpr float far_factor = 1 + 8 * static_cast<float>(unit_roundoff);
    std::array<float, 3> inverse_, near_, far_;
    std::array<bool, 3> forward_;
};

/// Calls test(leaf) for the leaves that the ray enters at t <= nearest, the nearer of a node's children first, until it
/// returns true; returns whether it did. `nearest` is read again after each test. Any order gives the same hits; this
/// one finds occluders in a tenth of the nodes. `fetch` is called with a leaf that may be tested soon.
template <class Test, class Fetch> [[gnu::always_inline]] inline bool visit_leaves(
    const HugeVector<BvhNode>& nodes, const BoxRay& ray, const float& nearest, const Test& test, const Fetch& fetch) {
    if (nodes.empty()) return false;
    // Where a child is entered, in the upper half, and the child: t >= 0 has the order of its bits.
    using Entry = std::uint64_t;
    const auto t_of = [](Entry e) __attribute__((always_inline)) {
        return std::bit_cast<float>(static_cast<std::uint32_t>(e >> 32));
    };
    std::array<Entry, stack_size> stack;
    std::size_t size = 0;
    Entry next = 0;
    for (;;) {
        if (const auto index = static_cast<std::int32_t>(static_cast<std::uint32_t>(next)); index >= 0) {
            const BvhNode& node = nodes[static_cast<std::size_t>(index)];
            std::array<float, children> entry;
            const std::size_t begin = size;
            unsigned bits = ray.meets(node, nearest, entry);
            const auto child_of = [&]() __attribute__((always_inline)) {
                const auto c = static_cast<std::size_t>(std::countr_zero(bits));
                bits &= bits - 1;
                const std::int32_t child = node.child[c];
                if (child < 0) fetch(static_cast<std::size_t>(~child));
                else __builtin_prefetch(&nodes[static_cast<std::size_t>(child)]);
                return Entry{std::bit_cast<std::uint32_t>(entry[c])} << 32 | static_cast<std::uint32_t>(child);
            };
            if (bits) {
                next = child_of();
                while (bits) {
                    const Entry other = child_of(), farther = other > next ? other : next;
                    next = other > next ? next : other;
                    std::size_t i = size++;  // the nearest last
                    for (; i > begin && stack[i - 1] < farther; --i) stack[i] = stack[i - 1];
                    stack[i] = farther;
                }
                continue;
            }
        } else if (test(static_cast<std::size_t>(~index))) {
            return true;
        }
        do {
            if (size == 0) return false;
            next = stack[--size];
        } while (t_of(next) > nearest);
    }
}

}  // namespace crescent
