// The interface of the SIMD kernels: input is one sampler, one BRDF and one tile's shading points; output is raw
// moments at every sample count.
//
//   X = f L_i cos / p     with   f = rho_d/pi + rho_s lobe   and   L_i one of few constants (the fill, each light),
//
// so RGB means follow from sums of g = cos/p and of g * lobe per emitter; only Y needs its square and its largest
// value. Light that varies, as that of a sky, has sums of g L and of g * lobe L per colour channel.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/vec.h"
#include "math/simd/scalar.h"
#include "render/shading_points.h"
#include "samplers/all.h"
#include "scene/lobes/all.h"

namespace crescent {

// ---- What a kernel needs of a combination whose samplers are all built in: a plain description, and functions that
// are compiled once for all instruction sets.

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

/// x within low and high.
CRESCENT_INLINE double clamped(double x, double low, double high) { return x < low ? low : x > high ? high : x; }
/// A random number in single precision, as built-in samplers take it: in (0, 1).
CRESCENT_INLINE float as_float(double u) {
    return static_cast<float>(clamped(static_cast<double>(static_cast<float>(u)), 0x1p-24, 1 - 0x1p-24));
}

/// Chooses one of `parts` parts by u and stretches u back to (0, 1); share(k): the probability of part k. A part of
/// probability 0 is never chosen.
template <class Share>
CRESCENT_INLINE double choose_part(const Share& share, std::size_t parts, double u, std::size_t& choice) {
    std::size_t last = 0, k = 0;
    for (std::size_t j = 0; j < parts; ++j)
        if (share(j) > 0) last = j;
    double start = 0;
    while (k < last && u >= start + share(k)) start += share(k++);
    choice = k;
    return clamped((u - start) / (k == last ? 1 - start : share(k)), 0x1p-53, 1 - 0x1p-53);
}

/// A combination whose samplers are all built in, as kernels take it.
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

/// Moments of n samples, one entry per shading point; sums are kept in double.
struct Moments {
    std::vector<double> g, g_lobe;                           // sum of g and of g * lobe over all samples
    std::vector<std::vector<double>> light_g, light_g_lobe;  // over the samples that met light k, disks first
    /// Over the samples that met light that varies: g, g * lobe, and both times L by colour channel. Empty without it.
    std::vector<double> around_g, around_g_lobe;
    std::array<std::vector<double>, 3> around_rgb, around_rgb_lobe;
    std::vector<double> spread;  // sum of (X - mean X)^2
    std::vector<float> largest;  // largest X
    std::vector<std::uint32_t> horizon, hits, bad;
    /// New entries are 0; kernels write all of them.
    void resize(const ShadingPoints& shading_points);
};

/// One call of a kernel: samples 0 to the last sample count of a sampler at all shading points, one after another.
/// Shading points and memory belong to the caller, who may make calls on several threads, each with its own `out` and
/// `memory`.
struct KernelCall {
    const ShadingPoints* shading_points = nullptr;
    std::span<const std::uint64_t> sample_counts;  // ascending
    std::uint32_t seed = 0;
    std::span<Moments> out;  // one per sample count, sized to the padded count
    const std::atomic<bool>* stop = nullptr;
    float* samples = nullptr;     // if not null: every X, sample k of shading point i at i * n + k
    std::byte* memory = nullptr;  // kernel_memory() bytes of the shading points
};

using Kernel = void (*)(const KernelCall&);
using CombinationKernel = void (*)(const KernelCall&, const CombinationCall&);

/// The kernels of one instruction set, by the index of the sampler in its list.
struct KernelTable {
    std::string_view isa;
    std::array<std::array<Kernel, Lobes::count + 1>, Samplers::count> of_lights;  // [lobe + 1]
    std::array<Kernel, Samplers::count> of_surroundings;                          // for points with surroundings
    std::array<CombinationKernel, 2> of_combinations;                             // without and with surroundings

    /// Returns the kernel for these points.
    Kernel kernel(int sampler, const ShadingPoints& points) const {
        const auto k = static_cast<std::size_t>(sampler);
        return points.around ? of_surroundings[k] : of_lights[k][static_cast<std::size_t>(points.lobe + 1)];
    }
};

/// Returns the instruction sets of kernel.cpp that this build has and this machine can run, best last.
std::vector<std::string> isas();
/// Returns all instruction sets of this processor family, for messages: "scalar, sse4, avx2, avx512".
std::string all_isas();
/// Returns the table for a name of isas(); "" means the best. Throws InputError for a name that is unknown or that the
/// machine lacks, OutputError for one that this build leaves out.
const KernelTable& kernels_for(const std::string& isa);
/// Returns the index in the list of samplers, or -1.
int arm_index(std::string_view sampler);

}  // namespace crescent
