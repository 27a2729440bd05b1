// crescent-import: reads a model of another program and writes it as a .mesh file. `crescent import` starts it as a
// process of its own with limits on memory and time, because the parsers of many formats are not made for hostile
// files: it may die, and that is reported.
//
//   crescent-import FILE MEMORY_MIB SECONDS [MATERIAL]
//
// The mesh goes to descriptor 3, a description in JSON to standard output. Exit code 2: {"error": "..."}.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <unordered_map>

#include <sys/resource.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "model.h"
#include "placement.h"

namespace {

using namespace crescent;
using namespace crescent::importer;
using Json = nlohmann::ordered_json;

void limit(int what, rlim_t most) {
    const rlimit value{most, most};
    setrlimit(what, &value);
}

using Corner = std::array<float, 8>;  // position, normal, texture coordinates

struct CornerHash {
    std::size_t operator()(const Corner& corner) const {
        return std::hash<std::string_view>{}({reinterpret_cast<const char*>(corner.data()), sizeof corner});
    }
};

float length_of(Vec3f v) { return std::sqrt(dot(v, v)); }

/// Gathers the triangles of one material, or of all, with common vertices.
class Gatherer {
public:
    Gatherer(const Model& model, const ModelPlacement& placement, const std::string& material)
        : model_(model), placement_(placement), wanted_(material) {
        for (const Part& part : model.parts) {
            if (!is_wanted(part)) continue;
            has_normals_ = has_normals_ || is_smooth(part);
            has_uv_ = has_uv_ || !part.uv.empty();
        }
        for (const Part& part : model.parts)
            if (is_wanted(part))
                for (const Triangle& triangle : part.triangles) add(part, triangle);
    }

    Mesh result;

private:
    bool is_wanted(const Part& part) const {
        return wanted_.empty() || model_.materials[part.material].name == wanted_;
    }
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

    void add(const Part& part, const Triangle& triangle) {
        Triangle corners;
        for (unsigned k = 0; k < 3; ++k) corners[k] = vertex(part, triangle, k);
        result.triangles.push_back(corners);
    }
    std::uint32_t vertex(const Part& part, const Triangle& triangle, unsigned k) {
        const Vec3f p = narrow(placement_.placed(part.positions[triangle[k]]));
        const Vec3f n = has_normals_ ? normal_of(part, triangle, k) : Vec3f{};
        const Vec2<float> uv = has_uv_ && !part.uv.empty() ? part.uv[triangle[k]] : Vec2<float>{};
        // 0 is added, so that -0 becomes 0.
        const Corner corner{p.x + 0, p.y + 0, p.z + 0, n.x + 0, n.y + 0, n.z + 0, uv.x + 0, uv.y + 0};
        const auto [known, is_new] = known_.try_emplace(corner, static_cast<std::uint32_t>(result.positions.size()));
        if (!is_new) return known->second;
        result.positions.push_back({corner[0], corner[1], corner[2]});
        if (has_normals_) result.normals.push_back({corner[3], corner[4], corner[5]});
        if (has_uv_) result.uv.push_back({corner[6], corner[7]});
        return known->second;
    }

    const Model& model_;
    ModelPlacement placement_;
    std::string wanted_;
    bool has_normals_ = false, has_uv_ = false;
    std::unordered_map<Corner, std::uint32_t, CornerHash> known_;
};

/// JSON has no numbers that are not finite: from 0 to 1e6, and 0 for NaN.
Json numbers_of(Vec3f v) {
    Json out = Json::array();
    for (const float x : {v.x, v.y, v.z}) out.push_back(x > 0 ? std::min(x, 1e6f) : 0);
    return out;
}

Json materials_of(const Model& model) {
    std::vector<std::size_t> triangles(model.materials.size());
    for (const Part& part : model.parts) triangles[part.material] += part.triangles.size();
    Json all = Json::array();
    for (std::size_t m = 0; m < model.materials.size(); ++m) {
        if (triangles[m] == 0) continue;
        const auto& [name, rho_d, emission, texture] = model.materials[m];
        Json one = {{"name", name}, {"triangles", triangles[m]}, {"rho_d", numbers_of(rho_d)},
            {"emission", numbers_of(emission)}};
        if (!texture.empty()) one["texture"] = texture;
        all.push_back(std::move(one));
    }
    return all;
}

void write_all(int to, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t n = ::write(to, bytes.data(), bytes.size());
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) throw ModelError(std::string("cannot write the mesh: ") + std::strerror(errno));
        bytes.remove_prefix(static_cast<std::size_t>(n));
    }
}

Model read_model(const std::filesystem::path& file) {
    const std::string extension = lower_extension(file);
    if (extension == ".ply") return read_ply(file);
    return extension == ".gltf" || extension == ".glb" ? read_gltf(file) : read_by_assimp(file);
}

Json import(const std::string& file, const std::string& material) {
    const Model model = read_model(file);
    const ModelPlacement placement = placement_of(model);
    const Gatherer gathered(model, placement, material);
    Json out = {{"materials", materials_of(model)}, {"left_out", model.left_out}};
    if (gathered.result.triangles.empty())
        throw ModelError(
            material.empty() ? "found no triangle" : "found no triangle of the material '" + material + "'");
    out["normals"] = !gathered.result.normals.empty();
    out["uv"] = !gathered.result.uv.empty();
    if (placement.is_needed()) {
        out["moved"] = {-placement.from.x, -placement.from.y, -placement.from.z};
        out["scaled"] = placement.by;
    }
    write_all(3, mesh_file(gathered.result));
    return out;
}

int ended_with(int code, const Json& what) {
    std::puts(what.dump(-1, ' ', false, Json::error_handler_t::replace).c_str());
    return code;
}

}  // namespace

int main(int count, char** words) {
    if (count < 4 || count > 5) {
        std::fputs("crescent-import: `crescent import` starts this program; see docs/scenes.md\n", stderr);
        return 2;
    }
    const rlim_t mebibytes = std::strtoull(words[2], nullptr, 10), seconds = std::strtoull(words[3], nullptr, 10);
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_CPU, seconds);
    limit(RLIMIT_AS, mebibytes << 20);
    limit(RLIMIT_FSIZE, mebibytes << 20);
    try {
        return ended_with(0, import(words[1], count == 5 ? words[4] : ""));
    } catch (const std::bad_alloc&) {
        return ended_with(2, {{"error", "needs more than " + std::to_string(mebibytes) + " MiB of memory (--memory)"}});
    } catch (const std::exception& error) { return ended_with(2, {{"error", error.what()}}); }
}
