// The published method for a reference: analytic Lambert x fill, the lobe x fill by sampling the lobe, the lights by
// next-event estimation, on streams that no arm uses. It states its standard error per pixel, plus the whole
// contribution of a lobe that is too narrow for that many samples on a light.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/progress.h"
#include "experiment/experiment.h"
#include "render/film.h"
#include "render/reference/paired.h"
#include "render/tiles.h"

namespace crescent {

/// Returns seed k of the article's reference: hashed from its own, and different from those of the experiment's arms
/// for any number of seeds.
std::uint32_t reference_seed(const Experiment& experiment, std::uint32_t k);

/// Its seeds follow those of the article's reference, of which there is one for the lobe and one for each light.
PairedPlan paired_plan(const Experiment& experiment);

/// Returns one film per view; the views differ only in their exponents, see views_at. `experiment` gives the sample
/// counts and seeds.
std::vector<ReferenceFilm> monte_carlo_reference(const std::vector<TiledScene>& views, const Experiment& experiment,
    const std::string& isa, ProgressMonitor& monitor);

}  // namespace crescent
