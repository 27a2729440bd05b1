// What the meters compare with, where the experiment asks for no other: the radiance of every pixel without a sample.
// Lambert x fill in closed form, lobe x fill by a table of its albedo, every light by DiskQuadrature; states its own
// error per pixel.
#pragma once

#include <vector>

#include "base/progress_monitor.h"
#include "estimator/tile_checkpoint.h"
#include "films/film.h"
#include "scene/scene.h"

namespace crescent::inline reference {

/// One film per exponent, in order. `checkpoint` keeps finished tiles.
std::vector<ReferenceFilm> quadrature_reference(const Scene& scene, const std::vector<double>& exponents,
    ProgressMonitor& monitor, TileCheckpoint* checkpoint = nullptr);

}  // namespace crescent::inline reference
