// Many small lobes with a round rim, as a sampler of many cones or of many distant lights has them: p is the same
// inside each and jumps at its rim. Cells would have to be cut along every rim; the caps are found from the draws
// instead, by three points of a rim, and taken off p before the cubature.
#pragma once

#include <optional>

#include "trials/densities.h"

namespace crescent::inline trials {

/// 1 - cos up to `a` from an axis, in which p is `step` more than outside.
struct Cap {
    Vec3d axis{};
    double a = 0, step = 0;
    bool holds(Vec3d w) const { return 0.5 * dot(w - axis, w - axis) < a; }
};

/// Caps that draws of a technique lie in; every one was looked at all round.
std::vector<Cap> find_caps(const Draws& work, int technique);

/// The integral over the bins of d: of the caps in closed form, of what they leave of p by cubature over `cells`. None
/// where fewer than eight caps are found.
std::optional<Integral> integrate_caps(
    const Draws& work, int technique, const Density& d, std::vector<Rect> cells, const Effort& effort);

}  // namespace crescent::inline trials
