// The .image file: its size is compared with that of the file before anything is allocated. Texels: double precision; a
// coordinate just below a whole number may round up to the width, and counts as the last texel.
#include "scene/texture.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <limits>
#include <span>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/errors.h"
#include "scene/sky.h"

namespace crescent {

namespace {

static_assert(std::endian::native == std::endian::little, "image files are little-endian");

constexpr std::uint32_t image_kind = 0x67616d69, image_version = 1;

struct ImageHeader {
    char magic[8];
    std::uint32_t kind, version, width, height;
    std::uint64_t hash;
};
static_assert(sizeof(ImageHeader) == image_header_size);

ImageHeader image_header_of(std::string_view head) {
    ImageHeader header{};
    std::memcpy(&header, head.data(), std::min(head.size(), sizeof header));
    return header;
}

}  // namespace

std::string why_no_sky_of(std::int64_t width, std::int64_t height) {
    if (width >= 2 && width <= widest_sky && width == 2 * height) return "";
    const bool is_cross =
        3 * width == 4 * height || 4 * width == 3 * height || width == 6 * height || 6 * width == height;
    return fmt::format(
        "expected a latitude-longitude image, twice as wide as high, at most {} x {} texels, found {} x {}{}",
        widest_sky, highest_sky, width, height,
        is_cross ? ", the shape of the six sides of a cube: a cube map must be converted first" : "");
}

std::string content_hash(const RgbImage& image) { return fmt::format("{:016x}", image.hash); }

std::string why_no_texture_of(std::int64_t width, std::int64_t height) {
    if (width >= 1 && width <= widest_texture && height >= 1 && height <= widest_texture) return "";
    return fmt::format("expected an image of at most {0} x {0} texels, found {1} x {2}", widest_texture, width, height);
}

namespace {

/// Passes the numbers of an image in blocks, in single precision.
template <class Take> void for_each_block(const RgbImage& image, const Take& take) {
    constexpr std::size_t longest = 4096;
    if (image.halves.empty()) return take(std::span(image.rgb));
    std::array<float, longest> block;
    for (std::size_t first = 0; first < image.halves.size(); first += longest) {
        const std::size_t count = std::min(longest, image.halves.size() - first);
        for (std::size_t k = 0; k < count; ++k) block[k] = value_of_half(image.halves[first + k]);
        take(std::span<const float>(block).first(count));
    }
}

}  // namespace

std::uint64_t hash_of_texels(const RgbImage& image) {
    const std::uint32_t size[2] = {static_cast<std::uint32_t>(image.width), static_cast<std::uint32_t>(image.height)};
    XXH3_state_t state;
    XXH3_INITSTATE(&state);
    XXH3_64bits_reset_withSeed(&state, XXH3_64bits(size, sizeof size));
    for_each_block(image,
        [&](std::span<const float> numbers) { XXH3_64bits_update(&state, numbers.data(), numbers.size_bytes()); });
    return XXH3_64bits_digest(&state);
}

float smallest_number(const RgbImage& image) {
    float smallest = std::numeric_limits<float>::infinity();
    for_each_block(image, [&](std::span<const float> numbers) {
        for (const float x : numbers) smallest = x < smallest ? x : smallest;
    });
    return smallest;
}

std::string image_file(const RgbImage& image) {
    ImageHeader header{.magic = {},
        .kind = image_kind,
        .version = image_version,
        .width = static_cast<std::uint32_t>(image.width),
        .height = static_cast<std::uint32_t>(image.height),
        .hash = image.hash};
    std::memcpy(header.magic, "crescent", 8);
    std::string out(sizeof header, '\0');
    std::memcpy(out.data(), &header, sizeof header);
    for_each_block(image, [&](std::span<const float> numbers) {
        out.append(reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes());
    });
    return out;
}

bool is_image_file(std::string_view head) {
    const ImageHeader header = image_header_of(head);
    return std::memcmp(header.magic, "crescent", 8) == 0 && header.kind == image_kind;
}

ImageSize read_image_size(std::string_view head, std::uint64_t size, const std::string& name) {
    const auto fail = [&](const std::string& message) { throw InputError({name, 0, 0}, message); };
    if (!is_image_file(head))
        fail(
            "expected an .image file (it begins with \"crescentimag\"); `crescent import` makes one of an OpenEXR "
            "image");
    if (size < sizeof(ImageHeader) || head.size() < sizeof(ImageHeader))
        fail(fmt::format(
            "expected an .image file, whose header has {} bytes; found {} bytes", sizeof(ImageHeader), size));
    const ImageHeader header = image_header_of(head);
    if (header.version != image_version)
        fail(fmt::format("byte 12: expected version {} of the .image format, found {}", image_version, header.version));
    if (header.width < 1 || header.height < 1 || header.width > widest_texture || header.height > widest_texture)
        fail(fmt::format("byte 16: expected 1 x 1 to {0} x {0} texels, found {1} x {2}", widest_texture, header.width,
            header.height));
    const std::uint64_t expected_size = sizeof header + std::uint64_t{12} * header.width * header.height;
    if (size != expected_size)
        fail(fmt::format("expected {} bytes for {} x {} texels, found {}{}", expected_size, header.width, header.height,
            size, size < expected_size ? ": the file is truncated" : ""));
    return {header.width, header.height};
}

std::shared_ptr<const RgbImage> read_image_file(std::string_view bytes, const std::string& name) {
    const ImageSize size = read_image_size(bytes, bytes.size(), name);
    auto out = std::make_shared<RgbImage>();
    out->width = static_cast<int>(size.width);
    out->height = static_cast<int>(size.height);
    out->rgb.resize(3 * out->texels());
    std::memcpy(out->rgb.data(), bytes.data() + sizeof(ImageHeader), out->rgb.size() * sizeof(float));
    out->hash = hash_of_texels(*out);
    if (const std::uint64_t stated = image_header_of(bytes).hash; stated != out->hash)
        throw InputError({name, 0, 0},
            fmt::format("byte 24: expected the hash of the content, {:016x}, found {:016x}: the file is damaged",
                out->hash, stated));
    return out;
}

// ---- Textures.

std::string why_no_texture(const RgbImage& image, TextureOf property) {
    for (std::size_t k = 0; k < image.texels(); ++k) {
        const float t[] = {image[3 * k], image[3 * k + 1], image[3 * k + 2]};
        const bool roughness = property == TextureOf::alpha;
        const auto is_good = [&](float x) { return x <= 1 && (roughness ? x > 0 : x >= 0); };
        if (is_good(t[0]) && is_good(t[1]) && is_good(t[2]) && (!roughness || (t[0] == t[1] && t[1] == t[2]))) continue;
        const std::size_t width = static_cast<std::size_t>(image.width);
        return fmt::format("texel ({}, {}), counted from the top-left: expected {}, found ({}, {}, {})", k % width,
            k / width, roughness ? "a grey roughness above 0, up to 1" : "an albedo from 0 to 1", t[0], t[1], t[2]);
    }
    return "";
}

Rgb texel_at(const RgbImage& image, double u, double v) {
    const auto step = [](double x, int size) {
        return std::min(static_cast<int>((x - std::floor(x)) * size), size - 1);
    };
    const auto column = static_cast<std::size_t>(step(u, image.width));
    const auto row = static_cast<std::size_t>(image.height - 1 - step(v, image.height));
    const std::size_t first = 3 * (row * static_cast<std::size_t>(image.width) + column);
    return {double(image[first]), double(image[first + 1]), double(image[first + 2])};
}

}  // namespace crescent
