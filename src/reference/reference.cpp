#include "reference/reference.h"

#include "reference/by_tiles.h"
#include "reference/pixel_quadrature.h"

namespace crescent::inline reference {

std::vector<ReferenceFilm> quadrature_reference(
    const Scene& scene, const std::vector<double>& exponents, ProgressMonitor& monitor, TileCheckpoint* checkpoint) {
    const std::vector<Scene> scenes = scenes_at(scene, exponents);
    const std::vector<PixelQuadrature> integrals(scenes.begin(), scenes.end());
    const auto pixel = [&](int i, int j, std::vector<ReferenceFilm>& films) {
        const auto hit = scenes[0].primary(i, j);
        if (!hit) return;
        const std::size_t at =
            static_cast<std::size_t>(j) * static_cast<std::size_t>(scene.image().width) + static_cast<std::size_t>(i);
        for (std::size_t e = 0; e < scenes.size(); ++e) {
            const Surface surface = scenes[e].surface(*hit);
            if (e > 0 && !(surface.rho_s > 0)) {  // no lobe, no exponent
                copy_pixel(films[0], films[e], at);
                continue;
            }
            const auto [radiance, error] = integrals[e](*hit, surface);
            store_pixel(films[e], at, radiance, error);
        }
    };
    return by_tiles(scene.image(), exponents, monitor, checkpoint,
        [&](std::size_t, const TileBox& tile, std::vector<ReferenceFilm>& films) {
            for (int j = tile.y0; j < tile.y1 && !monitor.stop.load(std::memory_order_relaxed); ++j)
                for (int i = tile.x0; i < tile.x1; ++i) pixel(i, j, films);
        });
}

}  // namespace crescent::inline reference
