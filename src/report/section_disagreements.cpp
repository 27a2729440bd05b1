// Published values that the bands of this run do not hold, and what stands between the two. The reasons that are given
// are those for which this run has the numbers; docs/scene.md tells how the geometry was inferred.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "math/functions.h"
#include "report/arm_words.h"

namespace crescent::inline report {
namespace {

using html::words;

std::string signed_percent(double fraction) {
    const double tenths = std::round(1000 * fraction);
    return html::value(tenths == 0 ? "0.0 %" : fmt::format("{:+.1f} %", tenths / 10));
}

std::optional<double> relative(const BandMeter* b) {
    if (!b || !b->published || *b->published == 0) return {};
    return b->band.median / *b->published - 1;
}

/// "18 to 22 % below", for deviations of one sign; empty where the signs differ or nothing was published.
std::string spread(const std::vector<double>& all) {
    if (all.empty()) return {};
    const auto [low, high] = std::minmax_element(all.begin(), all.end());
    if (*low < 0 && *high > 0) return {};
    const double least = std::min(std::fabs(*low), std::fabs(*high)),
                 most = std::max(std::fabs(*low), std::fabs(*high));
    const std::string range = most - least < 0.005 ? fmt::format("{:.0f}", 100 * most)
                                                   : fmt::format("{:.0f} to {:.0f}", 100 * least, 100 * most);
    return range + " % " + (*low < 0 ? "below" : "above");
}

/// The broad arms in the highlight, and why the geometry cannot simply be changed to meet them.
std::string highlight_remark(const Page& page, const std::string& region) {
    std::string parts;
    bool below = true;
    for (const char* kind : {"rmse.", "var."}) {
        std::vector<double> all;
        for (const ArmPlan* arm : arms_about_normal(page.in.experiment))
            if (const auto r = relative(page.find.band(arm->name, page.find.headline_n(), kind + region)))
                all.push_back(*r);
        const std::string range = spread(all);
        if (range.empty()) continue;
        below = below && all.front() < 0;
        parts += (parts.empty() ? "" : ", ") + meter_html(kind + region) + " " + range;
    }
    if (parts.empty()) return {};
    std::string out = "For the arms that do not follow the lobe, medians against the published values: " + parts + ".";
    const auto& control = page.in.experiment.exponent;
    if (!below || !control || control->s.empty()) return out;
    const double s = *std::max_element(control->s.begin(), control->s.end());
    const auto mean = relative(page.find.band(control->arm, control->n, "y_mean", s));
    if (mean && *mean > 0)
        out += fmt::format(
            " Matching them would need a highlight of more pixels, i.e. a larger {}, which would raise {} at <i>s</i> "
            "= {} further; it is {} already. No single geometry matches both.",
            escape(control->shape), meter_html("y_mean"), shortest(s), signed_percent(*mean));
    return out;
}

/// Deviations of one meter over the exponent control.
std::string exponent_remark(const Page& page, const std::string& meter) {
    const auto& control = page.in.experiment.exponent;
    if (!control) return {};
    std::string values;
    for (const double s : control->s)
        if (const auto r = relative(page.find.band(control->arm, control->n, meter, s)))
            values += fmt::format("{}{} at <i>s</i> = {}", values.empty() ? "" : ", ", signed_percent(*r), shortest(s));
    if (values.empty()) return {};
    return fmt::format("For {}, {}: {}.", escape(control->arm), meter_html(meter), values);
}

/// Largest departure of log RMSE from the -1/2 law, as a fraction.
double departure(const std::vector<std::uint64_t>& n, const std::vector<double>& rmse) {
    double mean = 0, worst = 0;
    for (std::size_t i = 0; i < n.size(); ++i)
        mean += math::log(rmse[i] * std::sqrt(static_cast<double>(n[i]))) / static_cast<double>(n.size());
    for (std::size_t i = 0; i < n.size(); ++i)
        worst = std::max(worst, std::fabs(math::log(rmse[i] * std::sqrt(static_cast<double>(n[i]))) - mean));
    return worst;
}

std::vector<double> ladder_of(const Page& page, const ArmPlan& arm, const std::string& region, std::uint32_t seed) {
    std::vector<double> out;
    for (const std::uint64_t n : arm.n) {
        const RunMeter* run = page.find.run({arm.name, n, page.find.s(), seed});
        const RegionMeter* meter = run ? run->region(region) : nullptr;
        if (!meter || !(meter->rmse > 0)) return {};
        out.push_back(meter->rmse);
    }
    return out;
}

/// A published ladder smoother than most seeds give, for an arm with a heavy tail.
std::string smooth_ladder_remark(const Page& page, const ArmPlan& narrow, const std::string& region) {
    std::vector<double> published;
    for (const std::uint64_t n : narrow.n)
        if (const BandMeter* b = page.find.band(narrow.name, n, "rmse." + region); b && b->published)
            published.push_back(*b->published);
    if (published.size() < 3 || published.size() != narrow.n.size()) return {};
    const double limit = departure(narrow.n, published);
    int close = 0, of = 0;
    for (const std::uint32_t seed : page.in.provenance.seeds) {
        const auto ladder = ladder_of(page, narrow, region, seed);
        if (ladder.empty()) continue;
        ++of;
        if (departure(narrow.n, ladder) <= limit) ++close;
    }
    if (of < 2) return {};
    return fmt::format(
        "The published ladder of {} in {} strays from the −1/2 law by no more than {}. Of {} seeds here, {} keep as "
        "close: the others meet a rare bright sample on some rung.",
        escape(narrow.name), escape(region), percent(limit, 2), of, close);
}

/// A published rise of RMSE with N, for an arm whose square has no expectation.
std::string rise_remark(const Page& page, const ArmPlan& narrow, const std::string& region) {
    for (std::size_t i = 1; i < narrow.n.size(); ++i) {
        const BandMeter *a = page.find.band(narrow.name, narrow.n[i - 1], "rmse." + region),
                        *b = page.find.band(narrow.name, narrow.n[i], "rmse." + region);
        if (!a || !b || !a->published || !b->published || *b->published <= *a->published) continue;
        const double factor = *b->published / *a->published;
        int rose = 0, so_much = 0, of = 0;
        for (const std::uint32_t seed : page.in.provenance.seeds) {
            const auto ladder = ladder_of(page, narrow, region, seed);
            if (ladder.empty()) continue;
            ++of;
            rose += ladder[i] > ladder[i - 1];
            so_much += ladder[i] >= factor * ladder[i - 1];
        }
        if (of < 2) return {};
        return fmt::format(
            "From <i>N</i> = {} to {} the published {} of {} rises by a factor of {:.2f}. In {} of {} seeds here it "
            "rises, in {} by that much. With an infinite variance behind it, it need not fall.",
            narrow.n[i - 1], narrow.n[i], meter_html("rmse." + region), escape(narrow.name), factor, rose, of, so_much);
    }
    return {};
}

std::string remarks(const Page& page) {
    std::vector<std::string> all;
    const ArmPair pair = arm_pair(page);
    const ArmPlan *broad = pair.broad, *narrow = pair.narrow;
    if (pair) {
        const std::string hot = page.find.region_where_worst(broad->name, narrow->name, page.find.headline_n());
        const std::string cold = page.find.region_where_worst(narrow->name, broad->name, page.find.headline_n());
        if (!hot.empty()) all.push_back(highlight_remark(page, hot));
        if (!cold.empty() && cold != hot)
            if (const auto r = relative(page.find.band(broad->name, page.find.headline_n(), "rmse." + cold)))
                all.push_back(fmt::format(
                    "For {}, {}: {}.", escape(broad->name), meter_html("rmse." + cold), signed_percent(*r)));
        for (const char* meter : {"fireflies", "y_mean", "horizon_frac"}) all.push_back(exponent_remark(page, meter));
        if (!hot.empty()) all.push_back(smooth_ladder_remark(page, *narrow, hot));
        if (!cold.empty()) all.push_back(rise_remark(page, *narrow, cold));
    }
    std::erase_if(all, [](const std::string& remark) { return remark.empty(); });
    if (all.empty()) return {};
    return html::p("What can be said about them, medians over seeds against published values:") + html::list(all) +
        html::p(
            "The scene was not refitted to meet them. The geometry was inferred (<code>docs/scene.md</code>), and no "
            "geometry was "
            "found that meets every published figure.");
}

}  // namespace

PageSection disagreements(Page& page) {
    if (!page.find.anything_published()) return {};
    html::Table table("Published values outside the 5–95 % band of this run (meters with a heavy tail have no band)",
        {words("Meter"), words("Run"), {"Published", true}, {"Median", true}, {"5–95 %", true},
            {"Median against published", true}});
    std::size_t judged = 0, outside = 0;
    for (const BandMeter& b : page.in.metrics.bands) {
        if (!b.published || b.band.heavy || b.band.seeds < 2) continue;
        ++judged;
        if (*b.published >= b.band.q05 && *b.published <= b.band.q95) continue;
        ++outside;
        const auto off = relative(&b);
        table.row({html::heading(meter_html(b.meter)), words(run_html(b.key, page.in.experiment)),
            html::figure(figures_of(b.meter, *b.published)), html::figure(figures_of(b.meter, b.band.median)),
            {interval_html(b.meter, b.band), true}, {off ? signed_percent(*off) : "–", true}});
    }
    if (judged == 0) return {};
    std::string out = html::p(fmt::format("{} can be held against a band; {} of them fall{} outside it.",
        plural(judged, "published value"), outside, outside == 1 ? "s" : ""));
    if (outside > 0) out += table.str() + remarks(page);
    return {"disagreements", "Where note and scene disagree", out};
}

}  // namespace crescent::inline report
