// Trials in, ordered verdicts out: the levels are shared over every test of the call, trials run on all cores.
#pragma once

#include <span>

#include "base/progress_monitor.h"
#include "judgements/summary.h"
#include "judgements/verdict.h"
#include "subjects/faults.h"
#include "subjects/subject.h"
#include "trials/settings.h"

namespace crescent::inline verdicts {

/// Throws Interrupted when the monitor says stop.
Judgement judge(std::span<const Trial> trials, const TestSettings& settings, ProgressMonitor& monitor);
/// How many statistical tests the trials ask for.
std::uint64_t count_tests(std::span<const Trial> trials);

}  // namespace crescent::inline verdicts
