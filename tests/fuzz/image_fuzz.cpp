// Any bytes as an .image file, a packed sky or texture: it is read, or rejected with an InputError that has a message.
// The hash is made right first, since no mutation would guess it. What is read is written again as the same bytes.
#include <cstdint>
#include <cstring>
#include <string>

#include "base/errors.h"
#include "scene/sky.h"
#include "scene/texture.h"

namespace {

using namespace crescent;

/// The hash of the content is the last field of the header.
void make_right(std::string& file) {
    if (file.size() < image_header_size + sizeof(float)) return;
    std::uint32_t size[2];
    std::memcpy(size, &file[16], sizeof size);
    const std::size_t floats = (file.size() - image_header_size) / sizeof(float);
    std::vector<float> rgb(floats);
    std::memcpy(rgb.data(), &file[image_header_size], floats * sizeof(float));
    const RgbImage image = {
        .width = static_cast<int>(size[0]), .height = static_cast<int>(size[1]), .rgb = std::move(rgb), .halves = {}};
    const std::uint64_t hash = hash_of_texels(image);
    std::memcpy(&file[image_header_size - sizeof hash], &hash, sizeof hash);
}

void read_or_refuse(const std::string& file) {
    try {
        const std::shared_ptr<const RgbImage> image = read_image_file(file, "fuzz.image");
        ensure(image->size() == 3 * image->texels(), "three numbers a texel");
        ensure(image_file(*image) == file, "what is read is written again");
        (void)why_no_sky(*image, 1);
        for (const TextureOf of : {TextureOf::rho_d, TextureOf::alpha}) (void)why_no_texture(*image, of);
        (void)texel_at(*image, 0.3, -7.2);
    } catch (const InputError& error) {
        ensure(!error.diagnostics().empty() && !error.diagnostics().front().message.empty(), "a refusal says why");
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::string file(reinterpret_cast<const char*>(data), size);
    read_or_refuse(file);
    make_right(file);
    read_or_refuse(file);
    return 0;
}
