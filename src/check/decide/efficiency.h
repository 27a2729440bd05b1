// efficiency: variance of X times the time of one sample, beside every other sampler of the same surface, light and w_o
// and beside the baselines (uniform and cosine).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/progress.h"
#include "check/decide/check_sampler.h"
#include "check/verdict.h"

namespace crescent::check {

/// Of one case, with what it is known to.
struct Efficiency {
    std::size_t check_case = 0;
    double variance = 0, relative_se = 0;  // of X; relative standard error of the variance
    double nanoseconds = 0, cost_se = 0;   // per sample, relative standard error; 0: not measured
    bool weighed = false;                  // there are weights
    bool heavy = false;                    // the tail does not let the variance be known
    bool whole = false;                    // over the sphere, not its upper half
    std::string fault;                     // how the sampler broke off meanwhile
    double value() const { return variance * nanoseconds; }
    double low() const;
    double high() const;
};

/// Variances of all cases: of what the check has drawn, or, of a baseline, of a few draws of its own.
std::vector<Efficiency> variances_of(std::span<const CheckCase> check_cases, std::span<const CheckOutcome> outcomes,
    const CheckSettings& settings, const ProgressMonitor& monitor);
/// The time of one sample of each, by one thread, all in turn: a slow moment of the machine falls on all alike.
void measure_costs(std::span<const CheckCase> check_cases, std::uint32_t seed, std::span<Efficiency> all,
    const ProgressMonitor& monitor);
/// A verdict by case. Two samplers whose intervals overlap are not ranked.
std::vector<Verdict> test_efficiency(std::span<const CheckCase> check_cases, std::span<const Efficiency> all);

}  // namespace crescent::check
