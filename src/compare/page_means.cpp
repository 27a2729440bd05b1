// The sections of a comparison's page about means and noise: whether arms agree, where the noise moved, its spectra.
#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "compare/page.h"
#include "compare/quantities.h"
#include "pages/charts.h"
#include "pages/html.h"
#include "pages/numbers.h"

namespace crescent::inline comparing {

namespace {

using html::words;

std::vector<html::Cell> row_of(const std::string& name, const MeanTest& t, const std::string& verdict) {
    const bool tested = t.why.empty();
    return {html::heading(escape(name)), html::figure(figures(t.a)), html::figure(figures(t.b)),
        html::figure(tested ? figures(t.welch.p, 2) : ""), html::figure(tested ? percent(t.smallest, 2) : ""),
        words(verdict)};
}

/// Y of each region; below it the channels, where one of them differs.
std::string region_table(const BiasResult& b) {
    html::Table table(fmt::format("{} and {}{}", escape(b.a), escape(b.b), b.paired ? ", in pairs" : ""),
        {words("region"), {"mean <i>Y</i>", true}, {"of the other", true}, {"<i>p</i>", true}, {"smallest seen", true},
            words("verdict")});
    for (const MeanTest& t : b.regions) {
        const std::vector<std::string> in = t.differs_in();
        const bool channel = std::any_of(t.channels.begin(), t.channels.end(), [](auto& c) { return c.differs; });
        table.row(row_of(t.region, t,
            !in.empty()            ? fmt::format("<b class=\"bad\">differs in {}</b>", html::join(in))
                : !t.why.empty()   ? escape(t.why)
                : !t.doubt.empty() ? escape(t.doubt)
                : b.identical      ? "identical"
                                   : "no difference found"));
        for (const MeanTest& c : t.channels)
            if (channel)
                table.row(row_of(
                    t.region + ", mean " + c.region, c, c.differs ? "<b class=\"bad\">differs</b>" : escape(c.why)));
    }
    return table.str();
}

/// The places that differ by the quantity that differs the most in each: "Y 3, R 12".
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

/// What holds of every pair, once.
std::string method(const CompareResult& result) {
    std::string out =
        "Welch’s test over renders, of the mean <i>Y</i>, and of R, G and B where renders are in colour, of each "
        "region, tile and pixel; Student’s of the differences of pairs where renders share their random numbers. Half "
        "of a level is for <i>Y</i>, a sixth for each channel; false discoveries are "
        "controlled after Holm (regions) and Benjamini and Hochberg (tiles, pixels). Values that are not finite on one "
        "side alone are a difference. A tile is left out where one "
        "pixel "
        "of one render carries half of its spread. A difference that rare events which no render met could make up "
        "counts as none. <i>Smallest seen</i>: the difference that would have been found nine times out of ten.";
    if (!result.reference_error_from.empty())
        out += " The reference’s own error: " + escape(result.reference_error_from) + ".";
    return html::p(out);
}

double sum_of(const std::vector<std::uint64_t>& counts) {
    return static_cast<double>(std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}));
}

/// Counts in percent of `total`.
std::vector<double> percents(const std::vector<std::uint64_t>& counts, double total) {
    std::vector<double> out;
    for (const std::uint64_t count : counts) out.push_back(100 * static_cast<double>(count) / total);
    return out;
}

/// Steps: `counts` over equal bins from low to high; a second series stands on the first.
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
            const double tiles = sum_of(h.told) + sum_of(h.rest);
            if (tiles == 0) continue;
            const Axis x{-noise_range, noise_range, false,
                fmt::format("log2 of the variance of {} over that of {}", n.a, n.b), {-4, -2, 0, 2, 4}};
            out += fmt::format(
                "<figure class=\"narrow\">{}<figcaption>Tiles of {}: coloured where the ratio is told apart from 1, "
                "grey where not; the ends hold what lies beyond.</figcaption></figure>\n",
                histogram(percents(h.told, tiles), percents(h.rest, tiles), x, "% of tiles",
                    "Histogram of the variance ratio"),
                escape(h.region));
        }
    }
    return out;
}

std::string spectra_section(const Readings& all, const CompareResult& result) {
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

}  // namespace crescent::inline comparing
