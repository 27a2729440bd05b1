// Positions are those that the kernels use: float, in the local frame of each point. Disks come first, as in the scene.
#include "render/external_lights.h"

#include <cmath>
#include <limits>

namespace crescent::inline render {

namespace {

LocalLight<double> local_light(const LightArrays& arrays, std::size_t at) {
    const auto number = [&](std::size_t k) { return static_cast<double>(arrays.numbers[k][at]); };
    const auto vector = [&](std::size_t k) { return Vec3d{number(k), number(k + 1), number(k + 2)}; };
    LocalLight<double> out{arrays.kind, static_cast<double>(arrays.power), vector(0), vector(3), vector(6), {}};
    for (std::size_t k = 0; k < out.number.size(); ++k) out.number[k] = number(9 + k);
    return out;
}

ExternalLightAt disk_at(const DiskArrays& disk, std::size_t at) {
    const Vec3d center{double(disk.cx[at]), double(disk.cy[at]), double(disk.cz[at])};
    const Vec3d normal{double(disk.nx[at]), double(disk.ny[at]), double(disk.nz[at])};
    return {center, normal, {}, {}, shines_flat(center, normal, static_cast<double>(disk.radius), disk.two_sided)};
}

template <class Kind> ExternalLightAt light_at(const LocalLight<double>& light) {
    ExternalLightAt out{light.a, {}, {}, {}, Kind::shines(light)};
    if constexpr (requires { Kind::half_edges(light); }) {
        const auto [u, v] = Kind::half_edges(light);
        out.edge_u = u, out.edge_v = v, out.normal = normalize(cross(u, v));
    }
    return out;
}

}  // namespace

std::vector<ExternalLight> lights_of(const ShadingPoints& shading_points) {
    std::vector<ExternalLight> out;
    if (shading_points.count == 0) return out;
    for (const DiskArrays& disk : shading_points.disks)
        out.push_back({lights::Disk::name, disk.radiance, static_cast<double>(disk.radius)});
    for (const LightArrays& arrays : shading_points.others)
        with_light_kind(arrays.kind, [&]<class Kind>() {
            out.push_back({Kind::name, arrays.radiance, std::sqrt(Kind::radius2(local_light(arrays, 0)))});
        });
    return out;
}

void add_lights_at(const ShadingPoints& shading_points, std::size_t at, std::vector<ExternalLightAt>& to) {
    for (const DiskArrays& disk : shading_points.disks) to.push_back(disk_at(disk, at));
    for (const LightArrays& arrays : shading_points.others)
        with_light_kind(arrays.kind, [&]<class Kind>() { to.push_back(light_at<Kind>(local_light(arrays, at))); });
}

ExternalRun run_at(const ShadingPoints& points, std::size_t at, Vec3<double> wo, std::size_t rows) {
    const Rgb& lambert = points.lambert[at];
    return {wo, {double(points.s[at]), double(points.alpha[at]), double(points.diffuse[at]), points.rho_s_exact[at]},
        rows, {lambert[0] * pi, lambert[1] * pi, lambert[2] * pi}};
}

bool is_usable(const Vec3<double>& wi, double p) {
    const auto pdf = static_cast<float>(p);
    return std::fabs(dot(wi, wi) - 1) <= 2e-4 && pdf > 0 && pdf <= std::numeric_limits<float>::max();
}

}  // namespace crescent::inline render
