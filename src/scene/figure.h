// The flat figure in whose directions a light is seen from a point: what the reference integrates over. Lengths in m.
#pragma once

#include <array>
#include <cmath>
#include <optional>

#include "scene/light.h"

namespace crescent::inline scene {

/// The side that a light's figure emits from.
inline Vec3d normal_of(const shapes::Disk& disk) { return disk.normal; }
inline Vec3d normal_of(const shapes::Quad& quad) { return normalize(cross(quad.edge_u, quad.edge_v)); }
inline Vec3d normal_of(const Figure& figure) {
    return std::visit([](const auto& f) { return normal_of(f); }, figure);
}
/// The centre of a figure, m.
inline Vec3d middle_of(const Figure& figure) {
    return std::visit([](const auto& f) { return f.middle(); }, figure);
}
/// How far a figure reaches from its middle along an axis, m.
inline double half_extent_of(const Figure& figure, Vec3d axis) {
    return std::visit([&](const auto& f) { return f.half_extent(axis); }, figure);
}

/// Of the disk about its middle that holds it, m.
inline double radius_of(const shapes::Disk& disk) { return disk.radius; }
inline double radius_of(const shapes::Quad& quad) {
    const Vec3d a = quad.edge_u + quad.edge_v, b = quad.edge_u - quad.edge_v;
    return 0.5 * std::sqrt(std::max(dot(a, a), dot(b, b)));
}
inline double radius_of(const Figure& figure) {
    return std::visit([](const auto& f) { return radius_of(f); }, figure);
}

/// Its area over pi, m^2.
inline double disk_area(const shapes::Disk& disk) { return sqr(disk.radius); }
inline double disk_area(const shapes::Quad& quad) {
    const Vec3d n = cross(quad.edge_u, quad.edge_v);
    return std::sqrt(dot(n, n)) / pi;
}
inline double disk_area(const Figure& figure) {
    return std::visit([](const auto& f) { return disk_area(f); }, figure);
}

/// The corners of a parallelogram that holds it, in order round it.
inline std::array<Vec3d, 4> corners_about(const shapes::Disk& disk) {
    const Frame<double> frame = frame_about(disk.normal);
    const Vec3d side = disk.radius * frame.t, up = disk.center + disk.radius * frame.b,
                down = disk.center - disk.radius * frame.b;
    return {up - side, up + side, down + side, down - side};
}
/// The corners in their order about the normal.
inline std::array<Vec3d, 4> corners_about(const shapes::Quad& quad) {
    return {quad.corner, quad.corner + quad.edge_u, quad.corner + quad.edge_u + quad.edge_v, quad.corner + quad.edge_v};
}
inline std::array<Vec3d, 4> corners_about(const Figure& figure) {
    return std::visit([](const auto& f) { return corners_about(f); }, figure);
}

/// The same directions from x, `far` times as far away.
inline shapes::Disk moved(const shapes::Disk& disk, Vec3d x, double far) {
    return {x + far * (disk.center - x), disk.normal, far * disk.radius};
}
/// The figure seen from x, lengths over `far`.
inline shapes::Quad moved(const shapes::Quad& quad, Vec3d x, double far) {
    return {x + far * (quad.corner - x), far * quad.edge_u, far * quad.edge_v};
}
inline Figure moved(const Figure& figure, Vec3d x, double far) {
    return std::visit([&](const auto& f) -> Figure { return moved(f, x, far); }, figure);
}

/// The figure as something that hides others.
inline Bodies::Any body_of(const Figure& figure) {
    return std::visit([](const auto& f) -> Bodies::Any { return f; }, figure);
}

/// Two points of a figure's edge.
struct Line {
    Vec3d from, to;
};
/// Where the plane of normal k through the origin cuts a figure whose middle or corner lies at `at` from there.
std::optional<Line> cut(const shapes::Disk& disk, Vec3d at, Vec3d k);
std::optional<Line> cut(const shapes::Quad& quad, Vec3d at, Vec3d k);

}  // namespace crescent::inline scene
