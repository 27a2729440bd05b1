// What shines. Radiance in W/(sr m^2), lengths in m.
#pragma once

#include <cstddef>
#include <string>

#include "base/errors.h"
#include "base/vec.h"
#include "color/rgb.h"

namespace crescent {

inline constexpr std::size_t most_disks = 64;  // disk lights in one scene: kernels hold the sums of each at hand

/// A disk that emits `radiance` from the side its normal points to (or both). Seen by sampled rays only.
struct DiskLight {
    std::string name;
    Vec3d center{}, normal{};
    double radius = 0;
    Rgb radiance{};
    bool two_sided = false;
    Place at;
};

}  // namespace crescent
