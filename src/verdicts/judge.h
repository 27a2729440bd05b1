// Trials in, ordered verdicts out: the levels are shared over every test of the call, trials run on all cores.
#pragma once

#include <span>
#include <stdexcept>

#include "verdicts/trial_context.h"

namespace crescent::inline verdicts {

/// The sampler cannot be talked with any more: what happened, at which request.
struct SubjectFault : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// It was given up in an earlier trial.
struct SubjectGone : SubjectFault {
    using SubjectFault::SubjectFault;
};

/// The program keeps to the protocol but needs more than PipeLimits::total_seconds.
struct SubjectTooSlow : SubjectFault {
    using SubjectFault::SubjectFault;
};

/// Throws Interrupted when the monitor says stop.
Judgement judge(std::span<const Trial> trials, const TestSettings& settings, ProgressMonitor& monitor);
/// The state of the whole: everything that the caller does not expect, and expectations that nothing meets.
void settle(Judgement& judgement);
/// What is not right, one line a finding over all w_o, then the details; "" where there is nothing.
std::string what_is_wrong(const Judgement& judgement);
/// How many statistical tests the trials ask for.
std::uint64_t count_tests(std::span<const Trial> trials);

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
