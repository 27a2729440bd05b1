// Tile by tile and row by row, so that a stop is heard within a tile.
#include "reference/reference.h"

#include "reference/by_tiles.h"
#include "reference/pixel_quadrature.h"

namespace crescent::inline reference {

std::vector<ReferenceFilm> quadrature_reference(
    const Scene& scene, const std::vector<double>& exponents, ProgressMonitor& monitor, TileCheckpoint* checkpoint) {
    const PixelQuadrature pixels(scene, exponents);
    return by_tiles(scene.image(), exponents, monitor, checkpoint,
        [&](std::size_t, const TileBox& tile, std::vector<ReferenceFilm>& films) {
            for (int j = tile.y0; j < tile.y1 && !monitor.stop.load(std::memory_order_relaxed); ++j)
                pixels.write({tile.x0, j, tile.x1, j + 1}, films);
        });
}

}  // namespace crescent::inline reference
