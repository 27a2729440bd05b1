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
    std::vector<std::size_t> remainder(corners.size());
    for (std::size_t k = 0; k < remainder.size(); ++k) remainder[k] = k;
    // Also two corners at one place, as at the bridge to a hole.
    const auto is_same_place = [&](std::size_t a, std::size_t b) {
        return plane[a].x == plane[b].x && plane[a].y == plane[b].y;
    };
    const auto is_ear = [&](std::size_t previous, std::size_t tip, std::size_t next) {
        if (!(area(plane[previous], plane[tip], plane[next]) > 0)) return false;
        for (const std::size_t k : remainder) {
            if (is_same_place(k, previous) || is_same_place(k, tip) || is_same_place(k, next)) continue;
            if (area(plane[previous], plane[tip], plane[k]) >= 0 && area(plane[tip], plane[next], plane[k]) >= 0 &&
                area(plane[next], plane[previous], plane[k]) >= 0)
                return false;
        }
        return true;
    };
    const auto cut = [&](std::size_t tip) {
        const std::size_t n = remainder.size();
        triangles.push_back(
            {corners[remainder[(tip + n - 1) % n]], corners[remainder[tip]], corners[remainder[(tip + 1) % n]]});
        remainder.erase(remainder.begin() + static_cast<std::ptrdiff_t>(tip));
    };
    std::size_t tip = 1;
    for (std::size_t tries = 0; remainder.size() > 3;) {
        const std::size_t n = remainder.size();
        tip %= n;
        // A polygon that crosses itself may have no ear: the next corner is cut off.
        if (tries < n && !is_ear(remainder[(tip + n - 1) % n], remainder[tip], remainder[(tip + 1) % n])) {
            ++tries;
            ++tip;
            continue;
        }
        cut(tip);
        tries = 0;
    }
    triangles.push_back({corners[remainder[0]], corners[remainder[1]], corners[remainder[2]]});
}

}  // namespace crescent::importer
