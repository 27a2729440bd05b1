// A pinhole camera and the grid of pixels behind it. Lengths in m, angles in degrees; right-handed.
#pragma once

#include "base/vec.h"

namespace crescent::inline scene {

struct Image {
    int width = 0, height = 0;  // pixels
};

/// Inclusive pixel coordinates at the image's size, origin bottom-left.
struct Box {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    int width() const { return x1 - x0 + 1; }
    int height() const { return y1 - y0 + 1; }
    bool operator==(const Box&) const = default;
};

struct Camera {
    Vec3d eye{}, target{}, up{};
    double vfov_deg = 0;  // vertical field of view
};

}  // namespace crescent::inline scene
