// KHR_draco_mesh_compression: the vertices and triangles of one primitive of glTF.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace crescent::importer {

struct DracoMesh {
    std::size_t count = 0;                              // of vertices
    std::map<std::string, std::vector<double>> values;  // of each attribute, vertex by vertex
    std::vector<std::uint32_t> corners;                 // three indices of vertices a triangle
};

/// Whether this build has the decoder.
bool can_read_draco();

/// Returns what the bytes contain; `ids`: the attributes by name, as Draco numbers them. Throws ModelError.
DracoMesh read_draco(std::string_view bytes, const std::map<std::string, std::size_t>& ids);

}  // namespace crescent::importer
