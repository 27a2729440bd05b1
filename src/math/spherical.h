// Unit vectors by their angles about z: theta from z, phi from x towards y, in radians.
#pragma once

#include <cmath>

#include "base/vec.h"
#include "math/functions.h"

namespace crescent::math {

/// The vector of sin theta, cos theta and phi.
inline Vec3d spherical(double sin, double cos, double phi) {
    const SinCos around = sincos(phi);
    return {sin * around.cos, sin * around.sin, cos};
}
/// The vector of cos theta, in [-1, 1] up to rounding, and phi.
inline Vec3d spherical(double cos, double phi) {
    const double squared = 1 - cos * cos;
    return spherical(std::sqrt(squared > 0 ? squared : 0), cos, phi);
}

}  // namespace crescent::math
