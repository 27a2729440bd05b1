// The model of measurements.html: the arms at one N, and the two ways in which they fail: the broad density on a small
// light, the narrow one on a broad integrand. The numbers determine which region shows which.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "experiment/experiment.h"
#include "report/page.h"

namespace crescent {
namespace {

bool is_biased(const ArmPlan& arm, const Experiment& e) { return !missed_light(arm, e).empty(); }

/// The arm's name and the remarks on its numbers.
Json column_head(const ArmPlan& arm, const Experiment& e) {
    const int techniques = techniques_of(arm);
    return {{"name", arm.name}, {"exponent", ""}, {"rays", techniques > 1 ? std::to_string(techniques) : ""},
        {"biased", is_biased(arm, e)}};
}

Json headline_table(const Page& page, std::uint64_t n) {
    const Experiment& e = page.in.experiment;
    std::vector<Column> columns;
    for (const ArmPlan& arm : e.arms)
        if (page.find.run(arm.name, n)) columns.push_back({column_head(arm, e), arm.name, n, page.find.s()});
    return metrics_table(page, columns);
}

Json frame_errors(const Page& page, std::uint64_t n) {
    Json out = Json::array();
    for (const ArmPlan& arm : page.in.experiment.arms)
        if (const RunMetrics* run = page.find.run(arm.name, n))
            out.push_back({{"arm", arm.name}, {"rmse", with_minus(figures(run->rmse_frame))}});
    return with_commas(std::move(out));
}

/// Returns one sentence for each other arm whose density is about the normal: how it compares with the best of them.
Json broad_arms(const Page& page, const ArmPair& pair, const std::string& region) {
    Json out = Json::array();
    for (const ArmPlan* arm : arms_about_normal(page.in.experiment)) {
        if (arm == pair.broad) continue;
        const std::string sentence = ordering_html(page, arm->name, pair.broad->name, pair.n, region);
        if (!sentence.empty()) out.push_back(sentence);
    }
    return out;
}

bool larger_in(
    const Page& page, const std::string& a, const std::string& b, std::uint64_t n, const std::string& region) {
    const auto rmse_a = page.find.rmse(a, n, region), rmse_b = page.find.rmse(b, n, region);
    return rmse_a && rmse_b && *rmse_a > *rmse_b;
}

/// Returns those of the two failures that this run does not show.
Json failures_not_seen(const Page& page, const ArmPair& pair) {
    const std::string broad = pair.broad->name, narrow = pair.narrow->name;
    Json out = Json::array();
    if (!larger_in(page, broad, narrow, pair.n, page.find.region_where_worst(broad, narrow, pair.n)) &&
        !all_lights(page.in.experiment).empty())
        out.push_back({{"loser", broad}, {"winner", narrow}});
    if (!larger_in(page, narrow, broad, pair.n, page.find.region_where_worst(narrow, broad, pair.n)))
        out.push_back({{"loser", narrow}, {"winner", broad}});
    return out;
}

/// What both failures state: the region in which `loser` is the worst against the other arm of the pair; null if its
/// error is nowhere larger.
Json failure_of(const Page& page, const ArmPair& pair, const ArmPlan& loser) {
    const ArmPlan& winner = &loser == pair.broad ? *pair.narrow : *pair.broad;
    const std::string region = page.find.region_where_worst(loser.name, winner.name, pair.n);
    if (!larger_in(page, loser.name, winner.name, pair.n, region)) return {};
    return {{"region", region}, {"ordering", ordering_html(page, loser.name, winner.name, pair.n, region)},
        {"broad", pair.broad->name}, {"narrow", pair.narrow->name}, {"n", pair.n},
        {"largest", with_minus(figures(page.find.run(loser.name, pair.n)->largest))}};
}

}  // namespace

Json results(Page& page) {
    const std::uint64_t n = page.find.headline_n();
    if (n == 0) return false;
    const Experiment& e = page.in.experiment;
    const ArmPair pair = arm_pair(page);
    const std::string rays = ray_words(e), bias = bias_words(e);
    const std::uint64_t bad = page.find.bad_samples();
    Json regions = Json::array();
    for (const Region& region : e.regions)
        if (pair) regions.push_back(ordering_html(page, pair.broad->name, pair.narrow->name, pair.n, region.name));
    return {{"plates", page.figures.plates(PlateKind::columns)}, {"table", headline_table(page, n)}, {"n", n},
        {"exponent", any_tells_s(e) ? shortest(page.find.s()) : ""}, {"regions", regions},
        {"remarks", rays.empty() ? bias : rays + after_space(bias)}, {"pair_n", pair.n},
        {"not_seen", pair && !e.regions.empty() ? failures_not_seen(page, pair) : Json::array()},
        {"bad_samples", bad ? plural(bad, "sample") : ""}, {"heat_plates", page.figures.plates(PlateKind::heat)},
        {"frame", frame_errors(page, n)}};
}

Json failure_a(Page& page) {
    const ArmPair pair = arm_pair(page);
    if (!pair || page.in.experiment.regions.empty() || all_lights(page.in.experiment).empty()) return false;
    Json out = failure_of(page, pair, *pair.broad);
    if (out.is_null()) return false;
    const std::string broad = pair.broad->name, narrow = pair.narrow->name;
    out["others"] = broad_arms(page, pair, out["region"]);
    out["mean"] = with_minus(figures(page.find.run(broad, pair.n)->y_mean));
    out["fireflies_broad"] = page.find.run(broad, pair.n)->fireflies;
    out["fireflies_narrow"] = page.find.run(narrow, pair.n)->fireflies;
    out["plates"] = Json::array();
    for (const std::string& arm : {broad, narrow})
        for (const Json& plate : page.figures.plates(PlateKind::ladder,
                 [&](const PlatePlan& plan) { return !plan.runs.empty() && plan.runs.front().arm == arm; }))
            out["plates"].push_back(plate);
    return out;
}

Json failure_b(Page& page) {
    const ArmPair pair = arm_pair(page);
    if (!pair || page.in.experiment.regions.empty()) return false;
    Json out = failure_of(page, pair, *pair.narrow);
    if (out.is_null()) return false;
    out["mean_broad"] = with_minus(figures(page.find.run(pair.broad->name, pair.n)->y_mean));
    out["mean_narrow"] = with_minus(figures(page.find.run(pair.narrow->name, pair.n)->y_mean));
    out["lost"] = !page.in.evidence.lost.empty();
    out["plates"] = page.figures.plates(PlateKind::surround);
    return out;
}

// ---- RMSE against N with the fitted slope, and the exponent control; the sample counts are prefixes of one stream of
// samples.

namespace {

std::vector<const Ladder*> ladders_in(const Page& page, const std::string& region) {
    std::vector<const Ladder*> ladders;
    for (const Ladder& l : page.in.metrics.ladders)
        if (l.region == region && l.n.size() > 1 && l.n.size() == l.rmse.size()) ladders.push_back(&l);
    return ladders;
}

std::string slope_interval_html(const Ladder& l) {
    if (l.heavy) return html::heavy_tail();
    if (!std::isfinite(l.low) || !std::isfinite(l.high)) return "–";
    return html::value(fmt::format("{:.3f} … {:.3f}", l.low, l.high));
}

std::vector<Point> points_of(const Ladder& l) {
    std::vector<Point> points;
    for (std::size_t i = 0; i < l.n.size(); ++i) points.push_back({static_cast<double>(l.n[i]), l.rmse[i]});
    return points;
}

std::vector<Point> published_of(const Page& page, const Ladder& l) {
    std::vector<Point> points;
    for (const std::uint64_t n : l.n)
        if (const SeedSpread* band = page.find.band(l.arm, n, "rmse." + l.region, l.s); band && band->published)
            points.push_back({static_cast<double>(n), *band->published});
    return points;
}

/// The 5 % and 95 % quantiles over seeds at each N of a ladder; empty with one seed.
struct LadderBand {
    std::vector<double> n, low, high;
};
LadderBand band_of(const Page& page, const Ladder& l) {
    LadderBand out;
    for (const std::uint64_t n : l.n)
        if (const SeedSpread* spread = page.find.band(l.arm, n, "rmse." + l.region, l.s);
            spread && spread->band.seeds > 1 && spread->band.q05 > 0) {
            out.n.push_back(static_cast<double>(n));
            out.low.push_back(spread->band.q05);
            out.high.push_back(spread->band.q95);
        }
    return out;
}

/// Returns RMSE = c N^(-1/2) through the first point, over the whole axis.
std::vector<Point> guide(const Point& first, const Axis& x) {
    return {{x.low, first.y * std::sqrt(first.x / x.low)}, {x.high, first.y * std::sqrt(first.x / x.high)}};
}

std::string ladder_chart(const Page& page, const std::string& region) {
    const auto ladders = ladders_in(page, region);
    std::vector<double> ns, values;
    for (const Ladder* l : ladders)
        for (const Point& p : points_of(*l)) {
            ns.push_back(p.x);
            values.push_back(p.y);
        }
    for (const Ladder* l : ladders)
        for (const Point& p : published_of(page, *l)) values.push_back(p.y);
    for (const Ladder* l : ladders) {
        const LadderBand band = band_of(page, *l);
        values.insert(values.end(), band.low.begin(), band.low.end());
        values.insert(values.end(), band.high.begin(), band.high.end());
    }
    Axis x = log_axis("N, samples per pixel", ns);
    x.ticks.assign(ns.begin(), ns.end());
    std::sort(x.ticks.begin(), x.ticks.end());
    x.ticks.erase(std::unique(x.ticks.begin(), x.ticks.end()), x.ticks.end());
    x.high *= 2.2;  // room for names at the ends of lines
    Chart chart(420, 330, x, log_axis(metric_text("rmse." + region), values), "RMSE against N in region " + region);
    for (const Ladder* l : ladders) {
        const auto points = points_of(*l);
        const std::string colour = page.colour(l->arm);
        if (const LadderBand band = band_of(page, *l); band.n.size() > 1)
            chart.band(band.n, band.low, band.high, colour + " faint");
        if (points.front().y > 0)
            chart.line(guide(points.front(), {x.low, x.high / 2.2, true, "", {}}), "dashed " + colour);
        chart.line(points, colour);
        chart.dots(points, colour);
        chart.diamonds(published_of(page, *l), colour);
        chart.name(points.back(), l->arm, colour);
    }
    return chart.str();
}

Json slopes_of(const Page& page) {
    const Experiment& e = page.in.experiment;
    Json out = Json::array();
    for (const Ladder& l : page.in.metrics.ladders) {
        if (l.n.size() < 2) continue;
        const ArmPlan* arm = e.find_arm(l.arm);
        out.push_back({{"region", l.region}, {"arm", l.arm}, {"biased", arm && is_biased(*arm, e)},
            {"exponent", cell_text(tells_s(l.arm, l.s, e) ? shortest(l.s) : "")},
            {"slope", cell_text(std::isfinite(l.slope) ? fmt::format("{:.3f}", l.slope) : "")},
            {"interval", slope_interval_html(l)}});
    }
    return out;
}

}  // namespace

Json ladders(Page& page) {
    std::string charts;
    for (const Region& region : page.in.experiment.regions)
        if (!ladders_in(page, region.name).empty()) charts += ladder_chart(page, region.name);
    if (charts.empty()) return false;
    return {{"over_seeds", page.in.experiment.seeds > 1}, {"charts", charts}, {"rows", slopes_of(page)},
        {"plates", page.figures.plates(PlateKind::ladder)}};
}

Json exponent_control(Page& page) {
    const auto& control = page.in.experiment.exponent;
    if (!control) return false;
    std::vector<Column> columns;
    for (const double s : control->s)
        columns.push_back(
            {{{"name", ""}, {"exponent", shortest(s)}, {"rays", ""}, {"biased", false}}, control->arm, control->n, s});
    Json table = metrics_table(page, columns);
    if (table == false) return false;
    return {{"arm", control->arm}, {"n", control->n}, {"shape", control->shape}, {"table", std::move(table)},
        {"plates", page.figures.plates(PlateKind::exponent)}};
}

// ---- White furnaces: one arm on a surface that reflects a known share of a light of radiance 1 from everywhere.

namespace {

bool is_heavy(const FurnaceResult& f) { return f.tail && f.tail->heavy(); }

/// Whether the reading is the expected one, by its standard error.
void add_verdict(const FurnaceResult& f, Json& to) {
    const double deviation = std::fabs(f.measured - f.expected);
    to["heavy"] = is_heavy(f);
    to["differs"] = false;
    to["remark"] = "";
    if (is_heavy(f)) return;
    if (!(f.se > 0)) {
        to["remark"] = deviation == 0 ? "exact" : "no standard error";
        return;
    }
    const double z = deviation / f.se;
    to["differs"] = !(z <= 3);
    to["remark"] = fmt::format("{}, {:.1f} standard errors off", z <= 3 ? "agrees" : "", z);
}

}  // namespace

Json furnaces(const Page& page) {
    const std::vector<FurnaceResult>& results = page.in.metrics.furnaces;
    if (results.empty()) return false;
    Json rows = Json::array(), shortfalls = Json::array();
    for (const FurnaceResult& f : results) {
        rows.push_back({{"name", f.name}, {"arm", f.arm}, {"part", f.part == "lobe" ? "lobe alone" : f.part},
            {"n", f.n}, {"expected", cell_text(figures(f.expected))},
            {"published", cell_text(f.published ? figures(*f.published) : "")},
            {"measured", cell_text(figures(f.measured))}, {"standard_error", figures(f.se, 2)},
            {"tail", cell_text(tail_text(f.tail))}});
        add_verdict(f, rows.back());
        if (!is_heavy(f) || f.expected <= 0) continue;
        const double deviation = f.measured / f.expected - 1;
        shortfalls.push_back({{"name", f.name}, {"measured", with_minus(figures(f.measured))},
            {"expected", with_minus(figures(f.expected))}, {"off", percent(std::fabs(deviation), 2)},
            {"short", deviation < 0}, {"tail", tail_text(f.tail)}});
    }
    const bool has_published =
        std::ranges::any_of(results, [](const FurnaceResult& f) { return f.published.has_value(); });
    return {{"with_published", has_published}, {"rows", rows}, {"shortfalls", shortfalls}};
}

}  // namespace crescent
