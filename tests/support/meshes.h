// Meshes for tests: a ball, triangles at random, and copies elsewhere.
#pragma once

#include <cmath>
#include <random>

#include "math/functions.h"
#include "scene/mesh/mesh.h"

namespace crescent::test {

inline Vec3f unit_vector(std::mt19937& random) {
    std::uniform_real_distribution<float> number(-1, 1);
    for (;;) {
        const Vec3f v = {number(random), number(random), number(random)};
        const float length2 = dot(v, v);
        if (length2 > 0.01f && length2 <= 1) return (1 / std::sqrt(length2)) * v;
    }
}

/// A ball of radius 1 about (0, 0, 0), its front outside, with smooth normals and texture coordinates.
inline Mesh sphere_mesh(std::uint32_t around, std::uint32_t up) {
    Mesh mesh;
    constexpr double pi = 3.14159265358979323846;
    for (std::uint32_t j = 0; j <= up; ++j)
        for (std::uint32_t i = 0; i < around; ++i) {
            const double theta = pi * j / up, phi = 2 * pi * i / around;
            const Vec3d p = {math::sin(theta) * math::cos(phi), math::cos(theta), -math::sin(theta) * math::sin(phi)};
            const bool pole = j == 0 || j == up;
            const Vec3f at = pole ? Vec3f{0, j == 0 ? 1.0f : -1.0f, 0} : as<float>(p);
            mesh.positions.push_back(at);
            mesh.normals.push_back(at);
            mesh.uv.push_back({static_cast<float>(i) / static_cast<float>(around),
                1 - static_cast<float>(j) / static_cast<float>(up)});
        }
    const auto at = [&](std::uint32_t i, std::uint32_t j) { return j * around + i % around; };
    for (std::uint32_t j = 0; j < up; ++j)
        for (std::uint32_t i = 0; i < around; ++i) {
            if (j + 1 < up) mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
            if (j > 0) mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
        }
    return mesh;
}

/// Triangles of about this size in a cube of side 2.
inline Mesh soup_mesh(std::size_t count, float size, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> number(-1, 1);
    Mesh mesh;
    for (std::uint32_t i = 0; i < count; ++i) {
        const Vec3f middle = {number(random), number(random), number(random)};
        for (int k = 0; k < 3; ++k)
            mesh.positions.push_back(middle + size * Vec3f{number(random), number(random), number(random)});
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return mesh;
}

/// The mesh, `by` times as large, about another place.
inline Mesh placed(Mesh mesh, Vec3f at, float by) {
    for (Vec3f& p : mesh.positions) p = at + by * p;
    return mesh;
}

}  // namespace crescent::test
