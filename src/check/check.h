// Trials in, ordered verdicts out.
#pragma once

#include <span>

#include "base/progress_monitor.h"
#include "check/settings.h"
#include "judgements/summary.h"
#include "judgements/verdict.h"
#include "subjects/faults.h"
#include "subjects/subject.h"

namespace crescent {

/// Verdicts in the order of the trials and of verdict_names. A sampler that breaks off leaves its other w_o standing.
/// Throws Interrupted when the monitor says stop.
Judgement judge(std::span<const Trial> trials, const TestSettings& settings, ProgressMonitor& monitor);

/// The budget of each w_o of a sampler, by the settings and how many w_o there are.
check::CheckBudget budget_of(const TestSettings& settings, bool limited, std::size_t w_o);

}  // namespace crescent
