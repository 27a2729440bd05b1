// The nearest light along w_i counts. Disks emit from the side of their normal; distances in m.
#include "check/sources/case_lighting.h"

namespace crescent {

std::optional<double> CaseDiskLight::distance(Vec3d wi) const {
    const double c = dot(center, normal), v = dot(wi, normal);
    if (!(v < 0 && c < 0)) return {};
    const Vec3d offset = wi * c - center * v;
    if (!(dot(offset, offset) <= sqr(radius * v))) return {};
    return c / v;
}

std::optional<double> CaseAreaLight::distance(Vec3d wi) const {
    const Vec3d origin{};
    return std::visit(
        [&](const auto& light) -> std::optional<double> {
            const double t = light.shines_on(origin) ? light.body().intersect(origin, wi).t : never;
            return t < never ? std::optional(t) : std::nullopt;
        },
        form);
}

double CaseAreaLight::power() const {
    return radiance * std::visit([](const auto& light) { return light.disk_area(); }, form);
}

std::optional<CaseLighting::Hit> CaseLighting::first_hit(Vec3d wi) const {
    std::optional<Hit> nearest;
    const auto visit = [&](const auto& lights) {
        for (const auto& light : lights)
            if (const std::optional<double> d = light.distance(wi); d && (!nearest || *d < nearest->distance))
                nearest = Hit{*d, light.radiance};
    };
    visit(disks);
    visit(area_lights);
    return nearest;
}

double CaseLighting::operator()(Vec3d wi) const {
    if (wi.z <= 0) return 0;
    const std::optional<Hit> hit = first_hit(wi);
    if (around) {
        const Vec3d w = frame.to_world(wi);
        if (around->triangles) {
            const std::uint32_t k = around->triangles->nearest(position, w);
            if (k != no_triangle && (!hit || around->triangles->distance(k, position, w) < hit->distance))
                return crescent::luminance(around->triangles->triangles()[k].radiance);
        }
        if (!hit && around->sky) return crescent::luminance(around->sky->radiance(around->sky->texel_at(w)));
    }
    return hit ? hit->radiance : fill;
}

}  // namespace crescent
