// Reads the files of meshes and their textures. A mesh must be within 1000 km of the origin, the range of all
// coordinates.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "experiment/parser.h"
#include "experiment/scene_files.h"

namespace crescent::inline experiment {

namespace {

void check_extent(const Experiment& e, const MeshObject& mesh) {
    const Bounds box = mesh.pack->mesh.bounds();
    const Affine own = mesh.placement.transform();
    const auto check = [&](const Affine& to, const std::string& path) {
        for (unsigned corner = 0; corner < 8; ++corner) {
            const Vec3d p = to.point(widen(Vec3f{corner & 1 ? box.high.x : box.low.x,
                corner & 2 ? box.high.y : box.low.y, corner & 4 ? box.high.z : box.low.z}));
            if (place_range.holds(p.x) && place_range.holds(p.y) && place_range.holds(p.z)) continue;
            throw InputError(e.place_of(path),
                fmt::format(
                    "{}: expected a mesh within {} m of the origin along each axis, found a corner of its box at "
                    "({:.4g}, {:.4g}, {:.4g})",
                    path, place_range.high, p.x, p.y, p.z));
        }
    };
    const std::string path = "meshes." + mesh.name;
    if (mesh.instances.empty()) check(own, path);
    for (std::size_t i = 0; i < mesh.instances.size(); ++i)
        check(mesh.instances[i].transform().after(own), fmt::format("{}.instances.{}", path, i));
}

void check_uv(const Experiment& e, const MeshObject& mesh, std::vector<Diagnostic>& found) {
    if (!mesh.pack->mesh.uv.empty()) return;
    for (const TextureKey& key : texture_keys) {
        const std::string path = fmt::format("meshes.{}.{}", mesh.name, key.name);
        if ((mesh.*key.texture).image)
            found.push_back({e.place_of(path),
                fmt::format("{}: expected a mesh with texture coordinates, found none in '{}'", path, mesh.file)});
    }
}

}  // namespace

void read_meshes(Experiment& experiment) {
    std::vector<Diagnostic> found;
    for (MeshObject& mesh : experiment.meshes) {
        const std::string path = "meshes." + mesh.name;
        /// A mistake in a file that a key names is reported at the key, with the place in the file.
        const auto at_key = [&](const std::string& key, const auto& work) {
            try {
                work();
            } catch (const InputError& error) {
                const Diagnostic& first = error.diagnostics().front();
                const bool located = first.at.file == experiment.file && first.at.line > 0;
                found.push_back({located ? first.at : experiment.place_of(key),
                    located ? first.message : fmt::format("{}: {}", key, error.what())});
            }
        };
        if (!mesh.pack)
            at_key(path + ".file", [&] {
                const std::string file = (std::filesystem::path(experiment.file).parent_path() / mesh.file).string();
                mesh.pack = mesh_in_file(file);
                check_extent(experiment, mesh);
            });
        for (const TextureKey& key : texture_keys)
            at_key(fmt::format("{}.{}", path, key.name),
                [&] { load_texture(mesh.*key.texture, key.of, experiment.file); });
        if (!mesh.pack || !found.empty()) continue;
        check_uv(experiment, mesh, found);
        const std::string content = content_of(mesh);
        if (mesh.content && *mesh.content != content)
            found.push_back({experiment.place_of(path + ".content"),
                fmt::format("{0}.content: expected a mesh and textures with the content {1}, found {2}", path,
                    *mesh.content, content)});
        mesh.content = content;
    }
    throw_if_any(std::move(found));
}

}  // namespace crescent::inline experiment
