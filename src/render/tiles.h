// A scene in tiles: shading points that are kept while memory allows, and a journal of finished tiles.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/journal.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "render/shading_points.h"
#include "scene/scene.h"

namespace crescent::inline render {

// ---- Keeps the finished part of a long pass over an image, tile by tile, in a journal next to the outputs.

/// The arrays that the tiles of a pass write to.
struct TileOutputs {
    int width = 0;                                 // pixels in a row of every plane
    std::vector<std::span<std::byte>> planes;      // 4 bytes per pixel
    std::vector<std::span<std::uint64_t>> counts;  // one entry per tile
};

/// Returns all planes of films of one size, and the counts of the tiles.
template <class F> TileOutputs outputs_of(std::vector<F>& films, std::span<std::vector<std::uint64_t>> counts = {}) {
    TileOutputs out;
    for (F& film : films) {
        out.width = film.width;
        for (const std::span<std::byte> plane : film.planes()) out.planes.push_back(plane);
    }
    out.counts.assign(counts.begin(), counts.end());
    return out;
}

class TileCheckpoint {
public:
    /// Nothing is written before the pass has taken `checkpoint_after_s` seconds; after that, all finished tiles are.
    TileCheckpoint(std::string path, std::string key, double checkpoint_after_s, ProgressMonitor& monitor);

    /// Begins the pass: tiles that an earlier run finished are restored into the outputs, which must outlive this
    /// object.
    void begin(std::vector<TileBox> tiles, TileOutputs outputs);
    bool holds(std::size_t tile) const { return units_[tile] >= 0; }
    /// Records a finished tile and its units of progress. Any thread.
    void add(std::size_t tile, double units);
    /// Returns the units of the tiles that begin() restored.
    double restored() const { return restored_; }
    void remove() { journal_.remove(); }

private:
    using Clock = std::chrono::steady_clock;

    void restore(Journal::Bytes record);
    void write(std::size_t tile);
    std::size_t record_size(const TileBox& tile) const;

    Journal journal_;
    double checkpoint_after_s_;
    ProgressMonitor& monitor_;
    std::vector<TileBox> tiles_;
    TileOutputs outputs_;
    std::vector<double> units_;  // of each finished tile; -1: not finished
    double restored_ = 0;
    Clock::time_point start_;
    Mutex lock_;                        // guards what follows and the journal
    std::vector<std::size_t> waiting_;  // finished, not yet written
};

// ---- A scene cut into tiles, with the shading points of each tile, which depend only on the scene and its exponent
// and are shared by all samplers, seeds and references of a run.

/// Const members may be called from any thread. Copies share the kept points.
class TiledScene {
public:
    using Points = std::vector<ShadingPoints>;  // of one tile, grouped by lobe

    /// Makes a scene whose points are created on each use.
    TiledScene(Scene scene);  // NOLINT(google-explicit-constructor): a scene is a tiled one that keeps nothing
    /// From now on the points of a tile are created on first use, and kept while this object or a copy lives.
    void keep_points();
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
    std::shared_ptr<std::vector<Kept>> kept_;    // one per tile; null: nothing is kept
    std::shared_ptr<const TiledScene> other_s_;  // keeps points of the same view; null: none
};

/// Returns the view at each exponent, in order; they share the points that `view` keeps.
std::vector<TiledScene> views_at(const TiledScene& view, const std::vector<double>& exponents);

/// Returns the bytes that the points of the whole image take if every pixel has one.
std::uint64_t bytes_of_points(const Scene& scene);

}  // namespace crescent::inline render
