// metrics: the table of values measured on the float films, published values next to them, and the N-ladders.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "metrics/metrics.h"
#include "report/plates/charts.h"
#include "report/plates/sheet.h"

namespace crescent::plates {

namespace {

constexpr std::size_t most_regions = 3;  // with a column of their own

struct Column {
    std::string metric, title;
};

std::vector<Column> columns_of(const Experiment& e) {
    std::vector<Column> c;
    auto title_of = [](const char* what, const Region& r) {
        return std::string(what) + "<sub>" + escaped(r.name) + "</sub>";
    };
    for (std::size_t i = 0; i < e.regions.size() && i < most_regions; ++i) {
        c.push_back({"rmse." + e.regions[i].name, title_of("RMSE", e.regions[i])});
    }
    c.push_back({"fireflies", "fireflies"});
    if (!e.regions.empty()) c.push_back({"var." + e.regions[0].name, title_of("var", e.regions[0])});
    c.push_back({"horizon_frac", "horizon_frac"});
    c.push_back({"y_mean", "Y<sub>mean</sub>"});
    return c;
}

const SeedSpread* band_of(const Metrics& m, const RunKey& key, const std::string& metric) {
    for (const SeedSpread& b : m.bands) {
        if (b.metric == metric && b.key.arm == key.arm && b.key.n == key.n && b.key.s == key.s) return &b;
    }
    return nullptr;
}

std::string value(const std::string& metric, double v, int digits = 4) {
    if (metric == "fireflies" && std::isfinite(v)) return count(static_cast<std::uint64_t>(std::llround(v)));
    return figure(v, digits);
}

/// With up to four digits, as the width permits.
std::string band_text(const Canvas& c, const std::string& metric, const Band& b, double width) {
    if (b.heavy) return "heavy tail";
    const auto with_digits = [&](int n) { return value(metric, b.q05, n) + " – " + value(metric, b.q95, n); };
    int digits = 4;
    while (digits > 2 && c.measure(with_digits(digits), with_px(small_text, small_text.least_px)).w > width) --digits;
    return with_digits(digits);
}

int seeds_of(const Metrics& m) {
    int seeds = 1;
    for (const SeedSpread& b : m.bands) seeds = std::max(seeds, b.band.seeds);
    return seeds;
}

// Returns the measured runs that the plate shows: the plan's, else every arm at the n and s of the experiment.
std::vector<const RunMetrics*> rows_of(const Sheet& sheet) {
    const Experiment& e = sheet.experiment();
    std::vector<RunKey> keys = keys_of(sheet.plan, e);
    if (keys.empty()) {
        for (const ArmPlan& a : e.arms) keys.push_back({a.name, e.n_of(a), e.s(), e.seed});
    }
    std::vector<const RunMetrics*> rows;
    for (const RunKey& k : keys) {
        if (const RunMetrics* r = sheet.in.metrics.find(k.arm, k.n, k.s, k.seed)) rows.push_back(r);
    }
    return rows;
}

// Under each measured value, as the number of rows permits: the published value, if any, and the band.
struct Table {
    std::vector<const RunMetrics*> rows;
    std::size_t runs = 0;  // the rows shown are those that fit
    std::vector<Column> columns;
    bool has_published = false, has_band = false;
    double row_h = 0, head_h = 32, name_w = 250;
};

constexpr double value_h = 27, under_h = 19;

Table plan_table(const Sheet& sheet) {
    Table t;
    t.rows = rows_of(sheet);
    t.runs = t.rows.size();
    t.columns = columns_of(sheet.experiment());
    auto height = [&] {
        return value_h + under_h * (t.has_published + t.has_band) + (t.has_published || t.has_band ? 13 : 5);
    };
    auto too_high = [&] { return double(t.rows.size()) * height() > content_band.h - t.head_h; };
    t.has_band = seeds_of(sheet.in.metrics) > 1;
    const auto& bands = sheet.in.metrics.bands;
    t.has_published =
        std::any_of(bands.begin(), bands.end(), [](const SeedSpread& b) { return b.published.has_value(); });
    if (too_high()) t.has_published = false;
    if (too_high()) t.has_band = false;
    t.row_h = height();
    t.rows.resize(std::min(t.rows.size(), static_cast<std::size_t>((content_band.h - t.head_h) / t.row_h)));
    return t;
}

/// Notes what does not fit; the report has all of it.
void note_what_is_left_out(Sheet& sheet, const Table& t) {
    const std::size_t regions = sheet.experiment().regions.size();
    if (t.rows.size() < t.runs) sheet.notes.push_back(fmt::format("{} of {} runs", t.rows.size(), t.runs));
    if (regions > most_regions) sheet.notes.push_back(fmt::format("{} of {} regions", most_regions, regions));
}

Rect cell(const Table& t, std::size_t c, double y, double h) {
    double w = (content_band.w - t.name_w) / double(t.columns.size());
    return {content_band.x + t.name_w + double(c) * w + 8, y, w - 8, h};
}

void draw_head(Sheet& sheet, const Table& t) {
    Text style = with(with(with_px(body_text, 17), muted), Align::right);
    for (std::size_t c = 0; c < t.columns.size(); ++c) {
        sheet.canvas.text(cell(t, c, content_band.y, 26), t.columns[c].title, style);
    }
    double y = content_band.y + t.head_h - 0.5;
    sheet.canvas.line(content_band.x, y, content_band.right(), y, muted, 1);
}

void draw_name(Sheet& sheet, const Table& t, const RunMetrics& r, double y, int seeds) {
    Rect line{content_band.x, y, t.name_w, value_h};
    sheet.canvas.text(line, runs_label({r.key}, sheet.experiment()), with(with_px(body_text, 20), Weight::semibold));
    line.y += value_h;
    line.h = under_h + 2;
    if (t.has_published) {
        sheet.canvas.text(line, "published", small_text);
        line.y += under_h;
    }
    if (t.has_band) sheet.canvas.text(line, fmt::format("5–95 % of {} seeds", seeds), small_text);
}

void draw_row(Sheet& sheet, const Table& t, const RunMetrics& r, double y, int seeds) {
    Canvas& c = sheet.canvas;
    Text value_text = with(with(with_px(body_text, 20), Weight::medium), Align::right);
    Text detail_text = with(small_text, Align::right);
    double top = y + (t.has_published || t.has_band ? 6 : 2);
    draw_name(sheet, t, r, top, seeds);
    for (std::size_t k = 0; k < t.columns.size(); ++k) {
        const std::string& metric = t.columns[k].metric;
        const SeedSpread* b = band_of(sheet.in.metrics, r.key, metric);
        c.text(cell(t, k, top, value_h), b ? value(metric, metric_value(r, metric)) : "–", value_text);
        double next = top + value_h;
        if (t.has_published) {
            c.text(cell(t, k, next, under_h + 2), b && b->published ? value(metric, *b->published) : "–", detail_text);
            next += under_h;
        }
        if (t.has_band)
            c.text(cell(t, k, next, under_h + 2), b ? band_text(c, metric, b->band, cell(t, k, 0, 0).w) : "–",
                detail_text);
    }
    c.line(content_band.x, y + t.row_h - 0.5, content_band.right(), y + t.row_h - 0.5, rule, 1);
}

void draw_charts(Sheet& sheet, const Rect& slot) {
    const Experiment& e = sheet.experiment();
    std::vector<std::string> regions;
    for (const Region& r : e.regions) {
        bool has_ladder = std::any_of(sheet.in.metrics.ladders.begin(), sheet.in.metrics.ladders.end(),
            [&](const Ladder& l) { return l.region == r.name && l.n.size() > 1 && l.s == e.s(); });
        if (has_ladder && regions.size() < 2) regions.push_back(r.name);
    }
    for (std::size_t i = 0; i < regions.size(); ++i) {
        draw_ladder_chart(sheet.canvas, column(slot, regions.size(), i),
            "RMSE<sub>" + escaped(regions[i]) + "</sub> against N", ladder_curves(sheet, regions[i]));
    }
}

}  // namespace

void draw_meters(Sheet& sheet) {
    Table t = plan_table(sheet);
    backend_header(sheet, "METERS", "linear Rec.709 Y of the float films, not PNG",
        fmt::format("measured at seed {}", sheet.experiment().seed));
    if (t.rows.empty()) {
        paint_missing(sheet, content_band, "no run of this plate was measured");
        return;
    }
    draw_head(sheet, t);
    int seeds = seeds_of(sheet.in.metrics);
    double y = content_band.y + t.head_h;
    for (const RunMetrics* r : t.rows) {
        draw_row(sheet, t, *r, y, seeds);
        y += t.row_h;
    }
    Rect slot{content_band.x, y + 18, content_band.w, content_band.bottom() - y - 18};
    if (slot.h >= 170) draw_charts(sheet, slot);
    note_what_is_left_out(sheet, t);
    note_biased_arms(sheet);
    if (seeds < 2) sheet.notes.push_back("one seed: no band");
    if (slot.h >= 170)
        sheet.notes.push_back(seeds > 1 ? "slopes: fit, and 5–95 % over seeds" : "slopes: fit and its interval");
    sheet.notes.push_back(
        fmt::format("Y in {}; fireflies: geometry pixels with |Y<sub>N</sub> − Y<sub>ref</sub>| > {} "
                    "Y<sub>ref</sub>",
            radiance_unit, number(sheet.experiment().firefly_k)));
}

}  // namespace crescent::plates
