// RMSE against N with the fitted slope, and the exponent control. Ladders are prefixes of one stream of samples.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "experiment/arm_facts.h"
#include "report/page.h"

namespace crescent::inline report {
namespace {

using html::words;

constexpr const char* ladder_prose = R"(
<p>The samples of a rung are the first samples of the next. Where the variance of a sample is finite the
error falls as <i>N</i><sup>−1/2</sup>, the dashed line. Fitted is {law} by least squares on the logarithms, at the
{seed} seed; the interval is {interval}. A heavy tail breaks the law: the rungs then jump whenever a
rare sample arrives, and the slope depends on the seed more than on the arm.</p>
)";

constexpr const char* exponent_prose = R"(
<p>The control runs {arm} again at <i>N</i> = {n} with other exponents. The exponent changes in the density, in the BRDF
of {shape} and in the reference alike, so each column is measured against its own truth. A wider lobe sends more samples
under the horizon, a narrower one leaves more of the hemisphere to chance.</p>
)";

std::vector<const Ladder*> ladders_in(const Page& page, const std::string& region) {
    std::vector<const Ladder*> all;
    for (const Ladder& l : page.in.metrics.ladders)
        if (l.region == region && l.n.size() > 1 && l.n.size() == l.rmse.size()) all.push_back(&l);
    return all;
}

std::string slope_interval(const Ladder& l) {
    if (l.heavy) return html::heavy_tail();
    if (!std::isfinite(l.low) || !std::isfinite(l.high)) return "–";
    return html::value(fmt::format("{:.3f} … {:.3f}", l.low, l.high));
}

std::vector<Point> points_of(const Ladder& l) {
    std::vector<Point> points;
    for (std::size_t i = 0; i < l.n.size(); ++i) points.push_back({static_cast<double>(l.n[i]), l.rmse[i]});
    return points;
}

std::vector<Point> published_of(const Page& page, const Ladder& l) {
    std::vector<Point> points;
    for (const std::uint64_t n : l.n)
        if (const BandMeter* band = page.find.band(l.arm, n, "rmse." + l.region, l.s); band && band->published)
            points.push_back({static_cast<double>(n), *band->published});
    return points;
}

/// RMSE = c N^(-1/2) through the first point, over the whole axis.
std::vector<Point> guide(const Point& first, const Axis& x) {
    return {{x.low, first.y * std::sqrt(first.x / x.low)}, {x.high, first.y * std::sqrt(first.x / x.high)}};
}

std::string ladder_chart(const Page& page, const std::string& region) {
    const auto all = ladders_in(page, region);
    std::vector<double> ns, values;
    for (const Ladder* l : all)
        for (const Point& p : points_of(*l)) ns.push_back(p.x), values.push_back(p.y);
    for (const Ladder* l : all)
        for (const Point& p : published_of(page, *l)) values.push_back(p.y);
    Axis x = log_axis("N, samples per pixel", ns);
    x.ticks.assign(ns.begin(), ns.end());
    std::sort(x.ticks.begin(), x.ticks.end());
    x.ticks.erase(std::unique(x.ticks.begin(), x.ticks.end()), x.ticks.end());
    x.high *= 2.2;  // room for names at the ends of lines
    Chart chart(420, 330, x, log_axis(meter_text("rmse." + region), values), "RMSE against N in region " + region);
    for (const Ladder* l : all) {
        const auto points = points_of(*l);
        const std::string colour = page.colour(l->arm);
        if (points.front().y > 0)
            chart.line(guide(points.front(), {x.low, x.high / 2.2, true, "", {}}), "dashed " + colour);
        chart.line(points, colour);
        chart.dots(points, colour);
        chart.diamonds(published_of(page, *l), colour);
        chart.name(points.back(), l->arm, colour);
    }
    return chart.str();
}

std::string arm_of(const Ladder& l, const Page& page) {
    const ArmPlan* arm = page.in.experiment.find_arm(l.arm);
    const bool biased = arm && !missed_light(*arm, page.in.experiment).empty();
    return escape(l.arm) + (biased ? "<small>biased: it stops falling</small>" : "");
}

std::string slope_table(const Page& page) {
    html::Table table(
        "Fitted slopes of log RMSE on log <i>N</i>; −0.5 where the variance is finite and no light is missed",
        {words("Region"), words("Arm"), {"<i>s</i>", true}, {"Slope", true}, {"5–95 %", true}});
    for (const Ladder& l : page.in.metrics.ladders)
        if (l.n.size() > 1)
            table.row({html::heading(escape(l.region)), words(arm_of(l, page)),
                html::figure(tells_s(l.arm, l.s, page.in.experiment) ? shortest(l.s) : ""),
                html::figure(std::isfinite(l.slope) ? fmt::format("{:.3f}", l.slope) : "–"),
                {slope_interval(l), true}});
    return table.str();
}

}  // namespace

PageSection ladders(Page& page) {
    std::string charts;
    for (const Region& region : page.in.experiment.regions)
        if (!ladders_in(page, region.name).empty()) charts += ladder_chart(page, region.name);
    if (charts.empty()) return {};
    const std::string published = page.find.anything_published() ? " Diamonds: published values." : "";
    std::string out = fmt::format(ladder_prose, fmt::arg("law", mathml::in_line(mathml::power_law())),
        fmt::arg("seed", page.seed_name()),
        fmt::arg("interval",
            page.in.experiment.seeds > 1 ? "the <span class=\"v\">5–95 %</span> band of the same fit over seeds"
                                         : "the fit’s own, from its residuals; two rungs leave none"));
    out += page.figures.chart("<div class=\"pair\">" + charts + "</div>",
        "RMSE against <i>N</i> at the " + page.seed_name() +
            " seed, by region. Dashed: the −1/2 law through each arm’s first rung." + published,
        "metrics.json, ladders");
    return {"ladders", "Ladders in N", out + slope_table(page) + page.figures.plates(PlateKind::ladder)};
}

PageSection exponent(Page& page) {
    const auto& control = page.in.experiment.exponent;
    if (!control) return {};
    std::vector<Column> columns;
    for (const double s : control->s) columns.push_back({"<i>s</i> = " + shortest(s), control->arm, control->n, s});
    const std::string table = meters_table(page,
        fmt::format("{} at <i>N</i> = {} by exponent. Large: at the {} seed. Small: median, 5–95 % band and tail index",
            escape(control->arm), control->n, page.seed_name()),
        columns);
    if (table.empty()) return {};
    return {"exponent", "Exponent control",
        fmt::format(exponent_prose, fmt::arg("arm", escape(control->arm)), fmt::arg("n", control->n),
            fmt::arg("shape", "<b>" + escape(control->shape) + "</b>")) +
            table + page.figures.plates(PlateKind::exponent)};
}

}  // namespace crescent::inline report
