// A primary ray goes from a pinhole through a pixel's centre; the nearest of all shapes, tested one by one, is hit.
// Whole hits are stored up to whole_hits pixels; above that, only the index of the shape. Positions in kernels are
// relative to the nearest of 144 hits, which is close to what is visible.
#include "scene/scene.h"

#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "math/functions.h"

namespace crescent::inline scene {

Scene::Made::Made(SceneData from) : data(std::move(from)) {
    const Camera& c = data.camera;
    forward = normalize(c.target - c.eye);
    const Vec3d across = normalize(cross(forward, c.up));
    const double pixel = 2 * math::tan(c.vfov_deg * pi / 360) / data.image.height;  // at distance 1
    right = pixel * across;
    up = pixel * cross(across, forward);
    for (std::size_t k = 0; k < data.shapes.size(); ++k)
        if (data.shapes[k].occludes) add_occluders(data.shapes[k], static_cast<int>(k), occluders);
    for (const DiskLight& disk : data.disks) lights.push_back(disk.light());
    for (const bool disks : {true, false}) {
        for (const Light& light : data.lights)
            if (light.is_disk() == disks) lights.push_back(light);
        if (disks) disk_count = lights.size();
    }
    if (const Shape* own = data.shape_of_s()) s_shape = own - data.shapes.data();
    origin = nearest_seen();
    around = surroundings();
}

std::shared_ptr<const Surroundings> Scene::Made::surroundings() const {
    if (!data.sky) return nullptr;
    auto out = std::make_shared<Surroundings>();
    out->sky.emplace(*data.sky);
    out->eye = as<float>(data.camera.eye - origin);
    return out;
}

Scene::Scene(SceneData data) : made_(std::make_shared<const Made>(std::move(data))), s_(made_->data.s()) {}

Vec3d Scene::Made::nearest_seen() const {
    constexpr int rays = 12;  // up and across
    const Camera& c = data.camera;
    const Image& image = data.image;
    Vec3d nearest = c.eye;
    double least = std::numeric_limits<double>::infinity();
    for (int j = 0; j < rays; ++j) {
        for (int i = 0; i < rays; ++i) {
            const auto middle = [&](int k, int size) { return static_cast<int>((k + 0.5) * size / rays); };
            const std::optional<Hit> hit = trace(middle(i, image.width), middle(j, image.height));
            if (!hit) continue;
            const Vec3d to = hit->x - c.eye;
            if (dot(to, to) < least) least = dot(to, to), nearest = hit->x;
        }
    }
    return nearest;
}

void Scene::remember_primaries() {
    const std::size_t width = static_cast<std::size_t>(image().width),
                      height = static_cast<std::size_t>(image().height);
    const auto remember = [&](auto& all, const auto& what) {
        parallel_for(std::size_t{0}, height, [&](std::size_t j) {
            for (std::size_t i = 0; i < width; ++i)
                if (const auto hit = made_->trace(static_cast<int>(i), static_cast<int>(j)))
                    all[j * width + i] = what(*hit);
        });
    };
    if (width * height <= whole_hits) {
        auto all = std::make_shared<std::vector<Hit>>(width * height);
        remember(*all, [](const Hit& hit) { return hit; });
        hits_ = std::move(all);
    } else {
        auto all = std::make_shared<std::vector<std::int32_t>>(width * height, -1);
        remember(*all, [](const Hit& hit) { return hit.shape; });
        shapes_ = std::move(all);
    }
}

Scene Scene::with_s(double s) const {
    Scene other = *this;
    if (made_->s_shape >= 0) other.s_ = s, other.other_s_ = true;
    return other;
}

std::optional<Hit> Scene::primary(int i, int j) const {
    const std::size_t at =
        static_cast<std::size_t>(j) * static_cast<std::size_t>(image().width) + static_cast<std::size_t>(i);
    if (hits_) return (*hits_)[at].shape < 0 ? std::nullopt : std::optional<Hit>((*hits_)[at]);
    if (!shapes_) return made_->trace(i, j);
    const int shape = (*shapes_)[at];
    if (shape < 0) return {};
    const Vec3d d = made_->towards(i, j);
    return made_->hit(shape, d, intersect(shapes()[static_cast<std::size_t>(shape)], camera().eye, d));
}

Vec3d Scene::Made::towards(int i, int j) const {
    const Image& image = data.image;
    return normalize(forward + (i + 0.5 - 0.5 * image.width) * right + (j + 0.5 - 0.5 * image.height) * up);
}

std::optional<Hit> Scene::Made::trace(int i, int j) const {
    const Vec3d d = towards(i, j);
    Intersection best;
    int shape = -1;
    for (std::size_t k = 0; k < data.shapes.size(); ++k) {
        const Intersection c = intersect(data.shapes[k], data.camera.eye, d);
        if (c.order < best.order) best = c, shape = static_cast<int>(k);
    }
    return shape < 0 ? std::nullopt : std::optional<Hit>(hit(shape, d, best));
}

Hit Scene::Made::hit(int shape, Vec3d d, const Intersection& met) const {
    return {shape, met.reveal, data.camera.eye + met.t * d, dot(met.n, d) < 0 ? met.n : -met.n, -d};
}

Surface Scene::surface_of_shape(std::size_t shape) const {
    Material material = shapes()[shape].material;
    if (other_s_ && (static_cast<std::ptrdiff_t>(shape) == made_->s_shape || material.inherits_s)) material.s = s_;
    return surface_of(material, s_);
}

Surface Scene::surface(const Hit& hit) const {
    const auto shape = static_cast<std::size_t>(hit.shape);
    Surface out = surface_of_shape(shape);
    if (hit.reveal) {
        out.rho_d = albedo_of_reveal(shapes()[shape]).value_or(out.rho_d);
        out.rho_s = 0;
    }
    return out;
}

}  // namespace crescent::inline scene
