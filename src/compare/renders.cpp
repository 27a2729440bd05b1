// Finds the format of a file by its first bytes.
#include "compare/renders.h"

#include <array>
#include <fmt/format.h>
#include <string_view>

#include "base/errors.h"

namespace crescent::inline comparison {

namespace {

struct Magic {
    std::string_view bytes;
    const char* name;
};
/// Formats of pictures for display: 8 bits, tone-mapped, gamma-encoded.
constexpr Magic picture_formats[] = {{"\x89PNG", "PNG"}, {"\xff\xd8\xff", "JPEG"}, {"GIF8", "GIF"}, {"BM", "BMP"},
    {"RIFF", "WebP"}, {"II*", "TIFF"}, {"MM", "TIFF"}, {"P6", "PPM"}};

}  // namespace

Render::Render(std::string path, int w, int h, Empty)
    : file(std::move(path)), width(w), height(h), data{0, 0, w - 1, h - 1}, display(data) {}

Render::Render(std::string path, int w, int h) : Render(std::move(path), w, h, empty) {
    for (std::vector<float>* plane : {&r, &g, &b}) plane->resize(data.pixels());
}

float Render::y(std::size_t i) const {
    const double rgb[3] = {static_cast<double>(r[i]), static_cast<double>(g[i]), static_cast<double>(b[i])};
    return static_cast<float>(weights[0] * rgb[0] + weights[1] * rgb[1] + weights[2] * rgb[2]);
}

void from_xyz(Render& render) {
    const Matrix3 m = xyz_to_rgb({});
    convert(render, m);
    render.primaries = {};
    render.weights = luminance_weights_of({});
}

void convert(Render& render, const Matrix3& m) {
    for (std::size_t i = 0; i < render.size(); ++i) {
        const Rgb out = transformed(
            m, {static_cast<double>(render.r[i]), static_cast<double>(render.g[i]), static_cast<double>(render.b[i])});
        render.r[i] = static_cast<float>(out[0]), render.g[i] = static_cast<float>(out[1]),
        render.b[i] = static_cast<float>(out[2]);
    }
}

Render read_render(const std::string& path, const std::string& layer) {
    const OpenFile file(path);
    std::array<char, 16> first{};
    const std::string_view head(first.data(), file.read_some(0, first));
    const auto with_state = [&](Render render) {
        file.expect_unchanged();
        render.state = file.state();
        return render;
    };
    if (head.starts_with("\x76\x2f\x31\x01")) return with_state(read_exr(file, layer));
    if (head.starts_with("PF") || head.starts_with("Pf")) return with_state(read_pfm(file));
    if (head.starts_with("#?")) return with_state(read_radiance_hdr(file));
    if (head.starts_with("\x93NUMPY")) return with_state(read_npy(file));
    for (const Magic& picture : picture_formats)
        if (head.starts_with(picture.bytes))
            file.fail(
                fmt::format("expected linear radiance (OpenEXR, PFM, Radiance HDR or NPY), found a {}: it is "
                            "tone-mapped, so radiance cannot be recovered from it",
                    picture.name));
    file.fail(head.empty() ? "expected OpenEXR, PFM, Radiance HDR or NPY, found an empty file"
                           : "expected OpenEXR, PFM, Radiance HDR or NPY, found something else");
}

}  // namespace crescent::inline comparison
