// Computes films from a scene and a sampler, on all cores. Films have the same bits for any number of threads and any
// instruction set.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/progress.h"
#include "render/combination.h"
#include "render/film.h"
#include "render/kernel.h"
#include "render/tiles.h"
#include "samplers/sampler_adapter.h"
#include "scene/scene.h"

namespace crescent {

/// Returns what a sample costs.
SampleCost cost_of_sample(const SamplerRef& arm);

/// Returns one film for each sample count of n (ascending). `isa`: a name of isas(), "" for the best.
std::vector<Film> estimate_films(const TiledScene& view, const SamplerRef& arm, const std::vector<std::uint64_t>& n,
    std::uint32_t seed, const std::string& isa, ProgressMonitor& monitor);

/// Converts sums over film.n samples to the pixels of these shading points. The caller counts film.invalid.
void resolve_film(const Scene& scene, const ShadingPoints& shading_points, const Moments& moments, Film& film);

/// Calls f(pixel, radiance) for each pixel of a box in which the camera sees the sky; pixel = i + j * width of the
/// image.
template <class F> void for_each_background(const Scene& scene, const TileBox& box, F&& f) {
    if (!scene.has_background()) return;
    const auto width = static_cast<std::uint32_t>(scene.image().width);
    for (int j = box.y0; j < box.y1; ++j)
        for (int i = box.x0; i < box.x1; ++i)
            if (!scene.sees_surface(i, j))
                f(static_cast<std::uint32_t>(i) + static_cast<std::uint32_t>(j) * width, scene.background(i, j));
}
/// Stores what the camera sees without a surface: known, so without variance and without samples.
void store_background(Film& film, std::size_t index, const Rgb& radiance);

/// Returns the mean radiance of shading point i over the n samples of `moments`.
Rgb mean_radiance(
    const Scene& scene, const ShadingPoints& shading_points, const Moments& moments, std::uint64_t n, std::size_t i);

/// Returns the shape that each pixel sees.
ShapeMap shape_map(const Scene& scene);

/// Returns the `count` >= 1 largest samples X of one sampler over the geometry pixels of an area, n samples each, in
/// descending order. `sample_count` receives the number of samples.
std::vector<float> largest_samples(const Scene& scene, const SamplerRef& arm, std::uint64_t n, std::uint32_t seed,
    const Area& area, std::size_t count, const std::string& isa, ProgressMonitor& monitor, std::uint64_t& sample_count);

/// Runs a kernel over shading points made by the caller and returns the moments of the last sample count.
Moments estimate_points(const ShadingPoints& shading_points, const SamplerRef& arm, std::uint64_t n, std::uint32_t seed,
    const std::string& isa, const std::atomic<bool>* stop, float* samples = nullptr);

/// The same for several sample counts (ascending), one entry for each.
std::vector<Moments> estimate_points(const ShadingPoints& shading_points, const SamplerRef& arm,
    std::span<const std::uint64_t> n, std::uint32_t seed, const std::string& isa, const std::atomic<bool>* stop,
    float* samples = nullptr);

/// Calls work(k) for every tile k on all cores; work returns the tile's units of progress. Stops early if the monitor
/// requests it.
void for_each_tile(
    const std::vector<TileBox>& tiles, ProgressMonitor& monitor, const std::function<double(std::size_t)>& work);

// ---- Kernels of external samplers: their draws are made first, in batches, and then estimated like those of a
// built-in sampler, in scalar code, because the sampler itself takes most of the time.

/// Has the form of a kernel of the table. A sample is bad if its direction is not of unit length to 1e-4, or if its pdf
/// is NaN, negative, infinite in single precision, or 0 in single precision but not in double.
void estimate_external(const SamplerAdapter& sampler, const KernelCall& call);

}  // namespace crescent
