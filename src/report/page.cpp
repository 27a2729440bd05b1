// Plates are embedded in the page as base64; if all of them would take more than 14 MB, the largest are linked instead,
// one by one. Metrics have the labels of the table of metrics.
#include "report/page.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fmt/format.h>

#include "output/templates.h"
#include "report/wording.h"

namespace crescent::inline report {
namespace {

constexpr std::size_t page_limit = 14'000'000;  // bytes of base64 allowed in the page

/// Returns the letters, digits and hyphens of a name, which an id may contain.
std::string slug(const std::string& name) {
    std::string out;
    for (const char c : name) out += std::isalnum(static_cast<unsigned char>(c)) ? c : '-';
    return out;
}

}  // namespace

Figures::Figures(const ReportInputs& in) : in_(in) {
    std::vector<std::pair<std::size_t, std::string>> sizes;
    std::size_t total = 0;
    for (const auto& [name, png] : in.plates) {
        sizes.emplace_back(png.size() * 4 / 3, name);
        total += sizes.back().first;
    }
    std::sort(sizes.rbegin(), sizes.rend());
    for (const auto& [size, name] : sizes) {
        if (total <= page_limit) break;
        outside_.insert(name);
        total -= size;
    }
}

Json Figures::plates(PlateKind kind, const std::function<bool(const PlatePlan&)>& only) {
    Json out = Json::array();
    for (const PlatePlan& plan : in_.experiment.plates)
        if (plan.kind == kind && in_.plates.count(plan.name) && !shown_.count(plan.name) && (!only || only(plan)))
            out.push_back(plate(plan.name, &plan));
    return out;
}

Json Figures::rest() {
    Json out = Json::array();
    for (const PlatePlan& plan : in_.experiment.plates)
        if (in_.plates.count(plan.name) && !shown_.count(plan.name)) out.push_back(plate(plan.name, &plan));
    for (const auto& [name, png] : in_.plates)
        if (!shown_.count(name)) out.push_back(plate(name, nullptr));
    return out;
}

Json Figures::plate(const std::string& name, const PlatePlan* plan) {
    shown_.insert(name);
    std::string look;
    if (plan) look = plate_info(plan->kind).look == PlateLook::photograph ? "Photograph" : "Instrument";
    return {{"name", name}, {"id", slug(name)}, {"look", look},
        {"caption", plan && !plan->caption.empty() ? plan->caption : name},
        {"source",
            outside_.count(name) ? escape("plates/" + name + ".png")
                                 : "data:image/png;base64," + base64(in_.plates.at(name))}};
}

std::string Page::colour(const std::string& arm) const {
    const auto& arms = in.experiment.arms;
    const auto found = std::find_if(arms.begin(), arms.end(), [&](const ArmPlan& a) { return a.name == arm; });
    return fmt::format("c{}", (found - arms.begin()) % 6);
}

std::string metric_html(const std::string& metric) {
    const auto dot = metric.find('.');
    const std::string kind = metric.substr(0, dot);
    const std::string region = dot == std::string::npos ? "" : "<sub>" + escape(metric.substr(dot + 1)) + "</sub>";
    std::string label = kind == "flip" ? "FLIP" : escape(kind);
    const auto look = [&](std::string_view name, const MetricInfo& info, auto) {
        if (name == kind && !info.label.empty()) label = info.label;
    };
    const RegionMetrics of_region;
    const RunMetrics of_frame;
    for_each_metric(of_region, look), for_each_metric(of_frame, look);
    return label + region;
}

std::string metric_text(const std::string& metric) {
    const auto dot = metric.find('.');
    if (dot == std::string::npos) return metric;
    return (metric.substr(0, dot) == "rmse" ? "RMSE" : metric.substr(0, dot)) + ", region " + metric.substr(dot + 1);
}

std::string tail_text(const std::optional<Tail>& tail) {
    return tail ? with_minus(fmt::format("{:.2f} ± {:.2f}", tail->k, tail->se)) : "";
}

std::string interval_html(const std::string& metric, const Band& band) {
    if (band.heavy) return html::heavy_tail();
    if (band.seeds < 2) return "–";
    return html::value(figures_of(metric, band.q05, std::isfinite(band.q95)) + " … " + figures_of(metric, band.q95));
}

std::string times(double ratio) {
    return std::isfinite(ratio) ? fmt::format("{:.{}f}", ratio, ratio < 10 ? 1 : 0) : "infinitely many";
}

Json with_commas(Json objects) {
    for (std::size_t i = 0; i < objects.size(); ++i) objects[i]["comma"] = i + 1 < objects.size() ? ", " : "";
    return objects;
}

namespace {

/// Compares an arm about the normal and one about the mirror direction in each region.
void add_story(const Page& page, Json& to) {
    const ArmPair pair = arm_pair(page);
    Json story = Json::array();
    if (pair)
        for (const Region& region : page.in.experiment.regions) {
            const auto a = page.find.rmse(pair.broad->name, pair.n, region.name),
                       b = page.find.rmse(pair.narrow->name, pair.n, region.name);
            if (!a || !b) continue;
            const RatioOfErrors c = compare(pair.broad->name, *a, pair.narrow->name, *b);
            story.push_back({{"region", region.name}, {"equal", c.equal}, {"larger", c.larger}, {"smaller", c.smaller},
                {"times", times(c.ratio)}, {"end", ";"}});
        }
    if (!story.empty()) story.back()["end"] = ".";
    to["story"] = story, to["story_n"] = pair.n;
}

}  // namespace

std::string report_html(const ReportInputs& in) {
    Page page(in);
    const Provenance& p = in.provenance;
    Json model = {{"title", in.experiment.title}, {"version", p.version}, {"command", p.command},
        {"experiment_file", p.experiment_file}, {"experiment_hash", p.experiment_hash}, {"seed_name", page.seed_name()},
        {"seed", in.experiment.seed}, {"seeds", page.seeds()}, {"any_published", page.find.anything_published()}};
    add_story(page, model);
    model["hero_plates"] = page.figures.plates(PlateKind::hero);
    model["question"] = question(page);
    model["estimator"] = estimator_equation(page);
    model["scene"] = scene(page);
    model["densities"] = densities(page);
    model["results"] = results(page);
    model["failure_a"] = failure_a(page);
    model["failure_b"] = failure_b(page);
    model["ladders"] = ladders(page);
    model["exponent_control"] = exponent_control(page);
    model["furnaces"] = furnaces(page);
    model["all_metrics"] = all_metrics(page);
    model["reference"] = reference(page);
    model["wrong"] = where_wrong(page);
    model["disagreements"] = disagreements(page);
    model["limits"] = limits(page);
    model["more_plates"] = more_plates(page);
    model["assertions"] = assertions(page);
    model["provenance"] = provenance(page);
    return render_page(report_templates(), "report.html", model);
}

}  // namespace crescent::inline report
