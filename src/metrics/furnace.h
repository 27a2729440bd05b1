// White furnaces: L_i = 1 everywhere and R = n, so that the expected value is known: rho_d + rho_s, or rho_s for the
// lobe alone.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "experiment/experiment.h"
#include "experiment/published.h"
#include "math/statistics.h"
#include "metrics/metrics.h"
#include "render/shading_points.h"
#include "samplers/sampler_adapter.h"
#include "scene/scene.h"
#include "scene/scene_data.h"

namespace crescent {

/// The draws of a furnace: its metric except the tail, and every X.
struct FurnaceDraws {
    FurnaceResult metric;
    std::vector<float> samples;
};
/// Computes one furnace of the experiment in two steps, between which a page may handle input; `plan` may have another
/// n.
FurnaceDraws draw_furnace(const Experiment& experiment, const FurnacePlan& plan, const std::string& isa,
    ProgressMonitor& monitor, const ExternalSamplers& external = {});
FurnaceResult read_furnace(FurnaceDraws draws);

/// Returns every furnace of the experiment, measured. Throws Interrupted if the monitor requests a stop.
std::vector<FurnaceResult> furnaces(const Experiment& experiment, const Published* published, const std::string& isa,
    ProgressMonitor& monitor, const ExternalSamplers& external = {});

// ---- Surface points in a white furnace: L_i = 1 over the whole hemisphere, no disk, by default seen from directly
// above.

/// Returns the material of a shape, with the scene's own s if it has none; lobe_only drops rho_d.
Surface furnace_surface(const SceneData& scene, const Material& material, bool lobe_only);

/// Returns `count` equal shading points, each with its own random numbers. X = (cos/p) f.
ShadingPoints furnace_points(const Surface& surface, std::size_t count, double cos_o = 1);

// ---- The tail index of one arm's samples in an area of the image.

/// How an area of the image is sampled: n samples per pixel, about four million in all, of which the largest are used:
/// `largest_count` of them, 0 if too few vary.
struct TailPlan {
    std::uint64_t n = 0;
    std::size_t largest_count = 0;
};
TailPlan tail_plan(std::uint64_t pixels);

/// Returns the tail index of one arm's samples X in an area, as tail_plan() defines; none if too few vary. May throw
/// Interrupted.
std::optional<Tail> region_tail(const Scene& scene, const SamplerRef& arm, std::uint32_t seed, const AreaPixels& pixels,
    const std::string& isa, ProgressMonitor& monitor);

}  // namespace crescent
