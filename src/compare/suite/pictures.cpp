// Means over renders as photographs; the difference of the means over their mean brightness, blue if the candidate is
// darker and orange if it is brighter. All pictures of a report together take at most 36 MB.
#include "compare/suite/suite.h"

#include <algorithm>
#include <cmath>

#include "compare/outputs.h"
#include "math/statistics.h"
#include "report/plates/raster.h"

namespace crescent::inline comparison {

namespace {

/// Budgets: of all pictures (base64 adds a third, for a page under 60 MB), and of one view.
constexpr std::size_t most_bytes = 36'000'000, most_of_view = 2'000'000;
constexpr int largest_width = 800, smallest_width = 48;
/// The colours of the difference map end at this multiple of the difference that must be found, or at the value that 1
/// % of the map exceeds.
constexpr double ends_at = 5, beyond = 0.99;

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

/// Returns means of d / brightness over cells of the picture, row by row from the top.
std::vector<double> relative_differences(const RenderStats& all, const BiasResult& means, int width, int height) {
    const std::size_t q = means.shown();
    const MeanPlane &a = all.arms[means.arm_a].film.of(q), &b = all.arms[means.arm_b].film.of(q);
    const auto cells = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    std::vector<double> difference(cells), brightness(cells), count(cells);
    for (int y = 0; y < all.height; ++y)
        for (int x = 0; x < all.width; ++x) {
            const auto i =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(all.width) + static_cast<std::size_t>(x);
            if (all.bad[i]) continue;
            const int cx = static_cast<int>(static_cast<std::int64_t>(x) * width / all.width),
                      cy = static_cast<int>(static_cast<std::int64_t>(all.height - 1 - y) * height / all.height);
            const auto c =
                static_cast<std::size_t>(cy) * static_cast<std::size_t>(width) + static_cast<std::size_t>(cx);
            difference[c] += a.mean[i] - b.mean[i];
            brightness[c] += (std::fabs(a.mean[i]) + std::fabs(b.mean[i])) / 2;
            count[c] += 1;
        }
    double mean = 0, counted = 0;
    for (std::size_t c = 0; c < cells; ++c) mean += brightness[c], counted += count[c];
    mean = counted > 0 ? mean / counted : 0;
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

double scale_of(const std::vector<double>& values, double smallest) {
    std::vector<double> sizes;
    for (const double v : values)
        if (!std::isnan(v)) sizes.push_back(std::fabs(v));
    return std::max(ends_at * smallest, sizes.empty() ? 0 : quantile(std::move(sizes), beyond));
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
        const std::size_t bytes = to.baseline.size() + to.candidate.size() + to.difference.size();
        if (bytes <= budget(suite) || w <= smallest_width) return;
        const double share = std::sqrt(static_cast<double>(budget(suite)) / static_cast<double>(bytes));
        w = std::max(smallest_width, static_cast<int>(w * std::min(0.9, 0.97 * share)));
    }
}

}  // namespace

void picture_one_side(const Suite& suite, const SuiteView& view, const RenderSource& source, ViewResult& out) {
    const bool added = view.baseline.empty();
    RenderStats all;
    const Render read = source.read((added ? view.candidate : view.baseline).front(), suite.options.layer);
    all.primaries = read.primaries;
    const Render first = in_rec709(all, read);
    out.width = first.width, out.height = first.height;
    ViewPictures& to = out.pictures;
    const std::size_t bytes = png_of(photograph(first, largest_width, suite.options.exposure)).size();
    within_budget(suite, first.width, bytes, to, [&](int width) {
        const plates::Block block = photograph(first, width, suite.options.exposure);
        to.width = block.width, to.height = block.height;
        (added ? to.candidate : to.baseline) = png_of(block);
    });
}

void picture_both_sides(const Suite& suite, const RenderStats& all, const BiasResult& means, ViewResult& out) {
    const Render baseline = in_rec709(all, all.arms[0].film), candidate = in_rec709(all, all.arms[1].film);
    ViewPictures& to = out.pictures;
    const plates::Block largest = photograph(candidate, largest_width, suite.options.exposure);
    const std::vector<unsigned char> largest_png = png_of(largest);
    within_budget(suite, all.width, largest_png.size(), to, [&](int width) {
        const plates::Block first = photograph(baseline, width, suite.options.exposure);
        to.width = first.width, to.height = first.height;
        to.baseline = png_of(first);
        to.candidate = to.width == largest.width && to.height == largest.height
            ? largest_png
            : png_of(photograph(candidate, width, suite.options.exposure));
        const std::vector<double> values = relative_differences(all, means, to.width, to.height);
        to.scale = scale_of(values, out.smallest);
        to.difference = png_of(difference_block(values, to.width, to.height, to.scale));
    });
}

}  // namespace crescent::inline comparison
