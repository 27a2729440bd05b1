// Tests of two arms, or of an arm and the reference, for the same expectation.
#pragma once

#include <cstddef>
#include <string>

#include "base/progress.h"
#include "compare/plan.h"
#include "compare/renders.h"
#include "compare/results.h"

namespace crescent {

/// Returns the source of that error, in words.
std::string reference_error_from(const ArmStats& reference);

/// The level of a test of two arms, which all its tests share. `power_level`: of the stated power and of the
/// differences that cannot be detected. `report_level`: of the reported regions, tiles and pixels; larger if several
/// such tests share a level.
struct BiasLevel {
    double power_level, report_level;
};
/// Tests whether two arms (b = arms.size(): the reference) have the same expectation.
BiasResult test_bias(const ComparePlan& plan, const RenderStats& stats, const CompareResult& result, std::size_t a,
    std::size_t b, const BiasLevel& level, ProgressMonitor& monitor);

}  // namespace crescent
