// The renders of a comparison, walked through one at a time: per-pixel means and spreads of every arm and the reference
// (first pass), then what each render says of each region and tile (second pass). Memory does not grow with the number
// of renders: 16 bytes a pixel and arm of grey renders, 64 of renders in colour, and one render.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "compare/open_file.h"
#include "compare/plan.h"
#include "compare/exr_file.h"
#include "metrics/metrics.h"

namespace crescent::inline comparison {

// ---- One render of another program: linear radiance per pixel, read from OpenEXR, PFM, Radiance HDR or NPY. Rows run
// bottom-up, pixel (i, j) at j * width + i, as in a Film. Units are the renderer's own; Y is the luminance of the
// file's primaries, Rec.709 where it names none.

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

/// Per pixel over K renders, Welford 1962.
struct MeanPlane {
    std::vector<double> mean, m2;  // m2: sum of the squared deviations from the mean
};

/// Means of the quantities of quantities.h over K renders. A film whose renders are all grey holds Y alone.
struct MeanFilm {
    std::size_t count = 0;               // K
    std::vector<MeanPlane> planes;       // Y; and R, G, B once a render was not grey
    std::vector<float> stated_variance;  // sum over renders of the variance of Y that the renderer wrote; empty: none
    double rounding = 0;                 // of a pixel, relative: the coarsest of its files
    /// `variance_scale` makes what the render tells the variance of its pixels; 0: it cannot be known.
    void add(const Render& render, double variance_scale = 1);
    /// The plane of a quantity; of a channel of a grey film that of Y.
    const MeanPlane& of(std::size_t quantity) const { return planes[quantity < planes.size() ? quantity : 0]; }
    const std::vector<double>& y() const { return planes[0].mean; }
    /// Mean radiance of a channel, 0 to 2, for pictures.
    std::vector<float> radiance(std::size_t channel) const;
    /// Variance of a quantity of one render at pixel i; NaN where it is not known.
    double variance(std::size_t i, std::size_t quantity = 0) const;
};

struct RenderFile {
    std::string path, hash;
    std::string layer, variance_channels, sample_channel;
    std::optional<double> spp, seconds;
    std::vector<std::uint64_t> numbers;  // in its name, for pairs
};

/// A region, a mask or the whole frame: which pixels, rising.
struct PixelSet {
    std::string name;
    std::optional<Box> box;
    std::vector<std::uint32_t> pixels;    // finite in every render
    std::vector<std::uint32_t> left_out;  // not finite in some
};

/// What one render says of one region; squares are means over its pixels.
struct RegionStats {
    double y = 0, mse = 0, relmse = 0, mape = 0, fireflies = 0;
    double spread = 0;    // mean (Y - mean over renders)^2
    double with_sum = 0;  // mean of e S, S the sum of all renders' errors: for the bias without the variance
};
struct TileReading {
    double mean = 0, spread = 0;
    double largest = 0;  // of the tile's squared deviations, over its pixels
};

/// What the second pass reads of one quantity, for tests of means.
struct QuantityReadings {
    std::vector<std::vector<double>> regions;     // [render][region]: mean
    std::vector<std::vector<TileReading>> tiles;  // [render][tile]
    std::vector<std::vector<float>> largest;      // [region]: the largest squared deviations of all renders, falling
    double rise = 0, fall = 0;                    // the largest of a pixel that is an outlier, see second_pass.cpp
};

struct ArmStats {
    std::vector<RenderFile> files;
    MeanFilm film;
    std::vector<std::vector<RegionStats>> regions;          // [render][region]
    std::vector<QuantityReadings> quantities;               // as many as RenderStats::quantities
    std::vector<std::vector<float>> largest;                // [region]: the largest squared errors, falling
    std::vector<std::vector<double>> power;                 // [region][frequency]: error spectrum; empty: none
    std::vector<std::uint32_t> not_finite;                  // [pixel]: in how many renders; empty: nowhere
    std::vector<std::vector<std::uint32_t>> failed_groups;  // [render][region]: groups of such pixels; empty: none
    std::vector<std::vector<float>> sampled;                // [render]: residuals of some pixels, see noise.h
};

/// Two renders, by their places in their arms.
using RenderPair = std::pair<std::size_t, std::size_t>;

/// Renders of two arms that share their random numbers, and what the pictures of their differences say.
struct PairedRenders {
    std::vector<RenderPair> pairs;
    ArmStats differences;  // a render is that of the first arm less that of the second
};

/// Square tiles, the last of a row or column cut off; about 512 of them, 8 pixels a side at least.
struct Tiles {
    int size = 8, across = 1, down = 1;
    Tiles() = default;
    Tiles(int width, int height);
    std::size_t count() const { return static_cast<std::size_t>(across) * static_cast<std::size_t>(down); }
    /// The pixels of a tile of an image.
    Box box(std::size_t tile, int width, int height) const;
    std::size_t of(int i, int j) const {
        return static_cast<std::size_t>(j / size) * static_cast<std::size_t>(across) +
            static_cast<std::size_t>(i / size);
    }
};

/// Files of the patterns, sorted by name; InputError where one matches nothing.
std::vector<std::string> expand(const std::vector<std::string>& patterns, const SourceLocation& at);

/// Where renders come from: files, or what a program holds in memory.
struct RenderSource {
    std::function<std::vector<std::string>(const std::vector<std::string>&, const SourceLocation&)> expand =
        crescent::expand;
    std::function<Render(const std::string& path, const std::string& layer)> read = read_render;
};

struct RenderStats {
    RenderSource source;  // its renders fit each other, see common_view.h
    Chromaticities primaries;
    int width = 0, height = 0;
    std::size_t quantities = 1;  // that are tested: 1 where every render is grey, else 4
    Tiles tiles;
    std::vector<PixelSet> regions;  // those of the plan, masks, then the whole frame
    std::vector<ArmStats> arms;     // as in the plan
    std::optional<ArmStats> reference;
    std::vector<bool> bad;  // pixels that are not finite in some render: left out everywhere
    std::uint64_t bad_pixels = 0;
    std::vector<std::string> warnings;
    Box frame() const { return {0, 0, width - 1, height - 1}; }
};

/// A render of these readings, or a film's mean, in Rec.709, as plates and FLIP show it.
Render in_rec709(const RenderStats& all, Render render);
Render in_rec709(const RenderStats& all, const MeanFilm& film);

/// Reads everything twice. Throws InputError where files do not fit each other.
RenderStats read_all(const ComparePlan& plan, ProgressMonitor& monitor, const RenderSource& source = {});

}  // namespace crescent::inline comparison
