// Integrand + arm -> films, on all cores. Films are the same bits for any number of threads and any instruction set.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "render/film.h"
#include "render/kernel.h"
#include "render/tiles.h"
#include "samplers/external_sampler.h"
#include "scene/scene.h"

namespace crescent::inline render {

/// One film per sample count of n (ascending). `isa`: a name of isas(), "" for the best. `checkpoint` keeps finished
/// tiles.
std::vector<Film> estimate_films(const TiledScene& view, const SamplerRef& arm, const std::vector<std::uint64_t>& n,
    std::uint32_t seed, const std::string& isa, ProgressMonitor& monitor, TileCheckpoint* checkpoint = nullptr);

/// Sums over film.n samples -> the pixels of these shading points; film.invalid is the caller's to count.
void resolve_film(const Scene& scene, const ShadingPoints& shading_points, const Moments& moments, Film& film);

/// Which shape each pixel sees.
ShapeMap shape_map(const Scene& scene);

/// The `count` >= 1 largest samples X of one arm over the geometry pixels of a box, n samples each, in falling order.
/// `drawn` receives how many samples there were.
std::vector<float> largest_samples(const Scene& scene, const SamplerRef& arm, std::uint64_t n, std::uint32_t seed,
    const Box& box, std::size_t count, const std::string& isa, ProgressMonitor& monitor, std::uint64_t& drawn);

/// Runs a kernel over shading points that the caller made; moments of the last sample count only.
Moments estimate_points(const ShadingPoints& shading_points, const SamplerRef& arm, std::uint64_t n, std::uint32_t seed,
    const std::string& isa, const std::atomic<bool>* stop, float* samples = nullptr);

/// Calls work(k) for every tile k on all cores, except for those that the checkpoint holds; it returns what the tile
/// was worth in units of progress. Stops early when the monitor says so.
void for_each_tile(const std::vector<TileBox>& tiles, ProgressMonitor& monitor, TileCheckpoint* checkpoint,
    const std::function<double(std::size_t)>& work);

// ---- The kernels of samplers from outside: their draws are made first, in batches, and are then estimated like those
// of an built-in arm. Scalar code on every machine: the time goes into the sampler.

/// As a kernel of the table. A direction that is not of unit length to 1e-4 makes a bad sample, and so does a pdf that
/// cannot be used: NaN, negative, or in single precision infinite, or 0 though it is not 0 in double.
void estimate_external(const ExternalSampler& sampler, const KernelCall& call);

}  // namespace crescent::inline render
