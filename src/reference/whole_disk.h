// A disk light that is open and above the horizon: Lambert's part in closed form, a soft lobe's by polar rules.
#pragma once

#include "reference/disk_point.h"
#include "reference/disk_quadrature.h"

namespace crescent::inline reference {

/// `frame` has the disk's normal for its axis. For lobes that are wide against the disk: rules of rising order until
/// two agree, and the error is the difference of the last two.
DiskIntegral whole_disk(const DiskPoint& point, const shapes::Disk& disk, const Frame<double>& frame);

}  // namespace crescent::inline reference
