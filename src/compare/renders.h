// The renders of a comparison, walked through one at a time: per-pixel means and spreads of every arm and the reference
// (first pass), then what each render says of each region and tile (second pass). Memory does not grow with the number
// of renders: 16 bytes a pixel and arm of grey renders, 64 of renders in colour, and one render.
#pragma once

#include <cstdint>
#include <functional>
#include <map>

#include "base/progress_monitor.h"
#include "compare/plan.h"
#include "compare/render.h"
#include "meters/metrics.h"

namespace crescent::inline comparing {

/// Per pixel over K renders, Welford 1962.
struct MeanPlane {
    std::vector<double> mean, m2;  // m2: sum of the squared deviations from the mean
};

/// Means of the quantities of quantities.h over K renders. A film whose renders are all grey holds Y alone.
struct MeanFilm {
    std::size_t count = 0;             // K
    std::vector<MeanPlane> planes;     // Y; and R, G, B once a render was not grey
    std::vector<float> told_variance;  // sum over renders of the variance of Y that the renderer wrote; empty: none
    double rounding = 0;               // of a pixel, relative: the coarsest of its files
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
struct RegionReading {
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

struct ArmReadings {
    std::vector<RenderFile> files;
    MeanFilm film;
    std::vector<std::vector<RegionReading>> regions;        // [render][region]
    std::vector<QuantityReadings> quantities;               // as many as Readings::quantities
    std::vector<std::vector<float>> largest;                // [region]: the largest squared errors, falling
    std::vector<std::vector<double>> power;                 // [region][frequency]: error spectrum; empty: none
    std::vector<std::uint32_t> not_finite;                  // [pixel]: in how many renders; empty: nowhere
    std::vector<std::vector<std::uint32_t>> failed_groups;  // [render][region]: groups of such pixels; empty: none
    std::vector<std::vector<float>> sampled;                // [render]: residuals of some pixels, see shared_seeds.h
};

/// Two renders, by their places in their arms.
using RenderPair = std::pair<std::size_t, std::size_t>;

/// Renders of two arms that share their random numbers, and what the pictures of their differences say.
struct PairedRenders {
    std::vector<RenderPair> pairs;
    ArmReadings differences;  // a render is that of the first arm less that of the second
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

struct Readings {
    RenderSource source;  // its renders fit each other, see common_view.h
    Chromaticities primaries;
    int width = 0, height = 0;
    std::size_t quantities = 1;  // that are tested: 1 where every render is grey, else 4
    Tiles tiles;
    std::vector<PixelSet> regions;  // those of the plan, masks, then the whole frame
    std::vector<ArmReadings> arms;  // as in the plan
    std::optional<ArmReadings> reference;
    std::vector<bool> bad;  // pixels that are not finite in some render: left out everywhere
    std::uint64_t bad_pixels = 0;
    std::vector<std::string> warnings;
    Box frame() const { return {0, 0, width - 1, height - 1}; }
};

/// A render of these readings, or a film's mean, in Rec.709, as plates and FLIP show it.
Render in_rec709(const Readings& all, Render render);
Render in_rec709(const Readings& all, const MeanFilm& film);

/// Reads everything twice. Throws InputError where files do not fit each other.
Readings read_all(const ComparePlan& plan, ProgressMonitor& monitor, const RenderSource& source = {});

}  // namespace crescent::inline comparing
