// A disk light behind bodies, chord by chord: on each chord the open parts are exact, Lambert's integral along them is in
// closed form and the lobe's by Gauss-Legendre; across the chords adaptive Gauss-Kronrod closes in on the kinks.
#pragma once

#include <vector>

#include "estimator/disk_point.h"
#include "estimator/disk_quadrature.h"

namespace crescent {

/// `frame` has the disk's normal for its axis; `bodies` may stand between.
DiskIntegral chord_by_chord(const DiskPoint& point, const DiskLight& disk, const Frame<double>& frame, const std::vector<const Occluder*>& bodies);

}  // namespace crescent
