// A disk light's part of the reflected radiance in polar coordinates of directions about an axis: fan by fan (fan.h),
// each with its open parts found exactly, and across the fans adaptive Gauss-Kronrod between the azimuths where bodies
// begin and end. The axis is the lobe's where the lobe is sharp, so that no rule can miss its peak; else the disk's
// centre.
#pragma once

#include "reference/all_fans.h"

namespace crescent::inline reference {

/// At the point of the fans, with this or another exponent of its lobe.
DiskIntegral fan_by_fan(const DiskPoint& point, AllFans& fans);

}  // namespace crescent::inline reference
