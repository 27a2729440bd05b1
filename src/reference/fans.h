// A disk light's part of the reflected radiance in polar coordinates of directions about an axis: fan by fan (fan.h),
// each with its open parts found exactly, and across the fans adaptive Gauss-Kronrod between the azimuths where bodies
// begin and end. The axis is the lobe's where the lobe is sharp, so that no rule can miss its peak; else the disk's
// centre.
#pragma once

#include <vector>

#include "reference/disk_point.h"
#include "reference/disk_quadrature.h"

namespace crescent::inline reference {

/// `bodies` may stand between the point and the light; `at_horizon`: part of it may lie under the surface's horizon.
DiskIntegral fan_by_fan(const DiskPoint& point, const Figure& light, const std::vector<const Blocker*>& bodies,
    bool about_lobe, bool at_horizon);

}  // namespace crescent::inline reference
