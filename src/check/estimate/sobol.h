// Sobol points in eight dimensions, the directions of Joe and Kuo 2008 ("Constructing Sobol sequences with better
// two-dimensional projections", new-joe-kuo-6.21201), each dimension Owen-scrambled by a hash: Laine and Karras 2011,
// "Stratified sampling for stochastic transparency", with the constants of Vegdahl 2021.
#pragma once

#include <array>
#include <cstdint>

#include "check/estimate/stream.h"

namespace crescent::check {

using SobolMatrix = std::array<std::array<std::uint32_t, 32>, PrimarySample::most>;

/// Directions v[dimension][bit].
constexpr SobolMatrix sobol_matrix() {
    struct Line {
        int s;
        std::uint32_t a, m[5];
    };
    constexpr Line lines[PrimarySample::most - 1] = {{1, 0, {1}}, {2, 1, {1, 3}}, {3, 1, {1, 3, 1}}, {3, 2, {1, 1, 1}},
        {4, 1, {1, 1, 3, 3}}, {4, 4, {1, 3, 5, 13}}, {5, 2, {1, 1, 5, 5, 17}}};
    SobolMatrix v{};
    for (int i = 0; i < 32; ++i) v[0][static_cast<std::size_t>(i)] = 1u << (31 - i);
    for (std::size_t d = 1; d < v.size(); ++d) {
        const Line& line = lines[d - 1];
        for (int i = 0; i < 32; ++i) {
            std::uint32_t& to = v[d][static_cast<std::size_t>(i)];
            if (i < line.s) {
                to = line.m[i] << (31 - i);
                continue;
            }
            const std::uint32_t back = v[d][static_cast<std::size_t>(i - line.s)];
            to = back ^ (back >> line.s);
            for (int j = 1; j < line.s; ++j)
                if (line.a >> (line.s - 1 - j) & 1) to ^= v[d][static_cast<std::size_t>(i - j)];
        }
    }
    return v;
}

/// Point i of the sequence, one dimension of it, as 32 bits.
inline std::uint32_t sobol(std::uint32_t i, int dimension) {
    static constexpr SobolMatrix matrix = sobol_matrix();
    const auto& v = matrix[static_cast<std::size_t>(dimension)];
    std::uint32_t x = 0;
    for (std::size_t bit = 0; i; i >>= 1, ++bit)
        if (i & 1) x ^= v[bit];
    return x;
}

constexpr std::uint32_t reversed_bits(std::uint32_t x) {
    x = x >> 16 | x << 16;
    x = (x & 0x00ff00ffu) << 8 | (x & 0xff00ff00u) >> 8;
    x = (x & 0x0f0f0f0fu) << 4 | (x & 0xf0f0f0f0u) >> 4;
    x = (x & 0x33333333u) << 2 | (x & 0xccccccccu) >> 2;
    return (x & 0x55555555u) << 1 | (x & 0xaaaaaaaau) >> 1;
}

/// A nested uniform scramble: each bit is flipped by a hash of the bits above it.
constexpr std::uint32_t owen_scrambled(std::uint32_t x, std::uint32_t seed) {
    x = reversed_bits(x) + seed;
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    x ^= x * 0x8d22f6e6u;
    return reversed_bits(x);
}

/// Sets of Sobol points that are scrambled independently of one another: their means are independent replicates.
class ScrambledSobol {
public:
    /// `key` names the set.
    ScrambledSobol(const StreamKey& key, int count, bool single) : count_(count), single_(single) {
        Stream stream(key);
        for (std::uint32_t& s : seeds_) s = stream.bits();
    }
    PrimarySample at(std::uint32_t i) const {
        PrimarySample out;
        for (int d = 0; d < count_; ++d) {
            const double u = unit_number(owen_scrambled(sobol(i, d), seeds_[static_cast<std::size_t>(d)]));
            out[d] = single_ ? single_number(u) : u;
        }
        return out;
    }

private:
    std::array<std::uint32_t, PrimarySample::most> seeds_{};
    int count_;
    bool single_;
};

}  // namespace crescent::check
