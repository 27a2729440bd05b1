// crescent-import: reads a model of another program and writes it as a .mesh file. `crescent import` starts it as a
// process of its own with limits on memory and time, because the parsers of many formats are not made for hostile
// files: it may die, and that is reported.
//
//   crescent-import FILE MEMORY_MIB SECONDS OPTIONS
//
// OPTIONS is an object of JSON with the keys material, select, up, scale, smooth and folder. A description in JSON goes
// to standard output, the mesh to descriptor 3; with "folder", one mesh for each material and one for each mesh with
// copies, and the images, one after another, at the places that the description states. Exit code 2: {"error": "..."}.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>
#include <unordered_map>

#include <sys/resource.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "edits.h"
#include "model.h"
#include "placement.h"

namespace {

using namespace crescent;
using namespace crescent::importer;
using OrderedJson = nlohmann::ordered_json;

void limit(int what, rlim_t maximum) {
    const rlimit value{maximum, maximum};
    setrlimit(what, &value);
}

using Corner = std::array<float, 8>;  // position, normal, texture coordinates

struct CornerHash {
    std::size_t operator()(const Corner& corner) const {
        return std::hash<std::string_view>{}({reinterpret_cast<const char*>(corner.data()), sizeof corner});
    }
};

float length_of(Vec3f v) { return std::sqrt(dot(v, v)); }

Transform transform_of(const ModelPlacement& placement) {
    Transform out{.origin = -placement.scale * placement.from};
    for (Vec3d& column : out.columns) column = placement.scale * column;
    return out;
}

/// Gathers the triangles of some parts, with common vertices.
class Gatherer {
public:
    /// Adds the copies of a part where they are, or, if `is_shared`, the part once, as it is.
    Gatherer(const std::vector<const Part*>& parts, const ModelPlacement& placement, bool is_shared = false) {
        for (const Part* part : parts) {
            has_normals_ = has_normals_ || is_smooth(*part);
            has_uv_ = has_uv_ || !part->uv.empty();
        }
        const Transform to_scene = transform_of(placement);
        for (const Part* part : parts) {
            if (is_shared) add(*part, nullptr);
            else if (part->copies.empty()) {
                placement_ = placement;
                add(*part, nullptr);
                placement_ = {};
            }
            if (!is_shared)
                for (const Copy& copy : part->copies) {
                    const Transform to = to_scene.then(copy.to);
                    add(*part, &to);
                }
        }
    }

    Mesh result;

private:
    static Vec3f face_normal(const Part& part, const Triangle& triangle) {
        const Vec3d a = part.positions[triangle[0]];
        const Vec3d n = cross(part.positions[triangle[1]] - a, part.positions[triangle[2]] - a);
        const double length = std::sqrt(dot(n, n));
        return length > 0 && std::isfinite(length) ? narrow((1 / length) * n) : Vec3f{0, 0, 1};
    }
    static Vec3f normal_of(const Part& part, const Triangle& triangle, unsigned k) {
        if (part.normals.empty()) return face_normal(part, triangle);
        const Vec3f n = part.normals[triangle[k]];
        const float length = length_of(n);
        return length > 1e-6f && std::isfinite(length) ? (1 / length) * n : face_normal(part, triangle);
    }
    /// Whether some corner has another normal than its triangle; else the normals say nothing.
    static bool is_smooth(const Part& part) {
        if (part.normals.empty()) return false;
        for (const Triangle& triangle : part.triangles)
            for (unsigned k = 0; k < 3; ++k)
                if (!(dot(normal_of(part, triangle, k), face_normal(part, triangle)) > 0.9999f)) return true;
        return false;
    }

    void add(const Part& part, const Transform* to) {
        for (const Triangle& triangle : part.triangles) {
            Triangle corners;
            for (unsigned k = 0; k < 3; ++k) corners[k] = vertex(part, triangle, k, to);
            if (to && to->determinant() < 0) std::swap(corners[1], corners[2]);
            result.triangles.push_back(corners);
        }
    }
    std::uint32_t vertex(const Part& part, const Triangle& triangle, unsigned k, const Transform* to) {
        const Vec3d position = part.positions[triangle[k]];
        const Vec3f p = narrow(to ? to->placed(position) : placement_.placed(position));
        Vec3f n = has_normals_ ? normal_of(part, triangle, k) : Vec3f{};
        if (to && has_normals_) {
            const Vec3d normal = to->turned_normal(widen(n));
            const double length = std::sqrt(dot(normal, normal));
            if (length > 0) n = narrow((1 / length) * normal);
        }
        const Vec2<float> uv = has_uv_ && !part.uv.empty() ? part.uv[triangle[k]] : Vec2<float>{};
        // 0 is added, so that -0 becomes 0.
        const Corner corner{p.x + 0, p.y + 0, p.z + 0, n.x + 0, n.y + 0, n.z + 0, uv.x + 0, uv.y + 0};
        const auto [index, is_new] =
            index_of_corner_.try_emplace(corner, static_cast<std::uint32_t>(result.positions.size()));
        if (!is_new) return index->second;
        result.positions.push_back({corner[0], corner[1], corner[2]});
        if (has_normals_) result.normals.push_back({corner[3], corner[4], corner[5]});
        if (has_uv_) result.uv.push_back({corner[6], corner[7]});
        return index->second;
    }

    ModelPlacement placement_;
    bool has_normals_ = false, has_uv_ = false;
    std::unordered_map<Corner, std::uint32_t, CornerHash> index_of_corner_;
};

constexpr float largest_number = 1e6f;  // of a material
/// JSON has no numbers that are not finite: 0 for NaN.
float number_of(float x) { return x > 0 ? std::min(x, largest_number) : 0; }
OrderedJson numbers_of(Vec3f v) { return {number_of(v.x), number_of(v.y), number_of(v.z)}; }
OrderedJson numbers_of(Vec3d v) { return {v.x, v.y, v.z}; }

OrderedJson materials_of(const Model& model) {
    std::vector<std::size_t> triangles(model.materials.size());
    for (const Part& part : model.parts) triangles[part.material] += part.triangles.size();
    OrderedJson materials = OrderedJson::array();
    for (std::size_t m = 0; m < model.materials.size(); ++m) {
        if (triangles[m] == 0) continue;
        const importer::Material& from = model.materials[m];
        OrderedJson entry = {{"name", from.name}, {"index", m}, {"triangles", triangles[m]},
            {"rho_d", numbers_of(from.rho_d)}, {"emission", numbers_of(from.emission)},
            {"rho_s", numbers_of(from.rho_s)}, {"metal", number_of(from.metal)}, {"alpha", number_of(from.alpha)},
            {"two_sided", from.two_sided}};
        if (!from.texture.empty()) entry["texture"] = from.texture;
        if (from.colours) entry["colours"] = *from.colours;
        if (from.surface) entry["surface"] = *from.surface;
        materials.push_back(std::move(entry));
    }
    return materials;
}

void write_all(int to, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t n = ::write(to, bytes.data(), bytes.size());
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) throw ModelError(std::string("cannot write the mesh: ") + std::strerror(errno));
        bytes.remove_prefix(static_cast<std::size_t>(n));
    }
}

Model read_model(const std::filesystem::path& file, const ReadingScope& scope) {
    const std::string extension = lower_extension(file);
    if (extension == ".ply") return read_ply(file);
    if (extension == ".obj") return read_obj(file, scope);
    if (extension == ".stl") return read_stl(file, scope);
    return read_gltf(file, scope);
}

std::vector<const Part*> parts_of(const Model& model, const std::string& material) {
    std::vector<const Part*> out;
    for (const Part& part : model.parts)
        if (material.empty() || model.materials[part.material].name == material) out.push_back(&part);
    return out;
}

// ---- The parts of a folder.

/// What descriptor 3 has of one thing.
OrderedJson written(std::size_t& end, std::string_view bytes) {
    write_all(3, bytes);
    end += bytes.size();
    return {{"begin", end - bytes.size()}, {"size", bytes.size()}};
}

/// Whether an experiment takes all of these as the matrices of instances: their entries, and their determinant.
bool are_instances(const std::vector<Copy>& copies, const Transform& to_scene) {
    return std::ranges::all_of(copies, [&](const Copy& copy) {
        const Transform to = to_scene.then(copy.to);
        double largest = 0;
        for (const Vec3d& v : {to.columns[0], to.columns[1], to.columns[2], to.origin})
            largest = std::max({largest, std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
        return largest <= 1e6 && std::fabs(to.determinant()) > 1e-17;
    });
}

/// Rows of a matrix, the translation last in each.
OrderedJson matrix_of(const Transform& to) {
    OrderedJson out = OrderedJson::array();
    for (const auto axis : {&Vec3d::x, &Vec3d::y, &Vec3d::z})
        out.push_back({to.columns[0].*axis, to.columns[1].*axis, to.columns[2].*axis, to.origin.*axis});
    return out;
}

/// Whether a part does not have the texture coordinates that the images of its material need: they have no effect on it
/// (glTF 2.0, section 3.9.2).
bool lacks_uv(const Model& model, const Part& part) {
    const importer::Material& material = model.materials[part.material];
    return part.uv.empty() && (material.colours || material.surface);
}

/// Writes a mesh for each material, of all parts without copies, and one for each part with copies. Parts that lack
/// texture coordinates are a mesh of their own.
OrderedJson write_meshes(
    const Model& model, const ModelPlacement& placement, const std::string& material, std::size_t& end) {
    OrderedJson out = OrderedJson::array();
    const Transform to_scene = transform_of(placement);
    std::map<std::pair<std::size_t, bool>, std::vector<const Part*>> of_material;
    std::vector<const Part*> copied_parts;
    for (const Part* part : parts_of(model, material)) {
        const bool is_shared = !part->copies.empty() && are_instances(part->copies, to_scene);
        if (is_shared) copied_parts.push_back(part);
        else of_material[{part->material, lacks_uv(model, *part)}].push_back(part);
    }
    const auto add = [&](const std::vector<const Part*>& parts, bool is_shared) {
        const Gatherer gatherer(parts, placement, is_shared);
        if (gatherer.result.triangles.empty()) return;
        OrderedJson entry = written(end, mesh_file(gatherer.result));
        entry["material"] = parts[0]->material;
        if (is_shared) {
            const std::vector<std::string>&part_names = parts[0]->names,
                  &names = part_names.empty() ? parts[0]->copies[0].names : part_names;
            entry["name"] = names.empty() ? "" : names.front();
            entry["instances"] = OrderedJson::array();
            for (const Copy& copy : parts[0]->copies) entry["instances"].push_back(matrix_of(to_scene.then(copy.to)));
        }
        out.push_back(std::move(entry));
    };
    for (const auto& [key, parts] : of_material) add(parts, false);
    for (const Part* part : copied_parts) add({part}, true);
    return out;
}

void list_numbers_out_of_range(Model& model) {
    const auto list = [&](const auto& is_out, std::string_view what) {
        const auto count = std::ranges::count_if(model.materials, [&](const importer::Material& m) {
            return std::ranges::any_of(std::array{m.rho_d.x, m.rho_d.y, m.rho_d.z, m.rho_s.x, m.rho_s.y, m.rho_s.z,
                                           m.emission.x, m.emission.y, m.emission.z, m.metal, m.alpha},
                is_out);
        });
        model.leave_out(static_cast<std::size_t>(count), what);
    };
    list([](float x) { return !(x >= 0); }, "material[s] with numbers below 0: [it has|they have] 0 in their place");
    list([](float x) { return x > largest_number; },
        "material[s] with numbers above 1e6: [it has|they have] 1e6 in their place");
}

void list_unused_materials(Model& model) {
    std::vector<bool> is_used(model.materials.size());
    for (const Part& part : model.parts) is_used[part.material] = true;
    model.leave_out(static_cast<std::size_t>(std::ranges::count(is_used, false)), "material[s] that no part has");
}

void list_parts_without_uv(Model& model) {
    const auto count = std::ranges::count_if(model.parts, [&](const Part& part) { return lacks_uv(model, part); });
    model.leave_out(static_cast<std::size_t>(count),
        "part[s] without texture coordinates, of a material with images: [it has|they have] its colours alone");
}

OrderedJson write_pictures(const Model& model, const OrderedJson& materials, std::size_t& end) {
    std::vector<bool> is_used(model.pictures.size());
    for (const OrderedJson& material : materials)
        for (const char* key : {"colours", "surface"})
            if (material.contains(key)) is_used[material[key].get<std::size_t>()] = true;
    OrderedJson out = OrderedJson::array();
    for (std::size_t k = 0; k < model.pictures.size(); ++k) {
        OrderedJson entry = written(end, is_used[k] ? std::string_view(model.pictures[k].bytes) : "");
        entry["name"] = model.pictures[k].name;
        out.push_back(std::move(entry));
    }
    return out;
}

OrderedJson camera_of(const ModelCamera& camera, const ModelPlacement& placement) {
    return {{"eye", numbers_of(placement.placed(camera.eye))}, {"view", numbers_of(camera.view)},
        {"up", numbers_of(camera.up)}, {"vfov_deg", camera.vfov_deg}, {"aspect", camera.aspect}};
}

OrderedJson import(const std::string& file, const OrderedJson& options) {
    const bool is_folder = options.value("folder", false);
    const std::string material = options.value("material", "");
    Model model = read_model(file, {.whole_scene = is_folder || options.contains("select"), .images = true});
    list_unused_materials(model);
    if (options.contains("select")) select(model, options["select"].get<std::string>());
    turn_and_scale(model, options.value("up", "y") == "z", options.value("scale", 1.0));
    if (options.contains("smooth")) smooth(model, options["smooth"].get<double>());
    const ModelPlacement placement = placement_of(model);
    list_numbers_out_of_range(model);
    list_parts_without_uv(model);
    OrderedJson out = {{"materials", materials_of(model)}, {"left_out", model.left_out}, {"assumed", model.assumed}};
    if (placement.is_needed()) {
        out["moved"] = {-placement.from.x, -placement.from.y, -placement.from.z};
        out["scaled"] = placement.scale;
    }
    const auto none = [&] {
        return ModelError(
            material.empty() ? "found no triangle" : "found no triangle of the material '" + material + "'");
    };
    if (is_folder) {
        std::size_t end = 0;
        out["meshes"] = write_meshes(model, placement, material, end);
        if (out["meshes"].empty()) throw none();
        out["pictures"] = write_pictures(model, out["materials"], end);
        if (model.camera) out["camera"] = camera_of(*model.camera, placement);
        return out;
    }
    const Gatherer gatherer(parts_of(model, material), placement);
    if (gatherer.result.triangles.empty()) throw none();
    out["normals"] = !gatherer.result.normals.empty();
    out["uv"] = !gatherer.result.uv.empty();
    std::size_t end = 0;
    out["mesh"] = written(end, mesh_file(gatherer.result));
    OrderedJson mesh_materials = OrderedJson::array();  // by the one material of the mesh, if it has one
    for (const OrderedJson& entry : out["materials"])
        if (entry["name"] == material || (material.empty() && out["materials"].size() == 1))
            mesh_materials.push_back(entry);
    out["pictures"] = write_pictures(model, mesh_materials, end);
    return out;
}

int ended_with(int code, const OrderedJson& what) {
    std::puts(what.dump(-1, ' ', false, OrderedJson::error_handler_t::replace).c_str());
    return code;
}

}  // namespace

int main(int count, char** words) {
    const OrderedJson options = count == 5 ? OrderedJson::parse(words[4], nullptr, false) : OrderedJson();
    if (!options.is_object()) {
        std::fputs("crescent-import: `crescent import` starts this program; see docs/scenes.md\n", stderr);
        return 2;
    }
    const rlim_t mebibytes = std::strtoull(words[2], nullptr, 10), seconds = std::strtoull(words[3], nullptr, 10);
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_CPU, seconds);
    limit(RLIMIT_AS, mebibytes << 20);
    limit(RLIMIT_FSIZE, mebibytes << 20);
    try {
        return ended_with(0, import(words[1], options));
    } catch (const std::bad_alloc&) {
        return ended_with(2, {{"error", "needs more than " + std::to_string(mebibytes) + " MiB of memory (--memory)"}});
    } catch (const OrderedJson::exception& error) {
        return ended_with(2, {{"error", unreadable_json(error)}});
    } catch (const std::exception& error) { return ended_with(2, {{"error", error.what()}}); }
}
