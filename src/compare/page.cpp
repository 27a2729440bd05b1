// The page of a comparison, from its JSON alone; compare.html lays it out: the findings, the metrics with their
// intervals, the pictures, the spectra, the files.
#include "compare/page.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>

#include "compare/compare.h"
#include "compare/outputs.h"
#include "output/charts.h"
#include "output/stored_json.h"
#include "output/templates.h"

namespace crescent {

namespace {

// ---- Metrics with their intervals.

MetricValue metric_of(const StoredJson& json) {
    MetricValue out{json.at("value").optional_number(), {}, json.value("why", "")};
    if (const StoredJson ends = json.at("interval"); !ends.is_null())
        out.interval = {ends.at(0).number(), ends.at(1).number()};
    return out;
}

Json interval_of(const MetricValue& m) {
    if (!m.interval) return false;
    return {{"low", with_minus(figures(m.interval->first, 3))}, {"high", with_minus(figures(m.interval->second, 3))}};
}

Json cell_of(const MetricValue& m) {
    return {{"value", m.value ? with_minus(figures(*m.value)) : ""}, {"why", m.why},
        {"interval", m.value ? interval_of(m) : Json(false)},
        {"is_heavy", m.value && !m.interval && m.why == heavy_tail}};
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
Json remarks_of(const std::string& region, const StoredJson& arms) {
    Json out = Json::array();
    for (const StoredJson& arm : arms.entries()) {
        const StoredJson r = arm.at("regions").at(region);
        const bool heavy = r.contains("heavy_tail");
        const auto renders = heavy ? r.at("heavy_tail").at("renders_needed").optional_number() : std::nullopt;
        const auto ratio =
            (r.contains("stated_variance_ratio") ? r.at("stated_variance_ratio").optional_number() : std::nullopt);
        out.push_back({{"arm", arm.at("arm")}, {"share", heavy ? percent(r.at("largest_share").number()) : ""},
            {"needed", renders ? fmt::format("{:.0f}", *renders) : ""},
            {"stated_ratio", ratio ? with_minus(figures(*ratio, 3)) : ""}});
    }
    return out;
}

/// A table of the metrics that some arm has in the region; the others are added to `not_measured` with their reasons.
Json region_of(const std::string& region, const StoredJson& regions, std::vector<Json>& not_measured) {
    std::vector<std::string> names;
    Json titles = Json::array(), arms = Json::array();
    const StoredJson first = regions.at(0).at("regions").at(region);
    const auto metric = [&](const StoredJson& arm, const std::string& name) {
        return metric_of(arm.at("regions").at(region).at("metrics").at(name));
    };
    for (const auto& [name, m] : first.at("metrics").items()) {
        const bool is_measured = std::ranges::any_of(
            regions.entries(), [&](const StoredJson& arm) { return metric(arm, name).value.has_value(); });
        if (is_measured) {
            names.push_back(name);
            titles.push_back(title_of(name));
        } else not_measured.push_back({{"metric", title_of(name)}, {"why", m.value("why", "")}});
    }
    for (const StoredJson& arm : regions.entries()) {
        Json cells = Json::array();
        for (const std::string& name : names) cells.push_back(cell_of(metric(arm, name)));
        arms.push_back({{"arm", arm.at("arm")}, {"renders", arm.at("renders")}, {"cells", cells}});
    }
    return {{"is_frame", region == whole_frame}, {"name", region}, {"pixels", first.at("pixels")}, {"metrics", titles},
        {"arms", arms}, {"remarks", remarks_of(region, regions)}};
}

std::vector<std::string> region_names(const StoredJson& result) {
    std::vector<std::string> out;
    for (const auto& [name, region] : result.at("arms").at(0).at("regions").items()) out.push_back(name);
    if (out.empty()) result.at("arms").at(0).at("regions").refuse("expected a region");
    return out;
}

/// The metrics that no arm has are those of the last region.
void add_numbers(const StoredJson& result, Json& to) {
    std::vector<Json> not_measured;
    Json regions = Json::array();
    for (const std::string& name : region_names(result)) {
        not_measured.clear();
        regions.push_back(region_of(name, result.at("arms"), not_measured));
    }
    to["regions"] = regions;
    to["not_measured"] = separated(std::move(not_measured));
}

// ---- Whether arms agree on the mean.

std::string figures_of(const StoredJson& object, const char* key, int digits = 4) {
    return object.contains(key) ? figures(object.at(key).number(), digits) : "";
}

Json row_of(const std::string& name, const StoredJson& test, const std::string& differs, const std::string& remark) {
    return {{"region", name}, {"mean", cell_text(figures_of(test, "a"))}, {"other", cell_text(figures_of(test, "b"))},
        {"p", cell_text(figures_of(test, "p", 2))},
        {"smallest", cell_text(test.contains("smallest") ? percent(test.at("smallest").number(), 2) : "")},
        {"differs", differs}, {"remark", remark}};
}

/// Y of each region; below it the channels if one of them differs.
Json rows_of(const StoredJson& pair) {
    Json out = Json::array();
    const std::string nothing = pair.at("identical").get<bool>() ? "identical" : "no difference found";
    for (const auto& [region, test] : pair.at("regions").items()) {
        const auto quantities = test.at("differs_in").get<std::vector<std::string>>();
        if (!quantities.empty()) out.push_back(row_of(region, test, "differs in " + listed(quantities), ""));
        else out.push_back(row_of(region, test, "", test.value("why", test.value("doubt", nothing))));
        if (!test.contains("channels")) continue;
        const auto channels = test.at("channels").items();
        if (std::ranges::any_of(channels, [](const auto& c) { return c.second.at("differs").template get<bool>(); }))
            for (const auto& [name, c] : channels) {
                const bool differs = c.at("differs").get<bool>();
                out.push_back(
                    row_of(region + ", mean " + name, c, differs ? "differs" : "", differs ? "" : c.value("why", "")));
            }
    }
    return out;
}

/// The number of places that differ, by the quantity that differs the most in each; false if none does.
Json most_in(const StoredJson& counts) {
    std::vector<Json> out;
    for (const auto& [quantity, count] : counts.items())
        if (count.get<std::uint64_t>()) out.push_back({{"quantity", quantity}, {"count", count}});
    return out.empty() ? Json(false) : Json{{"quantities", separated(std::move(out))}};
}

/// Tiles and pixels that differ; false if none was tested.
Json places_of(const StoredJson& pair) {
    const StoredJson tiles = pair.at("tiles"), pixels = pair.at("pixels");
    const auto quantity = pair.at("shown").get<std::string>();
    const bool is_y = quantity == quantity_names[0];
    if (tiles.at("tested") == 0 && pixels.at("tested") == 0 && is_y) return false;
    Json out = {{"tiles", false}, {"pixels", false}, {"maps_show", is_y ? "" : quantity},
        {"dependent", pair.at("method") == dependent_method}};
    if (tiles.at("tested") != 0)
        out["tiles"] = {{"tested", tiles.at("tested")}, {"different", tiles.at("different")},
            {"left_out", tiles.at("left_out")}, {"by", most_in(tiles.at("most_in"))}};
    if (pixels.at("tested") != 0)
        out["pixels"] = {{"tested", pixels.at("tested")}, {"different", pixels.at("different")},
            {"by", most_in(pixels.at("most_in"))}};
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
    const std::vector<double>& lower, const std::vector<double>& upper, Axis x, const char* what, const char* title) {
    std::vector<double> edges, zero, low, high, values{0};
    const double width = (x.high - x.low) / static_cast<double>(lower.size());
    for (std::size_t k = 0; k < lower.size(); ++k) {
        const double first = lower[k], second = first + (upper.empty() ? 0 : upper[k]);
        for (const double edge : {x.low + width * static_cast<double>(k), x.low + width * static_cast<double>(k + 1)}) {
            edges.push_back(edge);
            zero.push_back(0);
            low.push_back(first);
            high.push_back(second);
        }
        values.push_back(second);
    }
    Chart chart(460, 200, std::move(x), linear_axis(what, values), title);
    chart.band(edges, zero, low, "c1");
    if (!upper.empty()) chart.band(edges, low, high, "c0");
    return chart.str();
}

using BinCounts = std::vector<std::uint64_t>;

std::string pixel_histogram(const StoredJson& pixels) {
    if (pixels.at("tested") == 0) return {};
    const auto p = pixels.at("p").get<BinCounts>();
    const Axis x{0, 1, false, "p of a pixel", {0, 0.2, 0.4, 0.6, 0.8, 1}};
    return histogram(percents(p, sum_of(p)), {}, x, "% of pixels", "Histogram of p over pixels");
}

Json pairs_of(const StoredJson& result) {
    Json out = Json::array();
    for (const StoredJson& pair : result.at("bias").entries())
        out.push_back({{"a", pair.at("a")}, {"b", pair.at("b")}, {"paired", pair.at("paired")}, {"rows", rows_of(pair)},
            {"places", places_of(pair)}, {"histogram", pixel_histogram(pair.at("pixels"))}});
    return out;
}

// ---- Where the noise differs, and its spectra.

Json noise_of(const StoredJson& result) {
    Json out = Json::array();
    for (const StoredJson& n : result.at("noise").entries()) {
        Json charts = Json::array();
        for (const auto& [region, counts] : n.at("regions").items()) {
            const auto different = counts.at("told_apart").get<BinCounts>();
            auto undistinguished = counts.at("not_told_apart").get<BinCounts>();
            undistinguished.resize(different.size());
            const double tiles = sum_of(different) + sum_of(undistinguished);
            if (tiles == 0) continue;
            const Axis x{-noise_range, noise_range, false,
                fmt::format("log2 of the variance of {} over that of {}", n.at("a").get<std::string>(),
                    n.at("b").get<std::string>()),
                {-4, -2, 0, 2, 4}};
            charts.push_back({{"region", region},
                {"chart",
                    histogram(percents(different, tiles), percents(undistinguished, tiles), x, "% of tiles",
                        "Histogram of the variance ratio")}});
        }
        out.push_back({{"sentence", n.at("message")}, {"charts", charts}});
    }
    return out;
}

std::vector<double> power_of(const StoredJson& arm, const std::string& region) {
    std::vector<double> out;
    for (const StoredJson& p : arm.at("regions").at(region).at("spectrum").at("power").entries())
        out.push_back(p.number());
    return out;
}

Json spectra_of(const StoredJson& result) {
    Json out = Json::array();
    const StoredJson arms = result.at("arms");
    for (const std::string& region : region_names(result)) {
        std::vector<double> values;
        for (const StoredJson& arm : arms.entries())
            for (const double p : power_of(arm, region))
                if (p > 0) values.push_back(p);
        if (values.empty()) continue;
        Axis x{1, static_cast<double>(spectrum_bins), false, "frequency, cycles in 32 pixels", {1, 4, 8, 12, 16}};
        Chart chart(520, 240, x, log_axis("power of the error of Y", values), "Error spectrum");
        std::vector<Json> names;
        for (std::size_t a = 0; a < arms.size(); ++a) {
            const std::vector<double> power = power_of(arms.at(a), region);
            std::vector<Point> line;
            for (std::size_t k = 0; k < power.size(); ++k) line.push_back({static_cast<double>(k + 1), power[k]});
            if (line.empty()) continue;
            const std::string colour = fmt::format("c{}", a % 6);
            chart.line(line, colour);
            chart.name(line.back(), arms.at(a).at("arm").get<std::string>(), colour);
            names.push_back({{"arm", arms.at(a).at("arm")},
                {"colour", arms.at(a).at("regions").at(region).at("spectrum").at("noise")}});
        }
        out.push_back({{"chart", chart.str()}, {"region", region}, {"arms", separated(std::move(names))}});
    }
    return out;
}

// ---- Ladders, assertions, files.

/// The points of one ladder in one region.
struct LadderLine {
    std::string name;
    std::vector<double> spp;
    std::vector<MetricValue> metrics;
};

std::vector<LadderLine> ladder_lines(const StoredJson& result, const std::string& region) {
    std::vector<LadderLine> out;
    for (const StoredJson& ladder : result.at("ladders").entries()) {
        LadderLine& line = out.emplace_back();
        line.name = ladder.at("name").get<std::string>();
        for (std::size_t k = 0; k < ladder.at("arms").size(); ++k) {
            const std::vector<StoredJson> arms = result.at("arms").entries();
            const auto arm = std::ranges::find_if(
                arms, [&](const StoredJson& item) { return item.at("arm") == ladder.at("arms").at(k).value(); });
            if (arm == arms.end()) continue;
            line.spp.push_back(ladder.at("spp").at(k).number());
            const StoredJson metrics = arm->at("regions").at(region).at("metrics");
            line.metrics.push_back(ladder_metric(metric_of(metrics.at("rmse")), metric_of(metrics.at("var"))));
        }
    }
    return out;
}

Json ladder_chart(const StoredJson& result, const std::string& region) {
    const std::vector<LadderLine> lines = ladder_lines(result, region);
    const StoredJson metrics = result.at("arms").at(0).at("regions").at(region).at("metrics");
    const char* what = ladder_metric_name(metric_of(metrics.at("rmse")));
    std::vector<double> xs, ys;
    for (const LadderLine& line : lines)
        for (std::size_t k = 0; k < line.spp.size(); ++k) {
            const MetricValue& m = line.metrics[k];
            xs.push_back(line.spp[k]);
            if (m.value) ys.push_back(*m.value);
            if (m.interval) {
                ys.push_back(m.interval->first);
                ys.push_back(m.interval->second);
            }
        }
    Chart chart(520, 280, log_axis("samples a pixel", xs), log_axis(what, ys), "Ladder of " + region);
    std::vector<Json> slopes;
    for (std::size_t l = 0; l < lines.size(); ++l) {
        const std::string colour = fmt::format("c{}", l % 6);
        std::vector<Point> points;
        for (std::size_t k = 0; k < lines[l].spp.size(); ++k) {
            const MetricValue& m = lines[l].metrics[k];
            if (!m.value) continue;
            points.push_back({lines[l].spp[k], *m.value});
            if (m.interval) chart.bar(lines[l].spp[k], m.interval->first, m.interval->second, colour);
        }
        if (points.empty()) continue;
        chart.line(points, colour);
        chart.dots(points, colour);
        chart.name(points.back(), lines[l].name, colour);
        const MetricValue slope = metric_of(result.at("ladders").at(l).at("slopes").at(region));
        if (slope.value)
            slopes.push_back({{"arm", lines[l].name}, {"slope", with_minus(figures(*slope.value, 3))},
                {"interval", interval_of(slope)}});
    }
    return {{"chart", chart.str()}, {"region", region}, {"what", what}, {"slopes", separated(std::move(slopes))}};
}

Json ladder_charts(const StoredJson& result) {
    Json out = Json::array();
    if (result.at("ladders").empty()) return out;
    for (const std::string& region : region_names(result)) out.push_back(ladder_chart(result, region));
    return out;
}

Json assertions_of(const StoredJson& result) {
    Json out = Json::array();
    for (const StoredJson& a : result.at("assertions").entries())
        out.push_back({{"name", a.at("name")}, {"claim", a.at("text")}, {"left", cell_text(figures_of(a, "measured"))},
            {"right", cell_text(figures_of(a, "bound"))}, {"holds", a.at("pass")}});
    return out;
}

Json file_of(const std::string& arm, const StoredJson& f, double y) {
    const auto cell = [&](const char* key) {
        const auto value = f.at(key).optional_number();
        return cell_text(value ? figures(*value) : "");
    };
    return {{"arm", arm}, {"path", f.at("file")}, {"layer", f.at("layer")},
        {"variance", f.value("variance_channels", "")}, {"mean", cell_text(figures(y))}, {"spp", cell("spp")},
        {"seconds", cell("seconds")}};
}

Json files_of(const StoredJson& result) {
    Json out = Json::array();
    const std::string last = region_names(result).back();
    for (const StoredJson& arm : result.at("arms").entries())
        for (const StoredJson& f : arm.at("files").entries())
            out.push_back(file_of(arm.at("arm").get<std::string>(), f, f.at("regions").at(last).at("y_mean").number()));
    if (const StoredJson reference = result.at("reference"); !reference.is_null())
        for (const StoredJson& f : reference.at("files").entries())
            out.push_back(file_of("reference", f, f.at("y_mean").number()));
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

std::string compare_html(const Json& json, const std::map<std::string, std::vector<unsigned char>>& plates) {
    const StoredJson result(json);
    const auto sentence = result.at("message").get<std::string>();
    auto findings = result.at("found").get<std::vector<std::string>>();
    std::erase(findings, sentence);
    Json rankings = Json::array();
    for (const StoredJson& r : result.at("rankings").entries()) rankings.push_back(r.at("message"));
    const StoredJson reference = result.at("reference"), provenance = result.at("provenance");
    const double trim = result.at("trim").number();
    Json model = {{"title", result.at("title")}, {"version", provenance.at("version")},
        {"command", provenance.at("command")}, {"sentence", sentence}, {"fails", result.at("state") == "fails"},
        {"all_hold", sentence.empty() && !result.at("assertions").empty()}, {"found", findings},
        {"trimmed", trim > 0 ? percent(trim) : ""}, {"has_reference", !reference.is_null()},
        {"reference_error", reference.is_null() ? Json("") : Json(reference.at("standard_error_from"))},
        {"rankings", rankings}, {"pairs", pairs_of(result)}, {"pictures", pictures_of(plates)},
        {"noise", noise_of(result)}, {"ladders", ladder_charts(result)}, {"spectra", spectra_of(result)},
        {"assertions", assertions_of(result)}, {"files", files_of(result)},
        {"warnings", result.at("warnings").get<std::vector<std::string>>()}};
    add_numbers(result, model);
    return render_page(compare_templates(), "compare.html", model);
}

}  // namespace crescent
