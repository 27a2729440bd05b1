// The first bytes of a .mesh file, whose layout is in mesh.h: what can be known before the file is read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace crescent::inline scene {

inline constexpr std::size_t mesh_header_size = 40;

/// Returns the number of triangles that the first bytes of a file of `size` bytes state. Throws InputError like
/// read_mesh for what is wrong with these bytes.
std::uint32_t read_triangle_count(std::string_view head, std::uint64_t size, const std::string& name);

}  // namespace crescent::inline scene
