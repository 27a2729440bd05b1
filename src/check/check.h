// CheckCases in, ordered verdicts out.
#pragma once

#include <span>

#include "base/progress.h"
#include "check/report/summary.h"
#include "check/settings.h"
#include "check/sources/sampler_adapter.h"
#include "check/verdict.h"

namespace crescent {

/// Verdicts in the order of the cases and of verdict_names. A sampler that breaks off leaves its other w_o standing.
/// Throws Interrupted when the monitor says stop.
CheckResult run_checks(std::span<const CheckCase> check_cases, const TestSettings& settings, ProgressMonitor& monitor);

/// The budget of each w_o of a sampler, by the settings and how many w_o there are.
check::CheckBudget budget_of(const TestSettings& settings, bool limited, std::size_t w_o);

}  // namespace crescent
