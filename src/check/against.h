// Compares two samplers, A and B, at the same w_o under the same light: whether they draw from one distribution,
// whether they have the same f, and which has the smaller variance. There are three verdicts for each w_o:
//
//   same_distribution  E_A[h] = E_B[h] for the sums, nodes and bands of one tree, and the shares of delta parts, in
//                      two stages
//   same_f             f of both at directions over the whole sphere and at draws of either; q times weight of delta
//                      parts
//   variance           Var X_A / Var X_B with its 95 % interval; "heavy tail" if either sampler has one
//
// Without a pdf(w), X is the weight that the sampler returns with a draw. Not in crescent::check built alone.
#pragma once

#include <span>
#include <string>

#include "base/progress.h"
#include "check/check.h"
#include "check/sources/check_case.h"
#include "check/verdict.h"

namespace crescent::check {

/// The cases of A and of B correspond one to one. expect_same: a difference in distribution or f is wrong, not only
/// reported.
CheckResult compare_samplers(std::span<const CheckCase> a, std::span<const CheckCase> b, const TestSettings& settings,
    bool expect_same, ProgressMonitor& monitor);

/// One line for each w_o: both states, the ratio and its interval.
std::string against_text(const CheckResult& result);

}  // namespace crescent::check

namespace crescent {
using check::against_text, check::compare_samplers;
}
