// Images are checked for their use here, wherever they come from.
#include "experiment/scene_files.h"

#include <filesystem>
#include <fmt/format.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/errors.h"
#include "scene/image_pack.h"

namespace crescent::inline experiment {

void load_sky(SkyLight& sky) {
    std::shared_ptr<const RgbImage> image = sky_in_file(sky.file);
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
    std::shared_ptr<const RgbImage> image = texture_in_file(file);
    if (const std::string why = why_no_texture(*image, of); !why.empty()) throw InputError({file, 0, 0}, why);
    texture.image = std::move(image);
}

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
