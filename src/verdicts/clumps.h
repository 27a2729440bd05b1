// Draws that crowd where p does not.
#pragma once

#include <cstddef>
#include <span>

#include "trials/trial_context.h"

namespace crescent::inline verdicts {

/// The block of draws that is least likely for its room; see clumps.cpp.
struct Clump {
    double p = 1;                         // that any block were so crowded
    double draws = 0, due = 0, room = 0;  // due: at most; room in sr
    Vec3d at{};
};
/// How far a direction goes at least when it goes at all, in the median over these draws: by moves of u of 2^-24 or,
/// where those leave it where it is, by the least that does not. A warp that is steep, as a cell of a large table is,
/// draws no finer than that, and neither does one of which floats make stairs. Where many u are sent to one point
/// without such a stair, the way out of it is as fine as anywhere. Of a sampler that draws numbers of its own: how far
/// apart directions are that come again. 0: not known.
double least_step(const TrialContext& work, int technique, const SampleBatch& b, std::span<const std::size_t> draws);
Clump densest_clump(const TrialContext& work, int technique, const Density& d, const SampleBatch& b);
void tell_clump(Verdict& v, const Clump& clump);

}  // namespace crescent::inline verdicts
