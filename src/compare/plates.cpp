// The plates of a comparison, 1280x720: photographs of one render per arm, their errors on one scale, where arms differ
// and where the noise differs. Instrument plates show radiance; photographs have passed the display chain.
#include "compare/plates.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "compare/compare.h"
#include "compare/plan.h"
#include "compare/renders.h"
#include "compare/wording.h"
#include "math/functions.h"
#include "math/statistics.h"
#include "metrics/metrics.h"
#include "output/format.h"
#include "output/tone_map.h"
#include "report/plates/charts.h"
#include "report/plates/sheet.h"

namespace crescent::plates {

// ---- Colours are in sRGB; a difference t is interpolated linearly in sRGB from the middle colour to that of an end at
// t = 1. A reduced block shows means over its pixels. Places are in units of the sheet, one per pixel.

void header(Canvas& c, bool backend, const std::string& label) {
    const Colour accent = backend ? backend_accent : photograph_accent;
    c.fill({header_band.x, header_band.y + 4, 5, header_band.h - 8}, accent);
    c.text({header_band.x + 17, header_band.y, header_band.w - 17, header_band.h},
        (backend ? "INSTRUMENT / " : "Khronos PBR Neutral / PHOTO-ONLY / ") + label, label_text);
}

void finish(Canvas& c, const std::string& caption, const std::string& note) {
    c.text(caption_band, caption, with_lines(body_text, 2));
    c.text(footer_band, note, with_px(small_text, 17));
}

Picture finished(Canvas& c, const std::string& caption, const std::string& note) {
    finish(c, caption, note);
    return c.picture();
}

Srgb8 diverging(double t, Theme theme) {
    if (std::isnan(t)) return ground_pixel(theme);
    constexpr double middles[2][3] = {{52, 55, 60}, {226, 228, 230}};
    constexpr double lows[2][3] = {{70, 150, 240}, {20, 90, 190}}, highs[2][3] = {{250, 150, 50}, {200, 90, 0}};
    const bool light = theme == Theme::light;
    const double *middle = middles[light], *low = lows[light], *high = highs[light];
    const double a = std::min(1.0, std::fabs(t));
    Srgb8 out{};
    for (std::size_t k = 0; k < 3; ++k)
        out[k] = static_cast<unsigned char>(std::lround(middle[k] + a * ((t < 0 ? low : high)[k] - middle[k])));
    return out;
}

Block nearest_block(const Box& box, const Fit& f, const std::function<Srgb8(int, int)>& colour) {
    Block out(f.out_w, f.out_h);
    for (int y = 0; y < f.out_h; ++y)
        for (int x = 0; x < f.out_w; ++x)
            out.set(x, y, colour(box.x0 + x * f.in_w / f.out_w, box.y1 - y * f.in_h / f.out_h));
    return out;
}

Block diverging_block(const Box& box, const Fit& f, Theme theme, const std::function<double(int, int)>& value) {
    return nearest_block(box, f, [&](int x, int y) {
        if (!f.reduced) return diverging(value(x, y), theme);
        const int across = std::max(1, f.in_w / f.out_w), down = std::max(1, f.in_h / f.out_h);
        double sum = 0, count = 0;
        for (int j = y; j > std::max(box.y0 - 1, y - down); --j)
            for (int i = x; i < std::min(box.x1 + 1, x + across); ++i)
                if (const double v = value(i, j); !std::isnan(v)) {
                    sum += v;
                    count += 1;
                }
        return diverging(count > 0 ? sum / count : std::nan(""), theme);
    });
}

Rect framed(Canvas& c, const Block& block, const Rect& slot) {
    const int x = static_cast<int>(std::floor(slot.x + (slot.w - block.width) / 2)),
              y = static_cast<int>(std::floor(slot.y));
    c.paint(block, x, y);
    const Rect r{double(x), double(y), double(block.width), double(block.height)};
    c.outline(r.inset(-0.5), rule, 1);
    return r;
}

void bar(Canvas& c, const Rect& rect, const std::function<Srgb8(double)>& colour, const Ticks& ticks) {
    Block block(static_cast<int>(rect.w), static_cast<int>(rect.h));
    for (int y = 0; y < block.height; ++y)
        for (int x = 0; x < block.width; ++x) block.set(x, y, colour(1 - (y + 0.5) / block.height));
    framed(c, block, rect);
    for (const auto& [share, text] : ticks)
        c.text({rect.right() + 10, rect.y + rect.h * (1 - share) - 12, 84, 24}, text,
            with(with(with_px(small_text, 15), bright), Vertical::middle));
}

std::function<Srgb8(double)> signed_colours(Theme theme) {
    return [theme](double t) { return diverging(2 * t - 1, theme); };
}

}  // namespace crescent::plates

namespace crescent {

namespace {

using namespace plates;

constexpr std::size_t most_columns = 5;

Box crop_of(const RenderStats& stats) {
    for (const PixelSet& set : stats.regions)
        if (set.box && set.name != whole_frame) return *set.box;
    return stats.frame();
}

/// A column of a sheet: the whole frame above, the first region below it, at the same scale in every column.
struct Column {
    std::string name;
    Block frame, crop;
};
struct Fits {
    Fit frame, crop;
};
Fits fits(const RenderStats& stats, const Rect& band, std::size_t columns) {
    const double w = std::floor(column(band, columns, 0).w);
    const Box crop = crop_of(stats);
    return {fit(stats.width, stats.height, w, 260), fit(crop.width(), crop.height(), w, 240)};
}

void draw_plate(Canvas& c, const RenderStats& stats, const Rect& band, const std::vector<Column>& columns) {
    const Box crop = crop_of(stats);
    for (std::size_t i = 0; i < columns.size(); ++i) {
        Rect slot = column(band, columns.size(), i);
        c.text({slot.x, slot.y, slot.w, 30}, escaped(columns[i].name), with(with_px(title_text, 22), Align::centre));
        slot.y += 36;
        const Rect r = framed(c, columns[i].frame, slot);
        const double sx = r.w / stats.width, sy = r.h / stats.height;
        const Rect cut{
            r.x + crop.x0 * sx, r.y + (stats.height - 1 - crop.y1) * sy, crop.width() * sx, crop.height() * sy};
        if (crop.width() < stats.width || crop.height() < stats.height)
            outline_over(c, cut.inset(-1), photograph_accent);
        slot.y += r.h + 16;
        framed(c, columns[i].crop, slot);
    }
}

std::string crop_words(const RenderStats& stats) {
    const Box crop = crop_of(stats);
    return fmt::format("crop x {}–{}, y {}–{}", crop.x0, crop.x1, crop.y0, crop.y1);
}

struct Residual {
    std::string name;
    std::vector<float> plane;  // |Y - centre|
};

/// Returns the 98th percentile of the residuals, from at most a million of each arm.
double scale_of(const std::vector<Residual>& residuals) {
    std::vector<double> pooled;
    for (const Residual& r : residuals)
        for (std::size_t i = 0; i < r.plane.size(); i += r.plane.size() / 1000000 + 1)
            if (std::isfinite(r.plane[i])) pooled.push_back(static_cast<double>(r.plane[i]));
    const double top = pooled.empty() ? 1 : quantile(std::move(pooled), 0.98);
    return top > 0 ? top : 1;
}

Picture errors(
    const RenderStats& stats, const std::vector<Residual>& residuals, const std::string& centre, Theme theme) {
    Canvas c(sheet_width, sheet_height, ground, 1, theme);
    header(c, true, "|Y − " + centre + "| of one render of each arm, linear, one scale");
    Rect band = content_band;
    band.w -= bar_room;
    const double top = scale_of(residuals);
    const Fits f = fits(stats, band, residuals.size());
    std::vector<Column> columns;
    for (const Residual& r : residuals) {
        const auto value = [&](int x, int y) {
            return static_cast<double>(r.plane[static_cast<std::size_t>(y) * static_cast<std::size_t>(stats.width) +
                       static_cast<std::size_t>(x)]) /
                top;
        };
        columns.push_back(
            {r.name, turbo_block(stats.frame(), f.frame, value), turbo_block(crop_of(stats), f.crop, value)});
    }
    draw_plate(c, stats, band, columns);
    bar(c, {band.right() + gap, band.y + 40, 24, 360}, [](double t) { return turbo(t); },
        {{0, "0"}, {0.5, figures(top / 2, 3)}, {1, "≥ " + figures(top, 3)}});
    return finished(c,
        "Where each arm errs, in the units of the renders: the whole frame and, below it, the first region.",
        "the scale ends at the 98th percentile of all pixels; " + crop_words(stats));
}

/// Draws the sheets of renders and errors; reads the first render of each arm, one at a time.
void shown_renders(const ComparePlan& plan, const RenderStats& stats, std::map<std::string, Picture>& out) {
    const std::size_t arms = std::min(most_columns - (stats.reference ? 1 : 0), stats.arms.size());
    const Fits f = fits(stats, content_band, arms + (stats.reference ? 1 : 0));
    std::vector<Column> columns;
    std::vector<Residual> residuals;
    const auto add = [&](const std::string& name, const Render& render) {
        const View view{render.width, render.height, render.r.data(), render.g.data(), render.b.data(), nullptr};
        columns.push_back({name, photograph_block(view, stats.frame(), f.frame, plan.exposure),
            photograph_block(view, crop_of(stats), f.crop, plan.exposure)});
    };
    for (std::size_t a = 0; a < arms; ++a) {
        const Render r = stats.source.read(stats.arms[a].files[0].path, plan.arms[a].layer);
        add(plan.arms[a].name, in_rec709(stats, r));
        const MeanFilm& centre = stats.reference ? stats.reference->film : stats.arms[a].film;
        if (!stats.reference && centre.count < 2) continue;
        Residual residual{plan.arms[a].name, std::vector<float>(r.size())};
        for (std::size_t i = 0; i < r.size(); ++i)
            residual.plane[i] = static_cast<float>(std::fabs(static_cast<double>(r.y(i)) - centre.y()[i]));
        residuals.push_back(std::move(residual));
    }
    if (stats.reference) add("reference", in_rec709(stats, stats.reference->film));
    Canvas c(sheet_width, sheet_height, ground, 1, plan.theme);
    header(c, false, "one render of each arm");
    draw_plate(c, stats, content_band, columns);
    const char* remark = arms < stats.arms.size() ? "; further arms are not shown" : "";
    out["renders"] = finished(c, "The whole frame and, below it, the first region, enlarged alike in every column.",
        fmt::format("exposure {}; {}{}", figures(plan.exposure), crop_words(stats), remark));
    if (!residuals.empty())
        out["errors"] = errors(stats, residuals, stats.reference ? "Y<sub>ref</sub>" : "mean over renders", plan.theme);
}

/// Returns whether a pair is drawn: of many arms, only the pairs with the first one, because a page would have too many
/// maps.
bool shown_pair(const CompareResult& result, const std::string& a, const std::string& b) {
    constexpr std::size_t most_arms = 4;
    const std::string& first = result.arms[0].name;
    return result.arms.size() <= most_arms || a == first || b == first || b == the_reference;
}

}  // namespace

std::map<std::string, Picture> compare_plates(
    const ComparePlan& plan, const RenderStats& stats, const CompareResult& result) {
    std::map<std::string, Picture> out;
    shown_renders(plan, stats, out);
    if (!result.ladders.empty()) out["ladders"] = ladders_plate(result, plan.theme);
    for (std::size_t k = 0; k < result.bias.size(); ++k) {
        const BiasResult& bias = result.bias[k];
        if (!shown_pair(result, bias.a, bias.b)) continue;
        const BiasPair sides(plan, stats, result, bias.arm_a, bias.arm_b, bias.shown());
        const std::string pair = fmt::format("{}-{}", bias.a, sides.referred ? "reference" : bias.b);
        out["difference-" + pair] = difference_plate(sides, bias.a, bias.b, plan.theme);
        if (!bias.tiles.p.empty()) out["bias-" + pair] = bias_plate(sides, bias, plan.theme);
    }
    for (const NoiseResult& n : result.noise)
        if (shown_pair(result, n.a, n.b)) out[fmt::format("noise-{}-{}", n.a, n.b)] = noise_plate(stats, n, plan.theme);
    return out;
}

// ---- The plate of ladders: arms that are one sampler at several samples per pixel, RMSE (without a reference:
// standard deviation) over samples per pixel, both logarithmic, a column each for at most three regions.

using namespace plates;

namespace {

constexpr std::size_t most_charts = 3, most_curves = 8;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

LadderCurve curve_of(const CompareResult& result, std::size_t ladder, std::size_t region) {
    const SppLadder& l = result.ladders[ladder];
    LadderCurve out;
    out.name = escaped(l.name);
    out.ink = series[ladder % series_count];
    for (const std::size_t a : l.arms) {
        const RegionResult& metrics = result.arms[a].regions[region];
        const MetricValue metric = ladder_metric(metrics.metric("rmse"), metrics.metric("var"));
        out.n.push_back(*result.arms[a].spp);
        out.value.push_back(metric.value.value_or(nan));
        out.interval.push_back(metric.interval.value_or(std::pair(nan, nan)));
        out.heavy |= metrics.heavy();
    }
    const MetricValue& slope = l.slopes[region].second;
    out.slope = slope.value.value_or(nan);
    out.low = slope.interval ? slope.interval->first : nan;
    out.high = slope.interval ? slope.interval->second : nan;
    return out;
}

/// Regions first, then the whole frame if there is room.
std::vector<std::size_t> columns_of(const CompareResult& result) {
    std::vector<std::size_t> out;
    for (std::size_t r = 0; r < result.arms[0].regions.size() && out.size() < most_charts; ++r) out.push_back(r);
    return out;
}

void draw_plate(Canvas& c, const CompareResult& result) {
    const char* what = ladder_metric_name(result.arms[0].regions[0].metric("rmse"));
    header(c, true, fmt::format("{} of one render over its samples a pixel", what));
    const std::vector<std::size_t> columns = columns_of(result);
    const std::size_t curve_count = std::min(most_curves, result.ladders.size());
    for (std::size_t i = 0; i < columns.size(); ++i) {
        std::vector<LadderCurve> curves;
        for (std::size_t l = 0; l < curve_count; ++l) curves.push_back(curve_of(result, l, columns[i]));
        const std::string& region = result.arms[0].regions[columns[i]].region;
        draw_ladder_chart(c, column(content_band, columns.size(), i),
            fmt::format("{}<sub>{}</sub> against N", what, escaped(region)), curves);
    }
    const std::size_t left_out = result.ladders.size() - curve_count;
    finish(c,
        "The power of N with which each falls, and its interval. Independent samples alone fall as N<sup>−0.50</sup>; "
        "what falls slower has a bias or a heavy tail.",
        "bars: 95 % intervals over renders" +
            (left_out ? fmt::format("; {} more are in the page and in metrics.json", left_out) : ""));
}

}  // namespace

Picture ladders_plate(const CompareResult& result, Theme theme) {
    Canvas c(sheet_width, sheet_height, ground, 1, theme);
    draw_plate(c, result);
    return c.picture();
}

std::string ladders_svg(const CompareResult& result, Theme theme) {
    Canvas c(sheet_width, sheet_height, ground, 1, theme, Medium::svg);
    draw_plate(c, result);
    return c.svg();
}

// ---- Maps over the whole frame: how the means of two sides differ, where this is significant, and where the noise
// differs.

using namespace plates;

namespace {

std::size_t pixel(const RenderStats& stats, int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(stats.width) + static_cast<std::size_t>(x);
}

Rect titled(Canvas& c, const Rect& slot, const std::string& title) {
    c.text({slot.x, slot.y, slot.w, 30}, title, with(with_px(title_text, 18), Align::centre));
    return {slot.x, slot.y + 40, slot.w, slot.h - 40};
}

Ticks ends(double top) { return {{0, "≤ −" + figures(top, 2)}, {0.5, "0"}, {1, "≥ " + figures(top, 2)}}; }

/// Moves significant differences away from grey, the colour of the others.
double visible(double t) { return std::copysign(0.2 + 0.8 * std::min(1.0, std::fabs(t)), t); }

/// Draws one value per tile: `different` tiles in their colour, the others grey.
Block tile_block(const RenderStats& stats, const Fit& f, const std::vector<double>& value,
    const std::vector<bool>& different, double top, Theme theme) {
    return nearest_block(stats.frame(), f, [&](int x, int y) {
        const std::size_t t = stats.tiles.of(std::clamp(x, 0, stats.width - 1), std::clamp(y, 0, stats.height - 1));
        return diverging(std::isnan(value[t]) ? value[t] : different[t] ? visible(value[t] / top) : 0.0, theme);
    });
}

/// Returns the 98th percentile of the differences, from at most a million pixels.
double scale_of(const BiasPair& s) {
    std::vector<double> sizes;
    const auto& pixels = s.stats.regions.back().pixels;
    const std::size_t step = pixels.size() / 1000000 + 1;
    for (std::size_t k = 0; k < pixels.size(); k += step)
        sizes.push_back(std::fabs(s.mean_a(pixels[k]) - s.mean_b(pixels[k])));
    if (sizes.empty()) return 1;
    const double top = quantile(std::move(sizes), 0.98);
    return top > 0 ? top : 1;
}

/// Returns whether a pixel is not finite on one side, which is a difference; other pixels that are not finite have the
/// ground's colour.
bool fails(const BiasResult& bias, std::size_t pixel) {
    const auto contains = [&](const std::vector<std::uint32_t>& pixels) {
        return std::binary_search(pixels.begin(), pixels.end(), static_cast<std::uint32_t>(pixel));
    };
    return contains(bias.non_finite.a.pixels) || contains(bias.non_finite.b.pixels);
}

std::string failing_words(const BiasResult& bias) {
    const std::size_t pixels = bias.non_finite.a.pixels.size() + bias.non_finite.b.pixels.size();
    return pixels ? fmt::format(" Magenta: {} pixels are not finite on one side.", pixels) : "";
}

}  // namespace

Picture difference_plate(const BiasPair& s, const std::string& a, const std::string& b, Theme theme) {
    Canvas c(sheet_width, sheet_height, ground, 1, theme);
    header(c, true,
        fmt::format("mean <i>{}</i> of {} less that of {}", quantity_names[s.quantity], escaped(a), escaped(b)));
    Rect band = content_band;
    band.w -= bar_room;
    const double top = scale_of(s);
    const Fit f = fit(s.stats.width, s.stats.height, std::floor(band.w), std::floor(band.h));
    const auto value = [&](int x, int y) {
        const std::size_t i = pixel(s.stats, x, y);
        return s.stats.bad[i] ? std::nan("") : (s.mean_a(i) - s.mean_b(i)) / top;
    };
    framed(c, diverging_block(s.stats.frame(), f, theme, value), band);
    bar(c, {band.right() + gap, band.y + 20, 24, 360}, signed_colours(theme), ends(top));
    return finished(c,
        fmt::format(
            "Orange: {} is brighter. Blue: {} is brighter. Includes noise: the bias map shows significant differences.",
            escaped(a), escaped(b)),
        fmt::format(
            "means over {} and {} renders; the scale ends at the 98th percentile", s.a.files.size(), s.b.files.size()));
}

Picture bias_plate(const BiasPair& s, const BiasResult& bias, Theme theme) {
    Canvas c(sheet_width, sheet_height, ground, 1, theme);
    const char* name = quantity_names[s.quantity];
    header(c, true, fmt::format("where {} and {} differ: mean <i>{}</i>", escaped(bias.a), escaped(bias.b), name));
    Rect band = content_band;
    band.w -= bar_room;
    double top = 0;
    const std::vector<double>& tiles = bias.tiles.difference[s.quantity];
    for (std::size_t t = 0; t < tiles.size(); ++t)
        if (bias.tiles.differs[t]) top = std::max(top, std::fabs(tiles[t]));
    for (const Found& f : bias.pixels_found)
        if (f.quantity == s.quantity) top = std::max(top, std::fabs(f.a - f.b));
    top = top > 0 ? top : 1;
    const bool has_pixel_tests = !bias.pixel_p.empty();
    const Rect left_rect = titled(c, column(band, has_pixel_tests ? 2 : 1, 0),
        fmt::format("{} of {} tiles", bias.tiles.different, bias.tiles.test_count));
    const Fit f = fit(s.stats.width, s.stats.height, std::floor(left_rect.w), std::floor(left_rect.h));
    framed(c, tile_block(s.stats, f, tiles, bias.tiles.differs, top, theme), left_rect);
    if (has_pixel_tests) {
        const Rect right =
            titled(c, column(band, 2, 1), fmt::format("{} of {} pixels", bias.pixels_different, bias.pixels_tested));
        const std::vector<std::uint32_t>& different_pixels = bias.different_pixels;
        framed(c,
            nearest_block(s.stats.frame(), f,
                [&](int x, int y) {
                    const std::size_t i = pixel(s.stats, x, y);
                    if (s.stats.bad[i]) return fails(bias, i) ? not_a_number_colour : ground_pixel(theme);
                    const bool differs = std::binary_search(
                        different_pixels.begin(), different_pixels.end(), static_cast<std::uint32_t>(i));
                    return diverging(differs ? visible((s.mean_a(i) - s.mean_b(i)) / top) : 0, theme);
                }),
            right);
    }
    bar(c, {band.right() + gap, band.y + 40, 24, 360}, signed_colours(theme), ends(top));
    return finished(c,
        fmt::format("Orange: {} is brighter{}. Blue: {} is brighter. Grey: no difference found.{}", escaped(bias.a),
            s.quantity == 0 ? "" : fmt::format(" in {}", name), escaped(bias.b), failing_words(bias)),
        fmt::format("{} over renders, false discoveries controlled after {}; tiles of {} × {} pixels, {} left out",
            bias.paired ? "Student’s test of pairs" : "Welch’s test",
            bias.dependent ? "Benjamini and Yekutieli" : "Benjamini and Hochberg", s.stats.tiles.size,
            s.stats.tiles.size, bias.tiles.left_out));
}

Picture noise_plate(const RenderStats& stats, const NoiseResult& n, Theme theme) {
    Canvas c(sheet_width, sheet_height, ground, 1, theme);
    header(c, true, fmt::format("log<sub>2</sub> of the variance of {} over that of {}", escaped(n.a), escaped(n.b)));
    Rect band = content_band;
    band.w -= bar_room;
    std::vector<double> sizes{1};
    for (std::size_t t = 0; t < n.log2_ratio.size(); ++t)
        if (n.distinguished[t]) sizes.push_back(std::fabs(n.log2_ratio[t]));
    const double top = std::ceil(quantile(std::move(sizes), 0.95));
    const Fit f = fit(stats.width, stats.height, std::floor(band.w), std::floor(band.h));
    framed(c, tile_block(stats, f, n.log2_ratio, n.distinguished, top, theme), band);
    const auto ratio = [](double log2) {
        return log2 < 0 ? fmt::format("1/{:.0f}", math::exp2(-log2)) : fmt::format("{:.0f}", math::exp2(log2));
    };
    bar(c, {band.right() + gap, band.y + 20, 24, 360}, signed_colours(theme),
        {{0, "≤ " + ratio(-top)}, {0.5, "1"}, {1, "≥ " + ratio(top)}});
    return finished(c,
        fmt::format("Orange: {} is noisier. Blue: {} is noisier. Grey: no difference found. Ground: one of them has no "
                    "noise.",
            escaped(n.a), escaped(n.b)),
        fmt::format(
            "tiles of {} × {} pixels, variance of one render over renders", stats.tiles.size, stats.tiles.size));
}

}  // namespace crescent
