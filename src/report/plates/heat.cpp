// heat: |Y_N - Y_ref| of the float films, linear Rec.709 luminance in W/(sr m^2), in the turbo colour map on one shared
// scale that ends at the 98th percentile of all pixels shown.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "math/statistics.h"
#include "metrics/metrics.h"
#include "report/plates/sheet.h"

namespace crescent::plates {

namespace {

constexpr double words_height = 60, bar_width = 24, bar_room = 124;

struct Residual {
    RunKey key;
    const Film* film = nullptr;
    const ReferenceFilm* reference = nullptr;
    bool is_complete() const { return film && reference; }
    double at(int x, int y) const {
        std::size_t i = std::size_t(y) * std::size_t(film->width) + std::size_t(x);
        return std::abs(double(film->y[i]) - double(reference->y[i]));
    }
};

std::vector<double> values(const Residual& r, const Box& box) {
    std::vector<double> v;
    v.reserve(std::size_t(box.width()) * std::size_t(box.height()));
    for (int y = box.y0; y <= box.y1; ++y) {
        for (int x = box.x0; x <= box.x1; ++x) v.push_back(r.at(x, y));
    }
    return v;
}

Box shown_box(const Sheet& sheet) {
    const Experiment& e = sheet.experiment();
    View view;
    view.width = e.image.width;
    view.height = e.image.height;
    if (sheet.plan.crop) return inside(*sheet.plan.crop, view);
    return e.regions.empty() ? whole(view) : inside(e.regions[0].box, view);
}

bool within(const Box& b, const Box& box) {
    return b.x0 >= box.x0 && b.x1 <= box.x1 && b.y0 >= box.y0 && b.y1 <= box.y1;
}

// Returns the RMSE of each region that is fully shown, and how much of the crop is above the scale.
std::string reading(const Residual& r, const Box& box, double top, const PlateInputs& in) {
    std::vector<std::string> parts;
    for (const Region& region : in.experiment.regions) {
        if (!within(region.box, box)) continue;
        parts.push_back(fmt::format("RMSE<sub>{}</sub> {}", escaped(region.name),
            figure(rms_difference(r.film->y, r.reference->y, AreaPixels(region.area(), in.shapes)))));
    }
    std::vector<double> v = values(r, box);
    auto count = std::count_if(v.begin(), v.end(), [&](double x) { return x > top; });
    const double percent = 100.0 * double(count) / double(v.size());
    parts.push_back(fmt::format("{} % above scale", number(percent, percent < 99.5 ? 2 : 3)));
    return joined(parts, ", ");
}

void outline_regions(Sheet& sheet, const Rect& picture, const Box& box) {
    for (const Region& region : sheet.experiment().regions) {
        const Box& b = region.box;
        bool is_equal_size = b.width() == box.width() && b.height() == box.height();
        if (!within(b, box) || is_equal_size) continue;
        Rect r = on_picture(picture, box, b).inset(-1.5);
        outline_over(sheet.canvas, r, bright);
        name_tag(sheet, picture, r, region.name, bright);
    }
}

void draw_run(Sheet& sheet, const Residual& r, const Box& box, const Fit& f, double top, const Rect& col) {
    const Experiment& e = sheet.experiment();
    Rect slot{col.x, col.y, col.w, double(f.out_h)};
    if (r.is_complete()) {
        Block block = turbo_block(box, f, [&](int x, int y) {
            double v = r.at(x, y);
            return std::isfinite(v) ? v / top : std::nan("");
        });
        sheet.not_finite += not_finite(view(r.film), box);
        outline_regions(sheet, paint_framed(sheet, block, slot), box);
    } else {
        paint_missing(sheet, slot, escaped(to_string(r.key)) + " was not run");
    }
    double y = slot.bottom() + 8;
    sheet.canvas.text({col.x, y, col.w, 28}, runs_label({r.key}, e), with(with_px(title_text, 22), Align::centre));
    if (r.is_complete()) {
        sheet.canvas.text({col.x, y + 29, col.w, 23}, reading(r, box, top, sheet.in),
            with(with(with_px(body_text, 17), muted), Align::centre));
    }
}

std::vector<Residual> residuals(const Sheet& sheet) {
    std::vector<Residual> list;
    for (const RunKey& k : keys_of(sheet.plan, sheet.experiment())) {
        list.push_back({k, sheet.in.film(k), sheet.in.reference(k.s)});
    }
    return list;
}

}  // namespace

void draw_heat(Sheet& sheet) {
    std::vector<Residual> runs = residuals(sheet);
    std::vector<RunKey> keys = keys_of(sheet.plan, sheet.experiment());
    backend_header(sheet, "FINGERPRINT", "linear Rec.709 Y residual, not PNG", stream_words(keys));
    note_biased_arms(sheet);
    if (runs.empty()) {
        paint_missing(sheet, content_band, "the plan names no run");
        return;
    }
    Box box = shown_box(sheet);
    std::vector<double> pooled;
    for (const Residual& r : runs) {
        if (!r.is_complete()) continue;
        for (double v : values(r, box)) {
            if (std::isfinite(v)) pooled.push_back(v);
        }
    }
    double p98 = pooled.empty() ? 0 : quantile(std::move(pooled), 0.98), top = p98 > 0 ? p98 : 1;

    Rect band = content_band;
    band.w -= bar_room;
    Rect first = column(band, runs.size(), 0);
    Fit f = fit(box.width(), box.height(), std::floor(first.w), std::floor(band.h - words_height));
    band.y += std::floor((band.h - words_height - f.out_h) / 2);
    for (std::size_t i = 0; i < runs.size(); ++i) draw_run(sheet, runs[i], box, f, top, column(band, runs.size(), i));

    double bar_top = band.y + 52, bar_h = std::max(120.0, f.out_h - 52.0);
    sheet.canvas.text({band.right() + gap, band.y, bar_room - gap, 48},
        "|Y<sub>N</sub> − Y<sub>ref</sub>|\n" + std::string(radiance_unit), with_lines(with_px(small_text, 16), 2));
    colour_bar(sheet, {band.right() + gap, bar_top, bar_width, bar_h}, top, true);
    sheet.notes.insert(sheet.notes.begin(),
        {"one scale, 0 to p98 = " + number(p98) + " " + radiance_unit + ", all pixels shown",
            fmt::format("crop x {}–{}, y {}–{}, {}", box.x0, box.x1, box.y0, box.y1, to_string(f))});
}

}  // namespace crescent::plates
