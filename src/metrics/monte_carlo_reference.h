// The published recipe for a reference: analytic Lambert x fill, the lobe x fill by sampling the lobe, the lights by
// next-event estimation, on streams that no arm has; states its standard error per pixel, and all that a lobe may hold
// where it is too narrow for that many samples on a light.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/progress.h"
#include "experiment/experiment.h"
#include "render/film.h"
#include "render/tiles.h"

namespace crescent::inline metrics {

/// Seed k of the article's reference: hashed from its own, and none of those that the experiment's arms draw from,
/// however many seeds are run.
std::uint32_t reference_seed(const Experiment& experiment, std::uint32_t k);

/// One film a view, which are the same but for their exponents, see views_at. `experiment`: whose reference it is; says
/// how many samples, and which seeds. `checkpoint` keeps finished tiles.
std::vector<ReferenceFilm> monte_carlo_reference(const std::vector<TiledScene>& views, const Experiment& experiment,
    const std::string& isa, ProgressMonitor& monitor, TileCheckpoint* checkpoint = nullptr);

}  // namespace crescent::inline metrics
