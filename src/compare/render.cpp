// Which format a file has, by its first bytes.
#include "compare/render.h"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "base/errors.h"
#include "color/rgb.h"
#include "films/film.h"

namespace crescent::inline comparing {

namespace {

struct Magic {
    std::string_view bytes;
    const char* name;
};
/// Pictures made to be looked at: 8 bits, tone-mapped, gamma-encoded.
constexpr Magic pictures[] = {{"\x89PNG", "PNG"}, {"\xff\xd8\xff", "JPEG"}, {"GIF8", "GIF"}, {"BM", "BMP"},
    {"RIFF", "WebP"}, {"II*", "TIFF"}, {"MM", "TIFF"}, {"P6", "PPM"}};

/// The whole file. Uncompressed formats alone come through here: their size is that of the image.
std::vector<char> bytes_of(const std::string& path) {
    constexpr std::uintmax_t most = std::uintmax_t{8} << 30;
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    if (error) throw InputError({path, 0, 0}, "expected a render that can be read: " + error.message());
    if (size > most) throw InputError({path, 0, 0}, "expected a render of at most 8 GiB");
    std::vector<char> bytes(size);
    std::ifstream file(path, std::ios::binary);
    file.read(bytes.data(), static_cast<std::streamsize>(size));
    if (!file) throw InputError({path, 0, 0}, "expected a render that can be read whole");
    return bytes;
}

std::string first_bytes(const std::string& path) {
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored))
        throw InputError({path, 0, 0}, "expected a render, found a folder");
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    if (!file)
        throw InputError(
            {path, 0, 0}, std::string("expected a render that can be read: ") + std::strerror(errno ? errno : ENOENT));
    std::array<char, 16> head{};
    file.read(head.data(), head.size());
    return {head.data(), static_cast<std::size_t>(file.gcount())};
}

}  // namespace

Render::Render(std::string path, int w, int h) : file(std::move(path)), width(w), height(h) {
    const std::size_t pixels = static_cast<std::size_t>(w) * static_cast<std::size_t>(h);
    for (std::vector<float>* plane : {&r, &g, &b}) plane->resize(pixels);
}

float Render::y(std::size_t i) const {
    const double rgb[3] = {static_cast<double>(r[i]), static_cast<double>(g[i]), static_cast<double>(b[i])};
    return static_cast<float>(luminance(rgb));
}

Render read_render(const std::string& path, const std::string& layer) {
    const std::string head = first_bytes(path);
    if (head.starts_with("\x76\x2f\x31\x01")) return read_exr(path, layer);
    if (head.starts_with("PF") || head.starts_with("Pf")) return read_pfm(path, bytes_of(path));
    if (head.starts_with("#?")) return read_radiance_hdr(path, bytes_of(path));
    if (head.starts_with("\x93NUMPY")) return read_npy(path, bytes_of(path));
    for (const Magic& picture : pictures)
        if (head.starts_with(picture.bytes))
            throw InputError({path, 0, 0},
                fmt::format("expected linear radiance (OpenEXR, PFM, Radiance HDR or NPY), found a {}: a picture "
                            "has been through a tone map, and no radiance can be read off it",
                    picture.name));
    throw InputError({path, 0, 0}, "expected OpenEXR, PFM, Radiance HDR or NPY, found something else");
}

}  // namespace crescent::inline comparing
