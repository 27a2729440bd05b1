// Two samplers, A and B, at the same w_o under the same light: do they draw from one distribution, have they one f, and
// which of them has the smaller variance. Three verdicts a w_o:
//
//   same_distribution  E_A[h] = E_B[h] for the nodes of one tree, mean directions and the share of delta parts, in two
//                      stages
//   same_f             f of both at directions all over, and where either draws; q times weight of delta parts
//   variance           Var X_A / Var X_B with its 95 % interval; "heavy tail" where either has one
//
// Without a pdf(w) X is the weight that comes with a draw.
#pragma once

#include "base/progress.h"
#include "check/settings.h"
#include "check/sources/cases.h"
#include "check/verdict.h"

namespace crescent::check {

/// CheckCases of A and of B, one for one. expect_same: a difference in distribution or f is wrong, not only stated.
CheckResult compare_samplers(std::span<const CheckCase> a, std::span<const CheckCase> b, const TestSettings& settings,
    bool expect_same, ProgressMonitor& monitor);

/// A w_o a line: both states, the ratio and its interval.
std::string against_text(const CheckResult& result);

}  // namespace crescent::check

namespace crescent {
using check::against_text, check::compare_samplers;
}
