// Keeps what a long pass over an image has finished, tile by tile, in a journal beside the outputs.
#pragma once

#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/journal.h"
#include "base/parallel.h"
#include "base/progress_monitor.h"
#include "estimator/shading_points.h"

namespace crescent::inline estimator {

/// What the tiles of a pass write into.
struct TileOutputs {
    int width = 0;                                 // pixels in a row of every plane
    std::vector<std::span<std::byte>> planes;      // 4 bytes a pixel
    std::vector<std::span<std::uint64_t>> counts;  // one entry a tile
};

/// All planes of films of one size, and counts of the tiles beside them.
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
    /// Nothing is written before the pass has taken `checkpoint_after_s` seconds; then all finished tiles are.
    TileCheckpoint(std::string path, std::string key, double checkpoint_after_s, ProgressMonitor& monitor);

    /// The pass begins: tiles that an earlier run finished are put back into the outputs, which must outlive it.
    void begin(std::vector<TileBox> tiles, TileOutputs outputs);
    bool holds(std::size_t tile) const { return units_[tile] >= 0; }
    /// A tile is finished; it was worth so many units of progress. Any thread.
    void add(std::size_t tile, double units);
    /// Units of the tiles that begin() put back.
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

}  // namespace crescent::inline estimator
