// Where the draws are off most, told.
#pragma once

#include <vector>

#include "trials/trial_context.h"

namespace crescent::inline verdicts {

/// "Most at theta 31.2 deg, phi 250.1 deg: 812 seen, 640.3 due."
void tell_worst(Verdict& v, const Density& d, const std::vector<double>& observed, const std::vector<double>& expected);

}  // namespace crescent::inline verdicts
