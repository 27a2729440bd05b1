// Means over renders as photographs; the difference of the means over their mean brightness, blue if the candidate is
// darker and orange if it is brighter; and where noise does not explain it. All pictures of a report together take at
// most 36 MB.
#include "compare/suite/pictures.h"

#include <algorithm>
#include <cmath>

#include "compare/plates.h"
#include "compare/suite/suite.h"
#include "math/functions.h"
#include "math/statistics.h"
#include "report/plates/raster.h"

namespace crescent {

namespace {

/// Budgets: of all pictures (base64 adds a third, for a page under 60 MB), and of one view.
constexpr std::size_t most_bytes = 36'000'000, most_of_view = 2'000'000;
constexpr int largest_width = 800, smallest_width = 48;
/// The colours of the difference map end at this multiple of the difference that must be found, or at the value that 1
/// % of the map exceeds.
constexpr double scale_multiple = 5, scale_quantile = 0.99;
/// Of a tile whose noise differs: the binary logarithm of the ratio of the variances that has the full colour.
constexpr double full_noise = 2;
/// Of a tile that differs: p of the full colour, and the least share of it.
constexpr double full_p = 1e-9, least_colour = 0.4;

std::size_t budget(const Suite& suite) {
    return std::min(most_of_view, most_bytes / std::max<std::size_t>(1, suite.views.size()));
}

std::vector<unsigned char> png_of(const plates::Block& block) {
    return encode_png({block.width, block.height, block.rgb}, {{"Software", "crescent"}});
}

plates::Block photograph(const Render& r, int width, double exposure) {
    const plates::View view{r.width, r.height, r.r.data(), r.g.data(), r.b.data(), nullptr};
    const double height = static_cast<double>(width) * r.height / r.width;
    const plates::Fit fit = plates::fit(r.width, r.height, std::min(width, r.width), std::max(1.0, height));
    return plates::photograph_block(view, plates::whole(view), fit, exposure);
}

/// Returns the cell of a picture, row by row from the top, in which a pixel of the render is.
std::size_t cell_of(const RenderStats& stats, std::size_t pixel, int width, int height) {
    const auto across = static_cast<std::size_t>(stats.width), down = static_cast<std::size_t>(stats.height);
    const std::size_t x = pixel % across, y = pixel / across;
    return (down - 1 - y) * static_cast<std::size_t>(height) / down * static_cast<std::size_t>(width) +
        x * static_cast<std::size_t>(width) / across;
}

/// Returns means of d / brightness over cells of the picture, row by row from the top.
std::vector<double> relative_differences(const RenderStats& stats, const BiasResult& means, int width, int height) {
    const std::size_t q = means.shown();
    const MeanPlane &a = stats.arms[means.arm_a].film.of(q), &b = stats.arms[means.arm_b].film.of(q);
    const auto cells = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    std::vector<double> difference(cells), brightness(cells), count(cells);
    for (std::size_t i = 0; i < stats.bad.size(); ++i) {
        if (stats.bad[i]) continue;
        const std::size_t c = cell_of(stats, i, width, height);
        difference[c] += a.mean[i] - b.mean[i];
        brightness[c] += (std::fabs(a.mean[i]) + std::fabs(b.mean[i])) / 2;
        count[c] += 1;
    }
    double mean = 0, total = 0;
    for (std::size_t c = 0; c < cells; ++c) {
        mean += brightness[c];
        total += count[c];
    }
    mean = total > 0 ? mean / total : 0;
    std::vector<double> out(cells, std::nan(""));
    for (std::size_t c = 0; c < cells; ++c)  // a hundredth of the mean, so that black cells do not decide the scale
        if (count[c] > 0 && mean > 0) out[c] = difference[c] / (brightness[c] + 0.01 * mean * count[c]);
    return out;
}

plates::Block difference_block(const std::vector<double>& values, int width, int height, double scale) {
    plates::Block out(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double v =
                values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
            out.set(x, y, plates::diverging(v / scale, Theme::dark));
        }
    return out;
}

/// The tiles that differ by more than noise, by their p, and the pixels; NaN, the colour of no value, where no test is.
plates::Block significance_block(const RenderStats& stats, const BiasResult& means, int width, int height) {
    const PlaceTests& tiles = means.tiles;
    std::vector<double> of_pixel(stats.bad.size());
    for (std::size_t i = 0; i < of_pixel.size(); ++i) {
        const auto across = static_cast<std::size_t>(stats.width);
        const std::size_t t = stats.tiles.of(static_cast<int>(i % across), static_cast<int>(i / across));
        if (std::isnan(tiles.p[t])) of_pixel[i] = std::nan("");
        if (!tiles.differs[t]) continue;
        const double share = math::log(std::max(tiles.p[t], full_p)) / math::log(full_p);
        of_pixel[i] = std::copysign(std::max(share, least_colour), tiles.difference[tiles.quantity[t]][t]);
    }
    const std::size_t q = means.shown();
    const MeanPlane &a = stats.arms[means.arm_a].film.of(q), &b = stats.arms[means.arm_b].film.of(q);
    for (const std::uint32_t i : means.different_pixels) of_pixel[i] = std::copysign(1, a.mean[i] - b.mean[i]);
    std::vector<double> cells(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), std::nan(""));
    for (std::size_t i = 0; i < of_pixel.size(); ++i) {  // of the pixels of a cell the most significant one
        double& cell = cells[cell_of(stats, i, width, height)];
        if (std::isnan(cell) || std::fabs(of_pixel[i]) > std::fabs(cell)) cell = of_pixel[i];
    }
    return difference_block(cells, width, height, 1);
}

double scale_of(const std::vector<double>& values, double smallest) {
    std::vector<double> sizes;
    for (const double v : values)
        if (!std::isnan(v)) sizes.push_back(std::fabs(v));
    return std::max(scale_multiple * smallest, sizes.empty() ? 0 : quantile(std::move(sizes), scale_quantile));
}

/// Calls draw(width), which sets the pictures, with smaller widths until they fit the budget. `bytes_of_one`: of a
/// picture of the largest width.
template <class Draw>
void within_budget(const Suite& suite, int width, std::size_t bytes_of_one, ViewPictures& to, const Draw& draw) {
    constexpr double pictures = 3;
    const double first = std::sqrt(static_cast<double>(budget(suite)) / (pictures * static_cast<double>(bytes_of_one)));
    const int widest = std::min(width, largest_width);
    for (int w = std::clamp(static_cast<int>(widest * first), std::min(widest, smallest_width), widest);;) {
        draw(w);
        const std::size_t bytes =
            to.baseline.size() + to.candidate.size() + to.difference.size() + to.significance.size();
        if (bytes <= budget(suite) || w <= smallest_width) return;
        const double share = std::sqrt(static_cast<double>(budget(suite)) / static_cast<double>(bytes));
        w = std::max(smallest_width, static_cast<int>(w * std::min(0.9, 0.97 * share)));
    }
}

}  // namespace

void picture_one_side(const Suite& suite, const SuiteView& view, const RenderSource& source, ViewResult& out) {
    const bool is_added = view.baseline.empty();
    RenderStats stats;
    const Render render = source.read((is_added ? view.candidate : view.baseline).front(), suite.options.layer);
    stats.primaries = render.primaries;
    const Render first = in_rec709(stats, render);
    out.width = first.width;
    out.height = first.height;
    ViewPictures& to = out.pictures;
    const std::size_t bytes = png_of(photograph(first, largest_width, suite.options.exposure)).size();
    within_budget(suite, first.width, bytes, to, [&](int width) {
        const plates::Block block = photograph(first, width, suite.options.exposure);
        to.width = block.width;
        to.height = block.height;
        (is_added ? to.candidate : to.baseline) = png_of(block);
    });
}

void picture_both_sides(const Suite& suite, const RenderStats& stats, const BiasResult& means, ViewResult& out) {
    const Render baseline = in_rec709(stats, stats.arms[0].film), candidate = in_rec709(stats, stats.arms[1].film);
    ViewPictures& to = out.pictures;
    const plates::Block largest = photograph(candidate, largest_width, suite.options.exposure);
    const std::vector<unsigned char> largest_png = png_of(largest);
    within_budget(suite, stats.width, largest_png.size(), to, [&](int width) {
        const plates::Block first = photograph(baseline, width, suite.options.exposure);
        to.width = first.width;
        to.height = first.height;
        to.baseline = png_of(first);
        to.candidate = to.width == largest.width && to.height == largest.height
            ? largest_png
            : png_of(photograph(candidate, width, suite.options.exposure));
        const std::vector<double> values = relative_differences(stats, means, to.width, to.height);
        to.scale = scale_of(values, out.smallest);
        to.difference = png_of(difference_block(values, to.width, to.height, to.scale));
        if (means.tiles.different > 0 || means.pixels_different > 0)
            to.significance = png_of(significance_block(stats, means, to.width, to.height));
    });
}

void picture_noise(const RenderStats& stats, const NoiseResult& noise, ViewResult& out) {
    if (std::ranges::find(noise.distinguished, true) == noise.distinguished.end()) return;
    ViewPictures& to = out.pictures;
    std::vector<double> cells(static_cast<std::size_t>(to.width) * static_cast<std::size_t>(to.height), std::nan(""));
    for (std::size_t i = 0; i < stats.bad.size(); ++i) {
        const auto across = static_cast<std::size_t>(stats.width);
        const std::size_t t = stats.tiles.of(static_cast<int>(i % across), static_cast<int>(i / across));
        if (!std::isnan(noise.log2_ratio[t]))
            cells[cell_of(stats, i, to.width, to.height)] = noise.distinguished[t] ? noise.log2_ratio[t] : 0;
    }
    to.noise = png_of(difference_block(cells, to.width, to.height, full_noise));
}

}  // namespace crescent
