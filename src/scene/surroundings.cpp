// The ends of a ray count as in the kernels: what is within a relative 1e-5 of a light does not hide it.
#include "scene/surroundings.h"

#include <algorithm>

namespace crescent {

namespace {

void put(const Rgb& radiance, float* rgb) {
    for (std::size_t c = 0; c < 3; ++c) rgb[c] = static_cast<float>(radiance[c]);
}

}  // namespace

MeshesBefore meshes_before(
    const Surroundings& surroundings, Vec3f x, Vec3f d, float light, std::uint32_t aimed_triangle) {
    constexpr float margin = 1 - 1e-5f, nothing = 1e30f;
    MeshesBefore out;
    if (!surroundings.triangles) {
        out.is_hidden = surroundings.rays.occluded(x, d, light * margin);
        return out;
    }
    float end = light * margin;
    if (aimed_triangle == no_triangle && light == nothing && !surroundings.sky &&
        !surroundings.triangles->may_meet(x, d, 2 * surroundings.rays.error(x))) {
        out.is_hidden = true;  // or it leaves the scene: there is no light either way
        return out;
    }
    if (aimed_triangle != no_triangle) {
        out.distance = static_cast<float>(surroundings.triangles->distance(aimed_triangle, widen(x), widen(d)));
        if (out.distance > 0 && out.distance < light) {
            out.triangle = aimed_triangle;
            end = std::min(end, out.distance * margin);
        }
    }
    const MeshHit hit = surroundings.rays.closest(x, d, end);
    if (!hit.found()) return out;
    out.triangle = surroundings.triangles->find(hit.instance, hit.triangle, widen(d));
    out.distance = hit.t;
    out.is_hidden = out.triangle == no_triangle;
    return out;
}

void sky_radiance(const Surroundings& surroundings, std::uint32_t texel, Vec3f d, float* rgb) {
    texel_radiance(surroundings, texel == no_texel ? sky_texel(surroundings, d) : texel, rgb);
}

void texel_radiance(const Surroundings& surroundings, std::uint32_t texel, float* rgb) {
    if (surroundings.sky && texel != no_texel) put(surroundings.sky->radiance(texel), rgb);
}

std::uint32_t sky_texel(const Surroundings& surroundings, Vec3f d) {
    return surroundings.sky ? surroundings.sky->texel_at(widen(d)) : no_texel;
}

void triangle_radiance(const Surroundings& surroundings, std::uint32_t triangle, float* rgb) {
    put(surroundings.triangles->triangles()[triangle].radiance, rgb);
}

bool has_sky(const Surroundings& surroundings) { return surroundings.sky.has_value(); }
bool has_meshes(const Surroundings& surroundings) { return !surroundings.rays.empty(); }

void sample_sky(
    const Surroundings& surroundings, std::span<const double> u, std::span<const double> v, std::span<SkyDraw> out) {
    if (surroundings.sky) surroundings.sky->sample(u, v, out);
    else std::ranges::fill(out, SkyDraw{.w = {0, 1, 0}, .texel = no_texel, .pdf = 0});
}

double sky_pdf(const Surroundings& surroundings, std::uint32_t texel, Vec3d d) {
    return surroundings.sky ? surroundings.sky->pdf(texel == no_texel ? surroundings.sky->texel_at(d) : texel) : 0;
}

TriangleDraw sample_triangles(const Surroundings& surroundings, Vec3d x, double u, double v, bool is_whole) {
    return surroundings.triangles ? surroundings.triangles->sample(x, u, v, is_whole)
                                  : TriangleDraw{{0, 1, 0}, no_triangle, 0};
}

double triangles_pdf(const Surroundings& surroundings, Vec3d x, Vec3d d) {
    return surroundings.triangles ? surroundings.triangles->pdf(x, d) : 0;
}

}  // namespace crescent
