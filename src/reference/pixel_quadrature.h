// The radiance of one pixel without a sample: Lambert x fill in closed form, lobe x fill by a table of its albedo,
// every light by DiskQuadrature, with the error that these state. Pixels may be asked for in any order.
#pragma once

#include <memory>
#include <utility>

#include "color/rgb.h"
#include "estimator/shading_points.h"
#include "films/film.h"
#include "reference/lobe_albedo.h"
#include "scene/scene.h"

namespace crescent::inline reference {

class PixelQuadrature {
public:
    /// `make_way`: told while the tables of the lobes' albedos are made.
    explicit PixelQuadrature(const Scene& scene, const MakeWay& make_way = {});
    ~PixelQuadrature();
    PixelQuadrature(PixelQuadrature&&) noexcept;
    PixelQuadrature& operator=(PixelQuadrature&&) noexcept;

    /// Radiance, and the error of its Y.
    std::pair<Rgb, double> operator()(const Hit& hit, const Surface& surface) const;
    /// Writes the pixels of a box into a film of the scene's size: the same bits as quadrature_reference().
    void write(const TileBox& box, ReferenceFilm& film) const;

private:
    class Made;
    std::unique_ptr<const Made> made_;
};

/// One pixel of a reference.
void store_pixel(ReferenceFilm& film, std::size_t at, const Rgb& radiance, double error);

}  // namespace crescent::inline reference
