// crescent compare: renders of other programs -> metrics with their doubt, bias tests, plates, report.
#pragma once

#include "base/progress.h"
#include "compare/outputs.h"
#include "compare/plan.h"
#include "compare/results.h"

namespace crescent::inline comparison {

// ---- RenderStats -> results: the steps that compare_renders() takes, each usable alone.

/// What one render of an arm cost, where it is known.
struct Cost {
    std::optional<double> seconds, spp;
};
/// Mean FLIP of a region's pixels, where there is a reference: of radiance, and of the photographs.
struct Flips {
    std::optional<double> hdr, ldr;
};

/// Of the arm's first render, a region each; none without a reference.
std::vector<Flips> measure_flip(
    const ComparePlan& plan, const RenderStats& all, std::size_t arm, ProgressMonitor& monitor);

/// Every metric of one arm in one region.
RegionResult measure_region(
    const RenderStats& all, const ArmStats& arm, std::size_t region, const Cost& cost, const Flips& flips);

/// Mean over a region of the squared error of the reference's Y: over its files, else as it says, else estimated from
/// how roughly arms differ from it (see roughness()).
double reference_variance(const RenderStats& all, std::size_t region);
/// How that is known, in words.
std::string reference_error_from(const ArmStats& reference);

/// Whether two arms (b = arms.size(): the reference) have the same expectation; `alpha` is shared by all its tests.
BiasResult test_bias(const ComparePlan& plan, const RenderStats& all, const CompareResult& measured, std::size_t a,
    std::size_t b, double alpha, ProgressMonitor& monitor);

/// What it found, in one sentence; `alpha` is that of its regions.
std::string sentence_of(const RenderStats& all, const BiasResult& bias, double alpha);
/// Pixels of a pair that are not finite and differ, in words; "" where there are none.
std::string failing_pixels(const RenderStats& all, const BiasResult& bias);

/// The sentences of all pairs; of many pairs those in which nothing was found are one sentence.
std::vector<std::string> found_about_means(const CompareResult& result);

/// Where the variance of arm a differs from that of b.
NoiseResult compare_noise(const ComparePlan& plan, const RenderStats& all, std::size_t a, std::size_t b, double alpha);

/// Arms in order by what a unit of time or a sample buys, region by region.
std::vector<Ranking> rank(const CompareResult& result);

/// What a ladder shows of an arm in a region, and its name: the RMSE; where there is no reference, the standard
/// deviation. Both fall as N^-0.5 with independent samples.
MetricValue sample_count_of(const RegionResult& region);
const char* sample_count_text(const RegionResult& region);
/// Arms that are one arm at several samples a pixel, told by their names: "path-16" at 16, "path-64" at 64.
std::vector<SppLadder> ladders_of(const CompareResult& result);

/// Measures, tests and checks everything that the plan asks.
CompareResult test_differences(const ComparePlan& plan, const RenderStats& all, ProgressMonitor& monitor);

/// Where the outputs go.
struct CompareOptions {
    std::string out = "out/compare";
};

/// Reads, measures and writes everything under options.out; outputs appear whole or not at all. `summary` is for the
/// terminal. Throws InputError, OutputError, Interrupted.
CompareResult compare_renders(const ComparePlan& plan, const CompareOptions& options, const Provenance& provenance,
    ProgressMonitor& monitor, std::string& summary);

}  // namespace crescent::inline comparison
