// Works tile by tile and row by row, so that a stop takes effect within a tile.
#include "render/reference/reference.h"

#include <cmath>
#include <map>
#include <tuple>

#include "render/reference/disk_quadrature.h"

namespace crescent {

// ---- L_o = fill (rho_d + rho_s albedo) + sum over lights of (L - fill) times its integral, because a light replaces
// the fill behind it; exponents differ only in the lobe, so they share the visibility search.

namespace {

/// One table for each lobe of a scene.
class Albedos {
public:
    Albedos(const Scene& scene, const YieldToHost& yield_to_host) {
        for (std::size_t k = 0; k < scene.shapes().size() + scene.meshes().size(); ++k) {
            Hit hit;
            hit.shape = static_cast<int>(k);
            const Surface surface = scene.surface(hit);
            if (surface.rho_s > 0)
                tables_.try_emplace(key(surface), surface.brdf, surface.s, surface.alpha, yield_to_host);
        }
    }
    const LobeAlbedo& table_of(const Surface& surface) const { return tables_.at(key(surface)); }

private:
    using Key = std::tuple<LobeKind, double, double>;
    static Key key(const Surface& surface) { return {surface.brdf, surface.s, surface.alpha}; }
    std::map<Key, LobeAlbedo> tables_;
};

}  // namespace

class PixelQuadrature::Made {
public:
    Made(const Scene& scene, const std::vector<double>& exponents, const YieldToHost& yield_to_host)
        : scenes_(scenes_at(scene, exponents)) {
        for (const Scene& at_s : scenes_) albedos_.emplace_back(at_s, yield_to_host);
        for (std::size_t k = 0; k < scene.lights().size(); ++k) disks_.emplace_back(scene, k);
    }

    void write(const TileBox& box, std::span<ReferenceFilm> films) const {
        AtPixel pixel;
        for (int j = box.y0; j < box.y1; ++j)
            for (int i = box.x0; i < box.x1; ++i) {
                const auto hit = scenes_[0].primary(i, j);
                if (!hit) continue;
                look_at(*hit, pixel);
                const std::size_t index = static_cast<std::size_t>(j) * static_cast<std::size_t>(films[0].width) +
                    static_cast<std::size_t>(i);
                for (std::size_t e = 0; e < films.size(); ++e)
                    if (e < pixel.sums.size())
                        store_pixel(films[e], index, pixel.sums[e].radiance, pixel.sums[e].error);
                    else copy_pixel(films[0], films[e], index);
            }
    }

private:
    /// Radiance, and the error of its Y.
    struct Sum {
        Rgb radiance{};
        double error = 0;
    };

    /// One pixel at every exponent, or only at the first if it has no lobe.
    struct AtPixel {
        std::vector<Surface> surfaces;
        std::vector<DiskIntegral> lights;
        std::vector<Sum> sums;
    };

    void look_at(const Hit& hit, AtPixel& pixel) const {
        auto& [surfaces, lights, sums] = pixel;
        surfaces.clear();
        sums.clear();
        for (std::size_t e = 0; e < scenes_.size() && (e == 0 || surfaces[0].rho_s > 0); ++e) {
            surfaces.push_back(scenes_[e].surface(hit));
            sums.push_back(under_fill(hit, surfaces[e], albedos_[e]));
        }
        lights.resize(surfaces.size());
        for (std::size_t k = 0; k < disks_.size(); ++k) {
            disks_[k](hit, surfaces, lights);
            for (std::size_t e = 0; e < sums.size(); ++e) add(lights[e], scenes_[0].lights()[k], surfaces[e], sums[e]);
        }
    }

    Sum under_fill(const Hit& hit, const Surface& surface, const Albedos& albedos) const {
        const Rgb& fill = scenes_[0].fill();
        double albedo = 0;
        Sum out;
        if (surface.rho_s > 0) {
            const LobeAlbedo& table = albedos.table_of(surface);
            albedo = table(dot(hit.n, hit.wo));
            out.error = surface.rho_s * surface.tinted(fill) * table.error(dot(hit.n, hit.wo));
        }
        for (std::size_t c = 0; c < 3; ++c)
            out.radiance[c] = fill[c] * (surface.rho_d[c] + surface.rho_s * surface.tint[c] * albedo);
        return out;
    }

    /// Adds a light, which replaces the fill behind it.
    void add(const DiskIntegral& d, const Light& light, const Surface& surface, Sum& sum) const {
        Rgb error{};
        for (std::size_t c = 0; c < 3; ++c) {
            const double step = light.radiance[c] - scenes_[0].fill()[c], lobe = surface.rho_s * surface.tint[c];
            sum.radiance[c] += step * (surface.rho_d[c] * d.diffuse + lobe * d.lobe);
            error[c] = std::fabs(step) * (surface.rho_d[c] * d.diffuse_error + lobe * d.lobe_error);
        }
        sum.error += luminance(error);
    }

    std::vector<Scene> scenes_;  // one per exponent
    std::vector<Albedos> albedos_;
    std::vector<DiskQuadrature> disks_;
};

PixelQuadrature::PixelQuadrature(
    const Scene& scene, const std::vector<double>& exponents, const YieldToHost& yield_to_host)
    : content_(std::make_unique<const Made>(scene, exponents, yield_to_host)) {}
PixelQuadrature::~PixelQuadrature() = default;
PixelQuadrature::PixelQuadrature(PixelQuadrature&&) noexcept = default;
PixelQuadrature& PixelQuadrature::operator=(PixelQuadrature&&) noexcept = default;

void PixelQuadrature::write(const TileBox& box, std::span<ReferenceFilm> films) const { content_->write(box, films); }

void store_pixel(ReferenceFilm& film, std::size_t index, const Rgb& radiance, double error) {
    film.r[index] = static_cast<float>(radiance[0]);
    film.g[index] = static_cast<float>(radiance[1]);
    film.b[index] = static_cast<float>(radiance[2]);
    film.y[index] = static_cast<float>(luminance(radiance));
    film.error[index] = static_cast<float>(error);
}

std::vector<ReferenceFilm> quadrature_reference(
    const Scene& scene, const std::vector<double>& exponents, ProgressMonitor& monitor) {
    const PixelQuadrature pixels(scene, exponents);
    return by_tiles(
        scene.image(), exponents, monitor, [&](std::size_t, const TileBox& tile, std::vector<ReferenceFilm>& films) {
            for (int j = tile.y0; j < tile.y1 && !monitor.stop.load(std::memory_order_relaxed); ++j)
                pixels.write({tile.x0, j, tile.x1, j + 1}, films);
        });
}

}  // namespace crescent
