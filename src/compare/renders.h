// The renders of a comparison, walked through one at a time: per-pixel means and spreads of every arm and the reference
// (first pass), then what each render says of each region and tile (second pass). Memory does not grow with the number
// of renders: 28 bytes a pixel and arm, and one render.
#pragma once

#include <cstdint>
#include <functional>
#include <map>

#include "base/progress_monitor.h"
#include "compare/plan.h"
#include "compare/render.h"
#include "meters/metrics.h"

namespace crescent::inline comparing {

/// Per pixel over K renders: Welford 1962 in double, for Y; mean colour for pictures.
struct MeanFilm {
    std::size_t count = 0;             // K
    std::vector<double> y, m2;         // mean of Y; sum of (Y - mean)^2
    std::vector<float> r, g, b;        // mean radiance
    std::vector<float> told_variance;  // sum over renders of the variance of Y that the renderer wrote; empty: none
    double rounding = 0;               // of a pixel, relative: the coarsest of its files
    /// `variance_scale` makes what the render tells the variance of its pixels; 0: it cannot be known.
    void add(const Render& render, double variance_scale = 1);
    /// Variance of Y of one render at pixel i; NaN where nothing tells it.
    double variance(std::size_t i) const;
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
    std::vector<std::uint32_t> pixels;
};

/// What one render says of one region; squares are means over its pixels.
struct RegionReading {
    double y = 0, mse = 0, relmse = 0, mape = 0, fireflies = 0;
    double spread = 0;    // mean (Y - mean over renders)^2
    double with_sum = 0;  // mean of e S, S the sum of all renders' errors: for the bias without the variance
};
struct TileReading {
    double y = 0, spread = 0;
    double largest = 0;  // of the tile's squared deviations, as a share of their sum
};

struct ArmReadings {
    std::vector<RenderFile> files;
    MeanFilm film;
    std::vector<std::vector<RegionReading>> regions;  // [render][region]
    std::vector<std::vector<TileReading>> tiles;      // [render][tile]
    std::vector<std::vector<float>> largest;          // [region]: the largest squared errors of all renders, falling
    std::vector<std::vector<double>> power;  // [region][frequency]: error spectrum, see spectrum.h; empty: none
    double rare_event = 0;                   // largest rise of a pixel that stands alone in it, see second_pass.cpp
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
