// The model of the page of a comparison, which compare.html lays out: the findings, the metrics with their intervals,
// the pictures, the spectra, the files.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>

#include "compare/compare.h"
#include "compare/renders.h"
#include "compare/outputs.h"
#include "compare/plan.h"
#include "output/charts.h"
#include "output/templates.h"

namespace crescent {

namespace {

// ---- Metrics with their intervals.

Json interval_of(const MetricValue& m) {
    if (!m.interval) return false;
    return {{"low", with_minus(figures(m.interval->first, 3))}, {"high", with_minus(figures(m.interval->second, 3))}};
}

Json cell_of(const MetricValue& m) {
    return {{"value", m.value ? with_minus(figures(*m.value)) : ""}, {"why", m.why},
        {"interval", m.value ? interval_of(m) : Json(false)},
        {"is_heavy", m.value && !m.interval && m.why == "heavy tail"}};
}

/// The title of a metric, as HTML.
const char* title_of(const std::string& metric) {
    static const std::map<std::string, const char*> titles = {{"rmse", "RMSE"}, {"var", "variance"}, {"bias2", "bias²"},
        {"relmse", "relMSE"}, {"mape", "MAPE"}, {"fireflies", "fireflies"}, {"y_mean", "mean <i>Y</i>"},
        {"flip", "HDR-FLIP"}, {"flip_ldr", "LDR-FLIP"}, {"efficiency", "efficiency"},
        {"unit_time", "s to unit variance"}, {"sample_var", "variance of a sample"}};
    const auto it = titles.find(metric);
    return it == titles.end() ? "" : it->second;
}

/// What a heavy tail or the renderer's own variance says about the numbers of an arm in a region.
Json remarks_of(const std::string& region, const CompareResult& result) {
    Json out = Json::array();
    for (const ArmResult& arm : result.arms) {
        const RegionResult& r = arm.region(region);
        out.push_back({{"arm", arm.name}, {"share", r.heavy() ? percent(r.largest_share) : ""},
            {"needed", r.renders_needed ? fmt::format("{:.0f}", *r.renders_needed) : ""},
            {"stated_ratio", r.stated_ratio ? with_minus(figures(*r.stated_ratio, 3)) : ""}});
    }
    return out;
}

/// A table of the metrics that some arm has in the region; the others are added to `not_measured` with their reasons.
Json region_of(const PixelSet& set, const CompareResult& result, std::vector<Json>& not_measured) {
    std::vector<std::string> names;
    Json titles = Json::array(), arms = Json::array();
    for (const auto& [name, m] : result.arms[0].region(set.name).metrics) {
        const bool any = std::ranges::any_of(
            result.arms, [&](const ArmResult& arm) { return arm.region(set.name).metric(name).value.has_value(); });
        if (any) names.push_back(name), titles.push_back(title_of(name));
        else not_measured.push_back({{"metric", title_of(name)}, {"why", m.why}});
    }
    for (const ArmResult& arm : result.arms) {
        Json cells = Json::array();
        for (const std::string& name : names) cells.push_back(cell_of(arm.region(set.name).metric(name)));
        arms.push_back({{"arm", arm.name}, {"renders", arm.renders}, {"cells", cells}});
    }
    return {{"is_frame", set.name == whole_frame}, {"name", set.name}, {"pixels", set.pixels.size()},
        {"metrics", titles}, {"arms", arms}, {"remarks", remarks_of(set.name, result)}};
}

/// The metrics that no arm has are those of the last region.
void add_numbers(const RenderStats& all, const CompareResult& result, Json& to) {
    std::vector<Json> not_measured;
    Json regions = Json::array();
    for (const PixelSet& set : all.regions) {
        not_measured.clear();
        regions.push_back(region_of(set, result, not_measured));
    }
    to["regions"] = regions, to["not_measured"] = separated(std::move(not_measured));
}

// ---- Whether arms agree on the mean.

Json row_of(const std::string& name, const MeanTest& t, const std::string& differs, const std::string& remark) {
    const bool tested = t.why.empty();
    return {{"region", name}, {"mean", cell_text(figures(t.a))}, {"other", cell_text(figures(t.b))},
        {"p", cell_text(tested ? figures(t.welch.p, 2) : "")},
        {"smallest", cell_text(tested ? percent(t.smallest, 2) : "")}, {"differs", differs}, {"remark", remark}};
}

/// Y of each region; below it the channels if one of them differs.
Json rows_of(const BiasResult& b) {
    Json out = Json::array();
    for (const MeanTest& t : b.regions) {
        const std::vector<std::string> in = t.differs_in();
        if (!in.empty()) out.push_back(row_of(t.region, t, "differs in " + listed(in), ""));
        else
            out.push_back(row_of(t.region, t, "",
                !t.why.empty()          ? t.why
                    : !t.caveat.empty() ? t.caveat
                    : b.identical       ? "identical"
                                        : "no difference found"));
        if (std::ranges::any_of(t.channels, [](const MeanTest& c) { return c.differs; }))
            for (const MeanTest& c : t.channels)
                out.push_back(
                    row_of(t.region + ", mean " + c.region, c, c.differs ? "differs" : "", c.differs ? "" : c.why));
    }
    return out;
}

/// The number of places that differ, by the quantity that differs the most in each; false if none does.
Json most_in(const std::vector<std::uint64_t>& by) {
    std::vector<Json> out;
    for (std::size_t q = 0; q < by.size(); ++q)
        if (by[q]) out.push_back({{"quantity", quantity_names[q]}, {"count", by[q]}});
    return out.empty() ? Json(false) : Json{{"quantities", separated(std::move(out))}};
}

/// Tiles and pixels that differ; false if none was tested.
Json places_of(const BiasResult& b) {
    const bool tiles = !b.tiles.p.empty(), pixels = !b.pixel_p.empty(), shown = b.shown() != 0;
    if (!tiles && !pixels && !shown) return false;
    Json out = {{"tiles", false}, {"pixels", false}, {"maps_show", shown ? quantity_names[b.shown()] : ""},
        {"dependent", b.dependent}};
    if (tiles)
        out["tiles"] = {{"tested", b.tiles.tested}, {"different", b.tiles.different}, {"left_out", b.tiles.left_out},
            {"by", most_in(b.tiles_by)}};
    if (pixels)
        out["pixels"] = {{"tested", b.pixels_tested}, {"different", b.pixels_different}, {"by", most_in(b.pixels_by)}};
    return out;
}

double sum_of(const std::vector<std::uint64_t>& counts) {
    return static_cast<double>(std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}));
}

/// Returns counts in percent of `total`.
std::vector<double> percents(const std::vector<std::uint64_t>& counts, double total) {
    std::vector<double> out;
    for (const std::uint64_t count : counts) out.push_back(100 * static_cast<double>(count) / total);
    return out;
}

/// A step chart of counts over equal bins from low to high; the second series is stacked on the first.
std::string histogram(
    const std::vector<double>& below, const std::vector<double>& above, Axis x, const char* what, const char* title) {
    std::vector<double> edges, zero, low, high, all{0};
    const double width = (x.high - x.low) / static_cast<double>(below.size());
    for (std::size_t k = 0; k < below.size(); ++k) {
        const double first = below[k], second = first + (above.empty() ? 0 : above[k]);
        for (const double edge : {x.low + width * static_cast<double>(k), x.low + width * static_cast<double>(k + 1)})
            edges.push_back(edge), zero.push_back(0), low.push_back(first), high.push_back(second);
        all.push_back(second);
    }
    Chart chart(460, 200, std::move(x), linear_axis(what, all), title);
    chart.band(edges, zero, low, "c1");
    if (!above.empty()) chart.band(edges, low, high, "c0");
    return chart.str();
}

std::string pixel_histogram(const BiasResult& b) {
    if (!b.pixels_tested) return {};
    const Axis x{0, 1, false, "p of a pixel", {0, 0.2, 0.4, 0.6, 0.8, 1}};
    return histogram(percents(b.pixel_p, sum_of(b.pixel_p)), {}, x, "% of pixels", "Histogram of p over pixels");
}

Json pairs_of(const CompareResult& result) {
    Json out = Json::array();
    for (const BiasResult& b : result.bias)
        out.push_back({{"a", b.a}, {"b", b.b}, {"paired", b.paired}, {"rows", rows_of(b)}, {"places", places_of(b)},
            {"histogram", pixel_histogram(b)}});
    return out;
}

// ---- Where the noise differs, and its spectra.

Json noise_of(const CompareResult& result) {
    Json out = Json::array();
    for (const NoiseResult& n : result.noise) {
        Json charts = Json::array();
        for (const NoiseResult::Histogram& h : n.regions) {
            const double tiles = sum_of(h.different) + sum_of(h.rest);
            if (tiles == 0) continue;
            const Axis x{-noise_range, noise_range, false,
                fmt::format("log2 of the variance of {} over that of {}", n.a, n.b), {-4, -2, 0, 2, 4}};
            charts.push_back({{"region", h.region},
                {"chart",
                    histogram(percents(h.different, tiles), percents(h.rest, tiles), x, "% of tiles",
                        "Histogram of the variance ratio")}});
        }
        out.push_back({{"sentence", n.sentence}, {"charts", charts}});
    }
    return out;
}

Json spectra_of(const RenderStats& all, const CompareResult& result) {
    Json out = Json::array();
    for (const PixelSet& set : all.regions) {
        std::vector<double> values;
        for (const ArmResult& arm : result.arms)
            for (const double p : arm.region(set.name).power)
                if (p > 0) values.push_back(p);
        if (values.empty()) continue;
        Axis x{1, static_cast<double>(spectrum_bins), false, "frequency, cycles in 32 pixels", {1, 4, 8, 12, 16}};
        Chart chart(520, 240, x, log_axis("power of the error of Y", values), "Error spectrum");
        std::vector<Json> arms;
        for (std::size_t a = 0; a < result.arms.size(); ++a) {
            const RegionResult& r = result.arms[a].region(set.name);
            std::vector<Point> line;
            for (std::size_t k = 0; k < r.power.size(); ++k) line.push_back({static_cast<double>(k + 1), r.power[k]});
            if (line.empty()) continue;
            const std::string colour = fmt::format("c{}", a % 6);
            chart.line(line, colour), chart.name(line.back(), result.arms[a].name, colour);
            arms.push_back({{"arm", result.arms[a].name}, {"colour", to_string(r.colour)}});
        }
        out.push_back({{"chart", chart.str()}, {"region", set.name}, {"arms", separated(std::move(arms))}});
    }
    return out;
}

// ---- Ladders, assertions, files.

Json ladder_charts(const CompareResult& result) {
    Json out = Json::array();
    if (result.ladders.empty()) return out;
    for (std::size_t r = 0; r < result.arms[0].regions.size(); ++r) {
        const std::string& region = result.arms[0].regions[r].region;
        const char* what = ladder_metric_name(result.arms[0].regions[r]);
        std::vector<double> xs, ys;
        for (const SppLadder& l : result.ladders)
            for (const std::size_t a : l.arms) {
                xs.push_back(*result.arms[a].spp);
                const MetricValue m = ladder_metric(result.arms[a].regions[r]);
                if (m.value) ys.push_back(*m.value);
                if (m.interval) ys.push_back(m.interval->first), ys.push_back(m.interval->second);
            }
        Chart chart(520, 280, log_axis("samples a pixel", xs), log_axis(what, ys), "Ladder of " + region);
        std::vector<Json> slopes;
        for (std::size_t k = 0; k < result.ladders.size(); ++k) {
            const SppLadder& l = result.ladders[k];
            const std::string colour = fmt::format("c{}", k % 6);
            std::vector<Point> line;
            for (const std::size_t a : l.arms) {
                const MetricValue m = ladder_metric(result.arms[a].regions[r]);
                if (!m.value) continue;
                line.push_back({*result.arms[a].spp, *m.value});
                if (m.interval) chart.bar(*result.arms[a].spp, m.interval->first, m.interval->second, colour);
            }
            if (line.empty()) continue;
            chart.line(line, colour), chart.dots(line, colour), chart.name(line.back(), l.name, colour);
            const MetricValue& s = l.slopes[r].second;
            if (s.value)
                slopes.push_back(
                    {{"arm", l.name}, {"slope", with_minus(figures(*s.value, 3))}, {"interval", interval_of(s)}});
        }
        out.push_back(
            {{"chart", chart.str()}, {"region", region}, {"what", what}, {"slopes", separated(std::move(slopes))}});
    }
    return out;
}

Json assertions_of(const CompareResult& result) {
    Json out = Json::array();
    for (const AssertionResult& a : result.assertions)
        out.push_back({{"name", a.name}, {"claim", a.text}, {"left", cell_text(figures(a.measured))},
            {"right", cell_text(figures(a.bound))}, {"holds", a.pass}});
    return out;
}

Json file_of(const std::string& arm, const RenderFile& f, double y) {
    return {{"arm", arm}, {"path", f.path}, {"layer", f.layer}, {"variance", f.variance_channels},
        {"mean", cell_text(figures(y))}, {"spp", cell_text(f.spp ? figures(*f.spp) : "")},
        {"seconds", cell_text(f.seconds ? figures(*f.seconds) : "")}};
}

Json files_of(const RenderStats& all, const CompareResult& result) {
    Json out = Json::array();
    for (std::size_t a = 0; a < all.arms.size(); ++a)
        for (std::size_t k = 0; k < all.arms[a].files.size(); ++k)
            out.push_back(file_of(result.arms[a].name, all.arms[a].files[k], all.arms[a].regions[k].back().y));
    if (all.reference)
        for (std::size_t k = 0; k < all.reference->files.size(); ++k)
            out.push_back(file_of("reference", all.reference->files[k], all.reference->regions[k].back().y));
    return out;
}

/// All plates except the ladders, which are charts in their own section.
Json pictures_of(const std::map<std::string, std::vector<unsigned char>>& plates) {
    Json out = Json::array();
    for (const auto& [name, png] : plates)
        if (name != "ladders") out.push_back({{"name", name}, {"png", base64(png)}});
    return out;
}

}  // namespace

std::string compare_html(const ComparePlan& plan, const RenderStats& all, const CompareResult& result,
    const Provenance& provenance, const std::map<std::string, std::vector<unsigned char>>& plates) {
    std::vector<std::string> found = found_about_means(result), rankings;
    std::erase(found, result.sentence);
    for (const Ranking& r : result.rankings) rankings.push_back(r.sentence);
    Json model = {{"title", plan.title}, {"version", provenance.version}, {"command", provenance.command},
        {"sentence", result.sentence}, {"fails", result.state == CompareResult::State::fails},
        {"all_hold", result.sentence.empty() && !result.assertions.empty()}, {"found", found},
        {"trimmed", plan.trim > 0 ? percent(plan.trim) : ""}, {"has_reference", all.reference.has_value()},
        {"reference_error", result.reference_error_from}, {"rankings", rankings}, {"pairs", pairs_of(result)},
        {"pictures", pictures_of(plates)}, {"noise", noise_of(result)}, {"ladders", ladder_charts(result)},
        {"spectra", spectra_of(all, result)}, {"assertions", assertions_of(result)}, {"files", files_of(all, result)},
        {"warnings", result.warnings}};
    add_numbers(all, result, model);
    return render_page(compare_templates(), "compare.html", model);
}

}  // namespace crescent
