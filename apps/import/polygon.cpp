// Ears are tested in the plane along the longest axis of the area vector, so that nothing is divided.
#include "polygon.h"

#include <cmath>

namespace crescent::importer {

namespace {

/// Twice the signed area of a triangle of the plane.
double area(const Vec2<double>& a, const Vec2<double>& b, const Vec2<double>& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The corners in the plane, in which the polygon is counterclockwise.
std::vector<Vec2<double>> flattened(std::span<const Vec3d> positions, std::span<const std::uint32_t> corners) {
    Vec3d normal{};
    const Vec3d origin = positions[corners[0]];
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const Vec3d a = positions[corners[k]] - origin;
        const Vec3d b = positions[corners[(k + 1) % corners.size()]] - origin;
        normal = normal + cross(a, b);
    }
    const double x = std::fabs(normal.x), y = std::fabs(normal.y), z = std::fabs(normal.z);
    std::vector<Vec2<double>> out;
    out.reserve(corners.size());
    for (const std::uint32_t corner : corners) {
        const Vec3d p = positions[corner] - origin;
        if (z >= x && z >= y) out.push_back({normal.z < 0 ? p.y : p.x, normal.z < 0 ? p.x : p.y});
        else if (y >= x) out.push_back({normal.y < 0 ? p.x : p.z, normal.y < 0 ? p.z : p.x});
        else out.push_back({normal.x < 0 ? p.z : p.y, normal.x < 0 ? p.y : p.z});
    }
    return out;
}

}  // namespace

void triangulate(
    std::span<const Vec3d> positions, std::span<const std::uint32_t> corners, std::vector<Triangle>& triangles) {
    const std::vector<Vec2<double>> plane = flattened(positions, corners);
    std::vector<std::size_t> left(corners.size());
    for (std::size_t k = 0; k < left.size(); ++k) left[k] = k;
    // Also two corners at one place, as at the bridge to a hole.
    const auto same = [&](std::size_t a, std::size_t b) {
        return plane[a].x == plane[b].x && plane[a].y == plane[b].y;
    };
    const auto is_ear = [&](std::size_t before, std::size_t tip, std::size_t after) {
        if (!(area(plane[before], plane[tip], plane[after]) > 0)) return false;
        for (const std::size_t k : left) {
            if (same(k, before) || same(k, tip) || same(k, after)) continue;
            if (area(plane[before], plane[tip], plane[k]) >= 0 && area(plane[tip], plane[after], plane[k]) >= 0 &&
                area(plane[after], plane[before], plane[k]) >= 0)
                return false;
        }
        return true;
    };
    const auto cut = [&](std::size_t tip) {
        const std::size_t n = left.size();
        triangles.push_back({corners[left[(tip + n - 1) % n]], corners[left[tip]], corners[left[(tip + 1) % n]]});
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(tip));
    };
    std::size_t tip = 1;
    for (std::size_t tried = 0; left.size() > 3;) {
        const std::size_t n = left.size();
        tip %= n;
        // A polygon that crosses itself may have no ear: the next corner is cut off.
        if (tried < n && !is_ear(left[(tip + n - 1) % n], left[tip], left[(tip + 1) % n])) {
            ++tried;
            ++tip;
            continue;
        }
        cut(tip);
        tried = 0;
    }
    triangles.push_back({corners[left[0]], corners[left[1]], corners[left[2]]});
}

}  // namespace crescent::importer
