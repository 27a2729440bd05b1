// Random numbers as a pure function of (seed, pixel, sample, dimension): pcg4d of Jarzynski & Olano 2020, "Hash
// Functions for GPU Rendering", JCGT 9(3). One call serves two neighbouring samples and two dimensions; there is no
// state, so threads, lanes, ranks and sample counts cannot change a draw.
#pragma once

#include <cstdint>

#include "base/vec.h"
#include "math/simd/scalar.h"

namespace crescent {

/// Four unsigned 32-bit integers, or packs of them.
template <class U> struct Vec4u {
    U x, y, z, w;
};

/// A hash of 128 bits to 128 bits: Jarzynski & Olano 2020, "Hash Functions for GPU Rendering", JCGT 9(3), listing
/// pcg4d.
template <class U> CRESCENT_INLINE Vec4u<U> pcg4d(Vec4u<U> v) {
    const U a(1664525u), c(1013904223u);
    v = {v.x * a + c, v.y * a + c, v.z * a + c, v.w * a + c};
    v.x = v.x + v.y * v.w;
    v.y = v.y + v.z * v.x;
    v.z = v.z + v.x * v.y;
    v.w = v.w + v.y * v.z;
    v = {
        v.x ^ shift_right<16>(v.x), v.y ^ shift_right<16>(v.y), v.z ^ shift_right<16>(v.z), v.w ^ shift_right<16>(v.w)};
    v.x = v.x + v.y * v.w;
    v.y = v.y + v.z * v.x;
    v.z = v.z + v.x * v.y;
    v.w = v.w + v.y * v.z;
    return v;
}

/// u = (2k + 1) / 2^24 from the upper 23 bits: centred, so that neither 0 nor 1 is ever drawn. Smallest u: 2^-24.
template <class F> CRESCENT_INLINE F unit_float(UintOf<F> h) {
    return to_float<F>(shift_right<8>(h) | UintOf<F>(1u)) * number<F>(0x1p-24);
}

/// The four integers behind samples 2 `pair` and 2 `pair` + 1: (x, y) for the even one, (z, w) for the odd one.
/// `block` counts pairs of dimensions: dimensions 0 and 1 are block 0, 2 and 3 block 1.
template <class U>
CRESCENT_INLINE Vec4u<U> draws(U pixel, std::uint32_t pair, std::uint32_t block, std::uint32_t seed) {
    return pcg4d(Vec4u<U>{pixel, U(pair), U(block), U(seed)});
}

/// The same for one sample, for callers that draw one by one.
inline Vec2<float> draw(std::uint32_t seed, std::uint32_t pixel, std::uint64_t sample, std::uint32_t block = 0) {
    const auto h = draws<std::uint32_t>(pixel, static_cast<std::uint32_t>(sample >> 1), block, seed);
    return sample & 1 ? Vec2<float>{unit_float<float>(h.z), unit_float<float>(h.w)}
                      : Vec2<float>{unit_float<float>(h.x), unit_float<float>(h.y)};
}

/// Seeds of a series: the first is the given one, the others are hashed from it.
inline std::uint32_t seed_of(std::uint32_t first, std::uint32_t index) {
    return index == 0 ? first : pcg4d(Vec4u<std::uint32_t>{first, index, 0x5eedu, 0u}).x;
}

}  // namespace crescent
