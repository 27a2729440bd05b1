// What pdf and f may differ by because directions are rounded.
#pragma once

#include "trials/draws.h"

namespace crescent::inline trials {

/// How far the sampler's p may move when wo and wi move by their own rounding: the largest change over twelve nudges.
double pdf_conditioning(const Draws& work, int technique, Vec3d wi, double p);
double f_conditioning(const Draws& work, Vec3d wo, Vec3d wi, double f, int channel = 0);

}  // namespace crescent::inline trials
