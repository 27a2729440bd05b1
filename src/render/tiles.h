// A scene cut into tiles, with the shading points of each tile, which depend only on the scene and its exponent and are
// shared by all samplers, seeds and references of a run.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "render/shading_points.h"
#include "scene/scene.h"

namespace crescent {

/// Const members may be called from any thread. Copies share the kept points.
class TiledScene {
public:
    using Points = std::vector<ShadingPoints>;  // of one tile, grouped by lobe

    /// Makes a scene whose points are created on each use.
    TiledScene(Scene scene);  // NOLINT(google-explicit-constructor): a scene is a tiled one that keeps nothing
    /// From now on the points of a tile are created on first use, and kept while this object or a copy lives.
    void keep_points();
    bool keeps_points() const { return kept_points_ != nullptr; }
    /// Gives up the hits of primary rays, which nothing needs once all points are kept.
    void forget_hits() { scene_.forget_hits(); }
    /// Returns the same view with another exponent, see Scene::with_s. If this one keeps points, the other copies them
    /// each time, which costs less than the memory to keep them.
    TiledScene with_s(double s) const;

    const Scene& scene() const { return scene_; }
    const std::vector<TileBox>& tiles() const { return *tiles_; }
    /// Returns the points of tile k, an index into tiles().
    std::shared_ptr<const Points> points(std::size_t k) const;

private:
    struct Kept;
    std::shared_ptr<const Points> make(std::size_t k) const;

    Scene scene_;
    std::shared_ptr<const std::vector<TileBox>> tiles_;
    std::shared_ptr<std::vector<Kept>> kept_points_;  // one per tile; null: nothing is kept
    std::shared_ptr<const TiledScene> other_s_;       // keeps points of the same view; null: none
};

/// Returns the view at each exponent, in order; they share the points that `view` keeps.
std::vector<TiledScene> views_at(const TiledScene& view, const std::vector<double>& exponents);

/// Returns the bytes that the points of the whole image take if every pixel has one.
std::uint64_t bytes_of_points(const Scene& scene);

}  // namespace crescent
