// A tile's record: Head, its counts, then its rows plane by plane, as they are in memory. Tiles are not written until
// checkpoint_after_s have passed, so a short run writes nothing. Records of another size are skipped.
#include "render/tiles.h"

#include <cstring>
#include <utility>

#include "base/parallel.h"

namespace crescent::inline render {

namespace {

/// The head of a record, before the counts and pixels of a tile.
struct Head {
    std::uint64_t tile;
    double units;
};

/// Calls work(bytes) for each row of a tile in each plane.
template <class Work> void each_row(const TileOutputs& outputs, const TileBox& tile, Work&& work) {
    for (const std::span<std::byte> plane : outputs.planes)
        for (int y = tile.y0; y < tile.y1; ++y) {
            const std::size_t first = static_cast<std::size_t>(y) * static_cast<std::size_t>(outputs.width) +
                static_cast<std::size_t>(tile.x0);
            work(plane.subspan(4 * first, 4 * static_cast<std::size_t>(tile.x1 - tile.x0)));
        }
}

}  // namespace

TileCheckpoint::TileCheckpoint(std::string path, std::string key, double checkpoint_after_s, ProgressMonitor& monitor)
    : journal_(std::move(path), std::move(key), monitor),
      checkpoint_after_s_(checkpoint_after_s),
      monitor_(monitor),
      start_(Clock::now()) {}

void TileCheckpoint::begin(std::vector<TileBox> tiles, TileOutputs outputs) {
    tiles_ = std::move(tiles);
    outputs_ = std::move(outputs);
    units_.assign(tiles_.size(), -1.0);
    journal_.read([this](Journal::Bytes record) { restore(record); });
    start_ = Clock::now();
    monitor_.skip(restored_);
}

std::size_t TileCheckpoint::record_size(const TileBox& tile) const {
    const std::size_t area = static_cast<std::size_t>(tile.x1 - tile.x0) * static_cast<std::size_t>(tile.y1 - tile.y0);
    return sizeof(Head) + 8 * outputs_.counts.size() + 4 * area * outputs_.planes.size();
}

void TileCheckpoint::restore(Journal::Bytes record) {
    Head head;
    if (record.size() < sizeof head) return;
    std::memcpy(&head, record.data(), sizeof head);
    if (head.tile >= tiles_.size() || record.size() != record_size(tiles_[head.tile])) return;
    const std::byte* from = record.data() + sizeof head;
    for (const std::span<std::uint64_t> counts : outputs_.counts) {
        std::memcpy(&counts[head.tile], from, 8);
        from += 8;
    }
    each_row(outputs_, tiles_[head.tile], [&](std::span<std::byte> row) {
        std::memcpy(row.data(), from, row.size());
        from += row.size();
    });
    units_[head.tile] = head.units;
    restored_ += head.units;
}

void TileCheckpoint::add(std::size_t tile, double units) {
    const Guard guard(lock_);
    units_[tile] = units;
    waiting_.push_back(tile);
    if (std::chrono::duration<double>(Clock::now() - start_).count() < checkpoint_after_s_) return;
    for (const std::size_t finished : waiting_) write(finished);
    waiting_.clear();
}

void TileCheckpoint::write(std::size_t tile) {
    const Head head = {tile, units_[tile]};
    std::vector<Journal::Bytes> parts = {std::as_bytes(std::span(&head, 1))};
    for (const std::span<std::uint64_t> counts : outputs_.counts)
        parts.push_back(std::as_bytes(counts.subspan(tile, 1)));
    each_row(outputs_, tiles_[tile], [&](std::span<std::byte> row) { parts.push_back(row); });
    journal_.append(parts);
}

// ---- Points of a tile are created on first use, under that tile's lock; for a scene at another s only s and alpha
// change, so they are copied from the first scene's.

struct TiledScene::Kept {
    Mutex lock;
    std::shared_ptr<const Points> points;  // null: not created yet
};

TiledScene::TiledScene(Scene scene)
    : scene_(std::move(scene)),
      tiles_(std::make_shared<const std::vector<TileBox>>(tiles_of(scene_.image().width, scene_.image().height))) {}

void TiledScene::keep_points() { kept_ = std::make_shared<std::vector<Kept>>(tiles_->size()); }

TiledScene TiledScene::with_s(double s) const {
    TiledScene other = *this;
    other.scene_ = scene_.with_s(s);
    if (kept_) other.other_s_ = std::make_shared<const TiledScene>(*this), other.kept_ = nullptr;
    return other;
}

std::shared_ptr<const TiledScene::Points> TiledScene::points(std::size_t k) const {
    if (!kept_) return make(k);
    Kept& tile = (*kept_)[k];
    const Guard guard(tile.lock);
    if (!tile.points) tile.points = make(k);
    return tile.points;
}

std::shared_ptr<const TiledScene::Points> TiledScene::make(std::size_t k) const {
    if (!other_s_) return std::make_shared<const Points>(shading_points_of(scene_, (*tiles_)[k], nullptr));
    Points points = *other_s_->points(k);
    for (ShadingPoints& group : points) group.take_s(scene_);
    return std::make_shared<const Points>(std::move(points));
}

std::vector<TiledScene> views_at(const TiledScene& view, const std::vector<double>& exponents) {
    std::vector<TiledScene> views;
    for (const double s : exponents) views.push_back(s == view.scene().s() ? view : view.with_s(s));
    return views;
}

std::uint64_t bytes_of_points(const Scene& scene) {
    const auto pixels =
        static_cast<std::uint64_t>(scene.image().width) * static_cast<std::uint64_t>(scene.image().height);
    return pixels * empty_points(scene, 0).bytes_of_one();
}

}  // namespace crescent::inline render
