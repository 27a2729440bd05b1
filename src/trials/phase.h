// Whether f is that of a phase function.
#pragma once

#include "trials/draws.h"

namespace crescent::inline trials {

/// f |cos| depends on the angle between w_o and w_i alone, on both sides of the surface; see phase.cpp.
bool is_phase_function(const Draws& work);

}  // namespace crescent::inline trials
