// A model of another program: triangles in world space, by material. Lengths in the model's own unit.
#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "crescent/crescent.h"

namespace crescent::importer {

/// A mistake of the file, with its place; the name of the file is added by who prints it.
struct ModelError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The largest polygon: its triangulation takes seconds.
inline constexpr std::size_t most_corners = 4096;

struct Material {
    std::string name;
    Vec3f rho_d{0.5f, 0.5f, 0.5f}, emission{};
    std::string texture = {};  // the file of rho_d; "": none
};

/// Triangles of one material.
struct Part {
    std::size_t material = 0;
    std::vector<Vec3d> positions;
    std::vector<Vec3f> normals;   // one for each position, of any length; empty: none
    std::vector<Vec2<float>> uv;  // one for each position; empty: none
    std::vector<Triangle> triangles;
};

struct Model {
    std::vector<Material> materials;
    std::vector<Part> parts;
    std::vector<std::string> left_out;  // what the file has besides, "12 edges"
};

inline Vec3f narrow(Vec3d v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; }

/// Returns the bytes of a regular file. Throws ModelError.
std::string bytes_of(const std::filesystem::path& file);

/// Returns the extension of a name in lower case, ".obj".
std::string lower_extension(const std::filesystem::path& file);

/// Whether the file is in this folder or below it, links resolved.
bool is_inside(const std::filesystem::path& folder, const std::filesystem::path& file);

// Each reads a file of its format; throws ModelError with the place of a mistake, std::bad_alloc.
Model read_gltf(const std::filesystem::path& file);
Model read_ply(const std::filesystem::path& file);
/// OBJ and STL.
Model read_by_assimp(const std::filesystem::path& file);

}  // namespace crescent::importer
