// Reads the files of meshes: each file once, and not before its size is known to be that of a regular file. A mesh must
// be within 1000 km of the origin, the range of all coordinates. A page has no files: there meshes are refused.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>

#include "experiment/parser.h"

namespace crescent::inline experiment {

namespace {

#ifdef CRESCENT_NO_FILESYSTEM
std::string contents_of_regular_file(const std::string& path) {
    throw InputError({path, 0, 0}, "a page cannot read the file of a mesh");
}
#else
std::string contents_of_regular_file(const std::string& path) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    if (status.type() == std::filesystem::file_type::not_found)
        throw InputError({path, 0, 0}, "expected a .mesh file, found none");
    if (!std::filesystem::is_regular_file(status)) throw InputError({path, 0, 0}, "expected a regular file");
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    std::ifstream file(path, std::ios::binary);
    std::string bytes;
    if (!error && file) {
        bytes.resize(size);
        file.read(bytes.data(), static_cast<std::streamsize>(size));
    }
    if (error || !file) throw InputError({path, 0, 0}, "expected a .mesh file that can be read");
    return bytes;
}
#endif

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

}  // namespace

void read_meshes(Experiment& experiment) {
    std::map<std::string, std::shared_ptr<const MeshPack>> known;
    std::vector<Diagnostic> found;
    for (MeshObject& mesh : experiment.meshes) {
        if (mesh.pack) continue;
        const std::string path = "meshes." + mesh.name + ".file";
        const std::string file = (std::filesystem::path(experiment.file).parent_path() / mesh.file).string();
        try {
            std::shared_ptr<const MeshPack>& pack = known[file];
            if (!pack) pack = read_mesh(contents_of_regular_file(file), file);
            mesh.pack = pack;
            check_extent(experiment, mesh);
        } catch (const InputError& error) {
            const Diagnostic& first = error.diagnostics().front();
            const bool in_mesh = first.at.file == file;
            found.push_back({in_mesh ? experiment.place_of(path) : first.at,
                in_mesh ? fmt::format("{}: {}", path, error.what()) : first.message});
        }
    }
    throw_if_any(std::move(found));
}

}  // namespace crescent::inline experiment
