// Plates are embedded in the page as base64; if all of them would take more than 14 MB, the largest are linked instead,
// one by one. Figures are numbered in the order in which sections use them. Metrics have the labels of the table of
// metrics.
#include "report/page.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fmt/format.h>

#include "output/format.h"
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

std::string Figures::plates(PlateKind kind, const std::function<bool(const PlatePlan&)>& only) {
    std::string out;
    for (const PlatePlan& plan : in_.experiment.plates)
        if (plan.kind == kind && in_.plates.count(plan.name) && !shown_.count(plan.name) && (!only || only(plan)))
            out += plate(plan.name, &plan);
    return out;
}

std::string Figures::rest() {
    std::string out;
    for (const PlatePlan& plan : in_.experiment.plates)
        if (in_.plates.count(plan.name) && !shown_.count(plan.name)) out += plate(plan.name, &plan);
    for (const auto& [name, png] : in_.plates)
        if (!shown_.count(name)) out += plate(name, nullptr);
    return out;
}

std::string Figures::chart(const std::string& svg, const std::string& caption_html, const std::string& source) {
    return figure("chart-" + std::to_string(count_ + 1), svg, caption_html, source);
}

std::string Figures::plate(const std::string& name, const PlatePlan* plan) {
    shown_.insert(name);
    const std::vector<unsigned char>& png = in_.plates.at(name);
    const std::string caption = plan && !plan->caption.empty() ? plan->caption : name;
    const std::string source =
        outside_.count(name) ? "plates/" + name + ".png" : "data:image/png;base64," + base64(png);
    const std::string picture = fmt::format("<img src=\"{}\" alt=\"{}\" width=\"1280\" height=\"720\" />",
        outside_.count(name) ? escape(source) : source, escape(caption));
    std::string kind;
    if (plan)
        kind = fmt::format("<span class=\"kind\">{}</span> ",
            plate_info(plan->kind).look == PlateLook::photograph ? "Photograph" : "Instrument");
    return figure("plate-" + slug(name), picture, kind + escape(caption), "plates/" + name + ".png");
}

std::string Figures::figure(
    const std::string& id, const std::string& picture, const std::string& caption, const std::string& made) {
    ++count_;
    const char* narrow = picture.starts_with("<svg") ? " class=\"narrow\"" : "";  // a single chart fits the column
    return fmt::format(
        "<figure id=\"{}\"{}>\n{}\n<figcaption><b>Figure {}.</b> {}\n<span class=\"made\"><code>{}</code> → "
        "<code>{}</code></span></figcaption>\n</figure>\n",
        id, narrow, picture, count_, caption, escape(in_.provenance.command), escape(made));
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

std::string tail_html(const std::optional<Tail>& tail) {
    if (!tail) return "–";
    return fmt::format("{:.2f} ± {:.2f}", tail->k, tail->se);
}

std::string interval_html(const std::string& metric, const Band& band) {
    if (band.heavy) return html::heavy_tail();
    if (band.seeds < 2) return "–";
    return html::value(figures_of(metric, band.q05, std::isfinite(band.q95)) + " … " + figures_of(metric, band.q95));
}

std::string times(double ratio) {
    return std::isfinite(ratio) ? fmt::format("{:.{}f}", ratio, ratio < 10 ? 1 : 0) : "infinitely many";
}

// ---- report.html: the whole report in one file that opens offline; this part has the order of the sections, the head
// of the page and its contents.

namespace {

std::vector<PageSection> all_sections(Page& page) {
    return {question(page), estimator_equation(page), scene(page), densities(page), results(page), failure_a(page),
        failure_b(page), ladders(page), exponent(page), furnaces(page), published(page), reference(page),
        where_wrong(page), disagreements(page), what_ifs(page), limits(page), more_plates(page), assertions(page),
        provenance(page)};
}

std::string verdict(const std::vector<AssertionResult>& all) {
    if (all.empty()) return {};
    const auto failed = std::count_if(all.begin(), all.end(), [](const AssertionResult& a) { return a.failed(); });
    const auto empty = std::ranges::count_if(all, [](const AssertionResult& a) { return a.cannot_fail; });
    const std::string without = empty > 0 ? fmt::format(", {} of them for any measurements", empty) : "";
    if (failed == 0)
        return fmt::format(
            "<p class=\"verdict good\">All {} assertions of this run hold{}.</p>\n", all.size(), without);
    return fmt::format("<p class=\"verdict bad\">{} of {} assertions of this run FAIL. See {}.</p>\n", failed,
        all.size(), html::link("assertions", "which"));
}

/// Compares an arm about the normal and one about the mirror direction in each region, in one sentence.
std::string story(const Page& page) {
    const ArmPair pair = arm_pair(page);
    if (!pair) return {};
    const ArmPlan *broad = pair.broad, *narrow = pair.narrow;
    const std::uint64_t n = pair.n;
    std::string out;
    for (const Region& region : page.in.experiment.regions) {
        const auto a = page.find.rmse(broad->name, n, region.name), b = page.find.rmse(narrow->name, n, region.name);
        if (!a || !b) continue;
        const RatioOfErrors c = compare(broad->name, *a, narrow->name, *b);
        out += out.empty() ? fmt::format(" At <i>N</i> = {} and the {} seed", n, page.seed_name()) : ";";
        const std::string where = " in region " + escape(region.name);
        out += c.equal
            ? where + " the two err alike"
            : fmt::format("{} {}’s error is {} times {}’s", where, escape(c.larger), times(c.ratio), escape(c.smaller));
    }
    return out.empty()
        ? out
        : "One integral, one number of samples, one stream of random numbers: only the aim differs." + out + ".";
}

std::string lead(const Page& page) {
    const std::string words = story(page);
    return (words.empty() ? "" : html::element("p", "class=\"lead\"", words) + "\n") +
        verdict(page.in.metrics.assertions);
}

}  // namespace

std::string report_html(const ReportInputs& in) {
    Page page(in);
    PageFrame frame;
    frame.title_text = in.experiment.title;
    frame.kicker_text = "a bench for importance samplers";
    frame.version_text = in.provenance.version;
    frame.lead_html = lead(page) + page.figures.plates(PlateKind::hero) + "\n";  // the first figure
    frame.footer_html = fmt::format("Made by crescent {} from <code>{}</code>, hash <code>{}</code>.",
        escape(in.provenance.version), escape(in.provenance.experiment_file), escape(in.provenance.experiment_hash));
    frame.contents = true;
    return page_html(frame, all_sections(page));
}

}  // namespace crescent::inline report
