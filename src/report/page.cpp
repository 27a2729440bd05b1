// Plates go into the page as base64; where all of them would take more than 14 MB the largest are linked instead, one
// by one. Figures are numbered as sections ask for them. Meters have the labels of the table of meters.
#include "pages/base64.h"
#include "report/page.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include <fmt/format.h>

namespace crescent::inline report {
namespace {

constexpr std::size_t page_limit = 14'000'000;  // bytes of base64 that may go into the page

/// Letters, digits and hyphens of a name: what an id may hold.
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
    const char* narrow = picture.starts_with("<svg") ? " class=\"narrow\"" : "";  // one chart alone fits the column
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

std::string meter_html(const std::string& meter) {
    const auto dot = meter.find('.');
    const std::string kind = meter.substr(0, dot);
    const std::string region = dot == std::string::npos ? "" : "<sub>" + escape(meter.substr(dot + 1)) + "</sub>";
    std::string label = escape(kind);
    const auto look = [&](std::string_view name, const MeterInfo& info, auto) {
        if (name == kind && !info.label.empty()) label = info.label;
    };
    const RegionMeter of_region;
    const RunMeter of_frame;
    for_each_meter(of_region, look), for_each_meter(of_frame, look);
    return label + region;
}

std::string meter_text(const std::string& meter) {
    const auto dot = meter.find('.');
    if (dot == std::string::npos) return meter;
    return (meter.substr(0, dot) == "rmse" ? "RMSE" : meter.substr(0, dot)) + ", region " + meter.substr(dot + 1);
}

std::string tail_html(const std::optional<Tail>& tail) {
    if (!tail) return "–";
    return fmt::format("{:.2f} ± {:.2f}", tail->k, tail->se);
}

std::string interval_html(const std::string& meter, const Band& band) {
    if (band.heavy) return html::heavy_tail();
    if (band.seeds < 2) return "–";
    return html::value(figures_of(meter, band.q05) + " … " + figures_of(meter, band.q95));
}

std::string times(double ratio) {
    return std::isfinite(ratio) ? fmt::format("{:.{}f}", ratio, ratio < 10 ? 1 : 0) : "infinitely many";
}

}  // namespace crescent::inline report
