// The interface of the SIMD kernels: input is one sampler, one BRDF and one tile's shading points; output is raw
// moments at every sample count.
//
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
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "render/combination_call.h"
#include "render/shading_points.h"
#include "samplers/all.h"
#include "scene/lobes/all.h"

namespace crescent::inline render {

/// Moments of n samples, one entry per shading point; sums are kept in double.
struct Moments {
    std::vector<double> g, g_lobe;                           // sum of g and of g * lobe over all samples
    std::vector<std::vector<double>> light_g, light_g_lobe;  // over the samples that met light k, disks first
    /// Over the samples that met light that varies: g, g * lobe, and both times L by colour channel. Empty without it.
    std::vector<double> around_g, around_g_lobe;
    std::array<std::vector<double>, 3> around, around_lobe;
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

/// Returns the instruction sets of isas.h that this machine can run, best last.
std::vector<std::string> isas();
/// Returns all instruction sets of this build, for messages: "scalar, sse4, avx2, avx512".
std::string all_isas();
/// Returns the table for a name of isas(); "" means the best. Throws InputError for an unknown or unsupported name.
const KernelTable& kernels_for(const std::string& isa);
/// Returns the index in the list of samplers, or -1.
int arm_index(std::string_view sampler);

}  // namespace crescent::inline render
