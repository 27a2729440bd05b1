// A hemisphere as a disk: Lambert's azimuthal equal-area projection from n, (x, y) / sqrt(1 + z), the horizon at 1;
// rotated about n so that R lies towards +x, so the plane of incidence is the picture's middle row.
#pragma once

#include <cmath>
#include <functional>

#include "parts.h"

namespace crescent::web {

class Disk {
public:
    explicit Disk(Vec3d mirror) {
        const double length = std::sqrt(mirror.x * mirror.x + mirror.y * mirror.y);
        if (length > 1e-9) {
            c_ = mirror.x / length;
            s_ = mirror.y / length;
        }
    }
    /// Returns the point of a direction of the upper half in the unit disk.
    ordered_json place(Vec3d w) const {
        const double scale = 1 / std::sqrt(1 + std::max(w.z, 0.0));
        return {(c_ * w.x + s_ * w.y) * scale, (c_ * w.y - s_ * w.x) * scale};
    }
    /// Returns the direction of a point; nothing outside the disk.
    std::optional<Vec3d> direction(double x, double y) const {
        const double r2 = x * x + y * y;
        if (r2 >= 1) return std::nullopt;
        const double scale = std::sqrt(2 - r2);
        return Vec3d{(c_ * x - s_ * y) * scale, (c_ * y + s_ * x) * scale, 1 - r2};
    }

private:
    double c_ = 1, s_ = 0;
};

/// Returns a picture of a disk `size` pixels across, for disk(): values in turbo colours on a logarithmic scale of four
/// decades below the largest. Responds {}.
void paint_disk(const Disk& disk, int size, const std::function<double(Vec3d)>& value);

/// The same of ratios at places of the disk: two hues, full at a half and at twice, neither at 1.
void paint_ratio(const Disk& disk, int size, const std::function<double(double x, double y)>& ratio);

}  // namespace crescent::web
