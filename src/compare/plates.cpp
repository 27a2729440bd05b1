// The plates of a comparison, 1280x720: photographs of one render an arm, their errors on one scale, where arms differ
// and where the noise moved. Instruments read radiance; photographs have gone through the display chain.
#include "compare/plates.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/plate_parts.h"
#include "compare/schema.h"
#include "compare/sides.h"
#include "color/turbo.h"
#include "meters/meters.h"
#include "plates/sheet.h"
#include "plates/words.h"
#include "pages/numbers.h"
#include "stats/quantiles.h"

namespace crescent::inline comparing {

namespace {

using namespace plates;

constexpr std::size_t most_columns = 5;

Box crop_of(const Readings& all) {
    for (const PixelSet& set : all.regions)
        if (set.box && set.name != whole_frame) return *set.box;
    return all.frame();
}

/// A column of a sheet: the whole frame above, the first region below it, at the same scale in every column.
struct Column {
    std::string name;
    Block whole, close;
};
struct Fits {
    Fit whole, close;
};
Fits fits(const Readings& all, const Rect& band, std::size_t columns) {
    const double w = std::floor(column(band, columns, 0).w);
    const Box crop = crop_of(all);
    return {fit(all.width, all.height, w, 260), fit(crop.width(), crop.height(), w, 240)};
}

void draw(Canvas& c, const Readings& all, const Rect& band, const std::vector<Column>& columns) {
    const Box crop = crop_of(all);
    for (std::size_t i = 0; i < columns.size(); ++i) {
        Rect slot = column(band, columns.size(), i);
        c.text({slot.x, slot.y, slot.w, 30}, escaped(columns[i].name), with(with_px(title_text, 22), Align::centre));
        slot.y += 36;
        const Rect r = framed(c, columns[i].whole, slot);
        const double sx = r.w / all.width, sy = r.h / all.height;
        const Rect cut{
            r.x + crop.x0 * sx, r.y + (all.height - 1 - crop.y1) * sy, crop.width() * sx, crop.height() * sy};
        if (crop.width() < all.width || crop.height() < all.height) outline_over(c, cut.inset(-1), photograph_accent);
        slot.y += r.h + 16;
        framed(c, columns[i].close, slot);
    }
}

std::string crop_words(const Readings& all) {
    const Box crop = crop_of(all);
    return fmt::format("crop x {}–{}, y {}–{}", crop.x0, crop.x1, crop.y0, crop.y1);
}

struct Residual {
    std::string name;
    std::vector<float> plane;  // |Y - about|
};

/// The size below which 98 of 100 residuals lie, at most a million of each arm being looked at.
double scale_of(const std::vector<Residual>& residuals) {
    std::vector<double> pooled;
    for (const Residual& r : residuals)
        for (std::size_t i = 0; i < r.plane.size(); i += r.plane.size() / 1000000 + 1)
            if (std::isfinite(r.plane[i])) pooled.push_back(static_cast<double>(r.plane[i]));
    const double top = pooled.empty() ? 1 : quantile(std::move(pooled), 0.98);
    return top > 0 ? top : 1;
}

Picture errors(const Readings& all, const std::vector<Residual>& residuals, const std::string& about, Theme theme) {
    Canvas c(sheet_width, sheet_height, ground, 1, theme);
    header(c, true, "|Y − " + about + "| of one render of each arm, linear, one scale");
    Rect band = content_band;
    band.w -= bar_room;
    const double top = scale_of(residuals);
    const Fits f = fits(all, band, residuals.size());
    std::vector<Column> columns;
    for (const Residual& r : residuals) {
        const auto value = [&](int x, int y) {
            return static_cast<double>(r.plane[static_cast<std::size_t>(y) * static_cast<std::size_t>(all.width) +
                       static_cast<std::size_t>(x)]) /
                top;
        };
        columns.push_back(
            {r.name, turbo_block(all.frame(), f.whole, value), turbo_block(crop_of(all), f.close, value)});
    }
    draw(c, all, band, columns);
    bar(c, {band.right() + gap, band.y + 40, 24, 360}, [](double t) { return turbo(t); },
        {{0, "0"}, {0.5, figures(top / 2, 3)}, {1, "≥ " + figures(top, 3)}});
    return finished(c,
        "Where each arm errs, in the units of the renders: the whole frame and, below it, the first region.",
        "the scale ends at the 98th percentile of all pixels; " + crop_words(all));
}

/// Reads the first render of each arm, one at a time, into both sheets.
void shown_renders(const ComparePlan& plan, const Readings& all, std::map<std::string, Picture>& out) {
    const std::size_t arms = std::min(most_columns - (all.reference ? 1 : 0), all.arms.size());
    const Fits f = fits(all, content_band, arms + (all.reference ? 1 : 0));
    std::vector<Column> columns;
    std::vector<Residual> residuals;
    const auto add = [&](const std::string& name, const Render& seen) {
        const View view{seen.width, seen.height, seen.r.data(), seen.g.data(), seen.b.data(), nullptr};
        columns.push_back({name, photograph_block(view, all.frame(), f.whole, plan.exposure),
            photograph_block(view, crop_of(all), f.close, plan.exposure)});
    };
    for (std::size_t a = 0; a < arms; ++a) {
        const Render r = all.source.read(all.arms[a].files[0].path, plan.arms[a].layer);
        add(plan.arms[a].name, in_rec709(all, r));
        const MeanFilm& about = all.reference ? all.reference->film : all.arms[a].film;
        if (!all.reference && about.count < 2) continue;
        Residual residual{plan.arms[a].name, std::vector<float>(r.size())};
        for (std::size_t i = 0; i < r.size(); ++i)
            residual.plane[i] = static_cast<float>(std::fabs(static_cast<double>(r.y(i)) - about.y()[i]));
        residuals.push_back(std::move(residual));
    }
    if (all.reference) add("reference", in_rec709(all, all.reference->film));
    Canvas c(sheet_width, sheet_height, ground, 1, plan.theme);
    header(c, false, "one render of each arm");
    draw(c, all, content_band, columns);
    const char* rest = arms < all.arms.size() ? "; further arms are not shown" : "";
    out["renders"] = finished(c, "The whole frame and, below it, the first region, enlarged alike in every column.",
        fmt::format("exposure {}; {}{}", figures(plan.exposure), crop_words(all), rest));
    if (!residuals.empty())
        out["errors"] = errors(all, residuals, all.reference ? "Y<sub>ref</sub>" : "mean over renders", plan.theme);
}

/// Of many arms, every one beside the first alone: a hundred maps are too many for one page.
bool shown_pair(const CompareResult& result, const std::string& a, const std::string& b) {
    constexpr std::size_t few = 4;
    const std::string& first = result.arms[0].name;
    return result.arms.size() <= few || a == first || b == first || b == the_reference;
}

}  // namespace

std::map<std::string, Picture> compare_plates(
    const ComparePlan& plan, const Readings& all, const CompareResult& result) {
    std::map<std::string, Picture> out;
    shown_renders(plan, all, out);
    if (!result.ladders.empty()) out["ladders"] = ladders_plate(result, plan.theme);
    for (std::size_t k = 0; k < result.bias.size(); ++k) {
        const BiasResult& found = result.bias[k];
        if (!shown_pair(result, found.a, found.b)) continue;
        const Sides sides(plan, all, result, found.arm_a, found.arm_b, found.shown());
        const std::string pair = fmt::format("{}-{}", found.a, sides.referred ? "reference" : found.b);
        out["difference-" + pair] = difference_plate(sides, found.a, found.b, plan.theme);
        if (!found.tiles.p.empty()) out["bias-" + pair] = bias_plate(sides, found, plan.theme);
    }
    for (const NoiseResult& n : result.noise)
        if (shown_pair(result, n.a, n.b)) out[fmt::format("noise-{}-{}", n.a, n.b)] = noise_plate(all, n, plan.theme);
    return out;
}

}  // namespace crescent::inline comparing
