// White furnaces: L_i = 1 everywhere and R = n, so that the answer is known: rho_d + rho_s, or rho_s for the lobe
// alone.
#pragma once

#include <string>
#include <vector>

#include "arms/outside.h"
#include "base/progress_monitor.h"
#include "experiment/experiment.h"
#include "experiment/published.h"
#include "meters/metrics.h"

namespace crescent::inline studies {

/// What a furnace drew: its meter but for the tail, and every X.
struct FurnaceDraws {
    FurnaceMeter meter;
    std::vector<float> samples;
};
/// One furnace of the experiment in two steps, between which a page may answer its reader; `plan` may have another n.
FurnaceDraws draw_furnace(const Experiment& experiment, const FurnacePlan& plan, const std::string& isa,
    ProgressMonitor& monitor, const OutsideSamplers& outside = {});
FurnaceMeter read_furnace(FurnaceDraws draws);

/// Every furnace of the experiment, measured. Throws Interrupted when the monitor says stop.
std::vector<FurnaceMeter> furnaces(const Experiment& experiment, const Published* published, const std::string& isa,
    ProgressMonitor& monitor, const OutsideSamplers& outside = {});

}  // namespace crescent::inline studies
