// A primary ray goes from a pinhole through a pixel's centre; the nearest of all shapes, tested one by one, is hit.
// Whole hits are stored up to whole_hits pixels; above that, only the index of the shape. Positions in kernels are
// relative to the nearest of 144 hits, which is close to what is visible.
#include "scene/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "math/functions.h"

namespace crescent {

Scene::Made::Made(SceneData from) : data(std::move(from)) {
    const Camera& c = data.camera;
    forward = normalize(c.target - c.eye);
    const Vec3d unit_right = normalize(cross(forward, c.up));
    const double pixel = 2 * math::tan(c.vfov_deg * pi / 360) / data.image.height;  // at distance 1
    right = pixel * unit_right;
    up = pixel * cross(unit_right, forward);
    for (std::size_t k = 0; k < data.shapes.size(); ++k)
        if (data.shapes[k].occludes) add_occluders(data.shapes[k], static_cast<int>(k), occluders);
    for (const DiskLight& disk : data.disks) lights.push_back(disk.light());
    for (const bool disks : {true, false}) {
        for (const Light& light : data.lights)
            if (light.is_disk() == disks) lights.push_back(light);
        if (disks) disk_count = lights.size();
    }
    if (const auto surface = data.surface_of_s()) s_shape = static_cast<std::ptrdiff_t>(*surface);
    origin = c.eye;
    rays = Rays(instances(), origin);
    origin = nearest_seen();
    if (!rays.empty()) rays = Rays(instances(), origin);
    for (std::uint32_t k = 0; k < rays.instances().size(); ++k) {
        const MeshInstance& instance = rays.instances()[k];
        const MeshObject& mesh = data.meshes[static_cast<std::size_t>(instance.mesh)];
        if (!mesh.emits()) continue;
        for (std::uint32_t t = 0; t < instance.pack->mesh.triangles.size(); ++t) {
            const auto [p, q, r] = corners(k, t);
            triangle_lights.push_back({{p, q, r}, k, t, instance.mesh});
            if (mesh.two_sided) triangle_lights.push_back({{p, r, q}, k, t, instance.mesh});
        }
    }
    surroundings = make_surroundings();
}

std::shared_ptr<const Surroundings> Scene::Made::make_surroundings() const {
    if (!data.sky && rays.empty()) return nullptr;
    auto out = std::make_shared<Surroundings>();
    if (data.sky) out->sky.emplace(*data.sky);
    std::vector<EmittingTriangle> emitting;
    for (const TriangleLight& light : triangle_lights) {
        EmittingTriangle& to = emitting.emplace_back();
        for (std::size_t c = 0; c < 3; ++c) to.corner[c] = light.corner[c] - origin;
        to.radiance = data.meshes[static_cast<std::size_t>(light.mesh)].emission;
        to.instance = light.instance;
        to.triangle = light.triangle;
    }
    if (!emitting.empty()) out->triangles.emplace(std::move(emitting));
    out->rays = rays;
    out->eye = as<float>(data.camera.eye - origin);
    return out;
}

Scene::Scene(SceneData data) : content_(std::make_shared<const Made>(std::move(data))), s_(content_->data.s()) {}

std::vector<MeshInstance> Scene::Made::instances() const {
    std::vector<MeshInstance> out;
    for (std::size_t m = 0; m < data.meshes.size(); ++m) {
        const MeshObject& mesh = data.meshes[m];
        ensure(mesh.pack != nullptr, "the files of meshes are read before the scene is made");
        const Affine transform = mesh.placement.transform();
        if (mesh.instances.empty()) out.push_back({mesh.pack, transform, static_cast<int>(m)});
        for (const Placement& placement : mesh.instances)
            out.push_back({mesh.pack, placement.transform().after(transform), static_cast<int>(m)});
    }
    return out;
}

std::array<Vec3d, 3> Scene::Made::corners(std::uint32_t instance, std::uint32_t triangle) const {
    const MeshInstance& mesh_instance = rays.instances()[instance];
    const auto corner = [&](std::size_t k) {
        return mesh_instance.to_world.point(widen(mesh_instance.pack->mesh.corner(triangle, k)));
    };
    // A mirrored triangle keeps its front.
    return mesh_instance.to_world.det() > 0 ? std::array{corner(0), corner(1), corner(2)}
                                            : std::array{corner(0), corner(2), corner(1)};
}

Vec3d Scene::Made::nearest_seen() const {
    constexpr int steps = 12;  // up and across
    const Camera& c = data.camera;
    const Image& image = data.image;
    Vec3d nearest = c.eye;
    double distance2 = std::numeric_limits<double>::infinity();
    for (int j = 0; j < steps; ++j) {
        for (int i = 0; i < steps; ++i) {
            const auto middle = [&](int k, int size) { return static_cast<int>((k + 0.5) * size / steps); };
            const std::optional<Hit> hit = trace(middle(i, image.width), middle(j, image.height));
            if (!hit) continue;
            const Vec3d to = hit->x - c.eye;
            if (dot(to, to) < distance2) {
                distance2 = dot(to, to);
                nearest = hit->x;
            }
        }
    }
    return nearest;
}

void Scene::remember_primaries() {
    const std::size_t width = static_cast<std::size_t>(image().width),
                      height = static_cast<std::size_t>(image().height);
    const auto remember = [&](auto& values, const auto& what) {
        parallel_for(std::size_t{0}, height, [&](std::size_t j) {
            for (std::size_t i = 0; i < width; ++i)
                if (const auto hit = content_->trace(static_cast<int>(i), static_cast<int>(j)))
                    values[j * width + i] = what(*hit);
        });
    };
    if (width * height <= whole_hits) {
        auto hits = std::make_shared<std::vector<Hit>>(width * height);
        remember(*hits, [](const Hit& hit) { return hit; });
        hits_ = std::move(hits);
    } else {
        auto shapes = std::make_shared<std::vector<std::int32_t>>(width * height, -1);
        remember(*shapes, [](const Hit& hit) { return hit.shape; });
        shapes_ = std::move(shapes);
    }
}

void Scene::forget_hits() {
    if (!hits_) return;
    auto shapes = std::make_shared<std::vector<std::int32_t>>();
    shapes->reserve(hits_->size());
    for (const Hit& hit : *hits_) shapes->push_back(hit.shape);
    shapes_ = std::move(shapes);
    hits_ = nullptr;
}

Scene Scene::with_s(double s) const {
    Scene other = *this;
    if (content_->s_shape >= 0) {
        other.s_ = s;
        other.other_s_ = true;
    }
    return other;
}

std::size_t Scene::index_of(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(image().width) + static_cast<std::size_t>(i);
}

std::optional<Hit> Scene::primary(int i, int j) const {
    const std::size_t index = index_of(i, j);
    if (hits_) return (*hits_)[index].shape < 0 ? std::nullopt : std::optional<Hit>((*hits_)[index]);
    if (!shapes_) return content_->trace(i, j);
    const int shape = (*shapes_)[index];
    if (shape < 0) return {};
    if (static_cast<std::size_t>(shape) >= shapes().size()) return content_->trace(i, j);
    const Vec3d d = content_->towards(i, j);
    return content_->hit(shape, d, intersect(shapes()[static_cast<std::size_t>(shape)], camera().eye, d));
}

bool Scene::sees_surface(int i, int j) const {
    const std::size_t index = index_of(i, j);
    if (hits_) return (*hits_)[index].shape >= 0;
    return shapes_ ? (*shapes_)[index] >= 0 : content_->trace(i, j).has_value();
}

Rgb Scene::background(int i, int j) const {
    if (!has_background()) return {};
    const SkyTable& sky = *content_->surroundings->sky;
    return sky.radiance(sky.texel_at(content_->towards(i, j)));
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
        if (c.order < best.order) {
            best = c;
            shape = static_cast<int>(k);
        }
    }
    if (!rays.empty()) {
        const Vec3d from = data.camera.eye - origin;
        if (const MeshHit mesh_hit = rays.closest(from, d, infinity); mesh_hit.found()) {
            const Hit on_mesh = hit(mesh_hit, d);
            const double t = dot(on_mesh.x - data.camera.eye, d);
            if (t < best.order) return on_mesh;
        }
    }
    return shape < 0 ? std::nullopt : std::optional<Hit>(hit(shape, d, best));
}

/// In double precision, on the triangle that the ray in single precision has found: its plane, and the nearest point of
/// the triangle in it.
Hit Scene::Made::hit(const MeshHit& mesh_hit, Vec3d d) const {
    const MeshInstance& instance = rays.instances()[mesh_hit.instance];
    const Mesh& mesh = instance.pack->mesh;
    const Triangle& triangle = mesh.triangles[mesh_hit.triangle];
    const auto corner = [&](std::size_t k) {
        return instance.to_world.point(widen(mesh.corner(mesh_hit.triangle, k)));
    };
    const Vec3d a = corner(0), e1 = corner(1) - a, e2 = corner(2) - a, plane_normal = cross(e1, e2);
    const Vec3d from = data.camera.eye - a;
    // Cramer's rule for from + t d = u e1 + v e2; a ray along the plane keeps the weights that were found.
    const double det = -dot(plane_normal, d);
    double u = static_cast<double>(mesh_hit.u), v = static_cast<double>(mesh_hit.v);
    if (det != 0) {
        u = dot(cross(e2, d), from) / det * -1;
        v = dot(cross(d, e1), from) / det * -1;
    }
    u = std::clamp(u, 0.0, 1.0);
    v = std::clamp(v, 0.0, 1.0);
    if (u + v > 1) {
        u /= u + v;
        v = 1 - u;
    }
    Hit out;
    out.shape = static_cast<int>(data.shapes.size()) + instance.mesh;
    out.x = a + u * e1 + v * e2;
    out.wo = -d;
    out.instance = mesh_hit.instance;
    out.triangle = mesh_hit.triangle;
    out.u = u;
    out.v = v;
    const Vec3d face = normalize(plane_normal);
    out.face = dot(face, d) < 0 ? face : -face;
    out.n = out.face;
    if (!mesh.normals.empty()) {
        const auto normal = [&](std::size_t k) { return widen(mesh.normals[triangle[k]]); };
        const Vec3d smooth = instance.to_world.normal((1 - u - v) * normal(0) + u * normal(1) + v * normal(2));
        const double side = dot(smooth, out.face);
        const Vec3d n = side == 0 ? out.face : normalize(side > 0 ? smooth : -smooth);
        out.is_below = dot(n, d) >= 0;
        if (!out.is_below) out.n = n;
    }
    return out;
}

Hit Scene::Made::hit(int shape, Vec3d d, const Intersection& crossing) const {
    return {.shape = shape,
        .reveal = crossing.reveal,
        .x = data.camera.eye + crossing.t * d,
        .n = dot(crossing.n, d) < 0 ? crossing.n : -crossing.n,
        .wo = -d};
}

Vec3d Scene::ray_start(const Hit& hit) const {
    const Vec3d x = hit.x - origin();
    return hit.is_mesh() ? x + rays().offset(hit.instance, x) * hit.face : x;
}

Surface Scene::surface_of_shape(std::size_t shape) const {
    Material material = content_->data.material(shape);
    if (other_s_ && (static_cast<std::ptrdiff_t>(shape) == content_->s_shape || material.inherits_s)) material.s = s_;
    return surface_of(material, s_);
}

Texels Scene::texels(const Hit& hit) const {
    Texels out;
    if (!hit.is_mesh()) return out;
    const MeshObject& object = meshes()[static_cast<std::size_t>(hit.shape) - shapes().size()];
    const RgbImage* const rho_d = object.rho_d_texture.image.get();
    const RgbImage* const alpha = object.alpha_texture.image.get();
    if (!rho_d && !alpha) return out;
    const Mesh& mesh = object.pack->mesh;
    ensure(!mesh.uv.empty(), "a mesh with a texture has texture coordinates");
    const Triangle& corners = mesh.triangles[hit.triangle];
    const auto interpolate = [&](float Vec2<float>::* axis) {
        const auto coordinate = [&](std::size_t k) { return static_cast<double>(mesh.uv[corners[k]].*axis); };
        return (1 - hit.u - hit.v) * coordinate(0) + hit.u * coordinate(1) + hit.v * coordinate(2);
    };
    const double u = interpolate(&Vec2<float>::x), v = interpolate(&Vec2<float>::y);
    if (rho_d) out.rho_d = texel_at(*rho_d, u, v);
    if (alpha) out.alpha = texel_at(*alpha, u, v)[0];
    return out;
}

bool Scene::has_alpha_textures() const {
    return std::ranges::any_of(meshes(), [](const MeshObject& mesh) { return mesh.alpha_texture.image != nullptr; });
}

Surface Scene::surface(const Hit& hit) const {
    const auto shape = static_cast<std::size_t>(hit.shape);
    Surface out = surface_of_shape(shape);
    const Texels factor = texels(hit);
    for (std::size_t c = 0; c < 3; ++c) out.rho_d[c] *= factor.rho_d[c];
    out.alpha *= factor.alpha;
    if (hit.is_below) {
        out.rho_d = {};
        out.rho_s = 0;
    }
    if (hit.reveal) {
        out.rho_d = albedo_of_reveal(shapes()[shape]).value_or(out.rho_d);
        out.rho_s = 0;
    }
    return out;
}

}  // namespace crescent
