// crescent compare: computes metrics with their uncertainty, bias tests, plates and a report from renders of other
// programs.
#pragma once

#include "base/progress.h"
#include "compare/outputs.h"
#include "compare/plan.h"
#include "compare/results.h"

namespace crescent {

// ---- From RenderStats to results: the steps of compare_renders(), each usable alone.

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

/// Returns the metrics of one arm in all regions.
ArmResult measure_arm(const ComparePlan& plan, const RenderStats& stats, std::size_t arm, ProgressMonitor& monitor);

/// Returns the mean over a region of the squared error of the reference's Y: over its files, else as its file states
/// it, else estimated by roughness() from its differences from the arms.
double reference_variance(const RenderStats& stats, std::size_t region);
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

/// Returns the result as one sentence; `alpha` is the level of its regions.
std::string sentence_of(const RenderStats& stats, const BiasResult& bias, double alpha);
/// Describes the pixels of a pair that differ because they are not finite; "" if there are none.
std::string failing_pixels(const RenderStats& stats, const BiasResult& bias);

/// Returns the sentences of all pairs, or of all but that of the result; of many pairs, those without a difference
/// share one sentence.
std::vector<std::string> found_about_means(const CompareResult& result, bool with_stated_pair = true);

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

/// The assertions and the expectation that fail, as SARIF 2.1.0, at the compare file; file: "" without one.
std::string compare_sarif(
    const ComparePlan& plan, const CompareResult& result, const std::string& file, const Provenance& provenance);

}  // namespace crescent
