// Runs the checks of a list of cases and returns ordered verdicts.
#pragma once

#include <span>

#include "base/progress.h"
#include "check/report/summary.h"
#include "check/settings.h"
#include "check/sources/sampler_adapter.h"
#include "check/verdict.h"

namespace crescent {

/// Verdicts in the order of the cases and of verdict_names. If a sampler fails to answer at one w_o, the results of its
/// other w_o are kept. Throws Interrupted if the monitor requests a stop.
CheckResult run_checks(std::span<const CheckCase> check_cases, const TestSettings& settings, ProgressMonitor& monitor);

/// The budget of each w_o of a sampler, from the settings and the number of w_o.
check::CheckBudget budget_of(const TestSettings& settings, bool limited, std::size_t w_o);

}  // namespace crescent
