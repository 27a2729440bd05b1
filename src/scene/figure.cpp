// Where a plane through the viewpoint, with normal k, cuts a disk or a quad: both ends of the segment. Positions in m
// from the viewpoint.
#include "scene/figure.h"

namespace crescent::inline scene {

std::optional<Line> cut(const shapes::Disk& disk, Vec3d center, Vec3d k) {
    const Vec3d across = k - dot(k, disk.normal) * disk.normal;
    const double size2 = dot(across, across), off = dot(k, center);
    if (!(size2 * sqr(disk.radius) > sqr(off))) return {};
    const double half = std::sqrt(sqr(disk.radius) - sqr(off) / size2);
    const Vec3d foot = center - (off / size2) * across, along = (half / std::sqrt(size2)) * cross(disk.normal, across);
    return Line{foot - along, foot + along};
}

std::optional<Line> cut(const shapes::Quad& quad, Vec3d corner, Vec3d k) {
    const std::array corners = {corner, corner + quad.edge_u, corner + quad.edge_u + quad.edge_v, corner + quad.edge_v};
    std::array<Vec3d, 2> ends{};
    std::size_t found = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec3d p = corners[i], q = corners[(i + 1) % 4];
        const double hp = dot(k, p), hq = dot(k, q);
        if ((hp >= 0) == (hq >= 0) || found == 2) continue;
        ends[found++] = p + (hp / (hp - hq)) * (q - p);
    }
    if (found < 2) return {};
    return Line{ends[0], ends[1]};
}

}  // namespace crescent::inline scene
