// The plate of ladders: arms that are one arm at several samples a pixel, RMSE (without a reference: standard
// deviation) over samples a pixel, both logarithmic, a column each for at most three regions.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/judge.h"
#include "compare/plate_parts.h"
#include "compare/plates.h"
#include "plates/ladder_chart.h"

namespace crescent::inline comparing {

using namespace plates;

namespace {

constexpr std::size_t most_columns = 3, most_curves = 8;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

LadderCurve curve_of(const CompareResult& result, std::size_t ladder, std::size_t region) {
    const SppLadder& l = result.ladders[ladder];
    LadderCurve out;
    out.name = escaped(l.name), out.ink = series[ladder % series_count];
    for (const std::size_t a : l.arms) {
        const MeterValue rung = rung_of(result.arms[a].regions[region]);
        out.n.push_back(*result.arms[a].spp), out.value.push_back(rung.value.value_or(nan));
        out.interval.push_back(rung.interval.value_or(std::pair(nan, nan)));
        out.heavy |= result.arms[a].regions[region].heavy();
    }
    const MeterValue& slope = l.slopes[region].second;
    out.slope = slope.value.value_or(nan);
    out.low = slope.interval ? slope.interval->first : nan, out.high = slope.interval ? slope.interval->second : nan;
    return out;
}

/// Regions first, the whole frame where there is room left for it.
std::vector<std::size_t> columns_of(const CompareResult& result) {
    std::vector<std::size_t> out;
    for (std::size_t r = 0; r < result.arms[0].regions.size() && out.size() < most_columns; ++r) out.push_back(r);
    return out;
}

void draw(Canvas& c, const CompareResult& result) {
    const char* what = rung_words(result.arms[0].regions[0]);
    header(c, true, fmt::format("{} of one render over its samples a pixel", what));
    const std::vector<std::size_t> columns = columns_of(result);
    const std::size_t shown = std::min(most_curves, result.ladders.size());
    for (std::size_t i = 0; i < columns.size(); ++i) {
        std::vector<LadderCurve> curves;
        for (std::size_t l = 0; l < shown; ++l) curves.push_back(curve_of(result, l, columns[i]));
        const std::string& region = result.arms[0].regions[columns[i]].region;
        draw_ladder_chart(c, column(content_band, columns.size(), i),
            fmt::format("{}<sub>{}</sub> against N", what, escaped(region)), curves);
    }
    const std::size_t left_out = result.ladders.size() - shown;
    finish(c,
        "The power of N with which each falls, and its interval. Independent samples alone fall as N<sup>−0.50</sup>; "
        "what falls slower has a bias or a heavy tail.",
        "bars: 95 % intervals over renders" +
            (left_out ? fmt::format("; {} more are in the page and in metrics.json", left_out) : ""));
}

}  // namespace

Picture ladders_plate(const CompareResult& result, Theme theme) {
    Canvas c(sheet_width, sheet_height, ground, 1, theme);
    draw(c, result);
    return c.picture();
}

std::string ladders_svg(const CompareResult& result, Theme theme) {
    Canvas c(sheet_width, sheet_height, ground, 1, theme, Medium::svg);
    draw(c, result);
    return c.svg();
}

}  // namespace crescent::inline comparing
