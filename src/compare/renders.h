// The renders of a comparison, read one at a time: means and variances per pixel of every arm and the reference (first
// pass), then the statistics of each render in each region and tile (second pass). Memory does not grow with the number
// of renders: 16 bytes per pixel and arm for grey renders, 64 for renders in colour, and one render.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/progress.h"
#include "compare/image_file.h"
#include "compare/outliers.h"
#include "compare/plan.h"
#include "images/exr_file.h"
#include "images/open_file.h"
#include "metrics/metrics.h"

namespace crescent {

// ---- One render of another program, read from a file of a format below. Rows run bottom-up, pixel (i, j) is at j *
// width + i, as in a Film. Units are those of the renderer; Y is the luminance for
// the file's primaries, Rec.709 if it has none.

inline constexpr const char* readable_formats =
    "a render (OpenEXR, PFM, NPY, Radiance HDR, PNG, JPEG, BMP, TGA, PGM or PPM)";

/// How the names of such files end.
inline constexpr std::array image_endings = {
    ".exr", ".pfm", ".hdr", ".png", ".jpg", ".jpeg", ".bmp", ".tga", ".ppm", ".pgm", ".npy"};

/// A render and what its file states about it.
struct Render {
    std::string file;
    std::string layer;  // the part and layer that was read; "" if the file has only one
    int width = 0, height = 0;
    PixelWindow data, display;  // windows of these pixels and of the whole picture, in the file's coordinates
    Chromaticities primaries;   // of r, g and b
    Rgb weights{luminance_weights[0], luminance_weights[1], luminance_weights[2]};  // of r, g and b in Y
    FileState state;                 // of its file when it was read; unset for renders in memory
    std::uint64_t hash = 0;          // of r, g and b as they are compared
    std::vector<std::string> notes;  // conversions of the file that the user must know
    std::vector<float> r, g, b;      // radiance
    std::vector<float> alpha;        // empty: the file has none, or it is not tested
    std::vector<float> variance;     // of Y of this render, as the renderer stated it; empty: not stated
    std::string variance_channels;   // the channels of that variance, and their conversion
    std::string sample_channel;      // the channel with the samples of each pixel
    double rounding = 0x1p-24;       // of a channel, relative: 2^-24 for float, 2^-11 for half, 2^-8 for RGBE
    Quantisation steps;              // of r, g and b, if the file holds whole numbers
    bool display_referred = false;   // a picture for display: tone-mapped, and clipped at its largest number
    bool displayed = false;          // r, g and b are encoded as a display takes them
    bool per_sample = false;         // `variance` is that of one sample, not yet divided by the samples per pixel
    std::optional<double> spp;       // samples per pixel, from the file's attributes or its sample-count channel
    std::optional<double> seconds;   // render time, from the file's attributes

    Render() = default;
    /// A black picture in windows of its own size.
    Render(std::string path, int w, int h);
    struct Empty {};
    static constexpr Empty empty{};
    /// The same without pixels.
    Render(std::string path, int w, int h, Empty);
    std::size_t size() const { return r.size(); }
    float y(std::size_t i) const;
    /// Whether all pixels have one colour.
    bool is_uniform() const;
    /// Whether each tested channel of a pixel is finite.
    bool is_finite(std::size_t i) const;
};

/// Reads a render: the pixels of its data window. `layer` selects a part or layer of a file with several ("": the
/// beauty, by its usual names). Throws InputError with the file's name if it cannot be read, is shorter than its header
/// states, changes meanwhile or has no colours. Allocates only memory for pixels that the file can contain.
Render read_render(const std::string& path, const std::string& layer = {}, const ReadingOptions& options = {});

/// Multiplies each pixel's r, g and b by a matrix.
void convert(Render& render, const Matrix3& m);
/// Converts r, g and b from X, Y and Z to linear Rec.709.
void from_xyz(Render& render);

// Readers of the other formats; read_render() selects one by the first bytes.
Render read_pfm(const OpenFile& file);
Render read_npy(const OpenFile& file);

/// Per pixel over K renders, Welford 1962.
struct MeanPlane {
    std::vector<double> mean, m2;  // m2: sum of the squared deviations from the mean
};

/// Means of these quantities over K renders. A film of grey renders has only Y.
struct MeanFilm {
    std::size_t count = 0;          // K
    std::vector<MeanPlane> planes;  // Y; also R, G, B if a render was not grey; and alpha if it is tested
    std::vector<float>
        stated_variance;  // sum over renders of the variance of Y that the renderer stated; empty: not stated
    double rounding = 0;  // of a pixel, relative: the largest of its files
    Quantisation steps;   // the coarsest of its files
    /// Returns by how much rounding in the files moves a value at most.
    double half_step(double value) const { return std::max(rounding * std::fabs(value), steps.half_step(value)); }
    /// `variance_scale` converts the stated variance to that of a pixel; 0: the conversion is unknown.
    void add(const Render& render, double variance_scale = 1);
    /// Returns the plane of a quantity; for a channel of a grey film that of Y.
    const MeanPlane& of(std::size_t quantity) const { return planes[quantity < planes.size() ? quantity : 0]; }
    const std::vector<double>& y() const { return planes[0].mean; }
    /// Returns the mean radiance of channel 0 to 2, for pictures.
    std::vector<float> radiance(std::size_t channel) const;
    /// Returns the variance of a quantity of one render at pixel i; NaN if unknown.
    double variance(std::size_t i, std::size_t quantity = 0) const;
};

/// A file that was read.
struct RenderFile {
    std::string path, hash;
    std::string layer, variance_channels, sample_channel;
    std::optional<double> spp, seconds;
    std::vector<std::uint64_t> numbers;  // in its name, to find pairs
};

/// The pixels of a region, a mask or the whole frame, ascending.
struct PixelSet {
    std::string name;
    std::optional<Box> box;
    std::vector<std::uint32_t> pixels;    // finite in every render
    std::vector<std::uint32_t> left_out;  // not finite in some render
};

/// The statistics of one render in one region; squares are means over its pixels.
struct RegionStats {
    double y = 0, mse = 0, relmse = 0, mape = 0, fireflies = 0;
    double spread = 0;    // mean (Y - mean over renders)^2
    double with_sum = 0;  // mean of e S, where S is the sum of all renders' errors: for the bias without the variance
};
struct TileReading {
    double mean = 0, spread = 0;
    double largest = 0;  // of the tile's squared deviations, over its number of pixels
};

/// The results of the second pass for one quantity, for tests of means.
struct QuantityReadings {
    std::vector<std::vector<double>> regions;     // [render][region]: mean
    std::vector<std::vector<TileReading>> tiles;  // [render][tile]
    std::vector<std::vector<float>> largest;      // [region]: the largest squared deviations of all renders, descending
    double rise = 0, fall = 0;  // the largest deviations that are outliers of their pixels, see passes.cpp
};

/// The statistics of the renders of an arm, or of the reference.
struct ArmStats {
    std::vector<RenderFile> files;
    MeanFilm film;
    std::vector<std::vector<RegionStats>> regions;  // [render][region]
    std::vector<QuantityReadings> quantities;       // as many as RenderStats::quantities
    std::vector<std::vector<float>> largest;        // [region]: the largest squared errors, descending
    std::vector<std::vector<double>> power;         // [region][frequency]: error spectrum; empty: none
    std::vector<std::uint32_t> not_finite;          // [pixel]: number of renders; empty: none
    std::vector<std::vector<std::uint32_t>>
        failed_groups;                        // [render][region]: groups of pixels that are not finite; empty: none
    std::vector<std::vector<float>> sampled;  // [render]: residuals of some pixels, see shared_seeds.h
};

/// Two renders, by their indices in their arms.
using RenderPair = std::pair<std::size_t, std::size_t>;

/// Renders of two arms that share their random numbers, and the statistics of their differences.
struct PairedRenders {
    std::vector<RenderPair> pairs;
    ArmStats differences;  // of renders that are the first arm's minus the second arm's
};

/// Square tiles, the last of a row or column cut off; about 512 of them, with sides of at least 8 pixels.
struct Tiles {
    int size = 8, across = 1, down = 1;
    Tiles() = default;
    Tiles(int width, int height);
    /// Returns the number of tiles.
    std::size_t count() const { return static_cast<std::size_t>(across) * static_cast<std::size_t>(down); }
    /// Returns the pixels of a tile of an image.
    Box box(std::size_t tile, int width, int height) const;
    /// Returns the tile of pixel (i, j).
    std::size_t of(int i, int j) const {
        return static_cast<std::size_t>(j / size) * static_cast<std::size_t>(across) +
            static_cast<std::size_t>(i / size);
    }
};

/// Returns the files that match the patterns, sorted by name; InputError if one matches nothing.
std::vector<std::string> expand(const std::vector<std::string>& patterns, const SourceLocation& place);

/// The source of renders: files, or a program's memory.
struct RenderSource {
    /// Returns the names of the renders that match patterns.
    std::function<std::vector<std::string>(const std::vector<std::string>&, const SourceLocation&)> expand =
        crescent::expand;
    /// Returns one of them.
    std::function<Render(const std::string& path, const std::string& layer)> read =
        [](const std::string& path, const std::string& layer) { return read_render(path, layer); };
};
/// Returns a source that reads files in this way.
RenderSource files_read_with(const ReadingOptions& options);

/// The statistics of all renders of a comparison.
struct RenderStats {
    RenderSource source;  // its renders fit each other, see passes.h
    Chromaticities primaries;
    int width = 0, height = 0;
    std::size_t quantities = 1;  // that are tested: 1 if every render is grey, else 4; 5 with alpha
    Tiles tiles;
    std::vector<PixelSet> regions;  // those of the plan, masks, then the whole frame
    std::vector<ArmStats> arms;     // as in the plan
    std::optional<ArmStats> reference;
    std::vector<bool> bad;          // pixels that are not finite in some render, or set apart: left out everywhere
    std::uint64_t bad_pixels = 0;   // that are not finite
    OutlierPixels outliers;         // if the plan asks for them
    bool displayed = false;         // values are encoded as a display takes them
    bool display_referred = false;  // some render is a picture for display
    std::vector<bool> clipped;      // pixels with a channel at the largest number of every file; empty: none is known
    std::vector<std::string> warnings;
    std::string bad_files;  // of the warnings: which files have pixels that are not finite, and how many
    Box frame() const { return {0, 0, width - 1, height - 1}; }
};

/// Converts a render, or the mean of a film, to Rec.709, as plates and FLIP show it.
Render in_rec709(const RenderStats& stats, Render render);
Render in_rec709(const RenderStats& stats, const MeanFilm& film);

/// Reads all renders twice. Throws InputError if they do not fit each other.
RenderStats read_all(const ComparePlan& plan, ProgressMonitor& monitor, const RenderSource& source);
/// The same of files, read as the plan states.
RenderStats read_all(const ComparePlan& plan, ProgressMonitor& monitor);

// ---- The quantities that are tested at a pixel: Y, if some render is in colour also R, G and B, and alpha if it is
// asked for. Half of a level is for Y, the rest in equal parts for the channels. A difference in hue at equal luminance
// is found only in the channels.

inline constexpr std::size_t colour_quantities = 4, most_quantities = 5;  // with alpha
inline constexpr const char* quantity_names[most_quantities] = {"Y", "R", "G", "B", "alpha"};

/// Returns a quantity's share of a level if `quantities` quantities are tested.
inline double level_share(std::size_t quantity, std::size_t quantities) {
    if (quantities == 1) return 1;
    return quantity == 0 ? 0.5 : 0.5 / static_cast<double>(quantities - 1);
}

/// The p of "no quantity differs" (Bonferroni with those shares), and its quantity; NaN: none was tested.
struct JointP {
    double p = std::nan("");
    std::size_t quantity = 0;
};
/// `values`: p of each quantity, NaN if it was not tested.
inline JointP joint_p(std::span<const double> values) {
    JointP out;
    for (std::size_t q = 0; q < values.size(); ++q) {
        const double p = std::min(1.0, values[q] / level_share(q, values.size()));
        if (std::isnan(values[q]) || p >= out.p) continue;
        out = {p, q};
    }
    return out;
}

}  // namespace crescent
