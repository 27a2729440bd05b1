// The default reference of the metrics: the radiance of every pixel by quadrature. Lambert x fill is in closed form,
// lobe x fill uses a table of its albedo, every light uses DiskQuadrature. It states its own error per pixel.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "base/progress.h"
#include "base/vec.h"
#include "render/estimator.h"
#include "render/film.h"
#include "render/reference/lobe_albedo.h"
#include "render/shading_points.h"
#include "render/tiles.h"
#include "scene/scene.h"

namespace crescent {

// ---- The radiance of one pixel by quadrature, with the error stated by its parts; pixels may be computed in any
// order.

/// Created once for a scene; many threads may compute pixels.
class PixelQuadrature {
public:
    /// Prepares these exponents. `yield_to_host` is called while the tables of the lobes' albedos are computed.
    PixelQuadrature(const Scene& scene, const std::vector<double>& exponents, const YieldToHost& yield_to_host = {});
    ~PixelQuadrature();
    PixelQuadrature(PixelQuadrature&&) noexcept;
    PixelQuadrature& operator=(PixelQuadrature&&) noexcept;

    /// Writes the pixels of a box into films of the scene's size, one per exponent. The bits depend neither on the box
    /// nor on the other exponents.
    void write(const TileBox& box, std::span<ReferenceFilm> films) const;

private:
    class Made;
    std::unique_ptr<const Made> content_;
};

/// Stores one pixel of a reference.
void store_pixel(ReferenceFilm& film, std::size_t index, const Rgb& radiance, double error);

// ---- A reference for every exponent of a run, tile by tile.

/// Returns the scene at each exponent, in order.
inline std::vector<Scene> scenes_at(const Scene& scene, const std::vector<double>& exponents) {
    std::vector<Scene> scenes;
    for (double s : exponents) scenes.push_back(scene.with_s(s));
    return scenes;
}

/// Returns one film per exponent, computed by calling work(k, tile k, films) for every tile.
template <class Work> std::vector<ReferenceFilm> by_tiles(
    const Image& image, const std::vector<double>& exponents, ProgressMonitor& monitor, Work&& work) {
    std::vector<ReferenceFilm> films(exponents.size());
    parallel_for(std::size_t{0}, films.size(),
        [&](std::size_t e) { films[e] = ReferenceFilm(image.width, image.height, exponents[e]); });
    const std::vector<TileBox> tiles = tiles_of(image.width, image.height);
    for_each_tile(tiles, monitor, [&](std::size_t k) {
        work(k, tiles[k], films);
        return static_cast<double>(tiles[k].x1 - tiles[k].x0) * (tiles[k].y1 - tiles[k].y0);
    });
    return films;
}

/// Copies a pixel that is the same at both exponents.
inline void copy_pixel(const ReferenceFilm& from, ReferenceFilm& to, std::size_t index) {
    to.r[index] = from.r[index];
    to.g[index] = from.g[index];
    to.b[index] = from.b[index];
    to.y[index] = from.y[index];
    to.error[index] = from.error[index];
}

// ---- A cache of values by number, in the order of first use, because later passes mostly repeat that order.

/// Values by number, stored in the order of their first use.
template <class V> class Replay {
public:
    /// Starts empty.
    Replay() {
        arguments_.reserve(64);
        values_.reserve(64);
    }
    /// Returns the value for x, valid until the next call; calls make() if x was not used before the last rewind.
    template <class Make> const V& operator()(double x, Make&& make) {
        const auto last = arguments_.begin() + static_cast<std::ptrdiff_t>(old_count_);
        auto match = std::find(arguments_.begin() + static_cast<std::ptrdiff_t>(next_), last, x);
        if (match == last) match = std::find(arguments_.begin(), last, x);
        if (match == last) {
            arguments_.push_back(x);
            values_.push_back(make());
            return values_.back();
        }
        next_ = static_cast<std::size_t>(match - arguments_.begin()) + 1;
        return values_[next_ - 1];
    }
    void rewind() {
        next_ = 0;
        old_count_ = arguments_.size();
    }

private:
    std::vector<double> arguments_;
    std::vector<V> values_;
    std::size_t next_ = 0, old_count_ = 0;  // number of values before the last rewind; where the search begins
};

/// Returns one film per exponent, in order.
std::vector<ReferenceFilm> quadrature_reference(
    const Scene& scene, const std::vector<double>& exponents, ProgressMonitor& monitor);

}  // namespace crescent
