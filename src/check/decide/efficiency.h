// efficiency: variance of X times the time of one sample, compared with every other sampler of the same surface, light
// and w_o and with the baselines (uniform and cosine).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/progress.h"
#include "check/decide/check_sampler.h"
#include "check/sources/check_case.h"
#include "check/verdict.h"

namespace crescent::check {

/// The variance and time of one case with their errors.
struct Efficiency {
    std::size_t check_case = 0;
    double variance = 0, relative_se = 0;  // of X; relative standard error of the variance
    double nanoseconds = 0, cost_se = 0;   // per sample, relative standard error; 0: not measured
    bool has_weights = false;
    bool heavy = false;           // whether the tail is too heavy for a variance
    bool is_over_sphere = false;  // over the sphere, not only the upper hemisphere
    std::string fault;            // the error if the sampler failed meanwhile
    double value() const { return variance * nanoseconds; }
    double low() const;
    double high() const;
};

/// Variances of all cases: from the draws of the check or, for a baseline, from a few draws of its own.
std::vector<Efficiency> variances_of(std::span<const CheckCase> check_cases, std::span<const CheckOutcome> outcomes,
    const CheckSettings& settings, const ProgressMonitor& monitor);
/// Measures the time of one sample of each on one thread, in turns, so that a slow phase of the machine affects all
/// equally.
void measure_costs(std::span<const CheckCase> check_cases, std::uint32_t seed, std::span<Efficiency> variances,
    const ProgressMonitor& monitor);
/// One verdict for each case. Two samplers whose intervals overlap are not ranked.
std::vector<Verdict> test_efficiency(std::span<const CheckCase> check_cases, std::span<const Efficiency> variances);

}  // namespace crescent::check
