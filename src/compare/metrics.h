// The metrics of one arm in the regions of a comparison.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "base/progress.h"
#include "compare/plan.h"
#include "compare/renders.h"
#include "compare/results.h"

namespace crescent {

/// The cost of one render of an arm, if known.
struct Cost {
    std::optional<double> seconds, spp;
};
/// Mean FLIP over a region's pixels, if there is a reference: of radiance, and of the photographs.
struct Flips {
    std::optional<double> hdr, ldr;
};

/// Returns FLIP of the arm's first render, one per region; empty values without a reference.
std::vector<Flips> measure_flip(
    const ComparePlan& plan, const RenderStats& stats, std::size_t arm, ProgressMonitor& monitor);

/// Returns every metric of one arm in one region.
RegionResult measure_region(
    const RenderStats& stats, const ArmStats& arm, std::size_t region, const Cost& cost, const Flips& flips);

/// Returns the mean over a region of the squared error of the reference's Y: over its files, else as its file states
/// it, else estimated by roughness() from its differences from the arms.
double reference_variance(const RenderStats& stats, std::size_t region);

}  // namespace crescent
