// The plates of a comparison, 1280x720: photographs of one render an arm, their errors on one scale, where arms differ
// and where the noise moved. Instruments read radiance; photographs have gone through the display chain.
#include "compare/plates.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/schema.h"
#include "color/turbo.h"
#include "meters/meters.h"
#include "plates/raster.h"
#include "plates/style.h"
#include "plates/words.h"
#include "report/numbers.h"

namespace crescent {

namespace {

using namespace plates;

constexpr double bar_room = 116;

/// The header; caption and footer are set at the end.
void header(Canvas& c, bool instrument, const std::string& label) {
    const Colour accent = instrument ? instrument_accent : photograph_accent;
    c.fill({header_band.x, header_band.y + 4, 5, header_band.h - 8}, accent);
    c.text({header_band.x + 17, header_band.y, header_band.w - 17, header_band.h},
        (instrument ? "INSTRUMENT / " : "Khronos PBR Neutral / PHOTO-ONLY / ") + label, label_text);
}

Picture finished(Canvas& c, const std::string& caption, const std::string& note) {
    c.text(caption_band, caption, with_lines(body_text, 2));
    c.text(footer_band, note, small_text);
    return c.picture();
}

/// Dark in the middle, blue below, orange above; t in [-1, 1], NaN: the ground.
Srgb8 diverging(double t) {
    if (std::isnan(t)) return ground_bytes;
    constexpr double middle[3] = {52, 55, 60}, low[3] = {70, 150, 240}, high[3] = {250, 150, 50};
    const double a = std::min(1.0, std::fabs(t));
    Srgb8 out{};
    for (std::size_t k = 0; k < 3; ++k)
        out[k] = static_cast<unsigned char>(std::lround(middle[k] + a * ((t < 0 ? low : high)[k] - middle[k])));
    return out;
}

template <class Colour> Block block_of(const Box& box, const Fit& f, Colour colour) {
    Block out(f.out_w, f.out_h);
    for (int y = 0; y < f.out_h; ++y)
        for (int x = 0; x < f.out_w; ++x)
            out.set(x, y, colour(box.x0 + x * f.in_w / f.out_w, box.y1 - y * f.in_h / f.out_h));
    return out;
}

Rect framed(Canvas& c, const Block& block, const Rect& slot) {
    const int x = static_cast<int>(std::floor(slot.x + (slot.w - block.width) / 2)),
              y = static_cast<int>(std::floor(slot.y));
    c.paint(block, x, y);
    const Rect r{double(x), double(y), double(block.width), double(block.height)};
    c.outline(r.inset(-0.5), rule, 1);
    return r;
}

/// A vertical bar of `colour` with ticks at both ends and the middle.
template <class Colour>
void bar(Canvas& c, const Rect& at, Colour colour, const std::vector<std::pair<double, std::string>>& ticks) {
    Block block(static_cast<int>(at.w), static_cast<int>(at.h));
    for (int y = 0; y < block.height; ++y)
        for (int x = 0; x < block.width; ++x) block.set(x, y, colour(1 - (y + 0.5) / block.height));
    framed(c, block, at);
    for (const auto& [share, text] : ticks)
        c.text({at.right() + 10, at.y + at.h * (1 - share) - 12, 84, 24}, text,
            with(with(with_px(small_text, 15), bright), Vertical::middle));
}

struct Column {
    std::string name;
    View view;
};

Box shown(const Readings& all) {
    for (const PixelSet& set : all.regions)
        if (set.box && set.name != whole_frame) return *set.box;
    return {0, 0, all.width - 1, all.height - 1};
}

Picture photographs(const ComparePlan& plan, const Readings& all, const std::vector<Column>& columns) {
    Canvas c(sheet_width, sheet_height, ground);
    header(c, false, "one render of each arm");
    const Box frame{0, 0, all.width - 1, all.height - 1}, crop = shown(all);
    for (std::size_t i = 0; i < columns.size(); ++i) {
        Rect slot = column(content_band, columns.size(), i);
        c.text({slot.x, slot.y, slot.w, 30}, escaped(columns[i].name), with(with_px(title_text, 22), Align::centre));
        slot.y += 40;
        const Fit whole = fit(all.width, all.height, std::floor(slot.w), 235),
                  close = fit(crop.width(), crop.height(), std::floor(slot.w), 240);
        const Rect r = framed(c, photograph_block(columns[i].view, frame, whole, plan.exposure), slot);
        const double sx = r.w / all.width, sy = r.h / all.height;
        c.outline(Rect{r.x + crop.x0 * sx, r.y + (all.height - 1 - crop.y1) * sy, crop.width() * sx, crop.height() * sy}
                      .inset(-1),
            photograph_accent, 1.5);
        slot.y += 250;
        framed(c, photograph_block(columns[i].view, crop, close, plan.exposure), slot);
    }
    return finished(c, "The whole frame and, below it, the first region, enlarged alike in every column.",
        fmt::format("exposure {}; crop x {}–{}, y {}–{}", figures(plan.exposure), crop.x0, crop.x1, crop.y0, crop.y1));
}

Picture errors(const Readings& all, const std::vector<std::pair<std::string, std::vector<float>>>& residuals,
    const std::string& about) {
    Canvas c(sheet_width, sheet_height, ground);
    header(c, true, "|Y − " + about + "| of one render of each arm, linear, one scale");
    const Box box = shown(all);
    std::vector<double> pooled;
    const auto at = [&](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(all.width) + static_cast<std::size_t>(x);
    };
    for (const auto& [name, plane] : residuals)
        for (int y = box.y0; y <= box.y1; ++y)
            for (int x = box.x0; x <= box.x1; ++x)
                if (std::isfinite(plane[at(x, y)])) pooled.push_back(static_cast<double>(plane[at(x, y)]));
    const double p98 = pooled.empty() ? 1 : quantile(std::move(pooled), 0.98), top = p98 > 0 ? p98 : 1;
    Rect band = content_band;
    band.w -= bar_room;
    for (std::size_t i = 0; i < residuals.size(); ++i) {
        Rect slot = column(band, residuals.size(), i);
        const Fit f = fit(box.width(), box.height(), std::floor(slot.w), std::floor(slot.h - 44));
        c.text({slot.x, slot.y, slot.w, 30}, escaped(residuals[i].first), with(with_px(title_text, 22), Align::centre));
        slot.y += 40;
        framed(c,
            turbo_block(box, f, [&](int x, int y) { return static_cast<double>(residuals[i].second[at(x, y)]) / top; }),
            slot);
    }
    bar(c, {band.right() + gap, band.y + 40, 24, 360}, [](double t) { return turbo(t); },
        {{0, "0"}, {0.5, figures(top / 2, 3)}, {1, "≥ " + figures(top, 3)}});
    return finished(c, "Where each arm errs, in the units of the renders.",
        fmt::format("scale ends at the 98th percentile of all pixels shown; crop x {}–{}, y {}–{}", box.x0, box.x1,
            box.y0, box.y1));
}

/// A value a tile over the whole frame, with its bar; `told` tiles at full strength, the others left grey.
Picture tile_map(const Readings& all, const std::string& label, const std::vector<double>& value,
    const std::vector<bool>& told, double top, const std::vector<std::pair<double, std::string>>& ticks,
    const std::string& caption, const std::string& note) {
    Canvas c(sheet_width, sheet_height, ground);
    header(c, true, label);
    Rect band = content_band;
    band.w -= bar_room;
    const Box box{0, 0, all.width - 1, all.height - 1};
    const Fit f = fit(all.width, all.height, std::floor(band.w), std::floor(band.h));
    framed(c,
        block_of(box, f,
            [&](int x, int y) {
                const std::size_t t = all.tiles.of(std::clamp(x, 0, all.width - 1), std::clamp(y, 0, all.height - 1));
                return std::isnan(value[t]) ? ground_bytes : diverging(told[t] ? value[t] / top : 0.0);
            }),
        band);
    bar(c, {band.right() + gap, band.y + 20, 24, 360}, [](double t) { return diverging(2 * t - 1); }, ticks);
    return finished(c, caption, note);
}

}  // namespace

std::map<std::string, Picture> compare_plates(
    const ComparePlan& plan, const Readings& all, const CompareResult& result) {
    std::map<std::string, Picture> out;
    std::vector<Render> renders;
    for (std::size_t a = 0; a < all.arms.size() && a < 5; ++a)
        renders.push_back(read_render(all.arms[a].files[0].path, plan.arms[a].layer));
    std::vector<Column> columns;
    std::vector<std::pair<std::string, std::vector<float>>> residuals;
    for (std::size_t a = 0; a < renders.size(); ++a) {
        const Render& r = renders[a];
        columns.push_back({plan.arms[a].name, {r.width, r.height, r.r.data(), r.g.data(), r.b.data(), nullptr}});
        const MeanFilm& about = all.reference ? all.reference->film : all.arms[a].film;
        std::vector<float> residual(r.size());
        for (std::size_t i = 0; i < r.size(); ++i)
            residual[i] = static_cast<float>(std::fabs(static_cast<double>(r.y(i)) - about.y[i]));
        if (all.reference || about.count > 1) residuals.emplace_back(plan.arms[a].name, std::move(residual));
    }
    if (all.reference) {
        const MeanFilm& f = all.reference->film;
        columns.push_back({"reference", {all.width, all.height, f.r.data(), f.g.data(), f.b.data(), nullptr}});
    }
    out["renders"] = photographs(plan, all, columns);
    if (!residuals.empty())
        out["errors"] = errors(all, residuals, all.reference ? "Y<sub>ref</sub>" : "mean over renders");
    for (const BiasResult& b : result.bias) {
        if (b.tile_p.empty()) continue;
        double top = 0;
        for (std::size_t t = 0; t < b.tile_p.size(); ++t)
            if (b.tile_differs[t]) top = std::max(top, std::fabs(b.tile_difference[t]));
        top = top > 0 ? top : 1;
        const std::string file = fmt::format("bias-{}-{}", b.a, b.b == "the reference" ? "reference" : b.b);
        out[file] =
            tile_map(all, fmt::format("mean Y of {} less that of {}, tiles that differ", escaped(b.a), escaped(b.b)),
                b.tile_difference, b.tile_differs, top, {{0, figures(-top, 2)}, {0.5, "0"}, {1, figures(top, 2)}},
                escaped(b.sentence),
                fmt::format("{} tiles of {} x {} pixels tested, {} left out; grey: not told apart", b.tiles_tested,
                    all.tiles.size, all.tiles.size, b.tiles_left_out));
    }
    for (const NoiseResult& n : result.noise)
        out[fmt::format("noise-{}-{}", n.a, n.b)] = tile_map(all,
            fmt::format("log<sub>2</sub> of the variance of {} over that of {}", escaped(n.a), escaped(n.b)),
            n.log2_ratio, n.told_apart, 4, {{0, "1/16"}, {0.25, "1/4"}, {0.5, "1"}, {0.75, "4"}, {1, "16"}},
            fmt::format(
                "Orange: {} is noisier. Blue: {} is noisier. Grey: not told apart from 1.", escaped(n.a), escaped(n.b)),
            fmt::format(
                "tiles of {} x {} pixels, variance of one render over renders", all.tiles.size, all.tiles.size));
    return out;
}

}  // namespace crescent
