// One render of another program: linear radiance per pixel, read from OpenEXR, PFM, Radiance HDR or NPY. Rows run
// bottom-up, pixel (i, j) at j * width + i, as in a Film. Units are the renderer's own; Y is the luminance of the
// file's primaries, Rec.709 where it names none.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compare/open_file.h"
#include "compare/pixel_window.h"
#include "compare/primaries.h"

namespace crescent::inline comparing {

struct Render {
    std::string file;
    std::string layer;  // which part and layer of the file was read; "" where there is one alone
    int width = 0, height = 0;
    PixelWindow data, display;  // where these pixels are, and what the picture shows, in the file's coordinates
    Chromaticities primaries;   // of r, g and b
    Rgb weights{luminance_weights[0], luminance_weights[1], luminance_weights[2]};  // of r, g and b in Y
    FileState state;                 // of its file when it was read; of none in memory
    std::uint64_t hash = 0;          // of r, g and b as they are compared
    std::vector<std::string> notes;  // what was made of the file that its reader must know
    std::vector<float> r, g, b;      // radiance
    std::vector<float> variance;     // of Y of this render, where the renderer wrote it; empty elsewhere
    std::string variance_channels;   // which channels that came from, and what was made of them
    std::string sample_channel;      // where the renderer wrote the samples of each pixel
    double rounding = 0x1p-24;       // of a channel, relative: 2^-24 for float, 2^-11 for half, 2^-8 for RGBE
    bool per_sample = false;         // `variance` is that of one sample: to be divided by the samples a pixel
    std::optional<double> spp;       // samples a pixel, from the file's attributes or its sample-count channel
    std::optional<double> seconds;   // render time, from the file's attributes

    Render() = default;
    /// Black, in windows of its own size.
    Render(std::string path, int w, int h);
    struct Empty {};
    static constexpr Empty empty{};
    /// The same without its pixels.
    Render(std::string path, int w, int h, Empty);
    std::size_t size() const { return r.size(); }
    float y(std::size_t i) const;
};

/// Reads a render: the pixels of its data window. `layer` names a part or layer where the file holds several ("" takes
/// the beauty, by its usual names). Throws InputError, with the file's name, where it cannot be read, is shorter than
/// its header says, changes meanwhile, holds no radiance, or is a picture that was made to be looked at (PNG, JPEG,
/// ...): those have been through a tone map, and no radiance can be read off them. Memory is taken for what the file
/// can hold alone.
Render read_render(const std::string& path, const std::string& layer = {});

/// Each pixel's r, g and b times a matrix.
void convert(Render& render, const Matrix3& m);
/// r, g and b hold X, Y and Z: they become linear Rec.709.
void from_xyz(Render& render);

// The formats, by their first bytes; read_render chooses.
Render read_exr(const OpenFile& file, const std::string& layer);
Render read_pfm(const OpenFile& file);
Render read_radiance_hdr(const OpenFile& file);
Render read_npy(const OpenFile& file);

}  // namespace crescent::inline comparing
