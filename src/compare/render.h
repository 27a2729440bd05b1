// One render of another program: linear radiance per pixel, read from OpenEXR, PFM, Radiance HDR or NPY. Rows run
// bottom-up, pixel (i, j) at j * width + i, as in a Film. Units are the renderer's own; Y is linear Rec.709 luminance.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace crescent::inline comparing {

struct Render {
    std::string file;
    std::string layer;  // which part and layer of the file was read; "" where there is one alone
    int width = 0, height = 0;
    std::vector<float> r, g, b;     // radiance
    std::vector<float> variance;    // of Y of this render, where the renderer wrote it; empty elsewhere
    std::string variance_channels;  // which channels that came from, and what was made of them
    std::string sample_channel;     // where the renderer wrote the samples of each pixel
    double rounding = 0x1p-24;      // of a channel, relative: 2^-24 for float, 2^-11 for half, 2^-8 for RGBE
    bool per_sample = false;        // `variance` is that of one sample: to be divided by the samples a pixel
    std::optional<double> spp;      // samples a pixel, from the file's attributes or its sample-count channel
    std::optional<double> seconds;  // render time, from the file's attributes

    Render() = default;
    Render(std::string path, int w, int h);
    std::size_t size() const { return r.size(); }
    float y(std::size_t i) const;
};

/// Reads a render. `layer` names a part or layer where the file holds several ("" takes the beauty, by its usual
/// names). Throws InputError, with the file's name, where it cannot be read, holds no radiance, or is a picture that
/// was made to be looked at (PNG, JPEG, ...): those have been through a tone map, and no radiance can be read off them.
Render read_render(const std::string& path, const std::string& layer = {});

// The formats, by their first bytes; read_render chooses.
Render read_exr(const std::string& path, const std::string& layer);
Render read_pfm(const std::string& path, std::span<const char> bytes);
Render read_radiance_hdr(const std::string& path, std::span<const char> bytes);
Render read_npy(const std::string& path, std::span<const char> bytes);

}  // namespace crescent::inline comparing
