// One shading point of one pixel, in single precision and in the kernels' order of operations: X of a sample has the
// bits that it has in the film. Directions and outlines for drawing are in double.
#include "render/pixel.h"

#include <cmath>
#include <optional>

#include "base/errors.h"
#include "base/vec.h"
#include "math/functions.h"
#include "math/simd/random.h"
#include "render/disk_hit.h"
#include "samplers/all.h"
#include "scene/lobes/all.h"
#include "scene/scene_data.h"

namespace crescent {

namespace {

Vec3f vector_of(const std::vector<float>& x, const std::vector<float>& y, const std::vector<float>& z) {
    return {x[0], y[0], z[0]};
}

float lobe_of(const ShadingPoints& shading_points, Vec3f wi) {
    const Vec3f wo = vector_of(shading_points.wox, shading_points.woy, shading_points.woz);
    const float s = shading_points.s[0], alpha = shading_points.alpha[0];
    return lobe_value(static_cast<LobeKind>(shading_points.lobe), s, alpha, wo, wi);
}

std::vector<LocalDisk<float>> local_disks(const ShadingPoints& shading_points) {
    std::vector<LocalDisk<float>> out;
    for (const DiskArrays& d : shading_points.disks) {
        const float sides = d.two_sided ? 1.0f : 0.0f;
        out.push_back({vector_of(d.cx, d.cy, d.cz), vector_of(d.nx, d.ny, d.nz), d.radius, sides, d.power});
    }
    return out;
}

std::vector<LocalLight<float>> local_others(const ShadingPoints& shading_points) {
    std::vector<LocalLight<float>> out;
    for (const LightArrays& from : shading_points.others) {
        LocalLight<float>& light = out.emplace_back();
        const auto& n = from.numbers;
        light.kind = from.kind;
        light.power = from.power;
        light.a = vector_of(n[0], n[1], n[2]);
        light.b = vector_of(n[3], n[4], n[5]);
        light.c = vector_of(n[6], n[7], n[8]);
        for (std::size_t k = 0; k < light.number.size(); ++k) light.number[k] = n[9 + k][0];
    }
    return out;
}

/// The lights of a shading point, disks first.
struct Locals {
    const std::vector<LocalDisk<float>>& disks;
    const std::vector<LocalLight<float>>& others;
};

/// What a direction meets first: a light, or light that varies; neither: the fill.
struct Seen {
    int disk = -1;
    bool meets_surroundings = false;
    Vec3f radiance{};  // of light that varies
};

/// Returns whether a direction is below the triangle of the surface point.
bool is_below_face(const ShadingPoints& points, Vec3f wi) {
    return points.has_faces && dot(vector_of(points.face_x, points.face_y, points.face_z), wi) <= 0;
}

/// In the order of the kernels: the nearest light first, then the meshes and the bodies before it.
template <class D> Seen seen_by(const ShadingPoints& shading_points, const Locals& locals, const D& draw) {
    const auto& [disks, others] = locals;
    const Vec3f wi = draw.wi;
    constexpr float far = 1e30f;
    float nearest = far;
    int light = -1;
    for (std::size_t k = 0; k < disks.size(); ++k) {
        const FacingDisk<float> facing(disks[k]);
        float v;
        if (!meets_disk(facing, draw, k, shading_points.light_count() == 1, v) || !is_nearer(facing.k / v, nearest))
            continue;
        nearest = facing.k / v;
        light = static_cast<int>(k);
    }
    for (std::size_t k = 0; k < others.size(); ++k) {
        float t;
        if (!meets_light(others[k], draw, disks.size() + k, t) || !is_nearer(t, nearest)) continue;
        nearest = t;
        light = static_cast<int>(disks.size() + k);
    }
    const Surroundings* const surroundings = shading_points.around.get();
    if (light < 0 && !surroundings) return {};
    const Vec3f t = vector_of(shading_points.tx, shading_points.ty, shading_points.tz),
                b = vector_of(shading_points.bx, shading_points.by, shading_points.bz);
    const Frame<float> frame = {t, b, vector_of(shading_points.nx, shading_points.ny, shading_points.nz)};
    const Vec3f o = vector_of(shading_points.px, shading_points.py, shading_points.pz), d = frame.to_world(wi);
    std::uint32_t triangle = no_triangle, texel = no_texel;
    if (surroundings && has_meshes(*surroundings)) {
        std::uint32_t aimed_triangle = no_triangle;
        if constexpr (requires { draw.triangle; }) aimed_triangle = draw.triangle;
        const MeshesBefore meshes = meshes_before(*surroundings, o, d, nearest, aimed_triangle);
        if (meshes.is_hidden) return {};
        if (meshes.triangle != no_triangle) {
            triangle = meshes.triangle;
            nearest = meshes.distance;
        }
    }
    const bool meets_emitter = nearest < far;
    if (!meets_emitter && !has_sky(*surroundings)) return {};
    const float from = meets_emitter ? nearest : length(o - surroundings->eye);  // as the kernels: lo in units of it
    for (const OccluderF& body : shading_points.occluders)
        if (body.shape != shading_points.shape[0] &&
            blocked_by(body, o, d, from * float(1e-5), nearest * float(1 - 1e-5)))
            return {};
    if (meets_emitter && triangle == no_triangle) return {light};
    if constexpr (requires { draw.texel; }) texel = draw.texel;
    float rgb[3] = {0, 0, 0};
    if (triangle != no_triangle) triangle_radiance(*surroundings, triangle, rgb);
    else sky_radiance(*surroundings, texel, d, rgb);
    return {-1, true, {rgb[0], rgb[1], rgb[2]}};
}

/// f L of the Lambert part and of the lobe, as Y: X = (cos/p) (d + lobe s).
struct Worth {
    float d, s;
};
/// Of light that varies: the sum for one value of the lobe.
Worth worth(const ShadingPoints& points, Vec3f radiance, float lobe) {
    const float channel[3] = {radiance.x, radiance.y, radiance.z};
    float sum = 0;
    for (std::size_t c = 0; c < 3; ++c) {
        const float per_radiance = points.around_d[c][0] + lobe * points.around_s[c][0];
        sum = sum + channel[c] * per_radiance;
    }
    return {sum, 0};
}
double luminance_of(Vec3f radiance) {
    return luminance(Rgb{double(radiance.x), double(radiance.y), double(radiance.z)});
}

Worth worth(const ShadingPoints& shading_points, int disk) {
    if (disk < 0) return {shading_points.fill_d[0], shading_points.fill_s[0]};
    const std::size_t k = static_cast<std::size_t>(disk);
    if (k < shading_points.disks.size()) return {shading_points.disks[k].d[0], shading_points.disks[k].s[0]};
    const LightArrays& other = shading_points.others[k - shading_points.disks.size()];
    return {other.d[0], other.s[0]};
}

/// Returns f, per sr, for light of luminance `light`; without light, for grey light.
double reflected(const ShadingPoints& shading_points, const Worth& w, float lobe, double light) {
    if (light > 0) return double(w.d + lobe * w.s) / light;
    return double(shading_points.diffuse[0]) / pi + double(shading_points.rho_s[0] * lobe);
}

/// Computes X of a direction, in the kernels' own order of operations.
class Carrier {
public:
    Carrier(const ShadingPoints& shading_points, const Locals& disks, const std::vector<PixelLight>& pixel_lights,
        double fill)
        : shading_points_(shading_points), lights_(disks), pixel_lights_(pixel_lights), fill_(fill) {}

    template <class D> PixelSample operator()(Vec2<float> u, const D& draw, float weight, int technique) const {
        PixelSample out;
        out.u = u;
        out.wi = draw.wi;
        out.pdf = draw.pdf.v;
        out.cos = draw.wi.z;
        out.weight = weight;
        out.technique = technique;
        if (out.cos <= 0 || is_below_face(shading_points_, out.wi) || out.pdf == 0) return out;
        const float g = weight * (out.cos / out.pdf), lobe = lobe_of(shading_points_, out.wi);
        const Seen hit = seen_by(shading_points_, lights_, draw);
        out.disk = hit.disk;
        out.meets_surroundings = hit.meets_surroundings;
        const Worth w =
            hit.meets_surroundings ? worth(shading_points_, hit.radiance, lobe) : worth(shading_points_, out.disk);
        out.x = g * (w.d + lobe * w.s);
        out.light = static_cast<float>(hit.meets_surroundings ? luminance_of(hit.radiance)
                : out.disk < 0                                ? fill_
                               : pixel_lights_[static_cast<std::size_t>(out.disk)].light);
        out.f = static_cast<float>(reflected(shading_points_, w, lobe, double(out.light)));
        return out;
    }

private:
    const ShadingPoints& shading_points_;
    const Locals lights_;
    const std::vector<PixelLight>& pixel_lights_;
    double fill_;
};

/// Calls work.template operator()<A>() for the sampler of that name.
template <class Work> void with_arm(std::string_view sampler, Work&& work) {
    bool has_match = false;
    for_each_sampler(Samplers{}, [&]<template <class> class A>() {
        if (A<float>::name != sampler) return;
        has_match = true;
        work.template operator()<A>();
    });
    ensure(has_match, "a sampler is a word of arms/all.h");
}

PixelLight seen_light(const Light& light, const Hit& hit) {
    const Frame<double> frame = frame_about(hit.n);
    const Figure figure = light.seen_from(hit.x);
    const Vec3d c = frame.to_local(middle_of(figure) - hit.x);
    const double distance = length(c), half = math::atan2(radius_of(figure), distance) * 180 / pi;
    PixelLight out{.name = light.name,
        .towards = c * (1 / distance),
        .angular_radius = half,
        .light = luminance(light.radiance),
        .rim = {},
        .faces = light.shines_on(hit.x)};
    constexpr int points = 96;
    const auto disk = std::get_if<shapes::Disk>(&figure);
    const std::array<Vec3d, 4> corners = corners_about(figure);
    const Frame<double> light_frame = frame_about(normal_of(figure));
    for (int k = 0; k <= points; ++k) {
        const double a = 2 * pi * k / points, side = 4.0 * (k % points) / points;
        const std::size_t first = static_cast<std::size_t>(side);
        const Vec3d edge = corners[first] + (side - std::floor(side)) * (corners[(first + 1) % 4] - corners[first]);
        const Vec3d y =
            disk ? disk->center + disk->radius * (light_frame.t * math::cos(a) + light_frame.b * math::sin(a)) : edge;
        out.rim.push_back(normalize(frame.to_local(y - hit.x)));
    }
    return out;
}

ShadingPoints point_of(const Scene& scene, int i, int j) {
    std::vector<ShadingPoints> groups = shading_points_of(scene, {i, j, i + 1, j + 1}, nullptr);
    ensure(groups.size() == 1 && groups[0].count == 1, "an opened pixel sees a surface");
    return std::move(groups[0]);
}

}  // namespace

OpenPixel::OpenPixel(const Scene& scene, int i, int j)
    : i_(i),
      j_(j),
      shading_points_(point_of(scene, i, j)),
      hit_(*scene.primary(i, j)),
      surface_(scene.surface(hit_)),
      wo_(widen(vector_of(shading_points_.wox, shading_points_.woy, shading_points_.woz))),
      fill_(luminance(scene.fill())),
      local_(local_disks(shading_points_)),
      others_(local_others(shading_points_)) {
    for (const Light& light : scene.lights()) lights_.push_back(seen_light(light, hit_));
}

ShadingPoint<float> OpenPixel::aimed_from() const {
    const ShadingPoints& p = shading_points_;
    ShadingPoint<float> out{.wo = vector_of(p.wox, p.woy, p.woz),
        .s = p.s[0],
        .alpha = p.alpha[0],
        .diffuse = p.diffuse[0],
        .lobe = p.rho_s[0],
        .disks = local_.data(),
        .disk_count = static_cast<int>(local_.size()),
        .others = others_.data(),
        .other_count = static_cast<int>(others_.size())};
    out.lobe_kind = static_cast<LobeKind>(p.lobe);
    if (!p.around) return out;
    out.around = p.around.get();
    out.position = vector_of(p.px, p.py, p.pz);
    out.frame = {vector_of(p.tx, p.ty, p.tz), vector_of(p.bx, p.by, p.bz), vector_of(p.nx, p.ny, p.nz)};
    return out;
}

Vec3d OpenPixel::mirror() const { return crescent::mirror(wo_); }

namespace {

Seen seen_in(const ShadingPoints& points, const Locals& lights, Vec3d wi) {
    const Vec3f w = as<float>(wi);
    return wi.z > 0 && !is_below_face(points, w) ? seen_by(points, lights, Drawn<float>{w, {1}}) : Seen{};
}

}  // namespace

int OpenPixel::disk_met(Vec3d wi) const { return seen_in(shading_points_, {local_, others_}, wi).disk; }

bool OpenPixel::meets_light(Vec3d wi) const {
    const Seen hit = seen_in(shading_points_, {local_, others_}, wi);
    return hit.disk >= 0 || hit.meets_surroundings;
}

double OpenPixel::light(Vec3d wi) const {
    const Seen hit = seen_in(shading_points_, {local_, others_}, wi);
    if (hit.meets_surroundings) return luminance_of(hit.radiance);
    return hit.disk < 0 ? fill_ : lights_[static_cast<std::size_t>(hit.disk)].light;
}

double OpenPixel::f(Vec3d wi, int disk) const {
    if (!(wi.z > 0) || is_below_face(shading_points_, as<float>(wi))) return 0;
    const Worth w = worth(shading_points_, disk);
    const double light = disk < 0 ? fill_ : lights_[static_cast<std::size_t>(disk)].light;
    return reflected(shading_points_, w, lobe_of(shading_points_, as<float>(wi)), light);
}

double OpenPixel::pdf(std::string_view sampler, Vec3d wi) const {
    const ShadingPoint<float> shading_point = aimed_from();
    double out = 0;
    with_arm(sampler, [&]<template <class> class A>() {
        const A<float> arm(shading_point);
        const Vec3f w = as<float>(wi);
        if constexpr (requires { A<float>::techniques; })
            out = double(arm.template pdf_technique<0>(shading_point.wo, w).v);
        else out = double(arm.pdf(shading_point.wo, w).v);
    });
    return out;
}

std::vector<PixelSample> OpenPixel::samples(std::string_view sampler, std::uint64_t n, std::uint32_t seed) const {
    const ShadingPoint<float> shading_point = aimed_from();
    const Carrier accumulate(shading_points_, {local_, others_}, lights_, fill_);
    std::vector<PixelSample> out;
    with_arm(sampler, [&]<template <class> class A>() {
        const A<float> arm(shading_point);
        for (std::uint64_t k = 0; k < n; ++k) {
            const Vec2<float> u = draw(seed, shading_points_.pixel[0], k);
            if constexpr (requires { A<float>::techniques; }) {
                const Vec2<float> v = draw(seed, shading_points_.pixel[0], k, 1);
                const auto a = arm.template sample_technique<0>(shading_point.wo, u);
                const auto b = arm.template sample_technique<1>(shading_point.wo, v);
                out.push_back(accumulate(u, a, arm.template weight<0>(shading_point.wo, a), 0));
                out.push_back(accumulate(v, b, arm.template weight<1>(shading_point.wo, b), 1));
            } else {
                out.push_back(accumulate(u, arm.sample(shading_point.wo, u), 1, 0));
            }
        }
    });
    return out;
}

std::vector<double> running_mean(const std::vector<PixelSample>& samples) {
    std::vector<double> out;
    double sum = 0;
    for (const PixelSample& sample : samples) {
        sum += static_cast<double>(sample.x);
        if (sample.technique == 0) out.push_back(sum);
        else out.back() = sum;
    }
    for (std::size_t k = 0; k < out.size(); ++k) out[k] /= static_cast<double>(k + 1);
    return out;
}

}  // namespace crescent
