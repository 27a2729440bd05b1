// Measurements for "Where the article is wrong": the heavy tail of the Phong sampler on a Lambert surface, its lost
// support off the normal, and the result of a plain t-test. All in Y of the control shape's material.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/progress.h"
#include "experiment/experiment.h"

namespace crescent {

/// Quantiles over replicates of the combined white furnace of the Phong sampler, R = n, at N samples.
struct FurnaceQuantiles {
    std::string arithmetic;  // "float32", "float64"
    int u_bits = 0;          // resolution of u: 24, 32, 53
    std::uint64_t n = 0;
    double q05 = 0, q25 = 0, median = 0, q75 = 0, q95 = 0;
};
/// The limit for N -> infinity if u is never below 2^-bits: rho_s + rho_d (1 - 2^(-bits (1 - k))), k = (s-1)/(s+1).
struct FurnaceCap {
    int u_bits = 0;
    double y = 0;
};
/// The part of Lambert x fill that the Phong sampler cannot reach with R tilted by theta_R from n.
struct LostSupport {
    double theta_R_deg = 0;
    double measured = 0, se = 0;  // from cosine draws and the Phong pdf at them
    double theory = 0;            // (1 - cos theta_R) / 2
};
/// How often a t-test at level alpha rejects the correct Phong sampler (R = n, Lambert, true mean known).
struct FalseRejection {
    double s = 0, k = 0;  // k: the Pareto index (s-1)/(s+1)
    std::uint64_t n = 0;
    int runs = 0, rejected = 0;
    double low = 0, high = 0;  // Clopper-Pearson 95 % of the rate
};

/// The measurements of one run for the published explanations, at one exponent of the Phong lobe.
struct Evidence {
    double s = 0, rho_d = 0, rho_s = 0, expected = 0;  // Y
    double alpha = 0.01;
    std::vector<FurnaceQuantiles> furnace;
    std::vector<FurnaceCap> caps;
    std::vector<LostSupport> lost;
    std::vector<FalseRejection> rejections;
};

// ---- Functions that take these measurements.

/// Returns nothing (empty vectors) if the experiment does not request it, or if it has no Phong sampler or no shape
/// with a Phong lobe.
Evidence measure_evidence(const Experiment& experiment, const std::string& isa, ProgressMonitor& monitor);

}  // namespace crescent
