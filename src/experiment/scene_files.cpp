// A page has no files: scenes that need one are refused there.
#include "experiment/scene_files.h"

#include <filesystem>
#include <fmt/format.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/errors.h"
#ifndef CRESCENT_NO_FILESYSTEM
#include "render/image_file.h"
#endif

namespace crescent::inline experiment {

#ifdef CRESCENT_NO_FILESYSTEM
void load_sky(SkyLight& sky) { throw InputError({sky.file, 0, 0}, "a page cannot read the image of a sky"); }
void load_texture(Texture& texture, TextureOf, const std::string&) {
    if (texture.file) throw InputError({*texture.file, 0, 0}, "a page cannot read the image of a texture");
}
#else
void load_sky(SkyLight& sky) {
    std::shared_ptr<const RgbImage> image = read_sky(sky.file);
    if (const std::string why = why_no_sky(*image, sky.scale); !why.empty()) throw InputError({sky.file, 0, 0}, why);
    const std::string content = content_hash(*image);
    if (sky.content && sky.content != content)
        throw InputError(
            {sky.file, 0, 0}, fmt::format("expected an image with the content {}, found {}", *sky.content, content));
    sky.content = content, sky.image = std::move(image);
}

void load_texture(Texture& texture, TextureOf of, const std::string& beside) {
    if (!texture.file || texture.image) return;
    const std::string file = (std::filesystem::path(beside).parent_path() / *texture.file).string();
    std::shared_ptr<const RgbImage> image = read_texture(file);
    if (const std::string why = why_no_texture(*image, of); !why.empty()) throw InputError({file, 0, 0}, why);
    texture.image = std::move(image);
}
#endif

std::string content_of(const MeshObject& mesh) {
    ensure(mesh.pack != nullptr, "the content of a mesh is that of its file");
    std::uint64_t hash = mesh.pack->hash;
    for (const TextureKey& key : texture_keys) {
        const Texture& texture = mesh.*key.texture;
        if (!texture.image) continue;
        const std::uint64_t parts[] = {hash, texture.image->hash, key.of == TextureOf::alpha ? 1u : 0u};
        hash = XXH3_64bits(parts, sizeof parts);
    }
    return fmt::format("{:016x}", hash);
}

}  // namespace crescent::inline experiment
