// crescent-import: reads a model of another program by assimp and writes it as a .mesh file. `crescent import` starts
// it as a process of its own with limits on memory and time, because the parsers of many formats are not made for
// hostile files: it may die, and that is reported.
//
//   crescent-import FILE MEMORY_MIB SECONDS [MATERIAL]
//
// The mesh goes to descriptor 3, a description in JSON to standard output. Exit code 2: {"error": "..."}.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <unordered_map>

#include <sys/resource.h>
#include <unistd.h>

#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <nlohmann/json.hpp>

#include "crescent/crescent.h"

namespace {

using namespace crescent;
using Json = nlohmann::ordered_json;

struct Failure : std::runtime_error {
    using std::runtime_error::runtime_error;
};

void limit(int what, rlim_t most) {
    const rlimit value{most, most};
    setrlimit(what, &value);
}

/// Opens files of the model's folder and below it only, for any path that the model has.
class FolderFiles : public Assimp::DefaultIOSystem {
public:
    explicit FolderFiles(const std::filesystem::path& model)
        : folder_(std::filesystem::weakly_canonical(std::filesystem::absolute(model).parent_path())) {}

    bool Exists(const char* file) const override { return is_inside(file) && DefaultIOSystem::Exists(file); }
    Assimp::IOStream* Open(const char* file, const char* mode) override {
        return is_inside(file) && std::strchr(mode, 'w') == nullptr ? DefaultIOSystem::Open(file, mode) : nullptr;
    }

private:
    bool is_inside(const char* file) const {
        std::error_code error;
        const std::filesystem::path path = std::filesystem::weakly_canonical(std::filesystem::absolute(file), error);
        const auto end = std::mismatch(folder_.begin(), folder_.end(), path.begin(), path.end()).first;
        return !error && (end == folder_.end() || end->empty());
    }
    std::filesystem::path folder_;
};

using Corner = std::array<float, 8>;  // position, normal, texture coordinates

struct CornerHash {
    std::size_t operator()(const Corner& corner) const {
        return std::hash<std::string_view>{}({reinterpret_cast<const char*>(corner.data()), sizeof corner});
    }
};

Vec3f vector_of(const aiVector3D& v) { return {v.x + 0.0f, v.y + 0.0f, v.z + 0.0f}; }  // -0 becomes 0

float length_of(Vec3f v) { return std::sqrt(dot(v, v)); }

/// The triangles of one material, or of all.
class Gatherer {
public:
    Gatherer(const aiScene& scene, const std::string& material) : scene_(scene), wanted_(material) {
        for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
            const aiMesh& mesh = *scene.mMeshes[m];
            if (!is_wanted(mesh)) continue;
            has_normals_ = has_normals_ || mesh.HasNormals();
            has_uv_ = has_uv_ || mesh.HasTextureCoords(0);
        }
        has_normals_ = has_normals_ && any_smooth();
        for (unsigned m = 0; m < scene.mNumMeshes; ++m)
            if (is_wanted(*scene.mMeshes[m])) add(*scene.mMeshes[m]);
    }

    Mesh result;

private:
    bool is_wanted(const aiMesh& mesh) const { return wanted_.empty() || name_of(mesh) == wanted_; }
    std::string name_of(const aiMesh& mesh) const {
        return mesh.mMaterialIndex < scene_.mNumMaterials ? scene_.mMaterials[mesh.mMaterialIndex]->GetName().C_Str()
                                                          : "";
    }
    static Vec3f face_normal(const aiMesh& mesh, const aiFace& face) {
        const Vec3f a = vector_of(mesh.mVertices[face.mIndices[0]]);
        const Vec3f n =
            cross(vector_of(mesh.mVertices[face.mIndices[1]]) - a, vector_of(mesh.mVertices[face.mIndices[2]]) - a);
        const float length = length_of(n);
        return length > 0 && std::isfinite(length) ? (1 / length) * n : Vec3f{0, 0, 1};
    }
    static Vec3f normal_of(const aiMesh& mesh, const aiFace& face, unsigned k) {
        if (!mesh.HasNormals()) return face_normal(mesh, face);
        const Vec3f n = vector_of(mesh.mNormals[face.mIndices[k]]);
        const float length = length_of(n);
        return length > 1e-6f && std::isfinite(length) ? (1 / length) * n : face_normal(mesh, face);
    }

    /// Whether some corner has another normal than its triangle; else the normals say nothing.
    bool any_smooth() const {
        for (unsigned m = 0; m < scene_.mNumMeshes; ++m) {
            const aiMesh& part = *scene_.mMeshes[m];
            if (!is_wanted(part) || !part.HasNormals()) continue;
            for (unsigned f = 0; f < part.mNumFaces; ++f) {
                if (part.mFaces[f].mNumIndices != 3) continue;
                for (unsigned k = 0; k < 3; ++k)
                    if (!(dot(normal_of(part, part.mFaces[f], k), face_normal(part, part.mFaces[f])) > 0.9999f))
                        return true;
            }
        }
        return false;
    }

    void add(const aiMesh& part) {
        for (unsigned f = 0; f < part.mNumFaces; ++f) {
            const aiFace& face = part.mFaces[f];
            if (face.mNumIndices != 3) continue;
            Triangle triangle;
            for (unsigned k = 0; k < 3; ++k) triangle[k] = vertex(part, face, k);
            result.triangles.push_back(triangle);
        }
    }

    std::uint32_t vertex(const aiMesh& part, const aiFace& face, unsigned k) {
        const unsigned i = face.mIndices[k];
        if (i >= part.mNumVertices) throw Failure("a face has an index beyond the vertices");
        const Vec3f p = vector_of(part.mVertices[i]), n = has_normals_ ? normal_of(part, face, k) : Vec3f{};
        Vec2<float> uv{};
        if (has_uv_ && part.HasTextureCoords(0)) uv = {part.mTextureCoords[0][i].x, part.mTextureCoords[0][i].y};
        const auto [known, is_new] = known_.try_emplace(
            Corner{p.x, p.y, p.z, n.x, n.y, n.z, uv.x, uv.y}, static_cast<std::uint32_t>(result.positions.size()));
        if (!is_new) return known->second;
        result.positions.push_back(p);
        if (has_normals_) result.normals.push_back(n);
        if (has_uv_) result.uv.push_back(uv);
        return known->second;
    }

    const aiScene& scene_;
    std::string wanted_;
    bool has_normals_ = false, has_uv_ = false;
    std::unordered_map<Corner, std::uint32_t, CornerHash> known_;
};

Json materials_of(const aiScene& scene) {
    std::vector<std::size_t> triangles(scene.mNumMaterials);
    for (unsigned m = 0; m < scene.mNumMeshes; ++m)
        if (scene.mMeshes[m]->mMaterialIndex < scene.mNumMaterials)
            triangles[scene.mMeshes[m]->mMaterialIndex] += scene.mMeshes[m]->mNumFaces;
    Json all = Json::array();
    for (unsigned m = 0; m < scene.mNumMaterials; ++m) {
        if (triangles[m] == 0) continue;
        const aiMaterial& material = *scene.mMaterials[m];
        aiColor3D diffuse(0.5f, 0.5f, 0.5f), emission(0, 0, 0);
        material.Get(AI_MATKEY_COLOR_DIFFUSE, diffuse);
        material.Get(AI_MATKEY_COLOR_EMISSIVE, emission);
        Json one = {{"name", material.GetName().C_Str()}, {"triangles", triangles[m]},
            {"rho_d", {diffuse.r, diffuse.g, diffuse.b}}, {"emission", {emission.r, emission.g, emission.b}}};
        aiString texture;
        if (material.GetTexture(aiTextureType_DIFFUSE, 0, &texture) == aiReturn_SUCCESS ||
            material.GetTexture(aiTextureType_BASE_COLOR, 0, &texture) == aiReturn_SUCCESS)
            one["texture"] = texture.C_Str();
        all.push_back(std::move(one));
    }
    return all;
}

void write_all(int to, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t n = ::write(to, bytes.data(), bytes.size());
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) throw Failure(std::string("cannot write the mesh: ") + std::strerror(errno));
        bytes.remove_prefix(static_cast<std::size_t>(n));
    }
}

Json import(const std::string& file, const std::string& material) {
    Assimp::Importer importer;
    importer.SetIOHandler(new FolderFiles(file));  // the importer deletes it
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    const aiScene* scene =
        importer.ReadFile(file, aiProcess_Triangulate | aiProcess_SortByPType | aiProcess_PreTransformVertices);
    if (!scene) throw Failure(importer.GetErrorString());
    const Gatherer gathered(*scene, material);
    Json out = {{"materials", materials_of(*scene)}};
    if (gathered.result.triangles.empty())
        throw Failure(material.empty() ? "found no triangle" : "found no triangle of the material '" + material + "'");
    out["normals"] = !gathered.result.normals.empty(), out["uv"] = !gathered.result.uv.empty();
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
