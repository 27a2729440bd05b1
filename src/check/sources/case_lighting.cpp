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
    const Vec3d here{};
    return std::visit(
        [&](const auto& light) -> std::optional<double> {
            const double t = light.shines_on(here) ? light.body().intersect(here, wi).t : never;
            return t < never ? std::optional(t) : std::nullopt;
        },
        form);
}

double CaseAreaLight::power() const {
    return radiance * std::visit([](const auto& light) { return light.disk_area(); }, form);
}

std::optional<CaseLighting::Met> CaseLighting::first_met(Vec3d wi) const {
    std::optional<Met> first;
    const auto look = [&](const auto& lights) {
        for (const auto& light : lights)
            if (const std::optional<double> d = light.distance(wi); d && (!first || *d < first->distance))
                first = Met{*d, light.radiance};
    };
    look(disks);
    look(area_lights);
    return first;
}

double CaseLighting::operator()(Vec3d wi) const {
    if (wi.z <= 0) return 0;
    const std::optional<Met> met = first_met(wi);
    if (around) {
        const Vec3d w = frame.to_world(wi);
        if (around->triangles) {
            const std::uint32_t k = around->triangles->nearest(position, w);
            if (k != no_triangle && (!met || around->triangles->distance(k, position, w) < met->distance))
                return crescent::luminance(around->triangles->triangles()[k].radiance);
        }
        if (!met && around->sky) return crescent::luminance(around->sky->radiance(around->sky->texel_at(w)));
    }
    return met ? met->radiance : fill;
}

}  // namespace crescent
