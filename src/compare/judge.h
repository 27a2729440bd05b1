// Readings -> results: the steps that compare() takes, each usable alone.
#pragma once

#include "compare/plan.h"
#include "compare/results.h"

namespace crescent {

/// Every meter of one arm in one region. `flip`: the mean over the region's pixels, where there is a reference.
RegionResult measure_region(const Readings& all, const ArmReadings& arm, std::size_t region,
    const std::optional<double>& seconds, const std::optional<double>& flip);

/// Root mean square standard error of the reference's Y over a region; NaN where nothing tells it.
double reference_error(const Readings& all, std::size_t region);

/// Whether two arms (b = arms.size(): the reference) have the same expectation; `alpha` is shared by all its tests.
BiasResult judge_bias(const ComparePlan& plan, const Readings& all, const CompareResult& measured, std::size_t a,
    std::size_t b, double alpha);

/// Where the variance of arm a differs from that of b.
NoiseResult judge_noise(const ComparePlan& plan, const Readings& all, std::size_t a, std::size_t b, double alpha);

/// Pairs of renders of two arms with the same number in their names: indices into their files. Throws InputError where
/// a render has no partner.
std::vector<std::pair<std::size_t, std::size_t>> pairs_of(const ArmReadings& a, const ArmReadings& b);

/// Measures, tests and judges everything that the plan asks.
CompareResult judge(const ComparePlan& plan, const Readings& all, Watch& watch);

}  // namespace crescent
