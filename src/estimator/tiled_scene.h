// A scene cut into tiles, with the shading points of each tile: they depend on the scene and its exponent alone, so
// that all arms, seeds and references of a run share them.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "estimator/shading_points.h"
#include "scene/scene.h"

namespace crescent::inline estimator {

/// Const members may be called from any thread. Copies share what is kept.
class TiledScene {
public:
    using Points = std::vector<ShadingPoints>;  // of one tile, grouped by lobe

    /// A scene whose points are made each time they are asked for.
    TiledScene(Scene scene);  // NOLINT(google-explicit-constructor): a scene is a tiled one that keeps nothing
    /// From now on the points of a tile are made when they are first asked for, and kept while this or a copy lives.
    void keep_points();
    /// The same view with another exponent, see Scene::with_s. Where this one keeps points, the other copies them each
    /// time: that costs less than the memory to keep others.
    TiledScene with_s(double s) const;

    const Scene& scene() const { return scene_; }
    const std::vector<TileBox>& tiles() const { return *tiles_; }
    /// Points of tile k, an index into tiles().
    std::shared_ptr<const Points> points(std::size_t k) const;

private:
    struct Kept;
    std::shared_ptr<const Points> make(std::size_t k) const;

    Scene scene_;
    std::shared_ptr<const std::vector<TileBox>> tiles_;
    std::shared_ptr<std::vector<Kept>> kept_;    // one a tile; null: nothing is kept
    std::shared_ptr<const TiledScene> other_s_;  // keeps points of the same view; null: none does
};

/// The view at each exponent, in order; they share the points that `view` keeps.
std::vector<TiledScene> views_at(const TiledScene& view, const std::vector<double>& exponents);

/// Bytes that the points of the whole image take where every pixel has one.
std::uint64_t bytes_of_points(const Scene& scene);

}  // namespace crescent::inline estimator
