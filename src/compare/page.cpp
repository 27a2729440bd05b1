// report.html of a comparison: the findings, the metrics with their intervals, the pictures, the spectra, the files.
#include "compare/outputs.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>

#include "compare/compare.h"
#include "compare/metrics.h"
#include "compare/plan.h"
#include "output/charts.h"
#include "output/format.h"
#include "output/html.h"

namespace crescent::inline comparison {

namespace {

using html::words;

std::string lead(const CompareResult& result) {
    std::string out;
    if (!result.sentence.empty())
        out += html::element("p",
                   result.state == CompareResult::State::fails ? "class=\"verdict bad\"" : "class=\"verdict\"",
                   escape(result.sentence)) +
            "\n";
    else if (!result.assertions.empty()) out += "<p class=\"verdict good\">All assertions hold.</p>\n";
    std::vector<std::string> found;
    for (const std::string& sentence : found_about_means(result))
        if (sentence != result.sentence) found.push_back(escape(sentence));
    return out + (found.empty() ? "" : html::list(found));
}

/// All plates except the ladders, which are charts in their own section.
std::string pictures(const std::map<std::string, std::vector<unsigned char>>& plates) {
    std::string out;
    for (const auto& [name, png] : plates)
        if (name != "ladders")
            out += fmt::format(
                "<figure id=\"{0}\"><img alt=\"{0}\" width=\"1280\" height=\"720\" src=\"data:image/png;base64,{1}\" "
                "/></figure>\n",
                escape(name), base64(png));
    return out;
}

std::string assertions(const CompareResult& result) {
    if (result.assertions.empty()) return {};
    html::Table table("Assertions", {words("name"), words("claim"), {"left", true}, {"right", true}, words("verdict")});
    for (const AssertionResult& a : result.assertions)
        table.row({html::heading(escape(a.name)), words(html::code(a.text)), html::figure(figures(a.measured)),
            html::figure(figures(a.bound)), words(a.pass ? "holds" : "<b class=\"bad\">FAILS</b>")});
    return table.str();
}

}  // namespace

std::string compare_html(const ComparePlan& plan, const RenderStats& all, const CompareResult& result,
    const Provenance& provenance, const std::map<std::string, std::vector<unsigned char>>& plates) {
    PageFrame frame;
    frame.title_text = plan.title;
    frame.kicker_text = "renders compared";
    frame.version_text = provenance.version;
    frame.lead_html = lead(result);
    frame.footer_html =
        fmt::format("Made by crescent {}: {}", escape(provenance.version), html::code(provenance.command));
    return page_html(frame,
        {{"numbers", "How large the error is", numbers_section(plan, all, result)},
            {"rankings", "Which is better?", rankings_section(result)},
            {"bias", "Do they agree on the mean?", means_section(result)}, {"pictures", "Where", pictures(plates)},
            {"noise", "Where did the noise move?", noise_section(result)},
            {"ladders", "Over samples a pixel", ladders_section(result)},
            {"spectra", "What the noise is like", spectra_section(all, result)},
            {"assertions", "Assertions", assertions(result)}, {"files", "What was read", files_section(all, result)}});
}

// ---- The sections of a comparison's page about means and noise: whether arms agree, where the noise differs, its
// spectra.

namespace {

using html::words;

std::vector<html::Cell> row_of(const std::string& name, const MeanTest& t, const std::string& verdict) {
    const bool tested = t.why.empty();
    return {html::heading(escape(name)), html::figure(figures(t.a)), html::figure(figures(t.b)),
        html::figure(tested ? figures(t.welch.p, 2) : ""), html::figure(tested ? percent(t.smallest, 2) : ""),
        words(verdict)};
}

/// Y of each region; below it the channels if one of them differs.
std::string region_table(const BiasResult& b) {
    html::Table table(fmt::format("{} and {}{}", escape(b.a), escape(b.b), b.paired ? ", in pairs" : ""),
        {words("region"), {"mean <i>Y</i>", true}, {"of the other", true}, {"<i>p</i>", true}, {"smallest found", true},
            words("verdict")});
    for (const MeanTest& t : b.regions) {
        const std::vector<std::string> in = t.differs_in();
        const bool channel = std::any_of(t.channels.begin(), t.channels.end(), [](auto& c) { return c.differs; });
        table.row(row_of(t.region, t,
            !in.empty()             ? fmt::format("<b class=\"bad\">differs in {}</b>", html::join(in))
                : !t.why.empty()    ? escape(t.why)
                : !t.caveat.empty() ? escape(t.caveat)
                : b.identical       ? "identical"
                                    : "no difference found"));
        for (const MeanTest& c : t.channels)
            if (channel)
                table.row(row_of(
                    t.region + ", mean " + c.region, c, c.differs ? "<b class=\"bad\">differs</b>" : escape(c.why)));
    }
    return table.str();
}

/// Returns the number of places that differ, by the quantity that differs the most in each: "Y 3, R 12".
std::string most_in(const std::vector<std::uint64_t>& by) {
    std::vector<std::string> out;
    for (std::size_t q = 0; q < by.size(); ++q)
        if (by[q]) out.push_back(fmt::format("{} {}", quantity_names[q], by[q]));
    return out.empty() ? "" : fmt::format(" (most in {})", html::join(out));
}

std::string places(const BiasResult& b) {
    std::string out;
    if (!b.tiles.p.empty())
        out += fmt::format("Tiles: {} tested, {} differ{}, {} left out.", b.tiles.tested, b.tiles.different,
            most_in(b.tiles_by), b.tiles.left_out);
    if (!b.pixel_p.empty())
        out +=
            fmt::format(" Pixels: {} tested, {} differ{}.", b.pixels_tested, b.pixels_different, most_in(b.pixels_by));
    if (b.shown() != 0)
        out += fmt::format(" The maps show {}, in which they differ, not <i>Y</i>.", quantity_names[b.shown()]);
    if (b.dependent && !out.empty()) out += " Neighbouring pixels’ noise is correlated: after Benjamini and Yekutieli.";
    return out.empty() ? "" : html::p(out);
}

/// The method of all pairs, stated once.
std::string method(const CompareResult& result) {
    std::string out =
        "Welch’s test over renders, of the mean <i>Y</i>, and of R, G and B where renders are in colour, of each "
        "region, tile and pixel; Student’s of the differences of pairs where renders share their random numbers. Half "
        "of a level is for <i>Y</i>, a sixth for each channel; false discoveries are "
        "controlled after Holm (regions) and Benjamini and Hochberg (tiles, pixels). Values that are not finite on one "
        "side alone are a difference. A tile is left out where one "
        "pixel "
        "of one render carries half of its spread. A difference that rare events in none of the renders could explain "
        "is not "
        "reported. <i>Smallest found</i>: the difference that would have been found with a probability of 90 %.";
    if (!result.reference_error_from.empty())
        out += " The reference’s own error: " + escape(result.reference_error_from) + ".";
    return html::p(out);
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
    return fmt::format(
        "<figure class=\"narrow\">{}<figcaption>Over pixels, p is spread evenly where nothing differs and noise is "
        "near normal; a heap at 0 is a difference, one in the middle or at 1 noise with rare bright "
        "events.</figcaption></figure>\n",
        histogram(percents(b.pixel_p, sum_of(b.pixel_p)), {}, x, "% of pixels", "Histogram of p over pixels"));
}

}  // namespace

std::string means_section(const CompareResult& result) {
    if (result.bias.empty()) return {};
    std::string out = method(result);
    for (const BiasResult& b : result.bias) out += region_table(b) + places(b) + pixel_histogram(b);
    return out;
}

std::string noise_section(const CompareResult& result) {
    std::string out;
    for (const NoiseResult& n : result.noise) {
        out += html::p(escape(n.sentence));
        for (const NoiseResult::Histogram& h : n.regions) {
            const double tiles = sum_of(h.different) + sum_of(h.rest);
            if (tiles == 0) continue;
            const Axis x{-noise_range, noise_range, false,
                fmt::format("log2 of the variance of {} over that of {}", n.a, n.b), {-4, -2, 0, 2, 4}};
            out += fmt::format(
                "<figure class=\"narrow\">{}<figcaption>Tiles of {}: coloured if the ratio differs from 1, grey "
                "if no difference was found; the outermost bins include all beyond.</figcaption></figure>\n",
                histogram(percents(h.different, tiles), percents(h.rest, tiles), x, "% of tiles",
                    "Histogram of the variance ratio"),
                escape(h.region));
        }
    }
    return out;
}

std::string spectra_section(const RenderStats& all, const CompareResult& result) {
    std::string out;
    for (const PixelSet& set : all.regions) {
        std::vector<double> values;
        for (const ArmResult& arm : result.arms)
            for (const double p : arm.region(set.name).power)
                if (p > 0) values.push_back(p);
        if (values.empty()) continue;
        Axis x{1, static_cast<double>(spectrum_bins), false, "frequency, cycles in 32 pixels", {1, 4, 8, 12, 16}};
        Chart chart(520, 240, x, log_axis("power of the error of Y", values), "Error spectrum");
        std::vector<std::string> message;
        for (std::size_t a = 0; a < result.arms.size(); ++a) {
            const RegionResult& r = result.arms[a].region(set.name);
            std::vector<Point> line;
            for (std::size_t k = 0; k < r.power.size(); ++k) line.push_back({static_cast<double>(k + 1), r.power[k]});
            if (line.empty()) continue;
            const std::string colour = fmt::format("c{}", a % 6);
            chart.line(line, colour), chart.name(line.back(), result.arms[a].name, colour);
            message.push_back(fmt::format("{}: {} noise", escape(result.arms[a].name), to_string(r.colour)));
        }
        out += fmt::format(
            "<figure>{}<figcaption>Region {}. {}. White noise is level; blue noise rises to the right; filtered noise "
            "falls.</figcaption></figure>\n",
            chart.str(), escape(set.name), html::join(message));
    }
    return out;
}

// ---- The sections of a comparison's page with numbers: metrics with their intervals, rankings, ladders, files.

namespace {

using html::words;

std::string cell(const MetricValue& m) {
    if (!m.value) return html::element("span", fmt::format("title=\"{}\"", escape(m.why)), "–");
    std::string out = html::value(figures(*m.value));
    if (m.interval)
        out += fmt::format("<br /><small>{} … {}</small>", html::number(figures(m.interval->first, 3)),
            html::number(figures(m.interval->second, 3)));
    else if (m.why == "heavy tail") out += "<br /><small>" + html::heavy_tail() + "</small>";
    return out;
}

const char* title_of(const std::string& metric) {
    static const std::map<std::string, const char*> titles = {{"rmse", "RMSE"}, {"var", "variance"}, {"bias2", "bias²"},
        {"relmse", "relMSE"}, {"mape", "MAPE"}, {"fireflies", "fireflies"}, {"y_mean", "mean <i>Y</i>"},
        {"flip", "HDR-FLIP"}, {"flip_ldr", "LDR-FLIP"}, {"efficiency", "efficiency"},
        {"unit_time", "s to unit variance"}, {"sample_var", "variance of a sample"}};
    const auto it = titles.find(metric);
    return it == titles.end() ? "" : it->second;
}

/// Returns the metrics that some arm has; adds the others with their reasons to `not_measured`.
std::vector<std::string> measured(
    const CompareResult& result, const std::string& region, std::vector<std::string>& not_measured) {
    std::vector<std::string> out;
    for (const auto& [name, m] : result.arms[0].region(region).metrics) {
        const bool any = std::any_of(result.arms.begin(), result.arms.end(),
            [&](const ArmResult& arm) { return arm.region(region).metric(name).value.has_value(); });
        if (any) out.push_back(name);
        else not_measured.push_back(fmt::format("{} ({})", title_of(name), escape(m.why)));
    }
    return out;
}

std::string region_table(const PixelSet& set, const CompareResult& result, std::vector<std::string>& not_measured) {
    const std::vector<std::string> metrics = measured(result, set.name, not_measured);
    std::vector<html::Cell> head{words("arm"), {"renders", true}};
    for (const std::string& name : metrics) head.push_back({title_of(name), true});
    const std::string caption = set.name == whole_frame
        ? "Whole frame (a footnote: it mixes regions that err for different reasons)"
        : fmt::format("<b>{}</b>, {} pixels", escape(set.name), set.pixels.size());
    html::Table table(caption, head);
    for (const ArmResult& arm : result.arms) {
        std::vector<html::Cell> row{html::heading(escape(arm.name)), html::figure(std::to_string(arm.renders))};
        for (const std::string& name : metrics) row.push_back({cell(arm.region(set.name).metric(name)), true});
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
                    ? fmt::format("With about {:.0f} renders it would be a twentieth, and an interval could be given.",
                          *r.renders_needed)
                    : "How many renders an interval needs is unknown: the mean of such errors does not "
                      "converge over these renders."));
        if (r.stated_ratio)
            out += html::p(fmt::format("{} in {}: the renderer’s own variance is {} times that over renders.",
                escape(arm.name), escape(set.name), html::value(figures(*r.stated_ratio, 3))));
    }
    return out;
}

}  // namespace

std::string numbers_section(const ComparePlan& plan, const RenderStats& all, const CompareResult& result) {
    std::string out = fmt::format(
        "<p>Each number is of one render, the mean over the arm’s renders; below it the 95 % interval of that mean "
        "(Student’s t "
        "over renders; bias² by the jackknife). <i>Heavy tail</i> means that a few pixels decide the mean of "
        "squares, so that "
        "no interval is meaningful. Bias² is the MSE without the variance; noise may bring it below 0. Of relMSE "
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
    std::vector<std::string> message;
    for (const Ranking& r : result.rankings) message.push_back(escape(r.sentence));
    return message.empty() ? "" : html::p("Arms whose intervals overlap are not ranked.") + html::list(message);
}

std::string ladders_section(const CompareResult& result) {
    std::string out;
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
        std::vector<std::string> slopes;
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

std::string files_section(const RenderStats& all, const CompareResult& result) {
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

}  // namespace crescent::inline comparison
