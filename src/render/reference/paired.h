// The reference of scenes that no quadrature reaches: two independent estimates R1 and R2 of every pixel. The
// squared error of a film Y is then mean((Y - R1)(Y - R2)), without bias, because the errors of R1 and R2 do not
// correlate:
//   (Y - R1)(Y - R2) = (Y - R)^2 - e^2,  R = (R1 + R2)/2,  e = (R1 - R2)/2,
// so a film of R and |e| holds both. e^2 estimates the variance of R.
//
// Each estimate is the balance heuristic (Veach & Guibas 1995, eq. (9)) of the cosine, the lobe's own sampler, and the
// samplers of what shines: lights by solid angle, the sky, emitting triangles. Each of these has the two dimensions of
// a Sobol sequence of its own, Owen-scrambled by the pixel, the sampler and the estimate (math/sobol.h).
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "base/progress.h"
#include "render/film.h"
#include "render/shading_points.h"
#include "render/tiles.h"
#include "scene/scene.h"

namespace crescent {

/// How many samples, and from which streams.
struct PairedPlan {
    std::uint64_t n = 0;                   // samples per pixel of each estimate, of each sampler
    std::array<std::uint32_t, 2> seeds{};  // that no sampler of a film has
};

/// Returns R with |e| as its error, one film per view; the views differ only in their exponents, see views_at.
std::vector<ReferenceFilm> paired_reference(
    const std::vector<TiledScene>& views, const PairedPlan& plan, ProgressMonitor& monitor);

/// Writes the pixels of a box that see the sky into a film of the scene's size; they have no error.
void write_background(const Scene& scene, const TileBox& box, ReferenceFilm& film);
/// Writes the pixels of these points into a film of the scene's size. May end early if `stop` is set.
void write_paired(const Scene& scene, const ShadingPoints& points, const PairedPlan& plan,
    const std::atomic<bool>* stop, ReferenceFilm& film);

}  // namespace crescent
