// Variance times cost: what each sampler is ranked by.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/progress_monitor.h"
#include "trials/trial_context.h"

namespace crescent::inline verdicts {

/// Variance times cost of one trial, with what it is known to.
struct Efficiency {
    std::size_t trial = 0;
    double variance = 0, relative_se = 0;  // of the variance
    double nanoseconds = 0, cost_se = 0;   // per sample, relative standard error
    bool heavy = false, whole = false;     // whole: over the sphere, not its upper half
    double value() const { return variance * nanoseconds; }
    std::string fault;  // how the sampler broke off meanwhile
    double low() const;
    double high() const;
};
/// Variance of one trial's weight and the cost of a sample.
Efficiency measure_efficiency(const TrialContext& work, std::size_t trial);
/// The time of one sample of each, asked by one thread, all in turn: a slow moment of the machine falls on all alike.
void measure_costs(std::span<const Trial> trials, const TestSettings& settings, std::span<Efficiency> all,
    const ProgressMonitor& monitor);
/// Ranks trials that differ by the arm alone.
std::vector<Verdict> judge_efficiency(std::span<const Trial> trials, std::span<const Efficiency> all);

}  // namespace crescent::inline verdicts
