// Points of a tile are created on first use, under that tile's lock; for a scene at another s only s and alpha change,
// so they are copied from the first scene's.
#include "render/tiles.h"

#include <utility>

#include "base/parallel.h"

namespace crescent {

struct TiledScene::Kept {
    Mutex lock;
    std::shared_ptr<const Points> points;  // null: not created yet
};

TiledScene::TiledScene(Scene scene)
    : scene_(std::move(scene)),
      tiles_(std::make_shared<const std::vector<TileBox>>(tiles_of(scene_.image().width, scene_.image().height))) {}

void TiledScene::keep_points() { kept_points_ = std::make_shared<std::vector<Kept>>(tiles_->size()); }

TiledScene TiledScene::with_s(double s) const {
    TiledScene other = *this;
    other.scene_ = scene_.with_s(s);
    if (kept_points_) {
        other.other_s_ = std::make_shared<const TiledScene>(*this);
        other.kept_points_ = nullptr;
    }
    return other;
}

std::shared_ptr<const TiledScene::Points> TiledScene::points(std::size_t k) const {
    if (!kept_points_) return make(k);
    Kept& tile = (*kept_points_)[k];
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

}  // namespace crescent
