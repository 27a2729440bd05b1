// Decides all views of a suite together.
#pragma once

#include "compare/suite/suite.h"

namespace crescent {

/// Returns the exit code: 2 for unreadable views, 1 for changed, noisier or missing views and, unless `new_baseline`
/// allows them, new ones, 4 for too few renders, else 0.
int exit_code(const SuiteResult& result, bool new_baseline);

/// Decides all views together: Holm's method over their p-values.
void decide(const Suite& suite, SuiteResult& result);

}  // namespace crescent
