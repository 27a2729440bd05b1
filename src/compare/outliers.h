// Outliers of several renders of one view: single pixels of single renders (fireflies), and whole renders that do not
// belong to the others (black, of another view, with another exposure).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"

namespace crescent {

struct RenderStats;

/// A value of a pixel in one render that alone has more variance than the rest of its render.
struct OutlierPixel {
    std::size_t side = 0, render = 0;  // indices of an arm and of its file
    std::uint32_t pixel = 0;
    std::size_t quantity = 0;      // in which it is one, see quantity_names
    double value = 0, others = 0;  // mean of the other renders of both sides at this pixel
};

/// The outlier pixels of two sides. The rule is symmetric in the renders of both sides, so if the sides have the same
/// distribution, each outlier is on a side with the probability of that side's share of the renders.
struct OutlierPixels {
    std::vector<OutlierPixel> pixels;       // by side, render and pixel
    std::array<std::uint64_t, 2> groups{};  // of touching pixels, over the renders of each side
    std::array<std::vector<std::uint64_t>, 2> by_render;
    bool set_apart = false;  // their pixels are left out of the tests of means and variances
    std::uint64_t total() const { return groups[0] + groups[1]; }
};

/// Finds the outlier pixels of the first two arms after the first pass; files are read again only if some pixel may
/// have one. A value is an outlier if it is one among the values of its pixel over both sides (Grubbs 1950), and if its
/// squared deviation is larger than the variance, over renders, of the sum of all pixels of a region that have none:
/// such a value decides the mean of its render. If there are at most half as many groups as renders, they are set
/// apart: `stats.bad` contains their pixels, and the regions do not.
OutlierPixels find_outliers(RenderStats& stats, const std::array<std::string, 2>& layers, ProgressMonitor& monitor);

/// A render that does not belong to the other renders of its side.
struct OutlierRender {
    std::size_t side = 0, render = 0;
    std::uint64_t pixels = 0;     // its groups of outlier pixels, if p is that of their number
    double ratio = std::nan("");  // of its mean Y to that of the others of its side
    double deviation = 0;         // from the others, in standard deviations of a render
    double p = 1;                 // of no such render on either side
};

/// Returns the render of the first two arms that deviates the most from the others of its side; nothing if no side has
/// three, with light in four tiles. Outlier pixels deviate if one render has too many of them for equal rates (binomial
/// tail), all else by its tiles: the deviation is the |mean - mean of the others| that a quarter of the tiles, and four
/// of them, reach, relative to the root mean square of the standard deviation, over the others or over the other side,
/// the larger of the two: a few bright pixels do not increase it. p is that of Student's t if all tiles deviate
/// together, as with noise that is common to all pixels, times the number of renders and 2 (Bonferroni); with
/// independent tiles it is smaller.
std::optional<OutlierRender> outlier_render(const RenderStats& stats);

}  // namespace crescent
