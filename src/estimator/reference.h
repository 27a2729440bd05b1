// What the meters compare with.
//   quadrature  deterministic: Lambert x fill in closed form, lobe x fill by a table of its albedo, every disk by
//               DiskQuadrature; states its own error per pixel.
//   note        the published recipe: analytic Lambert x fill, the lobe x fill by sampling the lobe, the disks by
//               next-event estimation, on a seed of its own; states its standard error per pixel.
#pragma once

#include <vector>

#include "base/watch.h"
#include "estimator/tile_keeper.h"
#include "scene/scene.h"
#include "films/film.h"

namespace crescent {

/// One film per exponent, in order. `keeper`: keeps finished tiles.
std::vector<ReferenceFilm> quadrature_reference(const Scene& scene, const std::vector<double>& exponents, Watch& watch, TileKeeper* keeper = nullptr);
std::vector<ReferenceFilm> note_reference(const Scene& scene, const std::vector<double>& exponents, const std::string& isa, Watch& watch, TileKeeper* keeper = nullptr);

}  // namespace crescent
