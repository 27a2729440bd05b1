// What finite differences of sample(u) say of the density that is drawn.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "trials/trial_context.h"

namespace crescent::inline warps {

/// A point at which |Jacobian| of the warp is known: 1 / |J| is the density that is drawn there, where one u alone
/// reaches it.
struct WarpPoint {
    Vec3d wi{};
    double jacobian = 0, error = 0;  // sr, over the share of the number that chooses; relative
    Numbers u{};
    double p_jacobian = 0;
};
/// What finite differences say of the warp at these u; nothing where a seam is near.
std::vector<std::optional<WarpPoint>> jacobians_at(
    const TrialContext& work, int technique, std::span<const Numbers> at);
/// What the warp's derivatives say; see jacobian.cpp.
struct WarpFinding {
    std::size_t usable = 0, below = 0;  // points with a trusted |J|, and those with p |J| < 1
    double smallest = 1;                // p |J|
    double nowhere_above = 1;           // p |J| that three of four points with the best |J| do not exceed
    double region_below = 1;            // the least of that over sixteenths of the square of the first two numbers
    Vec2d region{};                     // the corner nearest to u = (0, 0) of that sixteenth
    Numbers at{};
    double one_to_one = 0;                   // share of usable points with p |J| = 1
    std::size_t steps_tried = 0, stuck = 0;  // moves of u by 2^-19 that ought to show, and those that do not
    std::vector<WarpPoint> points;           // the usable ones
    int choosers = 0;                        // numbers beside the first two that move the direction
};

/// Looked at once; kept with the work.
const WarpFinding& study_warp(const TrialContext& work, int technique);

}  // namespace crescent::inline warps
