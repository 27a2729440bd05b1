// Random numbers of the engine. A stream is one column of pcg4d (simd/random.h), which is a bijection of 128 bits: the
// key fills three words, the position the fourth. Two streams whose keys differ in any field therefore share no block,
// and stage 2 cannot reuse the numbers of stage 1.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>

#include "samplers/domains/sphere_chart.h"
#include "check/sources/check_case.h"
#include "math/simd/random.h"

namespace crescent::check {

/// The use of the numbers of a stream.
enum class Purpose : std::uint8_t { pilot, tree, points, draws, scrambles, pairs, corners, jacobian, light };

/// Fields, not a hash: distinct by construction. `place` is the index of the case in a call; `stage` is 1 or 2; `part`
/// is the index of a look or replicate.
struct StreamKey {
    std::uint32_t seed = 1;
    std::uint16_t place = 0;
    std::uint8_t technique = 0, stage = 1;
    Purpose purpose = Purpose::pilot;
    std::uint16_t part = 0;

    /// The key of a stage that confirms another one; `regrown` is the first stage on a second tree, `further` that on
    /// the tree of a check that goes on.
    static constexpr std::uint8_t regrown = 9, further = 17;
    bool confirms() const { return stage != 1 && stage != regrown && stage != further; }

    Vec4u<std::uint32_t> block(std::uint32_t index) const {
        const std::uint32_t location =
            std::uint32_t{place} | std::uint32_t{technique} << 16 | std::uint32_t{stage} << 24;
        return pcg4d(Vec4u<std::uint32_t>{index, location, static_cast<std::uint32_t>(purpose) << 16 | part, seed});
    }
};

/// (k + 1/2) / 2^32, at most 1 - 2^-24, so that no float conversion of it is 1.
inline double unit_number(std::uint32_t k) { return std::min((k + 0.5) * 0x1p-32, 1 - 0x1p-24); }
/// The number for a sampler in single precision: an odd multiple of 2^-24, as the estimator draws them.
inline double single_number(double u) {
    return static_cast<double>(static_cast<std::uint32_t>(u * 0x1p24) | 1u) * 0x1p-24;
}

/// The resolution of random numbers: odd multiples of 2^-24, for a sampler in single precision; 32 bits; or odd
/// multiples of 2^-53, for a sampler that asks for them.
enum class Resolution { single, standard, fine };
inline Resolution resolution_of(const Traits& traits) {
    return traits.u_bits == 53 ? Resolution::fine : traits.bits == 24 ? Resolution::single : Resolution::standard;
}
/// From 32 bits, and 32 more that only a fine number uses.
inline double number_of_bits(std::uint32_t bits, std::uint32_t extra_bits, Resolution resolution) {
    if (resolution == Resolution::standard) return unit_number(bits);
    if (resolution == Resolution::single) return single_number(unit_number(bits));
    return static_cast<double>((std::uint64_t{bits} << 21 | extra_bits >> 11) | 1u) * 0x1p-53;
}

/// Numbers of a stream in order.
class Stream {
public:
    explicit Stream(StreamKey key) : key_(key) {}
    std::uint32_t bits() {
        if (position_ % 4 == 0) block_ = key_.block(position_ / 4);
        const std::uint32_t lane = position_++ % 4;
        return lane == 0 ? block_.x : lane == 1 ? block_.y : lane == 2 ? block_.z : block_.w;
    }
    double number() { return unit_number(bits()); }

private:
    StreamKey key_;
    std::uint32_t position_ = 0;
    Vec4u<std::uint32_t> block_{};
};

/// Uniform above the horizon by at least `least_z`, or below it.
inline Vec3d random_direction(Stream& stream, bool is_below, double least_z) {
    const double z = least_z + (1 - least_z) * stream.number();
    return from_chart({is_below ? 1 + z : 1 - z, two_pi * stream.number()});
}

/// The random numbers of sample i of a stream, by position: blocks 2 i and 2 i + 1; the further bits of fine numbers
/// are in the blocks from 2^31 on.
inline PrimarySample numbers_at(const StreamKey& key, std::uint32_t i, int count, Resolution resolution) {
    PrimarySample out;
    for (int half = 0; half < (count > 4 ? 2 : 1); ++half) {
        const std::uint32_t block = 2 * i + static_cast<std::uint32_t>(half);
        const Vec4u<std::uint32_t> b = key.block(block),
                                   c = resolution == Resolution::fine ? key.block(block | 1u << 31)
                                                                      : Vec4u<std::uint32_t>{};
        const std::uint32_t lanes[4] = {b.x, b.y, b.z, b.w}, extra_bits[4] = {c.x, c.y, c.z, c.w};
        for (int k = 0; k < 4; ++k) out[4 * half + k] = number_of_bits(lanes[k], extra_bits[k], resolution);
    }
    return out;
}

/// The first `count` of them, in the resolution of the sampler.
inline std::vector<PrimarySample> first_numbers(const StreamKey& key, std::uint32_t count, const Traits& traits) {
    std::vector<PrimarySample> u(count);
    for (std::uint32_t i = 0; i < count; ++i)
        u[i] = numbers_at(key, i, std::max(traits.numbers, 1), resolution_of(traits));
    return u;
}

// ---- Sobol points in eight dimensions, the directions of Joe and Kuo 2008 ("Constructing Sobol sequences with better
// two-dimensional projections", new-joe-kuo-6.21201), each dimension Owen-scrambled by a hash: Laine and Karras 2011,
// "Stratified sampling for stochastic transparency", with the constants of Vegdahl 2021.

using SobolMatrix = std::array<std::array<std::uint32_t, 32>, PrimarySample::most_numbers>;

/// Directions v[dimension][bit].
constexpr SobolMatrix sobol_matrix() {
    struct Line {
        int s;
        std::uint32_t a, m[5];
    };
    constexpr Line lines[PrimarySample::most_numbers - 1] = {{1, 0, {1}}, {2, 1, {1, 3}}, {3, 1, {1, 3, 1}},
        {3, 2, {1, 1, 1}}, {4, 1, {1, 1, 3, 3}}, {4, 4, {1, 3, 5, 13}}, {5, 2, {1, 1, 5, 5, 17}}};
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
            const std::uint32_t previous = v[d][static_cast<std::size_t>(i - line.s)];
            to = previous ^ (previous >> line.s);
            for (int j = 1; j < line.s; ++j)
                if (line.a >> (line.s - 1 - j) & 1) to ^= v[d][static_cast<std::size_t>(i - j)];
        }
    }
    return v;
}

/// One dimension of point i of the sequence, as 32 bits.
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
constexpr std::uint32_t owen_of_reversed(std::uint32_t x, std::uint32_t seed) {
    x += seed;
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    x ^= x * 0x8d22f6e6u;
    return reversed_bits(x);
}
constexpr std::uint32_t owen_scrambled(std::uint32_t x, std::uint32_t seed) {
    return owen_of_reversed(reversed_bits(x), seed);
}

/// steps[dimension][k]: the change of a number with its bits reversed, from point i to i + 1, where i + 1 is divisible
/// by 2^k and not by 2^(k + 1): i and i + 1 differ in the bits 0 to k.
constexpr SobolMatrix reversed_sobol_steps() {
    SobolMatrix out = sobol_matrix();
    for (auto& v : out) {
        std::uint32_t x = 0;
        for (std::uint32_t& step : v) step = x ^= reversed_bits(step);
    }
    return out;
}

/// Sets of Sobol points with independent scrambles, so that their means are independent replicates.
class ScrambledSobol {
public:
    /// `key` selects the set.
    ScrambledSobol(const StreamKey& key, int count, Resolution resolution) : count_(count), resolution_(resolution) {
        Stream stream(key);
        for (std::uint32_t& s : seeds_) s = stream.bits();
    }
    /// Points `from` to `from + out.size()`.
    void points(std::uint32_t from, std::span<PrimarySample> out) const {
        static constexpr SobolMatrix steps = reversed_sobol_steps();
        std::ranges::fill(out, PrimarySample());
        for (int d = 0; d < count_; ++d) {
            const auto& step = steps[static_cast<std::size_t>(d)];
            const std::uint32_t seed = seeds_[static_cast<std::size_t>(d)];
            std::uint32_t x = reversed_bits(sobol(from, d)), i = from;
            for (PrimarySample& u : out) {
                const std::uint32_t extra_bits = resolution_ == Resolution::fine
                    ? pcg4d(Vec4u<std::uint32_t>{i, static_cast<std::uint32_t>(d), seed, 0}).x
                    : 0;
                u[d] = number_of_bits(owen_of_reversed(x, seed), extra_bits, resolution_);
                ++i;
                if (i != 0) x ^= step[static_cast<std::size_t>(std::countr_zero(i))];
            }
        }
    }
    PrimarySample at(std::uint32_t i) const {
        PrimarySample out;
        points(i, {&out, 1});
        return out;
    }

private:
    std::array<std::uint32_t, PrimarySample::most_numbers> seeds_{};
    int count_;
    Resolution resolution_;
};

}  // namespace crescent::check
