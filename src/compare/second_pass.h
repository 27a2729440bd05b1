// Renders one after another, and what the second walk through them reads.
#pragma once

#include "compare/renders.h"

namespace crescent::inline comparing {

/// Reads each file in turn and hands it on, the next one being read meanwhile: two renders in memory at a time.
void each_render(const RenderSource& source, const std::vector<std::string>& paths, const std::string& layer,
    ProgressMonitor& monitor, const std::function<void(const Render&)>& use);

/// What each render of an arm (or the reference) says of each region and tile; its means must be known. Errors are
/// measured where a `reference` is given.
void second_pass(const ComparePlan& plan, const Readings& all, const RenderSource& source, ArmReadings& arm,
    const std::string& layer, const MeanFilm* reference, ProgressMonitor& monitor);

}  // namespace crescent::inline comparing
