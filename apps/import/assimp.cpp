// OBJ and STL by assimp. The files that a model names are opened in its folder and below it only.
#include <cstring>

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
        left_out = std::move(checked.left_out);
        for (const std::string& library : checked.libraries)
            if (!can_open(folder_ / library))
                left_out.push_back(fmt::format("the materials of '{}', which cannot be opened", library));
    }

    std::vector<std::string> left_out;

    bool Exists(const char* file) const override { return file == model_.string() || can_open(file); }
    Assimp::IOStream* Open(const char* file, const char* mode) override {
        if (std::strchr(mode, 'w') != nullptr) return nullptr;
        if (file == model_.string())
            return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(text_.data()), text_.size());
        return can_open(file) ? DefaultIOSystem::Open(file, mode) : nullptr;
    }

private:
    bool can_open(const std::filesystem::path& file) const {
        std::error_code unknown;
        return std::filesystem::is_regular_file(file, unknown) && is_inside(folder_, file);
    }
    std::filesystem::path model_, folder_;
    std::string text_;
};

Vec3f vector_of(const aiVector3D& v) { return {v.x + 0.0f, v.y + 0.0f, v.z + 0.0f}; }  // -0 becomes 0

Material material_of(const aiMaterial& from) {
    Material out{from.GetName().C_Str()};
    aiColor3D colour;
    if (from.Get(AI_MATKEY_COLOR_DIFFUSE, colour) == aiReturn_SUCCESS) out.rho_d = {colour.r, colour.g, colour.b};
    if (from.Get(AI_MATKEY_COLOR_EMISSIVE, colour) == aiReturn_SUCCESS) out.emission = {colour.r, colour.g, colour.b};
    aiString texture;
    if (from.GetTexture(aiTextureType_DIFFUSE, 0, &texture) == aiReturn_SUCCESS) out.texture = texture.C_Str();
    return out;
}

Part part_of(const aiMesh& from) {
    Part out;
    out.material = from.mMaterialIndex;
    for (unsigned k = 0; k < from.mNumVertices; ++k) {
        out.positions.push_back(widen(vector_of(from.mVertices[k])));
        if (from.HasNormals()) out.normals.push_back(vector_of(from.mNormals[k]));
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

Model read_by_assimp(const std::filesystem::path& file) {
    Assimp::Importer importer;
    auto* const files = new ModelFiles(file);
    importer.SetIOHandler(files);  // which deletes it
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    const aiScene* scene = importer.ReadFile(
        file.string(), aiProcess_Triangulate | aiProcess_SortByPType | aiProcess_PreTransformVertices);
    if (!scene) throw ModelError(importer.GetErrorString());
    Model out;
    out.left_out = files->left_out;
    for (unsigned m = 0; m < scene->mNumMaterials; ++m) out.materials.push_back(material_of(*scene->mMaterials[m]));
    for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
        out.parts.push_back(part_of(*scene->mMeshes[m]));
        if (out.parts.back().material >= out.materials.size())
            throw ModelError("a mesh has a material beyond the last");
    }
    return out;
}

}  // namespace crescent::importer
