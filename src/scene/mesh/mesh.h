// Triangle meshes as plain data, and the .mesh file that holds one. A mesh with its acceleration structure is a pack,
// which scenes and the instances of a scene share. Single precision; lengths in the mesh's own unit.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/vec.h"
#include "scene/mesh/bvh.h"

namespace crescent {

/// Triangles with common vertices. The front of a triangle is the side from which its corners are counterclockwise.
struct Mesh {
    std::vector<Vec3f> positions;
    std::vector<Triangle> triangles;  // indices of positions
    std::vector<Vec3f> normals;       // smooth normals, unit, one for each position; empty: the triangles' own
    std::vector<Vec2<float>> uv;      // texture coordinates, one for each position; empty: none

    /// Returns a corner (0, 1 or 2) of a triangle.
    Vec3f corner(std::size_t triangle, std::size_t k) const { return positions[triangles[triangle][k]]; }
    Bounds bounds() const;
};

/// A mesh that rays can be traced against. Immutable, so that scenes and threads share it.
struct MeshPack {
    Mesh mesh;
    Bvh bvh;
    std::uint64_t hash = 0;      // XXH3 of the file's content
    std::size_t degenerate = 0;  // triangles of the file without area: left out
    std::size_t duplicate = 0;   // triangles of the file whose three corners an earlier triangle has: left out

    /// Returns the bytes in memory.
    std::size_t bytes() const;
};

/// Builds the acceleration structure of a mesh without triangles that have no area or occur twice.
std::shared_ptr<MeshPack> make_pack(Mesh mesh);

// ---- The file: little-endian, in this order.
//
//   char magic[8]         "crescent"
//   uint32 kind           0x6873656d, "mesh"
//   uint32 version        1
//   uint32 vertices, triangles
//   uint32 flags          1: normals, 2: texture coordinates
//   uint32 reserved       0
//   uint64 hash           XXH3 of all that follows; 0: not stated, and not checked
//   float positions[vertices][3]
//   float normals[vertices][3]     if flagged
//   float uv[vertices][2]          if flagged
//   uint32 triangles[triangles][3]

/// Returns the hash in its file.
std::uint64_t hash_of(const Mesh& mesh);
/// Returns the file's bytes.
std::string mesh_file(const Mesh& mesh);

/// Reads a file; `name` is in messages. Throws InputError with the file and the place in it: another format, a size
/// that differs from the one that the counts give, another hash, a coordinate that is not finite, a normal that is not
/// of unit length, an index beyond the vertices, no triangle with an area. Memory is bounded by the size of `bytes`.
std::shared_ptr<const MeshPack> read_mesh(std::string_view bytes, const std::string& name);

/// Removes triangles without area, and those whose three corners (in any order) an earlier triangle has.
struct Removed {
    std::size_t degenerate = 0, duplicate = 0;
};
Removed remove_useless(Mesh& mesh);

// ---- The first bytes of a .mesh file: what can be known before the file is read.

inline constexpr std::size_t mesh_header_size = 40;

/// Returns the number of triangles that the first bytes of a file of `size` bytes state. Throws InputError like
/// read_mesh for what is wrong with these bytes.
std::uint32_t read_triangle_count(std::string_view head, std::uint64_t size, const std::string& name);

}  // namespace crescent
