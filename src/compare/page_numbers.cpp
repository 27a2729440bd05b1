// The sections of a comparison's page that hold numbers: meters with their doubt, who is better, ladders, files.
#include <fmt/format.h>

#include <algorithm>

#include "compare/judge.h"
#include "compare/page.h"
#include "compare/schema.h"
#include "pages/charts.h"
#include "pages/html.h"
#include "pages/numbers.h"

namespace crescent::inline comparing {

namespace {

using html::words;

std::string cell(const MeterValue& m) {
    if (!m.value) return html::element("span", fmt::format("title=\"{}\"", escape(m.why)), "–");
    std::string out = html::value(figures(*m.value));
    if (m.interval)
        out += fmt::format("<br /><small>{} … {}</small>", html::number(figures(m.interval->first, 3)),
            html::number(figures(m.interval->second, 3)));
    else if (m.why == "heavy tail") out += "<br /><small>" + html::heavy_tail() + "</small>";
    return out;
}

const char* title_of(const std::string& meter) {
    static const std::map<std::string, const char*> titles = {{"rmse", "RMSE"}, {"var", "variance"}, {"bias2", "bias²"},
        {"relmse", "relMSE"}, {"mape", "MAPE"}, {"fireflies", "fireflies"}, {"y_mean", "mean <i>Y</i>"},
        {"flip", "HDR-FLIP"}, {"flip_ldr", "LDR-FLIP"}, {"efficiency", "efficiency"},
        {"unit_time", "s to unit variance"}, {"sample_var", "variance of a sample"}};
    const auto it = titles.find(meter);
    return it == titles.end() ? "" : it->second;
}

/// Meters that some arm has; of the others, why not.
std::vector<std::string> measured(
    const CompareResult& result, const std::string& region, std::vector<std::string>& not_measured) {
    std::vector<std::string> out;
    for (const auto& [name, m] : result.arms[0].region(region).meters) {
        const bool any = std::any_of(result.arms.begin(), result.arms.end(),
            [&](const ArmResult& arm) { return arm.region(region).meter(name).value.has_value(); });
        if (any) out.push_back(name);
        else not_measured.push_back(fmt::format("{} ({})", title_of(name), escape(m.why)));
    }
    return out;
}

std::string region_table(const PixelSet& set, const CompareResult& result, std::vector<std::string>& not_measured) {
    const std::vector<std::string> meters = measured(result, set.name, not_measured);
    std::vector<html::Cell> head{words("arm"), {"renders", true}};
    for (const std::string& name : meters) head.push_back({title_of(name), true});
    const std::string caption = set.name == whole_frame
        ? "Whole frame (a footnote: it mixes regions that err for different reasons)"
        : fmt::format("<b>{}</b>, {} pixels", escape(set.name), set.pixels.size());
    html::Table table(caption, head);
    for (const ArmResult& arm : result.arms) {
        std::vector<html::Cell> row{html::heading(escape(arm.name)), html::figure(std::to_string(arm.renders))};
        for (const std::string& name : meters) row.push_back({cell(arm.region(set.name).meter(name)), true});
        table.row(row);
    }
    return "<div class=\"wide\">" + table.str() + "</div>\n";
}

std::string remarks(const PixelSet& set, const CompareResult& result) {
    std::string out;
    for (const ArmResult& arm : result.arms) {
        const RegionResult& r = arm.region(set.name);
        if (r.heavy())
            out += html::p(fmt::format("{} in {}: {}; the largest squared error is {} of their sum. {}",
                escape(arm.name), escape(set.name), html::heavy_tail(), percent(r.largest_share),
                r.renders_needed
                    ? fmt::format(
                          "From about {:.0f} renders on it would be a twentieth, and an interval could be said.",
                          *r.renders_needed)
                    : "From how many renders on an interval could be said is not known: the mean of such errors "
                      "does not settle over those that are here."));
        if (r.told_ratio)
            out += html::p(fmt::format("{} in {}: the renderer’s own variance is {} times that over renders.",
                escape(arm.name), escape(set.name), html::value(figures(*r.told_ratio, 3))));
    }
    return out;
}

}  // namespace

std::string numbers_section(const ComparePlan& plan, const Readings& all, const CompareResult& result) {
    std::string out = fmt::format(
        "<p>Each number is of one render, the mean over the arm’s renders; below it the 95 % interval of that mean "
        "(Student’s t "
        "over renders; bias² by the jackknife). <i>Heavy tail</i> stands where a few pixels decide the mean of "
        "squares, so that "
        "no interval would mean anything. Bias² is the MSE without the variance; noise may bring it below 0. Of relMSE "
        "and MAPE {} "
        "was trimmed. FLIP is the one measure of pictures, after a tone map.</p>\n",
        plan.trim > 0 ? percent(plan.trim) + " of the pixels, the largest," : "nothing");
    std::vector<std::string> not_measured;
    for (const PixelSet& set : all.regions) {
        not_measured.clear();
        out += region_table(set, result, not_measured) + remarks(set, result);
    }
    if (!not_measured.empty()) out += html::p("Not measured: " + html::join(not_measured) + ".");
    if (all.reference) out += html::p("The reference’s own error: " + escape(result.reference_error_from) + ".");
    return out;
}

std::string rankings_section(const CompareResult& result) {
    std::vector<std::string> said;
    for (const Ranking& r : result.rankings) said.push_back(escape(r.sentence));
    return said.empty() ? "" : html::p("Arms whose intervals overlap are not ranked.") + html::list(said);
}

std::string ladders_section(const CompareResult& result) {
    std::string out;
    if (result.ladders.empty()) return out;
    for (std::size_t r = 0; r < result.arms[0].regions.size(); ++r) {
        const std::string& region = result.arms[0].regions[r].region;
        const char* what = rung_words(result.arms[0].regions[r]);
        std::vector<double> xs, ys;
        for (const SppLadder& l : result.ladders)
            for (const std::size_t a : l.arms) {
                xs.push_back(*result.arms[a].spp);
                const MeterValue m = rung_of(result.arms[a].regions[r]);
                if (m.value) ys.push_back(*m.value);
                if (m.interval) ys.push_back(m.interval->first), ys.push_back(m.interval->second);
            }
        Chart chart(520, 280, log_axis("samples a pixel", xs), log_axis(what, ys), "Ladder of " + region);
        std::vector<std::string> slopes;
        for (std::size_t k = 0; k < result.ladders.size(); ++k) {
            const SppLadder& l = result.ladders[k];
            const std::string colour = fmt::format("c{}", k % 6);
            std::vector<Point> line;
            for (const std::size_t a : l.arms) {
                const MeterValue m = rung_of(result.arms[a].regions[r]);
                if (!m.value) continue;
                line.push_back({*result.arms[a].spp, *m.value});
                if (m.interval) chart.bar(*result.arms[a].spp, m.interval->first, m.interval->second, colour);
            }
            if (line.empty()) continue;
            chart.line(line, colour), chart.dots(line, colour), chart.name(line.back(), l.name, colour);
            const MeterValue& s = l.slopes[r].second;
            if (s.value)
                slopes.push_back(
                    fmt::format("{} falls as N to the power {}{}", escape(l.name), html::value(figures(*s.value, 3)),
                        s.interval ? fmt::format(" ({} … {})", html::number(figures(s.interval->first, 3)),
                                         html::number(figures(s.interval->second, 3)))
                                   : ""));
        }
        out += fmt::format(
            "<figure>{}<figcaption>Region {}. The {} of {}. Independent samples alone fall as N to the power −0.5; "
            "less is a bias or a tail.</figcaption></figure>\n",
            chart.str(), escape(region), what, html::join(slopes));
    }
    return out;
}

std::string files_section(const Readings& all, const CompareResult& result) {
    html::Table table("Renders",
        {words("arm"), words("file"), words("layer"), words("variance from"), {"mean <i>Y</i>", true}, {"spp", true},
            {"seconds", true}});
    const auto row = [&](const std::string& arm, const RenderFile& f, double y) {
        table.row({html::heading(escape(arm)), words(html::code(f.path)), words(escape(f.layer)),
            words(escape(f.variance_channels)), html::figure(figures(y)), html::figure(f.spp ? figures(*f.spp) : ""),
            html::figure(f.seconds ? figures(*f.seconds) : "")});
    };
    for (std::size_t a = 0; a < all.arms.size(); ++a)
        for (std::size_t k = 0; k < all.arms[a].files.size(); ++k)
            row(result.arms[a].name, all.arms[a].files[k], all.arms[a].regions[k].back().y);
    if (all.reference)
        for (std::size_t k = 0; k < all.reference->files.size(); ++k)
            row("reference", all.reference->files[k], all.reference->regions[k].back().y);
    std::vector<std::string> warnings;
    for (const std::string& w : result.warnings) warnings.push_back(escape(w));
    return "<div class=\"wide\">" + table.str() + "</div>\n" +
        (warnings.empty() ? "" : "<h3>Warnings</h3>\n" + html::list(warnings));
}

}  // namespace crescent::inline comparing
