// Plates are embedded in the page as base64; if all of them would take more than 14 MB, the largest are linked instead,
// one by one. Metrics have the labels of the table of metrics.
#include "report/page.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "experiment/experiment.h"
#include "math/functions.h"
#include "output/templates.h"
#include "samplers/info.h"

namespace crescent {
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
        linked_plates_.insert(name);
        total -= size;
    }
}

Json Figures::plates(PlateKind kind, const std::function<bool(const PlatePlan&)>& accepts) {
    Json out = Json::array();
    for (const PlatePlan& plan : in_.experiment.plates)
        if (plan.kind == kind && in_.plates.count(plan.name) && !placed_plates_.count(plan.name) &&
            (!accepts || accepts(plan)))
            out.push_back(plate(plan.name, &plan));
    return out;
}

Json Figures::remaining_plates() {
    Json out = Json::array();
    for (const PlatePlan& plan : in_.experiment.plates)
        if (in_.plates.count(plan.name) && !placed_plates_.count(plan.name)) out.push_back(plate(plan.name, &plan));
    for (const auto& [name, png] : in_.plates)
        if (!placed_plates_.count(name)) out.push_back(plate(name, nullptr));
    return out;
}

Json Figures::plate(const std::string& name, const PlatePlan* plan) {
    placed_plates_.insert(name);
    std::string label;
    if (plan) label = plate_info(plan->kind).look == PlateLook::photograph ? "Photograph" : "Instrument";
    return {{"name", name}, {"id", slug(name)}, {"look", label},
        {"caption", plan && !plan->caption.empty() ? plan->caption : name},
        {"source",
            linked_plates_.count(name) ? escape("plates/" + name + ".png")
                                       : "data:image/png;base64," + base64(in_.plates.at(name))}};
}

std::string Page::colour(const std::string& arm) const {
    const auto& arms = in.experiment.arms;
    const auto match = std::find_if(arms.begin(), arms.end(), [&](const ArmPlan& a) { return a.name == arm; });
    return fmt::format("c{}", (match - arms.begin()) % 6);
}

std::string metric_html(const std::string& metric) {
    const auto dot = metric.find('.');
    const std::string kind = metric.substr(0, dot);
    const std::string region = dot == std::string::npos ? "" : "<sub>" + escape(metric.substr(dot + 1)) + "</sub>";
    std::string label = kind == "flip" ? "FLIP" : escape(kind);
    const auto take_label = [&](std::string_view name, const MetricInfo& info, auto) {
        if (name == kind && !info.label.empty()) label = info.label;
    };
    const RegionMetrics region_metrics;
    const RunMetrics frame_metrics;
    for_each_metric(region_metrics, take_label);
    for_each_metric(frame_metrics, take_label);
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
    to["story"] = story;
    to["story_n"] = pair.n;
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
    model["scene"] = scene_section(page);
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

// ---- An arm's side follows from the axis that SamplerInfo gives its density; an arm that combines others has none. Of
// the arms about the normal, the one with most sample counts in common with the mirror's is taken; among equals, the
// one with the least sum of ln RMSE over the regions, at the headline N if both ran it, else at the largest they share.

namespace {

/// Returns the sum of log RMSE over the regions; infinite if a run or an error is missing.
double error_of(const Page& page, const ArmPlan& arm, std::uint64_t n) {
    double sum = 0;
    for (const Region& region : page.in.experiment.regions) {
        const auto rmse = page.find.rmse(arm.name, n, region.name);
        if (!rmse || !(*rmse > 0)) return std::numeric_limits<double>::infinity();
        sum += math::log(*rmse);
    }
    return sum;
}

bool is_about(const ArmPlan& arm, PdfAxis axis) {
    const SamplerInfo* info = find_arm_info(arm.sampler);
    return info && info->about == axis && !info->combines;
}

std::ptrdiff_t shared_sample_counts(const ArmPlan& a, const ArmPlan& b) {
    return std::ranges::count_if(a.n, [&](std::uint64_t n) { return std::ranges::find(b.n, n) != b.n.end(); });
}

std::vector<std::string> names_where(const Experiment& e, const std::function<bool(const ArmPlan&)>& accepts) {
    std::vector<std::string> names;
    for (const ArmPlan& arm : e.arms)
        if (accepts(arm)) names.push_back("<b>" + escape(arm.name) + "</b>");
    return names;
}

}  // namespace

std::vector<const ArmPlan*> arms_about_normal(const Experiment& experiment) {
    std::vector<const ArmPlan*> out;
    for (const ArmPlan& arm : experiment.arms)
        if (is_about(arm, PdfAxis::normal)) out.push_back(&arm);
    return out;
}

const ArmPlan* arm_about_mirror(const Experiment& experiment) {
    for (const ArmPlan& arm : experiment.arms)
        if (is_about(arm, PdfAxis::mirror)) return &arm;
    return nullptr;
}

ArmPair arm_pair(const Page& page) {
    ArmPair pair;
    pair.narrow = arm_about_mirror(page.in.experiment);
    if (!pair.narrow) return {};
    double smallest_error = std::numeric_limits<double>::infinity();
    std::ptrdiff_t largest = 0;
    for (const ArmPlan* arm : arms_about_normal(page.in.experiment)) {
        const auto was_run = [&](std::uint64_t n) {
            return n > 0 && page.find.run(arm->name, n) && page.find.run(pair.narrow->name, n);
        };
        const std::uint64_t headline_n = page.find.headline_n();
        const std::uint64_t n = was_run(headline_n) ? headline_n : page.find.common_n({arm, pair.narrow});
        if (!was_run(n)) continue;
        const double error = error_of(page, *arm, n);
        const std::ptrdiff_t sample_counts = shared_sample_counts(*arm, *pair.narrow);
        if (!pair.broad || sample_counts > largest || (sample_counts == largest && error < smallest_error)) {
            pair.broad = arm;
            pair.n = n;
            smallest_error = error;
            largest = sample_counts;
        }
    }
    return pair ? pair : ArmPair{};
}

std::string run_html(const RunKey& key, const Experiment& experiment) {
    std::string out = fmt::format("{}, <i>N</i> = {}", escape(key.arm), key.n);
    if (tells_s(key.arm, key.s, experiment)) out += fmt::format(", <i>s</i> = {}", shortest(key.s));
    return out;
}

std::string ray_words(const Experiment& experiment) {
    const auto names = names_where(experiment, [](const ArmPlan& arm) { return techniques_of(arm) > 1; });
    if (names.empty()) return {};
    return fmt::format(
        "{} {} two techniques: {} <i>N</i> counts pairs, and at equal <i>N</i> {} two rays for each one "
        "of the others.",
        listed(names), names.size() == 1 ? "joins" : "join", names.size() == 1 ? "its" : "their",
        names.size() == 1 ? "it sends" : "they send");
}

std::string bias_words(const Experiment& experiment) {
    std::string out;
    for (const ArmPlan& arm : experiment.arms)
        if (const std::string light = missed_light(arm, experiment); !light.empty())
            out += fmt::format(
                "{}<b>{}</b> is biased in this scene: it cannot reach {}. More samples do not bring that light, so "
                "that its RMSE stops falling.",
                out.empty() ? "" : " ", escape(arm.name), escape(light));
    return out;
}

std::string after_space(const std::string& text) { return text.empty() ? "" : " " + text; }

// ---- Sentences that compare two arms are made from the values and follow their order; they rank nothing if intervals
// overlap or a heavy tail leaves no interval.

namespace {

std::string first_words(const RatioOfErrors& c, std::uint64_t n, const std::string& metric, const std::string& seed) {
    const std::string larger = escape(c.larger), smaller = escape(c.smaller);
    if (c.equal)
        return fmt::format("At <i>N</i> = {} and the {} seed, {} and {} read the same {}, {}.", n, seed, larger,
            smaller, metric, html::value(figures(c.high)));
    return fmt::format("At <i>N</i> = {} and the {} seed, {}’s {} is <b>{} times</b> {}’s ({} against {}).", n, seed,
        larger, metric, times(c.ratio), smaller, html::value(figures(c.high)), html::value(figures(c.low)));
}

std::string heavy_words(const Page& page, const SeedSpread& a, const SeedSpread& b) {
    std::string names;
    for (const SeedSpread* band : {&a, &b}) {
        if (!band->band.heavy) continue;
        const auto tail = page.find.tail(*band);
        names += (names.empty() ? "" : " and ") + escape(band->key.arm);
        if (tail) names += fmt::format(" (tail index {})", html::value(tail_text(tail)));
    }
    return fmt::format(
        " How large the ratio is stays <b>inconclusive: heavy tail</b>: the samples of {} spread so widely "
        "there that no interval means anything.",
        names);
}

std::string ranking(const Page& page, const SeedSpread& a, const SeedSpread& b) {
    if (a.band.heavy || b.band.heavy) return heavy_words(page, a, b);
    if (a.band.seeds < 2) return " One seed gives no interval, so the two are not ranked.";
    const bool bands_overlap = a.band.q05 <= b.band.q95 && b.band.q05 <= a.band.q95;
    if (bands_overlap) return " The <span class=\"v\">5–95 %</span> bands overlap, so the two are not ranked.";
    const double chance = chance_of_parted_bands(std::min(a.band.seeds, b.band.seeds));
    return chance > 0.05 ? fmt::format(
                               " With {} seeds the bands of equal arms are disjoint in {} of all runs, so the two "
                               "are not ranked.",
                               std::min(a.band.seeds, b.band.seeds), percent(chance, 2))
                         : " The <span class=\"v\">5–95 %</span> bands over seeds do not overlap.";
}

Json metric_cell(const Page& page, const SeedSpread* band) {
    Json out = {{"value", "–"}, {"median", ""}, {"band", ""}, {"tail", ""}};
    if (!band) return out;
    const bool paired = page.in.experiment.reference.kind == ReferenceKind::paired;
    out["value"] = with_minus(figures_of(band->metric, band->measured, paired));
    if (band->band.seeds > 1) {
        out["median"] = with_minus(figures_of(band->metric, band->band.median, paired));
        out["band"] = interval_html(band->metric, band->band);
    }
    if (band->metric.starts_with("rmse.")) out["tail"] = tail_text(page.find.tail(*band));
    return out;
}

/// A row for each region in which FLIP was measured.
void add_flip_rows(const Page& page, const std::vector<Column>& columns, Json& rows) {
    for (const Region& region : page.in.experiment.regions) {
        const std::string metric = "flip." + region.name;
        Json cells = Json::array();
        bool has_values = false;
        for (const Column& column : columns) {
            const RunMetrics* run = page.find.run(column.arm, column.n, column.s);
            const RegionMetrics* values = run ? run->region(region.name) : nullptr;
            const bool is_measured = values && values->has_flip();
            has_values = has_values || is_measured;
            const SeedSpread* band = page.find.band(column.arm, column.n, metric, column.s);
            cells.push_back(metric_cell(page, band));
            if (!band && is_measured) cells.back()["value"] = with_minus(figures(values->flip));
        }
        if (has_values) rows.push_back({{"metric", metric_html(metric)}, {"cells", cells}});
    }
}

}  // namespace

Json metrics_table(const Page& page, const std::vector<Column>& columns) {
    Json heads = Json::array(), rows = Json::array();
    for (const Column& column : columns) heads.push_back(column.head);
    for (const std::string& metric : headline_metrics(page.in.experiment)) {
        Json cells = Json::array();
        bool has_values = false;
        for (const Column& column : columns) {
            const SeedSpread* band = page.find.band(column.arm, column.n, metric, column.s);
            has_values = has_values || band;
            cells.push_back(metric_cell(page, band));
        }
        if (has_values) rows.push_back({{"metric", metric_html(metric)}, {"cells", cells}});
    }
    add_flip_rows(page, columns, rows);
    if (rows.empty()) return false;
    return {{"columns", heads}, {"rows", rows}};
}

std::string ordering_html(
    const Page& page, const std::string& a, const std::string& b, std::uint64_t n, const std::string& region) {
    const auto rmse_a = page.find.rmse(a, n, region), rmse_b = page.find.rmse(b, n, region);
    if (!rmse_a || !rmse_b) return {};
    const RatioOfErrors c = compare(a, *rmse_a, b, *rmse_b);
    const std::string metric = "rmse." + region;
    std::string out = first_words(c, n, metric_html(metric), page.seed_name());
    const SeedCount seeds = page.find.seeds_above(c.larger, c.smaller, n, region);
    if (seeds.total > 1 && !c.equal)
        out += fmt::format(" The order is the same in {} of {} seeds.", seeds.larger, seeds.total);
    const SeedSpread *band_a = page.find.band(a, n, metric), *band_b = page.find.band(b, n, metric);
    if (band_a && band_b) out += ranking(page, *band_a, *band_b);
    return out;
}

// ---- The model of the end of the report: the limits of this run, its assertions and its provenance.

namespace {

/// Returns whether an arm aims only at the lights or combines several densities.
bool remedies(const Experiment& e) {
    return std::any_of(e.arms.begin(), e.arms.end(), [](const ArmPlan& arm) {
        const SamplerInfo* info = find_arm_info(arm.sampler);
        return info && (info->combines || !info->misses.empty());
    });
}

}  // namespace

Json more_plates(Page& page) {
    Json plates = page.figures.remaining_plates();
    return plates.empty() ? Json(false) : Json{{"plates", std::move(plates)}};
}

Json limits(const Page& page) {
    const Experiment& e = page.in.experiment;
    const auto& bands = page.in.metrics.bands;
    const auto heavy_count = std::ranges::count_if(bands, [](const SeedSpread& b) { return b.band.heavy; });
    const double chance = chance_of_parted_bands(e.seeds);
    Json out = {{"bands", false}, {"rays", after_space(ray_words(e))}, {"bias", bias_words(e)},
        {"remedies", remedies(e)}, {"one_seed", e.seeds < 2}, {"few_seeds", e.seeds >= 2 && e.seeds < 20},
        {"heavy", heavy_count > 0 ? std::to_string(heavy_count) : ""}, {"metrics", bands.size()}};
    if (e.seeds > 1) out["bands"] = {{"chance", chance > 1e-3 ? percent(chance, 2) : "less than 0.1 %"}};
    return out;
}

Json assertions(const Page& page) {
    const auto& results = page.in.metrics.assertions;
    if (results.empty()) return false;
    const auto failure_count = std::ranges::count_if(results, [](const AssertionResult& a) { return a.failed(); });
    const auto empty_count = std::ranges::count_if(results, [](const AssertionResult& a) { return a.cannot_fail; });
    Json rows = Json::array();
    for (const AssertionResult& a : results) {
        const bool was_run = a.skipped.empty(), holds = was_run && !a.failed();
        rows.push_back({{"name", a.name}, {"claim", a.text}, {"measured", cell_text(compact(a.measured))}, {"op", a.op},
            {"bound", cell_text(compact(a.bound))}, {"skipped", a.skipped}, {"fails", was_run && a.failed()},
            {"holds", holds}, {"cannot_fail", holds && a.cannot_fail}});
    }
    return {{"total", results.size()}, {"one", results.size() == 1},
        {"failed", failure_count > 0 ? std::to_string(failure_count) : ""},
        {"empty", empty_count > 0 ? std::to_string(empty_count) : ""}, {"rows", rows}};
}

Json provenance(const Page& page) {
    const Provenance& p = page.in.provenance;
    Json details = Json::array(), films = Json::array(), part = false;
    for (const auto& [what, message] : p.backend_details) details.push_back({{"what", what}, {"message", message}});
    for (const auto& [name, hash] : page.in.metrics.film_hashes) films.push_back({{"name", name}, {"hash", hash}});
    if (!p.missing().empty()) part = {{"places", ranges_text(p.places)}, {"series", p.series}};
    return {{"commit", p.commit}, {"compiler", p.compiler}, {"backend", p.backend}, {"backend_details", details},
        {"all_seeds", fmt::format("{}", fmt::join(p.seeds, ", "))}, {"part", part}, {"films", films}};
}

}  // namespace crescent
