// Points of the plane in doubles: coordinates of directions, random numbers.
#pragma once

#include "base/vec.h"

namespace crescent::inline base {

using Vec2d = Vec2<double>;

}  // namespace crescent::inline base
