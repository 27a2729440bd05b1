// What a kernel needs of a combination whose samplers are all built in: a plain description, and functions that are
// compiled once for all instruction sets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "base/vec.h"
#include "math/simd/scalar.h"

namespace crescent::inline render {

class Combination;
struct ShadingPoints;

/// Two random numbers in (0, 1) of a sample of a pixel; each block has others.
using PixelNumbers = std::function<Vec2<float>(std::uint32_t pixel, std::uint64_t sample, std::uint32_t block)>;

/// The most samplers of a combination.
inline constexpr std::size_t most_parts = 16;

/// The block of random numbers of pair `pair` of repetition `repeat` of sampler k. The first pair of the first sampler
/// is that of every built-in sampler, the first pair of the second that of a built-in pair of samplers; further pairs
/// come from blocks that no built-in sampler uses.
CRESCENT_INLINE std::uint32_t block_of(std::size_t k, std::size_t pair, std::size_t repeat) {
    constexpr std::uint32_t of_repetition = 1024;  // blocks: 16 samplers, at most 4 pairs each
    const auto sampler = static_cast<std::uint32_t>(k);
    if (repeat == 0 && pair == 0 && k < 2) return sampler;
    return static_cast<std::uint32_t>(repeat) * of_repetition + 16 * (sampler + 1) + static_cast<std::uint32_t>(pair);
}

CRESCENT_INLINE double clamped(double x, double low, double high) { return x < low ? low : x > high ? high : x; }
/// A random number in single precision, as built-in samplers take it: in (0, 1).
CRESCENT_INLINE float as_float(double u) {
    return static_cast<float>(clamped(static_cast<double>(static_cast<float>(u)), 0x1p-24, 1 - 0x1p-24));
}

/// Chooses one of `parts` parts by u and stretches u back to (0, 1); share(k): the probability of part k. A part of
/// probability 0 is never chosen.
template <class Share>
CRESCENT_INLINE double choose_part(const Share& share, std::size_t parts, double u, std::size_t& chosen) {
    std::size_t last = 0, k = 0;
    for (std::size_t j = 0; j < parts; ++j)
        if (share(j) > 0) last = j;
    double below = 0;
    while (k < last && u >= below + share(k)) below += share(k++);
    chosen = k;
    return clamped((u - below) / (k == last ? 1 - below : share(k)), 0x1p-53, 1 - 0x1p-53);
}

struct CombinationCall {
    /// A direction of each sampler, weighted; of one sampler, weighted; of one sampler, by the density of the mixture.
    enum class Form { every, one, mixture };

    const Combination* combination = nullptr;
    Form form = Form::every;
    bool power = false;        // the power heuristic, else the balance heuristic
    bool has_weights = false;  // weights() in place of a heuristic
    std::size_t samplers = 0;
    const int* sampler = nullptr;            // their indices in samplers/all.h
    const std::uint64_t* repeats = nullptr;  // of Form::every: directions of each
    const PixelNumbers* numbers = nullptr;   // null: those of films

    /// Writes with which probability, or with which share of the mixture, each sampler is chosen at a point.
    void shares(const ShadingPoints& points, std::size_t point, double* out) const;
    /// The weight of a direction of sampler k from the densities of all samplers.
    double weight(const ShadingPoints& points, std::size_t point, std::size_t k, float cos_i, const double* p) const;
    /// Two random numbers for each of `count` pixels.
    void read_numbers(const std::uint32_t* pixel, std::size_t count, std::uint64_t sample, std::uint32_t block,
        float* x, float* y) const;
};

}  // namespace crescent::inline render
