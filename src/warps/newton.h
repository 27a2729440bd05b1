// Newton's method for the u that leads to a direction: one step for many at once, by draws beside each u.
#pragma once

#include <span>
#include <vector>

#include "trials/trial_context.h"

namespace crescent::inline warps {

/// Where a step leads from one u: there already, or on by so much in the first two numbers; nowhere where the two
/// derivatives lie along one line.
struct NewtonMove {
    bool arrived = false, moves = false;
    double dx = 0, dy = 0;
};

/// What a step is made with, in u: the differences for derivatives, the longest move, and how near to a u counts as
/// there, beside the rounding of directions.
struct NewtonStep {
    double difference, longest, near;
};

/// A move for each u of `from` towards the direction of `to` at its place. Asks for three draws each.
std::vector<NewtonMove> newton_moves(const TrialContext& work, int technique, std::span<const Numbers> from,
    std::span<const Vec3d> to, const NewtonStep& step);

}  // namespace crescent::inline warps
