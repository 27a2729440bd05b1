// Bounds and the removal of useless triangles; the .mesh file is in mesh_file.cpp. A triangle without area is one whose
// corners repeat or lie on a line: the cross product of two edges, in double precision, is 0.
#include "scene/mesh/mesh.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace crescent::inline scene {

namespace {

using Key = std::array<float, 9>;  // corners in an order of their own

Key key_of(const Mesh& mesh, std::size_t triangle) {
    std::array<std::array<float, 3>, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3f p = mesh.corner(triangle, k);
        corners[k] = {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f};  // -0 becomes 0
    }
    std::sort(corners.begin(), corners.end());
    Key key;
    for (std::size_t k = 0; k < 3; ++k)
        std::copy_n(corners[k].begin(), 3, key.begin() + static_cast<std::ptrdiff_t>(3 * k));
    return key;
}

/// FNV-1a over words.
std::uint64_t hash_of(const Key& key) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const float x : key) hash = (hash ^ std::bit_cast<std::uint32_t>(x)) * 0x100000001b3, hash ^= hash >> 29;
    return hash;
}

bool has_area(const Mesh& mesh, std::size_t triangle) {
    const Vec3d a = widen(mesh.corner(triangle, 0));
    const Vec3d n = cross(widen(mesh.corner(triangle, 1)) - a, widen(mesh.corner(triangle, 2)) - a);
    return n.x != 0 || n.y != 0 || n.z != 0;
}

}  // namespace

Bounds Mesh::bounds() const {
    Bounds box;
    for (const Triangle& triangle : triangles)
        for (const std::uint32_t k : triangle) box.add(positions[k]);
    return box;
}

Removed remove_useless(Mesh& mesh) {
    const std::size_t count = mesh.triangles.size();
    std::vector<bool> useless(count);
    std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
    order.reserve(count);
    Removed removed;
    for (std::size_t i = 0; i < count; ++i) {
        if (!has_area(mesh, i)) useless[i] = true, ++removed.degenerate;
        else order.emplace_back(hash_of(key_of(mesh, i)), static_cast<std::uint32_t>(i));
    }
    std::sort(order.begin(), order.end());
    for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
        while (end < order.size() && order[end].first == order[begin].first) ++end;
        for (std::size_t i = begin + 1; i < end; ++i) {
            const bool known = std::any_of(order.begin() + static_cast<std::ptrdiff_t>(begin),
                order.begin() + static_cast<std::ptrdiff_t>(i),
                [&, own = key_of(mesh, order[i].second)](
                    const auto& other) { return !useless[other.second] && key_of(mesh, other.second) == own; });
            if (known) useless[order[i].second] = true, ++removed.duplicate;
        }
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count; ++i)
        if (!useless[i]) mesh.triangles[kept++] = mesh.triangles[i];
    mesh.triangles.resize(kept);
    return removed;
}

std::shared_ptr<MeshPack> make_pack(Mesh mesh) {
    auto pack = std::make_shared<MeshPack>();
    const Removed removed = remove_useless(mesh);
    pack->degenerate = removed.degenerate, pack->duplicate = removed.duplicate;
    pack->bvh = Bvh(mesh.positions, mesh.triangles);
    pack->hash = hash_of(mesh);
    pack->mesh = std::move(mesh);
    return pack;
}

std::size_t MeshPack::bytes() const {
    return bvh.bytes() + mesh.positions.size() * sizeof(Vec3f) + mesh.triangles.size() * sizeof(Triangle) +
        mesh.normals.size() * sizeof(Vec3f) + mesh.uv.size() * sizeof(Vec2<float>);
}

}  // namespace crescent::inline scene
