// The ends of a ray count as in the kernels: what is within a relative 1e-5 of a light does not hide it.
#include "scene/surroundings.h"

#include <algorithm>

namespace crescent {

namespace {

void put(const Rgb& radiance, float* rgb) {
    for (std::size_t c = 0; c < 3; ++c) rgb[c] = static_cast<float>(radiance[c]);
}

}  // namespace

MeshesBefore meshes_before(const Surroundings& around, Vec3f x, Vec3f d, float light, std::uint32_t aimed) {
    constexpr float before = 1 - 1e-5f, nothing = 1e30f;
    MeshesBefore out;
    if (!around.triangles) {
        out.hidden = around.rays.occluded(x, d, light * before);
        return out;
    }
    float end = light * before;
    if (aimed == no_triangle && light == nothing && !around.sky &&
        !around.triangles->may_meet(x, d, 2 * around.rays.error(x))) {
        out.hidden = true;  // or it leaves the scene: there is no light either way
        return out;
    }
    if (aimed != no_triangle) {
        out.distance = static_cast<float>(around.triangles->distance(aimed, widen(x), widen(d)));
        if (out.distance > 0 && out.distance < light) {
            out.triangle = aimed;
            end = std::min(end, out.distance * before);
        }
    }
    const MeshHit hit = around.rays.closest(x, d, end);
    if (!hit.found()) return out;
    out.triangle = around.triangles->find(hit.instance, hit.triangle, widen(d));
    out.distance = hit.t;
    out.hidden = out.triangle == no_triangle;
    return out;
}

void sky_radiance(const Surroundings& around, std::uint32_t texel, Vec3f d, float* rgb) {
    texel_radiance(around, texel == no_texel ? sky_texel(around, d) : texel, rgb);
}

void texel_radiance(const Surroundings& around, std::uint32_t texel, float* rgb) {
    if (around.sky && texel != no_texel) put(around.sky->radiance(texel), rgb);
}

std::uint32_t sky_texel(const Surroundings& around, Vec3f d) {
    return around.sky ? around.sky->texel_at(widen(d)) : no_texel;
}

void triangle_radiance(const Surroundings& around, std::uint32_t triangle, float* rgb) {
    put(around.triangles->triangles()[triangle].radiance, rgb);
}

bool has_sky(const Surroundings& around) { return around.sky.has_value(); }
bool has_meshes(const Surroundings& around) { return !around.rays.empty(); }

void sample_sky(
    const Surroundings& around, std::span<const double> u, std::span<const double> v, std::span<SkyDraw> out) {
    if (around.sky) around.sky->sample(u, v, out);
    else std::ranges::fill(out, SkyDraw{.w = {0, 1, 0}, .texel = no_texel, .pdf = 0});
}

double sky_pdf(const Surroundings& around, std::uint32_t texel, Vec3d d) {
    return around.sky ? around.sky->pdf(texel == no_texel ? around.sky->texel_at(d) : texel) : 0;
}

TriangleDraw sample_triangles(const Surroundings& around, Vec3d x, double u, double v, bool whole) {
    return around.triangles ? around.triangles->sample(x, u, v, whole) : TriangleDraw{{0, 1, 0}, no_triangle, 0};
}

double triangles_pdf(const Surroundings& around, Vec3d x, Vec3d d) {
    return around.triangles ? around.triangles->pdf(x, d) : 0;
}

}  // namespace crescent
