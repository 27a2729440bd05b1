// A reference of every exponent of a run, tile by tile.
#pragma once

#include <vector>

#include "base/parallel.h"
#include "estimator/estimator.h"

namespace crescent::inline reference {

/// The scene at each exponent, in order.
inline std::vector<Scene> scenes_at(const Scene& scene, const std::vector<double>& exponents) {
    std::vector<Scene> scenes;
    for (double s : exponents) scenes.push_back(scene.with_s(s));
    return scenes;
}

/// One film per exponent, made by calling work(k, tile k, films) for every tile.
template <class Work> std::vector<ReferenceFilm> by_tiles(const Image& image, const std::vector<double>& exponents,
    ProgressMonitor& monitor, TileCheckpoint* checkpoint, Work&& work) {
    std::vector<ReferenceFilm> films(exponents.size());
    parallel_for(std::size_t{0}, films.size(),
        [&](std::size_t e) { films[e] = ReferenceFilm(image.width, image.height, exponents[e]); });
    const std::vector<TileBox> tiles = tiles_of(image.width, image.height);
    if (checkpoint) checkpoint->begin(tiles, outputs_of(films));
    for_each_tile(tiles, monitor, checkpoint, [&](std::size_t k) {
        work(k, tiles[k], films);
        return static_cast<double>(tiles[k].x1 - tiles[k].x0) * (tiles[k].y1 - tiles[k].y0);
    });
    return films;
}

/// A pixel that is the same at both exponents.
inline void copy_pixel(const ReferenceFilm& from, ReferenceFilm& to, std::size_t at) {
    to.r[at] = from.r[at], to.g[at] = from.g[at], to.b[at] = from.b[at], to.y[at] = from.y[at],
    to.error[at] = from.error[at];
}

}  // namespace crescent::inline reference
