// Where single precision makes a direction a step function of the random numbers: a cosine next to 1 takes few values,
// so that draws lie on rings about an axis.
#pragma once

#include <vector>

#include "check/estimate/source.h"

namespace crescent::check {

/// Where w(u) jumps to when it next changes, for a draw that stays the same while one of its numbers moves by an ulp.
struct LocalStep {
    double jump = 0;  // an angle; 0 where there is none, or where single precision does not explain it
    Vec3d next{};
};
/// w: the draws at u. As many as were looked at: all, or the first of them.
std::vector<LocalStep> local_steps(Source& source, const std::vector<PrimarySample>& u, const std::vector<Vec3d>& w);

}  // namespace crescent::check
