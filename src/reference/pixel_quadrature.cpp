#include "reference/pixel_quadrature.h"

#include <cmath>
#include <map>
#include <tuple>
#include <vector>

#include "reference/disk_quadrature.h"

namespace crescent::inline reference {

namespace {

/// One table for each lobe of a scene.
class Albedos {
public:
    Albedos(const Scene& scene, const MakeWay& make_way) {
        for (std::size_t k = 0; k < scene.shapes().size(); ++k) {
            Hit hit;
            hit.shape = static_cast<int>(k);
            const Surface surface = scene.surface(hit);
            if (surface.rho_s > 0) tables_.try_emplace(key(surface), surface.brdf, surface.s, surface.alpha, make_way);
        }
    }
    const LobeAlbedo& of(const Surface& surface) const { return tables_.at(key(surface)); }

private:
    using Key = std::tuple<LobeKind, double, double>;
    static Key key(const Surface& surface) { return {surface.brdf, surface.s, surface.alpha}; }
    std::map<Key, LobeAlbedo> tables_;
};

}  // namespace

class PixelQuadrature::Made {
public:
    Made(const Scene& scene, const MakeWay& make_way) : scene_(scene), albedos_(scene_, make_way) {
        for (std::size_t k = 0; k < scene_.lights().size(); ++k) disks_.emplace_back(scene_, k);
    }

    const Scene& scene() const { return scene_; }

    std::pair<Rgb, double> operator()(const Hit& hit, const Surface& surface) const {
        const Rgb& fill = scene_.fill();
        double albedo = 0, error = 0;
        if (surface.rho_s > 0) {
            const LobeAlbedo& table = albedos_.of(surface);
            albedo = table(dot(hit.n, hit.wo));
            error = surface.rho_s * surface.tinted(fill) * table.error(dot(hit.n, hit.wo));
        }
        Rgb out{};
        for (std::size_t c = 0; c < 3; ++c)
            out[c] = fill[c] * (surface.rho_d[c] + surface.rho_s * surface.tint[c] * albedo);
        for (std::size_t k = 0; k < disks_.size(); ++k) {
            const DiskIntegral d = disks_[k](hit, surface);
            Rgb part{};
            for (std::size_t c = 0; c < 3; ++c) {
                const double step = scene_.lights()[k].radiance[c] - fill[c];
                out[c] += step * (surface.rho_d[c] * d.diffuse + surface.rho_s * surface.tint[c] * d.lobe);
                part[c] = std::fabs(step) *
                    (surface.rho_d[c] * d.diffuse_error + surface.rho_s * surface.tint[c] * d.lobe_error);
            }
            error += luminance(part);
        }
        return {out, error};
    }

private:
    Scene scene_;
    Albedos albedos_;
    std::vector<DiskQuadrature> disks_;
};

PixelQuadrature::PixelQuadrature(const Scene& scene, const MakeWay& make_way)
    : made_(std::make_unique<const Made>(scene, make_way)) {}
PixelQuadrature::~PixelQuadrature() = default;
PixelQuadrature::PixelQuadrature(PixelQuadrature&&) noexcept = default;
PixelQuadrature& PixelQuadrature::operator=(PixelQuadrature&&) noexcept = default;

std::pair<Rgb, double> PixelQuadrature::operator()(const Hit& hit, const Surface& surface) const {
    return (*made_)(hit, surface);
}

void PixelQuadrature::write(const TileBox& box, ReferenceFilm& film) const {
    for (int j = box.y0; j < box.y1; ++j)
        for (int i = box.x0; i < box.x1; ++i) {
            const auto hit = made_->scene().primary(i, j);
            if (!hit) continue;
            const auto [radiance, error] = (*made_)(*hit, made_->scene().surface(*hit));
            store_pixel(film, static_cast<std::size_t>(j * film.width + i), radiance, error);
        }
}

void store_pixel(ReferenceFilm& film, std::size_t at, const Rgb& radiance, double error) {
    film.r[at] = static_cast<float>(radiance[0]);
    film.g[at] = static_cast<float>(radiance[1]);
    film.b[at] = static_cast<float>(radiance[2]);
    film.y[at] = static_cast<float>(luminance(radiance));
    film.error[at] = static_cast<float>(error);
}

}  // namespace crescent::inline reference
