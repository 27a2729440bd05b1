// What no w_o shows alone: contrasts of one degree of freedom, pooled over all w_o of a sampler.
#pragma once

#include <array>
#include <optional>

#include "base/progress_monitor.h"
#include "trials/trial_context.h"

namespace crescent::inline verdicts {

struct Outcome;
/// How many tests that makes: one a contrast and sampler of four w_o or more.
std::uint64_t pooled_tests(std::span<const Trial> trials);
/// Where the contrasts of a sampler's w_o together are off, and again on a fresh seed, density is wrong at the w_o that
/// shows it most.
void judge_pooled(std::span<const Trial> trials, std::span<Outcome> outcomes, const TestSettings& settings,
    TestCounts& test_counts, const ProgressMonitor& monitor);

}  // namespace crescent::inline verdicts
