// Polygons to triangles.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "model.h"

namespace crescent::importer {

/// Appends the triangles of a polygon, which may be concave, by cutting off ears (Meisters 1975, "Polygons Have Ears")
/// in the plane of its area vector (Newell). Corners: at least 3, indices of positions. Time: from the square to the
/// cube of their number.
void triangulate(
    std::span<const Vec3d> positions, std::span<const std::uint32_t> corners, std::vector<Triangle>& triangles);

}  // namespace crescent::importer
