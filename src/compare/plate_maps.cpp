// Maps over the whole frame: how the means of two sides differ, where that is told, and where the noise moved.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "math/functions.h"
#include "compare/plate_parts.h"
#include "compare/plates.h"
#include "compare/quantities.h"
#include "compare/sides.h"
#include "meters/meters.h"
#include "plates/words.h"
#include "pages/numbers.h"
#include "stats/quantiles.h"

namespace crescent::inline comparing {

using namespace plates;

namespace {

std::size_t pixel(const Readings& all, int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(all.width) + static_cast<std::size_t>(x);
}

Rect titled(Canvas& c, const Rect& slot, const std::string& title) {
    c.text({slot.x, slot.y, slot.w, 30}, title, with(with_px(title_text, 18), Align::centre));
    return {slot.x, slot.y + 40, slot.w, slot.h - 40};
}

Ticks ends(double top) { return {{0, "≤ −" + figures(top, 2)}, {0.5, "0"}, {1, "≥ " + figures(top, 2)}}; }

/// What is told is never as grey as what is not.
double visible(double t) { return std::copysign(0.2 + 0.8 * std::min(1.0, std::fabs(t)), t); }

/// A value a tile, `told` ones in their colour, the others grey; in the left of two slots, or in one.
Block tile_block(const Readings& all, const Fit& f, const std::vector<double>& value, const std::vector<bool>& told,
    double top, Theme theme) {
    return nearest_block(all.frame(), f, [&](int x, int y) {
        const std::size_t t = all.tiles.of(std::clamp(x, 0, all.width - 1), std::clamp(y, 0, all.height - 1));
        return diverging(std::isnan(value[t]) ? value[t] : told[t] ? visible(value[t] / top) : 0.0, theme);
    });
}

/// The size below which 98 of 100 differences lie, at most a million of them being looked at.
double scale_of(const Sides& s) {
    std::vector<double> sizes;
    const auto& pixels = s.all.regions.back().pixels;
    const std::size_t step = pixels.size() / 1000000 + 1;
    for (std::size_t k = 0; k < pixels.size(); k += step)
        sizes.push_back(std::fabs(s.mean_a(pixels[k]) - s.mean_b(pixels[k])));
    if (sizes.empty()) return 1;
    const double top = quantile(std::move(sizes), 0.98);
    return top > 0 ? top : 1;
}

/// Of pixels that are not finite on one side, which is a difference; others that are not are of the ground's colour.
bool fails(const BiasResult& found, std::size_t pixel) {
    const auto in = [&](const std::vector<std::uint32_t>& pixels) {
        return std::binary_search(pixels.begin(), pixels.end(), static_cast<std::uint32_t>(pixel));
    };
    return in(found.non_finite.a.pixels) || in(found.non_finite.b.pixels);
}

std::string failing_words(const BiasResult& found) {
    const std::size_t pixels = found.non_finite.a.pixels.size() + found.non_finite.b.pixels.size();
    return pixels ? fmt::format(" Magenta: {} pixels are not finite on one side.", pixels) : "";
}

}  // namespace

Picture difference_plate(const Sides& s, const std::string& a, const std::string& b, Theme theme) {
    Canvas c(sheet_width, sheet_height, ground, 1, theme);
    header(c, true,
        fmt::format("mean <i>{}</i> of {} less that of {}", quantity_names[s.quantity], escaped(a), escaped(b)));
    Rect band = content_band;
    band.w -= bar_room;
    const double top = scale_of(s);
    const Fit f = fit(s.all.width, s.all.height, std::floor(band.w), std::floor(band.h));
    const auto value = [&](int x, int y) {
        const std::size_t i = pixel(s.all, x, y);
        return s.all.bad[i] ? std::nan("") : (s.mean_a(i) - s.mean_b(i)) / top;
    };
    framed(c, diverging_block(s.all.frame(), f, theme, value), band);
    bar(c, {band.right() + gap, band.y + 20, 24, 360}, signed_colours(theme), ends(top));
    return finished(c,
        fmt::format(
            "Orange: {} is brighter. Blue: {} is brighter. Noise is in it: the bias map says what is told apart.",
            escaped(a), escaped(b)),
        fmt::format(
            "means over {} and {} renders; the scale ends at the 98th percentile", s.a.files.size(), s.b.files.size()));
}

Picture bias_plate(const Sides& s, const BiasResult& found, Theme theme) {
    Canvas c(sheet_width, sheet_height, ground, 1, theme);
    const char* name = quantity_names[s.quantity];
    header(c, true, fmt::format("where {} and {} differ: mean <i>{}</i>", escaped(found.a), escaped(found.b), name));
    Rect band = content_band;
    band.w -= bar_room;
    double top = 0;
    const std::vector<double>& tiles = found.tiles.difference[s.quantity];
    for (std::size_t t = 0; t < tiles.size(); ++t)
        if (found.tiles.differs[t]) top = std::max(top, std::fabs(tiles[t]));
    for (const Found& f : found.pixels_found)
        if (f.quantity == s.quantity) top = std::max(top, std::fabs(f.a - f.b));
    top = top > 0 ? top : 1;
    const bool by_pixel = !found.pixel_p.empty();
    const Rect left = titled(
        c, column(band, by_pixel ? 2 : 1, 0), fmt::format("{} of {} tiles", found.tiles.different, found.tiles.tested));
    const Fit f = fit(s.all.width, s.all.height, std::floor(left.w), std::floor(left.h));
    framed(c, tile_block(s.all, f, tiles, found.tiles.differs, top, theme), left);
    if (by_pixel) {
        const Rect right =
            titled(c, column(band, 2, 1), fmt::format("{} of {} pixels", found.pixels_different, found.pixels_tested));
        const std::vector<std::uint32_t>& differ = found.different_pixels;
        framed(c,
            nearest_block(s.all.frame(), f,
                [&](int x, int y) {
                    const std::size_t i = pixel(s.all, x, y);
                    if (s.all.bad[i]) return fails(found, i) ? not_a_number_colour : ground_pixel(theme);
                    const bool differs =
                        std::binary_search(differ.begin(), differ.end(), static_cast<std::uint32_t>(i));
                    return diverging(differs ? visible((s.mean_a(i) - s.mean_b(i)) / top) : 0, theme);
                }),
            right);
    }
    bar(c, {band.right() + gap, band.y + 40, 24, 360}, signed_colours(theme), ends(top));
    return finished(c,
        fmt::format("Orange: {} is brighter{}. Blue: {} is brighter. Grey: no difference found.{}", escaped(found.a),
            s.quantity == 0 ? "" : fmt::format(" in {}", name), escaped(found.b), failing_words(found)),
        fmt::format("{} over renders, false discoveries controlled after {}; tiles of {} × {} pixels, {} left out",
            found.paired ? "Student’s test of pairs" : "Welch’s test",
            found.dependent ? "Benjamini and Yekutieli" : "Benjamini and Hochberg", s.all.tiles.size, s.all.tiles.size,
            found.tiles.left_out));
}

Picture noise_plate(const Readings& all, const NoiseResult& n, Theme theme) {
    Canvas c(sheet_width, sheet_height, ground, 1, theme);
    header(c, true, fmt::format("log<sub>2</sub> of the variance of {} over that of {}", escaped(n.a), escaped(n.b)));
    Rect band = content_band;
    band.w -= bar_room;
    std::vector<double> sizes{1};
    for (std::size_t t = 0; t < n.log2_ratio.size(); ++t)
        if (n.told_apart[t]) sizes.push_back(std::fabs(n.log2_ratio[t]));
    const double top = std::ceil(quantile(std::move(sizes), 0.95));
    const Fit f = fit(all.width, all.height, std::floor(band.w), std::floor(band.h));
    framed(c, tile_block(all, f, n.log2_ratio, n.told_apart, top, theme), band);
    const auto ratio = [](double log2) {
        return log2 < 0 ? fmt::format("1/{:.0f}", math::exp2(-log2)) : fmt::format("{:.0f}", math::exp2(log2));
    };
    bar(c, {band.right() + gap, band.y + 20, 24, 360}, signed_colours(theme),
        {{0, "≤ " + ratio(-top)}, {0.5, "1"}, {1, "≥ " + ratio(top)}});
    return finished(c,
        fmt::format("Orange: {} is noisier. Blue: {} is noisier. Grey: not told apart from 1. Ground: one of them has "
                    "no noise.",
            escaped(n.a), escaped(n.b)),
        fmt::format("tiles of {} × {} pixels, variance of one render over renders", all.tiles.size, all.tiles.size));
}

}  // namespace crescent::inline comparing
