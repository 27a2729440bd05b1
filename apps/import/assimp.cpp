// OBJ and STL by assimp. The files that a model names are opened in its folder and below it only.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <list>
#include <map>
#include <span>

#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include "model.h"
#include "obj.h"

namespace crescent::importer {

namespace {

/// The model itself comes from memory.
class ModelFiles : public Assimp::DefaultIOSystem {
public:
    explicit ModelFiles(std::filesystem::path model)
        : model_(std::move(model)), folder_(std::filesystem::absolute(model_).parent_path()), text_(bytes_of(model_)) {
        if (lower_extension(model_) != ".obj") return;
        ObjText checked = checked_obj(text_);
        text_ = std::move(checked.text);
        origin = checked.origin;
        left_out = std::move(checked.left_out);
        for (const std::string& library : checked.libraries)
            if (!can_open(folder_ / library))
                left_out.push_back(fmt::format("the materials of '{}', which cannot be opened", library));
    }

    std::vector<std::string> left_out;
    Vec3d origin{};  // of the vertices

    bool Exists(const char* file) const override { return file == model_.string() || can_open(file); }
    Assimp::IOStream* Open(const char* file, const char* mode) override {
        if (std::strchr(mode, 'w') != nullptr) return nullptr;
        if (file == model_.string())
            return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(text_.data()), text_.size());
        if (!can_open(file)) return nullptr;
        if (lower_extension(file) != ".mtl") return DefaultIOSystem::Open(file, mode);
        const std::string& text = materials_.emplace_back(checked_mtl(bytes_of(file), left_out));
        return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
    }

    /// Returns the bytes of an image that a material names; "" if it cannot be read.
    std::string picture(const std::string& name) const {
        const std::filesystem::path file = folder_ / name;
        return can_open(file) ? bytes_of(file) : "";
    }

private:
    bool can_open(const std::filesystem::path& file) const {
        std::error_code unknown;
        return std::filesystem::is_regular_file(file, unknown) && is_inside(folder_, file);
    }
    std::filesystem::path model_, folder_;
    std::string text_;
    std::list<std::string> materials_;  // the texts of MTL files
};

Vec3f vector_of(const aiVector3D& v) { return {v.x + 0.0f, v.y + 0.0f, v.z + 0.0f}; }  // -0 becomes 0

/// The colours of an MTL file; its exponent as a roughness (Blinn-Phong of the same width: Walter et al. 2007).
Material material_of(const aiMaterial& from) {
    Material out{from.GetName().C_Str()};
    aiColor3D colour;
    if (from.Get(AI_MATKEY_COLOR_DIFFUSE, colour) == aiReturn_SUCCESS) out.rho_d = {colour.r, colour.g, colour.b};
    if (from.Get(AI_MATKEY_COLOR_EMISSIVE, colour) == aiReturn_SUCCESS) out.emission = {colour.r, colour.g, colour.b};
    if (from.Get(AI_MATKEY_COLOR_SPECULAR, colour) == aiReturn_SUCCESS) out.rho_s = {colour.r, colour.g, colour.b};
    float number = 0;
    if (from.Get(AI_MATKEY_SHININESS, number) == aiReturn_SUCCESS && number >= 0)
        out.alpha = std::sqrt(2 / (number + 2));
    if (from.Get(AI_MATKEY_ROUGHNESS_FACTOR, number) == aiReturn_SUCCESS) out.alpha = number * number;
    if (from.Get(AI_MATKEY_METALLIC_FACTOR, number) == aiReturn_SUCCESS) out.metal = number;
    aiString texture;
    if (from.GetTexture(aiTextureType_DIFFUSE, 0, &texture) == aiReturn_SUCCESS) {
        out.texture = texture.C_Str();
        std::ranges::replace(out.texture, '\\', '/');
    }
    return out;
}

/// What a material has besides, by its kind.
constexpr std::pair<aiTextureType, const char*> other_images[] = {{aiTextureType_NORMALS, "normal maps"},
    {aiTextureType_HEIGHT, "bump maps"}, {aiTextureType_SPECULAR, "images of the lobe's colour"},
    {aiTextureType_SHININESS, "images of the exponent"}, {aiTextureType_OPACITY, "images of transparency"},
    {aiTextureType_EMISSIVE, "images of emission"}, {aiTextureType_DISPLACEMENT, "images of displacement"},
    {aiTextureType_REFLECTION, "images of reflection"}, {aiTextureType_AMBIENT, "images of ambient light"}};

void list_what_is_left_out(const aiScene& scene, std::vector<std::string>& out) {
    const auto add = [&](std::size_t count, const char* what) {
        if (count > 0) out.push_back(fmt::format("{} {}", count, what));
    };
    const std::span<aiMaterial* const> materials(scene.mMaterials, scene.mNumMaterials);
    for (const auto& [kind, what] : other_images)
        add(static_cast<std::size_t>(
                std::ranges::count_if(materials, [&](const aiMaterial* m) { return m->GetTextureCount(kind) > 0; })),
            what);
    add(static_cast<std::size_t>(std::ranges::count_if(materials,
            [](const aiMaterial* m) {
                float opacity = 1;
                return m->Get(AI_MATKEY_OPACITY, opacity) == aiReturn_SUCCESS && opacity < 1;
            })),
        "materials' transparency");
    const std::span<aiMesh* const> meshes(scene.mMeshes, scene.mNumMeshes);
    add(static_cast<std::size_t>(std::ranges::count_if(meshes, [](const aiMesh* m) { return m->HasVertexColors(0); })),
        "meshes' colours of vertices");
}

/// `has_normals`: those of STL are of its flat triangles. `origin`: of the positions.
Part part_of(const aiMesh& from, bool has_normals, Vec3d origin) {
    Part out;
    out.material = from.mMaterialIndex;
    out.names = {from.mName.C_Str()};
    std::ranges::replace(out.names[0], blank_of_name, ' ');
    for (unsigned k = 0; k < from.mNumVertices; ++k) {
        out.positions.push_back(widen(vector_of(from.mVertices[k])) + origin);
        if (has_normals && from.HasNormals()) out.normals.push_back(vector_of(from.mNormals[k]));
        if (from.HasTextureCoords(0)) out.uv.push_back({from.mTextureCoords[0][k].x, from.mTextureCoords[0][k].y});
    }
    for (unsigned f = 0; f < from.mNumFaces; ++f) {
        const aiFace& face = from.mFaces[f];
        if (face.mNumIndices != 3) continue;  // points and lines are removed
        for (unsigned k = 0; k < 3; ++k)
            if (face.mIndices[k] >= from.mNumVertices) throw ModelError("a face has an index beyond the vertices");
        out.triangles.push_back({face.mIndices[0], face.mIndices[1], face.mIndices[2]});
    }
    return out;
}

}  // namespace

Model read_by_assimp(const std::filesystem::path& file, const ReadingScope& scope) {
    Assimp::Importer importer;
    auto* const files = new ModelFiles(file);
    importer.SetIOHandler(files);  // which deletes it
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    // No node of OBJ and STL has a transform: this step joins the meshes of a material, and loses their names.
    const unsigned joining = scope.whole_scene ? 0 : aiProcess_PreTransformVertices;
    const aiScene* scene = importer.ReadFile(file.string(), aiProcess_Triangulate | aiProcess_SortByPType | joining);
    if (!scene) throw ModelError(importer.GetErrorString());
    Model out;
    out.left_out = files->left_out;  // of the materials' files too, which were read by now
    for (unsigned m = 0; m < scene->mNumMaterials; ++m) out.materials.push_back(material_of(*scene->mMaterials[m]));
    list_what_is_left_out(*scene, out.left_out);
    std::map<std::string, std::size_t> known;
    for (Material& material : out.materials) {
        if (!scope.images || material.texture.empty()) continue;
        const auto [picture, is_new] = known.try_emplace(material.texture, out.pictures.size());
        material.colours = picture->second;
        if (is_new) out.pictures.push_back({material.texture, files->picture(material.texture)});
    }
    for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
        out.parts.push_back(part_of(*scene->mMeshes[m], lower_extension(file) != ".stl", files->origin));
        if (out.parts.back().material >= out.materials.size())
            throw ModelError("a mesh has a material beyond the last");
    }
    return out;
}

}  // namespace crescent::importer
