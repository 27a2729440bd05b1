// The radiance of one pixel without a sample: Lambert x fill in closed form, lobe x fill by a table of its albedo,
// every light by DiskQuadrature, with the error that these state. Pixels may be asked for in any order.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "color/rgb.h"
#include "estimator/shading_points.h"
#include "films/film.h"
#include "reference/lobe_albedo.h"
#include "scene/scene.h"

namespace crescent::inline reference {

class PixelQuadrature {
public:
    /// At each of these exponents. `make_way`: told while the tables of the lobes' albedos are made.
    PixelQuadrature(const Scene& scene, const std::vector<double>& exponents, const MakeWay& make_way = {});
    ~PixelQuadrature();
    PixelQuadrature(PixelQuadrature&&) noexcept;
    PixelQuadrature& operator=(PixelQuadrature&&) noexcept;

    /// Writes the pixels of a box into films of the scene's size, one an exponent: the same bits in any box, and
    /// whatever other exponents there are.
    void write(const TileBox& box, std::span<ReferenceFilm> films) const;

private:
    class Made;
    std::unique_ptr<const Made> made_;
};

/// One pixel of a reference.
void store_pixel(ReferenceFilm& film, std::size_t at, const Rgb& radiance, double error);

}  // namespace crescent::inline reference
