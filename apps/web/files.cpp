// Files that the user gave to the page, by name: packs of meshes and images. An experiment finds them by the last part
// of their paths. Each is checked and unpacked when it is given.
#include <fmt/format.h>

#include <filesystem>
#include <map>

#include "api.h"

namespace crescent::web {

namespace {

constexpr std::uint32_t most_triangles = 300'000;              // each worker builds the tree of a mesh and keeps it
constexpr std::uint64_t most_texels = std::uint64_t{1} << 21;  // 25 MB, for each worker too

std::map<std::string, std::shared_ptr<const MeshPack>> meshes;
std::map<std::string, std::shared_ptr<const RgbImage>> images;

bool is_mesh(const std::string& name) { return name.ends_with(".mesh"); }

template <class T> std::shared_ptr<const T> given(
    const std::map<std::string, std::shared_ptr<const T>>& files, const std::string& path, const char* kind) {
    const auto entry = files.find(std::filesystem::path(path).filename().string());
    if (entry != files.end()) return entry->second;
    throw InputError({path, 0, 0}, fmt::format("expected an {} file among those given to the page, found none", kind));
}

std::shared_ptr<const RgbImage> image(const std::string& path, std::string (*why_not)(std::int64_t, std::int64_t)) {
    const auto picture = given(images, path, ".image");
    if (const std::string reason = why_not(picture->width, picture->height); !reason.empty())
        throw InputError({path, 0, 0}, reason);
    return picture;
}

std::string_view given_bytes() {
    const std::vector<std::byte>& bytes = scratch<std::byte>();
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

/// {name, size} and the first bytes of a file in tile_buffer() -> {}; throws InputError if it is no pack, or a larger
/// one than a page takes.
CRESCENT_EXPORT(expect_file)()->void {
    const ordered_json query = request();
    const std::string name = query.at("name").get<std::string>();
    const auto size = query.at("size").get<std::uint64_t>();
    if (is_mesh(name)) {
        const std::uint32_t triangles = read_triangle_count(given_bytes(), size, name);
        if (triangles > most_triangles)
            throw InputError({name, 0, 0},
                fmt::format(
                    "a page takes meshes of at most {} triangles, this one has {}; the program has no such limit",
                    most_triangles, triangles));
    } else {
        const ImageSize texels = read_image_size(given_bytes(), size, name);
        if (std::uint64_t{texels.width} * texels.height > most_texels)
            throw InputError({name, 0, 0},
                fmt::format("a page takes images of at most {} texels, this one has {} x {}; the program has no such "
                            "limit",
                    most_texels, texels.width, texels.height));
    }
    respond(ordered_json::object());
}

/// {name} and all bytes of a file in tile_buffer() -> {}: keeps it for experiments that name it.
CRESCENT_EXPORT(keep_file)()->void {
    const std::string name = request().at("name").get<std::string>();
    if (is_mesh(name)) meshes[name] = read_mesh(given_bytes(), name);
    else images[name] = read_image_file(given_bytes(), name);
    std::vector<std::byte>().swap(scratch<std::byte>());
    respond(ordered_json::object());
}

/// Forgets all files.
CRESCENT_EXPORT(forget_files)()->void {
    meshes.clear();
    images.clear();
}

/// Returns the text of an experiment for the files that are kept; throws InputError if there is no mesh.
CRESCENT_EXPORT(experiment_of_files)()->void {
    if (meshes.empty())
        throw InputError(
            {"your files", 0, 0}, "expected a mesh pack (.mesh) or an experiment (.toml) that names the files");
    std::optional<std::string> sky;
    for (const auto& [name, texels] : images)
        if (!sky && why_no_sky_of(texels->width, texels->height).empty()) sky = name;
    respond(experiment_for({meshes.begin(), meshes.end()}, sky));
}

}  // namespace crescent::web

namespace crescent {

std::shared_ptr<const MeshPack> mesh_in_file(const std::string& path) { return web::given(web::meshes, path, ".mesh"); }
std::shared_ptr<const RgbImage> sky_in_file(const std::string& path, const std::string& layer) {
    if (!layer.empty())
        throw InputError({path, 0, 0},
            "a page reads packs, which have no layers: `crescent import FILE --layer NAME --out NAME.image` makes one");
    return web::image(path, why_no_sky_of);
}
std::string read_input(const std::string& path, std::size_t /*limit*/, std::string_view what) {
    throw InputError(
        {path, 0, 0}, "expected " + std::string(what) + " that can be read: there are no files in a browser");
}
bool is_no_regular_file(const std::string& /*path*/) { return false; }

bool leads_out(const std::string& /*folder*/, const std::string& /*path*/) { return false; }
std::shared_ptr<const RgbImage> texture_in_file(const std::string& path) { return web::image(path, why_no_texture_of); }

}  // namespace crescent
