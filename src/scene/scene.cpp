#include "scene/scene.h"

#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "math/functions.h"
#include "scene/intersect.h"

namespace crescent {

namespace {

void add_occluders(const Shape& q, int index, std::vector<Occluder>& out) {
    using K = Occluder::Kind;
    switch (q.kind) {
        case ShapeKind::sphere: out.push_back({K::sphere, index, q.center, {}, {}, q.radius}); break;
        case ShapeKind::box: out.push_back({K::box, index, q.min, q.max, {}, 0}); break;
        case ShapeKind::quad: out.push_back({K::quad, index, q.corner, q.edge_u, q.edge_v, 0}); break;
        case ShapeKind::disk: out.push_back({K::disk, index, q.center, q.normal, {}, q.radius}); break;
        case ShapeKind::plane: out.push_back({K::plane, index, q.point, q.normal, {}, 0}); break;
        case ShapeKind::panel: {
            const Vec3d down = -q.depth * quad_normal(q);
            out.push_back({K::quad, index, q.corner + down, q.edge_u, q.edge_v, 0});
            out.push_back({K::quad, index, q.corner, q.edge_u, down, 0});
            out.push_back({K::quad, index, q.corner, q.edge_v, down, 0});
            out.push_back({K::quad, index, q.corner + q.edge_v, q.edge_u, down, 0});
            out.push_back({K::quad, index, q.corner + q.edge_u, q.edge_v, down, 0});
            break;
        }
    }
}

}  // namespace

Scene::Scene(const Experiment& experiment) : experiment_(experiment) {
    const Camera& c = experiment_.camera;
    const Image& image = experiment_.image;
    const Vec3d forward = normalize(c.target - c.eye);
    const Vec3d right = normalize(cross(forward, c.up));
    const double pixel = 2 * math::tan(c.vfov_deg * pi / 360) / image.height;  // at distance 1
    forward_ = forward;
    right_ = pixel * right;
    up_ = pixel * cross(right, forward);
    bool needs_s = false;
    for (const Shape& shape : experiment_.shapes) needs_s = needs_s || !shape.material.s;
    s_ = needs_s ? experiment_.s() : 0;
    for (std::size_t k = 0; k < experiment_.shapes.size(); ++k)
        if (experiment_.shapes[k].occludes) add_occluders(experiment_.shapes[k], static_cast<int>(k), occluders_);
    origin_ = nearest_seen();
}

Vec3d Scene::nearest_seen() const {
    constexpr int rays = 12;  // up and across
    const Camera& c = experiment_.camera;
    const Image& image = experiment_.image;
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
    const std::size_t width = static_cast<std::size_t>(experiment_.image.width),
                      height = static_cast<std::size_t>(experiment_.image.height);
    if (width * height > std::size_t{1} << 20) return;
    auto all = std::make_shared<std::vector<Hit>>(width * height);
    parallel_for(std::size_t{0}, height, [&](std::size_t j) {
        for (std::size_t i = 0; i < width; ++i)
            if (const auto hit = trace(static_cast<int>(i), static_cast<int>(j))) (*all)[j * width + i] = *hit;
    });
    primaries_ = std::move(all);
}

Scene Scene::with_s(double s) const {
    Scene other(experiment_.with_s(s));
    other.primaries_ = primaries_;
    return other;
}

std::optional<Hit> Scene::primary(int i, int j) const {
    if (!primaries_) return trace(i, j);
    const Hit& hit = (*primaries_)[static_cast<std::size_t>(j) * static_cast<std::size_t>(experiment_.image.width) +
        static_cast<std::size_t>(i)];
    return hit.shape < 0 ? std::nullopt : std::optional<Hit>(hit);
}

std::optional<Hit> Scene::trace(int i, int j) const {
    const Image& image = experiment_.image;
    const Vec3d d = normalize(forward_ + (i + 0.5 - 0.5 * image.width) * right_ + (j + 0.5 - 0.5 * image.height) * up_);
    const Vec3d eye = experiment_.camera.eye;
    Crossing best;
    Hit hit;
    for (std::size_t k = 0; k < experiment_.shapes.size(); ++k) {
        const Crossing c = intersect(experiment_.shapes[k], eye, d);
        if (c.order < best.order) best = c, hit.shape = static_cast<int>(k);
    }
    if (hit.shape < 0) return {};
    hit.reveal = best.reveal;
    hit.x = eye + best.t * d;
    hit.n = dot(best.n, d) < 0 ? best.n : -best.n;
    hit.wo = -d;
    return hit;
}

Surface surface_of(const Material& m, double common_s) {
    const double s = m.s.value_or(common_s);
    return {m.rho_d, m.rho_s, m.brdf, s, m.alpha.value_or(std::sqrt(2 / (s + 2)))};
}

Surface Scene::surface(const Hit& hit) const {
    const Shape& shape = experiment_.shapes[static_cast<std::size_t>(hit.shape)];
    Surface out = surface_of(shape.material, s_);
    if (hit.reveal) {
        out.rho_d = shape.reveal_rho_d.value_or(out.rho_d);
        out.rho_s = 0;
    }
    return out;
}

}  // namespace crescent
