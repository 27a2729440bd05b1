// A model of another program: triangles by material, with the placements of copies. Lengths in the model's own unit.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "crescent/crescent.h"

namespace crescent::importer {

/// A mistake of the file, with its place; the name of the file is added by who prints it.
struct ModelError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The largest polygon: its triangulation takes seconds.
inline constexpr std::size_t most_corners = 4096;

/// An image that a material names, as the bytes of its file.
struct Picture {
    std::string name;   // of the file, or that the model gives it; "": none
    std::string bytes;  // "": it cannot be read
};

/// Of metal and other surfaces: rho_d is the share 1 - metal of the colour; the lobe has the share `metal` of it and,
/// of the rest, rho_s.
struct Material {
    std::string name;
    Vec3f rho_d{0.5f, 0.5f, 0.5f}, emission{};  // rho_d: the colour
    std::string texture = {};                   // the name of the image that multiplies the colour; "": none
    Vec3f rho_s{};
    float metal = 0, alpha = 0.5f;
    std::optional<std::size_t> colours{};  // the picture of `texture`
    std::optional<std::size_t> surface{};  // the picture whose green is the square root of a factor of alpha, and
                                           // whose blue is a factor of `metal`
    bool two_sided = false;
};

/// x' = columns x + origin.
struct Transform {
    Vec3d columns[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, origin{};

    Vec3d turned(Vec3d v) const { return v.x * columns[0] + v.y * columns[1] + v.z * columns[2]; }
    Vec3d placed(Vec3d p) const { return turned(p) + origin; }
    Transform then(const Transform& inner) const {
        Transform out;
        for (int k = 0; k < 3; ++k) out.columns[k] = turned(inner.columns[k]);
        out.origin = placed(inner.origin);
        return out;
    }
    double determinant() const { return dot(columns[0], cross(columns[1], columns[2])); }
    /// The direction of a normal: by the cofactors, which are the inverse transpose times the determinant.
    Vec3d turned_normal(Vec3d n) const {
        Transform cofactors;
        for (int k = 0; k < 3; ++k) cofactors.columns[k] = cross(columns[(k + 1) % 3], columns[(k + 2) % 3]);
        return (determinant() < 0 ? -1.0 : 1.0) * cofactors.turned(n);
    }
};

/// A perspective camera.
struct ModelCamera {
    Vec3d eye{}, view{0, 0, -1}, up{0, 1, 0};
    double vfov_deg = 40, aspect = 4.0 / 3;
};

/// Where a copy of a part is, and the names of the nodes above it.
struct Copy {
    Transform to;
    std::vector<std::string> names;
};

/// Triangles of one material.
struct Part {
    std::size_t material = 0;
    std::vector<std::string> names;  // of its mesh, and of the nodes above it if it is there once
    std::vector<Copy> copies;        // empty: it is there once, as it is
    std::vector<Vec3d> positions;
    std::vector<Vec3f> normals;   // one for each position, of any length; empty: none
    std::vector<Vec2<float>> uv;  // one for each position; empty: none
    std::vector<Triangle> triangles;
};

struct Model {
    std::vector<Material> materials;
    std::vector<Part> parts;
    std::vector<Picture> pictures;
    std::optional<ModelCamera> camera;
    std::vector<std::string> left_out;  // what the file has besides, "12 edges"
    std::vector<std::string> assumed;   // where the file does not say what is meant

    /// Lists so many things as left out; `what` as counted() takes it. Nothing for 0.
    void leave_out(std::size_t count, std::string_view what) {
        if (count > 0) left_out.push_back(counted(count, what));
    }
};

inline Vec3f narrow(Vec3d v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; }

/// Returns the bytes of a regular file. Throws ModelError.
std::string bytes_of(const std::filesystem::path& file);

/// Returns the extension of a name in lower case, ".obj".
std::string lower_extension(const std::filesystem::path& file);
/// Returns the number that a word of a text file is, as a whole; nothing if it is none. Beyond the range of a double: 0
/// or infinity.
std::optional<double> number_in(std::string_view word);

/// Whether the file is in this folder or below it, links resolved.
bool is_inside(const std::filesystem::path& folder, const std::filesystem::path& file);

/// A file that a model names.
struct FoundFile {
    std::filesystem::path path;
    bool is_other = false;  // the name has a folder that is not there
};
/// Returns the regular file that a name means in one of these folders: as it is written, with '/' for '\\', or by its
/// last part alone, as paths of other machines need. It is in the folder `outer` or below it; nothing if there is none.
std::optional<FoundFile> file_named(
    std::string_view name, std::span<const std::filesystem::path> folders, const std::filesystem::path& outer);

/// Statements that are not read by their names, and how often they occur.
using Kinds = std::map<std::string, std::size_t>;
inline constexpr const char* other_kinds = "";  // the name of those beyond the fiftieth
/// A file of another format has any number of kinds: those beyond the fiftieth are counted as one.
void count_kind(Kinds& kinds, const std::string& name);

/// Returns "'a', 'b', 'c' and 4 more".
std::string some_of(const std::vector<std::string>& names);

/// What is read besides the triangles.
struct ReadingScope {
    bool whole_scene = false;  // parts keep their names, meshes that are placed twice their placements
    bool images = false;       // are read
};

// Each reads a file of its format; throws ModelError with the place of a mistake, std::bad_alloc.
Model read_gltf(const std::filesystem::path& file, const ReadingScope& scope);
Model read_ply(const std::filesystem::path& file);
Model read_obj(const std::filesystem::path& file, const ReadingScope& scope);
Model read_stl(const std::filesystem::path& file, const ReadingScope& scope);

}  // namespace crescent::importer
