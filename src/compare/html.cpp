// report.html of a comparison: what was found, the numbers with their doubt, the pictures, the spectra, the files.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/base64.h"
#include "compare/outputs.h"
#include "compare/schema.h"
#include "report/charts.h"
#include "report/html.h"
#include "report/numbers.h"
#include "report/style.h"

namespace crescent {

namespace {

using html::words;

constexpr const char* frame = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8" />
<meta name="viewport" content="width=device-width, initial-scale=1" />
<meta name="color-scheme" content="light dark" />
<title>{title}</title>
<style>{style}</style>
</head>
<body>
<header>
<p class="kicker">crescent · renders compared</p>
<h1>{title}</h1>
{lead}
</header>
<main id="main">
{sections}</main>
<footer>
<p class="footnote">Made by crescent {version}: <code>{command}</code></p>
</footer>
</body>
</html>
)";

std::string section(const std::string& id, const std::string& title, const std::string& html) {
    if (html.empty()) return {};
    return fmt::format(
        "<section id=\"{0}\" aria-labelledby=\"{0}-title\">\n<h2 id=\"{0}-title\">{1}</h2>\n{2}</section>\n", id, title,
        html);
}

std::string lead(const CompareResult& result) {
    std::string out;
    if (!result.say.empty())
        out += html::element("p",
                   result.state == CompareResult::State::fails ? "class=\"verdict bad\"" : "class=\"verdict\"",
                   escape(result.say)) +
            "\n";
    else if (!result.assertions.empty()) out += "<p class=\"verdict good\">All assertions hold.</p>\n";
    std::vector<std::string> found;
    for (const BiasResult& b : result.bias) found.push_back(escape(b.sentence));
    return out + (found.empty() ? "" : html::list(found));
}

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
        {"flip", "FLIP"}, {"efficiency", "efficiency"}};
    const auto it = titles.find(meter);
    return it == titles.end() ? "" : it->second;
}

std::string numbers(const Readings& all, const CompareResult& result) {
    std::string out =
        "<p>Each number is of one render, the mean over the arm’s renders; below it the 95 % interval of that mean "
        "(Student’s t over "
        "renders; bias² by the jackknife). <i>Heavy tail</i> stands where a few pixels decide the mean of squares, so "
        "that no interval would mean anything. "
        "Bias² is the MSE without the variance; noise may bring it below 0. FLIP is the one measure of pictures, after "
        "a tone map.</p>\n";
    for (const PixelSet& set : all.regions) {
        std::vector<html::Cell> head{words("arm"), {"renders", true}};
        for (const auto& [name, m] : result.arms[0].region(set.name).meters) head.push_back({title_of(name), true});
        const bool footnote = set.name == whole_frame;
        html::Table table(footnote ? "Whole frame (a footnote: it mixes regions that err for different reasons)"
                                   : fmt::format("<b>{}</b>, {} pixels", escape(set.name), set.pixels.size()),
            head);
        for (const ArmResult& arm : result.arms) {
            std::vector<html::Cell> row{html::heading(escape(arm.name)), html::figure(std::to_string(arm.renders))};
            for (const auto& [name, m] : arm.region(set.name).meters) row.push_back({cell(m), true});
            table.row(row);
        }
        out += "<div class=\"wide\">" + table.str() + "</div>\n";
    }
    return out;
}

std::string bias(const CompareResult& result) {
    std::string out;
    for (const BiasResult& b : result.bias) {
        html::Table table(fmt::format("{} and {}{}", escape(b.a), escape(b.b), b.paired ? ", in pairs" : ""),
            {words("region"), {"mean <i>Y</i>", true}, {"of the other", true}, {"<i>p</i>", true},
                {"smallest seen", true}, words("verdict")});
        for (const MeanTest& t : b.regions) {
            const bool tested = t.why.empty();
            table.row({html::heading(escape(t.region)), html::figure(figures(t.a)), html::figure(figures(t.b)),
                html::figure(tested ? figures(t.welch.p, 2) : ""), html::figure(tested ? percent(t.smallest, 2) : ""),
                words(!tested       ? escape(t.why)
                        : t.differs ? "<b class=\"bad\">differs</b>"
                                    : "no difference found")});
        }
        out += table.str();
        if (b.tile_p.empty()) continue;
        out += html::p(
            fmt::format("Tiles: {} tested by Welch’s test over renders, {} differ (false discoveries controlled after "
                        "{}), {} left out because one pixel of one render carries half of their spread. A difference "
                        "that eight of the largest errors seen would make up counts as none.",
                b.tiles_tested, b.tiles_different,
                b.dependent ? "Benjamini and Yekutieli: neighbouring pixels’ noise is correlated"
                            : "Benjamini and Hochberg",
                b.tiles_left_out));
        if (b.pixel_p.empty()) continue;
        Axis x{0, 1, false, "p of a pixel", {0, 0.2, 0.4, 0.6, 0.8, 1}};
        std::vector<double> counts(b.pixel_p.begin(), b.pixel_p.end()), middle, zero(10, 0.0);
        for (int k = 0; k < 10; ++k) middle.push_back(0.1 * k + 0.05);
        counts.push_back(0);
        Axis y = linear_axis("pixels", counts);
        counts.pop_back();
        Chart chart(420, 200, x, y, "Histogram of p over pixels");
        chart.band(middle, zero, counts, "c1");
        out += "<figure class=\"narrow\">" + chart.str() +
            "<figcaption>Over pixels, p is spread evenly where nothing differs and noise is near normal; a heap at 0 "
            "is a difference, a heap at 1 heavy-tailed noise.</figcaption></figure>\n";
    }
    return out;
}

std::string spectra(const Readings& all, const CompareResult& result) {
    std::string out;
    for (const PixelSet& set : all.regions) {
        std::vector<double> values;
        for (const ArmResult& arm : result.arms)
            for (const double p : arm.region(set.name).power)
                if (p > 0) values.push_back(p);
        if (values.empty()) continue;
        Axis x{1, static_cast<double>(spectrum_bins), false, "frequency, cycles in 32 pixels", {1, 4, 8, 12, 16}};
        Chart chart(520, 240, x, log_axis("power of the error of Y", values), "Error spectrum");
        std::vector<std::string> said;
        for (std::size_t a = 0; a < result.arms.size(); ++a) {
            const RegionResult& r = result.arms[a].region(set.name);
            std::vector<Point> line;
            for (std::size_t k = 0; k < r.power.size(); ++k) line.push_back({static_cast<double>(k + 1), r.power[k]});
            if (line.empty()) continue;
            const std::string colour = fmt::format("c{}", a % 6);
            chart.line(line, colour), chart.name(line.back(), result.arms[a].name, colour);
            said.push_back(fmt::format("{}: {} noise", escape(result.arms[a].name), to_string(r.colour)));
        }
        out += fmt::format(
            "<figure>{}<figcaption>Region {}. {}. White noise is level; blue noise rises to the right; filtered noise "
            "falls.</figcaption></figure>\n",
            chart.str(), escape(set.name), html::join(said));
    }
    return out;
}

std::string pictures(const std::map<std::string, std::vector<unsigned char>>& plates) {
    std::string out;
    for (const auto& [name, png] : plates)
        out += fmt::format(
            "<figure id=\"{0}\"><img alt=\"{0}\" width=\"1280\" height=\"720\" src=\"data:image/png;base64,{1}\" "
            "/></figure>\n",
            escape(name), base64(png));
    return out;
}

std::string files(const Readings& all, const CompareResult& result) {
    html::Table table("Renders",
        {words("arm"), words("file"), words("layer"), {"mean <i>Y</i>", true}, {"spp", true}, {"seconds", true}});
    for (std::size_t a = 0; a < all.arms.size(); ++a)
        for (std::size_t k = 0; k < all.arms[a].files.size(); ++k) {
            const RenderFile& f = all.arms[a].files[k];
            table.row({html::heading(escape(result.arms[a].name)), words(html::code(f.path)), words(escape(f.layer)),
                html::figure(figures(all.arms[a].regions[k].back().y)), html::figure(f.spp ? figures(*f.spp) : ""),
                html::figure(f.seconds ? figures(*f.seconds) : "")});
        }
    std::vector<std::string> warnings;
    for (const std::string& w : result.warnings) warnings.push_back(escape(w));
    return table.str() + (warnings.empty() ? "" : "<h3>Warnings</h3>\n" + html::list(warnings));
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

std::string compare_html(const ComparePlan& plan, const Readings& all, const CompareResult& result,
    const Provenance& provenance, const std::map<std::string, std::vector<unsigned char>>& plates) {
    const std::string sections = section("numbers", "How large the error is", numbers(all, result)) +
        section("bias", "Do they agree on the mean?", bias(result)) + section("pictures", "Where", pictures(plates)) +
        section("spectra", "What the noise is like", spectra(all, result)) +
        section("assertions", "Assertions", assertions(result)) + section("files", "What was read", files(all, result));
    return fmt::format(frame, fmt::arg("title", escape(plan.title)), fmt::arg("style", style_sheet),
        fmt::arg("lead", lead(result)), fmt::arg("sections", sections), fmt::arg("version", escape(provenance.version)),
        fmt::arg("command", escape(provenance.command)));
}

}  // namespace crescent
