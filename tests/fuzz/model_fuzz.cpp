// Any bytes as a model: its first byte selects PLY, OBJ, STL, glTF, GLB or, of an OBJ, its materials. It is read, or
// rejected with a ModelError. Triangles name vertices that there are.
#include <unistd.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include <nlohmann/json.hpp>

#include "../../apps/import/edits.h"
#include "../../apps/import/model.h"
#include "../../apps/import/placement.h"

namespace {

using namespace crescent;
using namespace crescent::importer;

/// A folder with nothing but the model.
const std::filesystem::path& folder() {
    static const std::filesystem::path made = [] {
        auto path = std::filesystem::temp_directory_path() / ("model-fuzz-" + std::to_string(::getpid()));
        std::filesystem::create_directories(path);
        return path;
    }();
    return made;
}

Model read_as(const std::string& extension, const std::filesystem::path& file) {
    const ReadingScope scope{.whole_scene = true, .images = true};
    if (extension == ".ply") return read_ply(file);
    if (extension == ".obj") return read_obj(file, scope);
    if (extension == ".stl") return read_stl(file, scope);
    return read_gltf(file, scope);
}

void check_parts(const Model& model) {
    for (const Part& part : model.parts) {
        ensure(part.material < model.materials.size(), "a part has a material");
        ensure(part.normals.empty() || part.normals.size() == part.positions.size(), "a normal for each position");
        ensure(part.uv.empty() || part.uv.size() == part.positions.size(), "uv for each position");
        for (const Triangle& t : part.triangles)
            for (const std::uint32_t corner : t) ensure(corner < part.positions.size(), "a corner is a position");
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static constexpr std::array extensions = {".ply", ".obj", ".stl", ".gltf", ".glb", ".mtl"};
    if (size == 0) return -1;
    const std::string extension = extensions[data[0] % extensions.size()];
    const std::filesystem::path file = folder() / ("model" + extension);
    std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(data) + 1, std::streamsize(size) - 1);
    const std::filesystem::path with_materials = folder() / "material.obj";
    std::ofstream(with_materials) << "mtllib model.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n";
    try {
        Model model = extension == ".mtl" ? read_obj(with_materials, {.whole_scene = true, .images = true})
                                          : read_as(extension, file);
        check_parts(model);
        turn_and_scale(model, true, 2);
        smooth(model, 30);
        check_parts(model);
        (void)placement_of(model);
    } catch (const ModelError& error) {
        ensure(*error.what() != '\0', "a refusal says why");
    } catch (const nlohmann::ordered_json::exception&) {  // the program prints it with unreadable_json()
    }
    return 0;
}
