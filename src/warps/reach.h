// Whether the draws reach wherever p is positive.
#pragma once

#include <cstddef>

#include "trials/trial_context.h"

namespace crescent::inline warps {

/// Of directions in proportion to p, those to which no u was found to lead; see reach.cpp.
struct Reach {
    std::size_t looked_at = 0, unknown = 0, empty = 0;  // empty: nor did any draw fall near, where many were due
    double share = 1;  // of p that may lie where nothing is drawn: more would be missed in one case of a thousand
};
/// Looks 3000 such directions up, for a warp of two numbers that leads to each direction once.
Reach reach_of_draws(const TrialContext& work, int technique);

}  // namespace crescent::inline warps
