// crescent compare: computes metrics with their uncertainty, bias tests, plates and a report from renders of other
// programs.
#pragma once

#include "base/progress.h"
#include "compare/plan.h"
#include "compare/results.h"
#include "report/report.h"

namespace crescent {

// ---- From RenderStats to results: the steps of compare_renders(), each usable alone.

/// Returns the metrics of one arm in all regions.
ArmResult measure_arm(const ComparePlan& plan, const RenderStats& stats, std::size_t arm, ProgressMonitor& monitor);

/// Finds where the variance of arm a differs from that of b.
NoiseResult compare_noise(
    const ComparePlan& plan, const RenderStats& stats, std::size_t a, std::size_t b, double alpha);

/// Ranks the arms by variance at equal time or at equal samples, in each region.
std::vector<Ranking> rank(const CompareResult& result);

/// The metric of a ladder, of those of one arm in a region, and its name: the RMSE; without a reference, the standard
/// deviation. Both fall as N^-0.5 with independent samples.
MetricValue ladder_metric(const MetricValue& rmse, const MetricValue& var);
const char* ladder_metric_name(const MetricValue& rmse);
/// Finds arms that are one sampler at several samples per pixel, by their names: "path-16" at 16, "path-64" at 64.
std::vector<SppLadder> ladders_of(const CompareResult& result);

/// Computes the metrics and tests of the plan and checks its assertions.
CompareResult test_differences(const ComparePlan& plan, const RenderStats& stats, ProgressMonitor& monitor);

/// The folder of the outputs.
struct CompareOptions {
    std::string out = "out/compare";
};

/// Reads and measures the renders and writes all outputs to options.out, which appear all at once. `summary` receives
/// the text for the terminal. Throws InputError, OutputError, Interrupted.
CompareResult compare_renders(const ComparePlan& plan, const CompareOptions& options, const Provenance& provenance,
    ProgressMonitor& monitor, std::string& summary);

}  // namespace crescent
