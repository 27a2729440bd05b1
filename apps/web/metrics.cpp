// Numbers under the pictures: the metrics of a film with the published values of the same run, tails, and charts of
// both.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "parts.h"
#include "user_sampler.h"

namespace crescent::web {

namespace {

ordered_json one_metric(const RunMetrics& run, const std::string& name) {
    const std::optional<Published>& figures = bench().experiment.figures;
    const bool is_paired = bench().experiment.reference.kind == ReferenceKind::paired;
    ordered_json out = {{"value", json_number(metric_value(run, name))},
        {"text", figures_of(name, metric_value(run, name), is_paired)}};
    const bool has_same_seed = figures && (!figures->seed || *figures->seed == run.key.seed);
    const auto published = has_same_seed ? figures->find(run.key.arm, run.key.n, run.key.s, name) : std::nullopt;
    if (published) out["published"] = figures_of(name, *published);
    return out;
}

std::string class_of(const std::string& arm) {
    const auto& arms = bench().experiment.arms;
    const auto index = std::ranges::find(arms, arm, &ArmPlan::name) - arms.begin();
    return fmt::format("c{}", index % 6);
}

void send_tail(const std::optional<Tail>& tail) {
    if (!tail) return respond(ordered_json{{"words", "no tail: the samples do not spread"}});
    // The mean is the integral and exists for any k; from k = 1 on the observed samples do not bound it.
    const bool is_sure = std::fabs(tail->k - 0.5) >= 2 * tail->se;
    const std::string_view words = tail->k >= 1 ? "inconclusive: heavy tail, these samples do not bound even the mean"
        : tail->heavy() && is_sure              ? "inconclusive: heavy tail, the variance looks infinite"
        : tail->heavy()                         ? "inconclusive: heavy tail, the variance may be infinite"
        : is_sure                               ? "the variance looks finite"
                                                : "the variance may be finite";
    respond(ordered_json{{"k", tail->k}, {"se", tail->se}, {"heavy", tail->heavy()},
        {"text", fmt::format("{} ± {}", figures(tail->k, 2), figures(tail->se, 1))}, {"words", words}});
}

ordered_json metrics_of(const Slot& s) {
    const Bench& b = bench();
    const RunMetrics run = measure(b.experiment, s.key, s.film, b.reference, b.shapes);
    ordered_json out = {{"key", to_string(s.key)}, {"largest", json_number(run.largest)}, {"bad", run.bad}};
    for (const auto& [name, info] : metric_names(b.experiment))
        if (!(info->from_two_samples && s.key.n < 2)) out["metrics"][name] = one_metric(run, name);
    for (const Region& region : b.experiment.regions) {
        if (b.experiment.reference.kind == ReferenceKind::paired) {  // whose error the RMSE is corrected for
            out["own"][region.name] = figures(run.region(region.name)->reference_error, 2);
            continue;
        }
        const double error = rms(b.reference.error, AreaPixels(region.area(), b.shapes));
        const double rmse = run.region(region.name)->rmse;
        if (error > most_error_share * rmse) out["unsure"].push_back(region.name);
    }
    return out;
}

}  // namespace

/// Film `index` -> {key, metrics: {"rmse.H": {value, text, published}, ...}, largest, bad, unsure, hash}.
CRESCENT_EXPORT(metrics)(int index)->void {
    ordered_json out = metrics_of(slot(index));
    out["hash"] = hash(slot(index).film);
    respond(out);
}

/// {arm, region, box: [x0, y0, x1, y1]} -> {k, se, heavy, text, words}: the tail index of the arm's samples in a box,
/// in the pixels of the region's object if it has one.
CRESCENT_EXPORT(tail)()->void {
    const ordered_json query = request();
    const Area area = requested_area(query);
    const SamplerRef sampler = sampler_of(arm_of(query.at("arm").get<std::string>()));
    const ShapeMap& shapes = area.surface == any_surface ? bench().shapes : all_shapes();
    ProgressMonitor monitor;
    send_tail(region_tail(bench().scene, sampler, bench().experiment.seed, AreaPixels(area, shapes), "", monitor));
}

/// {region, series: [{arm, points: [[n, rmse], ...], band: [[n, low, high], ...]}]} -> RMSE against N as SVG, with
/// N^(-1/2) from the first points.
CRESCENT_EXPORT(ladder_chart)()->void {
    const ordered_json query = request();
    std::vector<double> ns, values;
    for (const auto& series : query.at("series"))
        for (const auto& p : series.at("points")) {
            ns.push_back(p.at(0));
            values.push_back(p.at(1));
        }
    for (const auto& series : query.at("series"))
        for (const auto& b : series.at("band")) {
            values.push_back(b.at(1));
            values.push_back(b.at(2));
        }
    Axis x = log_axis("N, samples per pixel", ns);
    x.ticks = ns;
    std::ranges::sort(x.ticks);
    x.ticks.erase(std::unique(x.ticks.begin(), x.ticks.end()), x.ticks.end());
    const double last = *std::ranges::max_element(ns);
    x.high *= 2.2;  // room for names at the ends of lines
    for (const auto& series : query.at("series"))
        if (const auto& points = series.at("points"); !points.empty())
            values.push_back(points[0].at(1).get<double>() * std::sqrt(points[0].at(0).get<double>() / last));
    const auto region = query.at("region").get<std::string>();
    Chart chart(420, 330, x, log_axis("RMSE of " + region, values), "RMSE against N in region " + region);
    for (const auto& series : query.at("series")) {
        std::vector<Point> points;
        for (const auto& p : series.at("points")) points.push_back({p.at(0), p.at(1)});
        if (points.empty()) continue;
        const auto arm = series.at("arm").get<std::string>();
        std::vector<double> positions, low, high;
        for (const auto& b : series.at("band")) {
            positions.push_back(b.at(0));
            low.push_back(b.at(1));
            high.push_back(b.at(2));
        }
        if (positions.size() > 1) chart.band(positions, low, high, "band " + class_of(arm));
        const Point first = points.front();
        if (first.y > 0) chart.line({first, {last, first.y * std::sqrt(first.x / last)}}, "dashed " + class_of(arm));
        chart.line(points, class_of(arm));
        chart.dots(points, class_of(arm));
        chart.name(points.back(), arm, class_of(arm));
    }
    respond(chart.str());
}

}  // namespace crescent::web
