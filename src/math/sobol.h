// Points of the first two dimensions of Sobol's sequence, scrambled as Owen does, as a function of their index and a
// seed. Direction numbers of Joe & Kuo 2008, "Constructing Sobol Sequences with Better Two-Dimensional Projections":
// the first dimension is the radical inverse, the second has the primitive polynomial x + 1 with m_1 = 1.
//
// The scrambling is hash-based: Laine & Karras 2011, "Stratified Sampling for Stochastic Transparency", as Burley 2020,
// "Practical Hash-based Owen Scrambling", JCGT 9(4), applies it, with the constants of Vegdahl 2021. It permutes as a
// nested uniform scrambling does, but is not exactly uniform over seeds; a random digital shift on top makes every
// point uniform, so that an estimate is unbiased, and keeps the nesting.
#pragma once

#include <cstdint>

#include "math/simd/random.h"

namespace crescent::math {

constexpr std::uint32_t reversed_bits(std::uint32_t x) {
    x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
    x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
    x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
    return (x >> 16) | (x << 16);
}

/// Each output bit depends on the bits below it alone: with reversed bits, on those before it.
constexpr std::uint32_t laine_karras(std::uint32_t x, std::uint32_t seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

/// The second dimension of Sobol's sequence, as a 32-bit fraction.
constexpr std::uint32_t sobol_second(std::uint32_t index) {
    std::uint32_t out = 0;
    for (std::uint32_t direction = 0x80000000u; index; index >>= 1, direction ^= direction >> 1)
        if (index & 1u) out ^= direction;
    return out;
}

/// Point `index` of a scrambled sequence, each coordinate in (0, 1) with 23 bits.
inline Vec2<float> scrambled_sobol(std::uint32_t index, Vec4u<std::uint32_t> seed) {
    const std::uint32_t x = reversed_bits(laine_karras(index, seed.x)) ^ seed.z;
    const std::uint32_t y = reversed_bits(laine_karras(reversed_bits(sobol_second(index)), seed.y)) ^ seed.w;
    return {unit_float<float>(x), unit_float<float>(y)};
}

}  // namespace crescent::math
