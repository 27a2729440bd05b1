// The arms at one N, and the two ways in which they fail: the broad density on a small light, the narrow one on a broad
// integrand. The numbers determine which region shows which.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "experiment/queries.h"
#include "report/page.h"
#include "report/wording.h"

namespace crescent::inline report {
namespace {

/// Returns the arm's name and the remarks on its numbers.
std::string column_title(const ArmPlan& arm, const Experiment& e) {
    std::string out = escape(arm.name);
    if (techniques_of(arm) > 1) out += fmt::format("<small>{} rays a sample</small>", techniques_of(arm));
    if (!missed_light(arm, e).empty()) out += "<small>biased here</small>";
    return out;
}

std::string headline_table(const Page& page, std::uint64_t n) {
    const Experiment& e = page.in.experiment;
    std::vector<Column> columns;
    for (const ArmPlan& arm : e.arms)
        if (page.find.run(arm.name, n)) columns.push_back({column_title(arm, e), arm.name, n, page.find.s()});
    return metrics_table(page,
        fmt::format(
            "All arms at <i>N</i> = {}{}. Large: at the {} seed, {}. Small: median over {}, its 5–95 % band, and the "
            "tail index of the region’s samples",
            n, any_tells_s(e) ? ", <i>s</i> = " + shortest(page.find.s()) : "", page.seed_name(), e.seed,
            plural(static_cast<std::uint64_t>(e.seeds), "seed")),
        columns);
}

std::string frame_footnote(const Page& page, std::uint64_t n) {
    std::string values;
    for (const ArmPlan& arm : page.in.experiment.arms)
        if (const RunMetrics* run = page.find.run(arm.name, n))
            values += fmt::format(
                "{}{} {}", values.empty() ? "" : ", ", escape(arm.name), html::value(figures(run->rmse_frame)));
    if (values.empty()) return {};
    return html::element("p", "class=\"footnote\"",
               "Footnote: the RMSE of the whole frame, which mixes the regions, is " + values + ".") +
        "\n";
}

/// Returns one sentence for each other arm whose density is about the normal: how it compares with the best of them.
std::string broad_arms_sentence(const Page& page, const ArmPair& pair, const std::string& region) {
    std::string out;
    for (const ArmPlan* arm : arms_about_normal(page.in.experiment)) {
        if (arm == pair.broad) continue;
        const std::string sentence = ordering_sentence(page, arm->name, pair.broad->name, pair.n, region);
        if (!sentence.empty()) out += html::p("Of the arms about the normal: " + sentence);
    }
    return out;
}

std::string not_seen(const ArmPair& pair, const std::string& loser, const std::string& winner) {
    return html::p(
        fmt::format("In this run the failure does not show: at <i>N</i> = {} there is no region in which {}’s RMSE is "
                    "larger than {}’s.",
            pair.n, escape(loser), escape(winner)));
}

bool larger_in(
    const Page& page, const std::string& a, const std::string& b, std::uint64_t n, const std::string& region) {
    const auto of_a = page.find.rmse(a, n, region), of_b = page.find.rmse(b, n, region);
    return of_a && of_b && *of_a > *of_b;
}

constexpr const char* a_prose = R"(
<p>A small bright light fills little of the hemisphere. A density that spreads its rays over all of it rarely meets the
light; a ray that does has the weight of all those that missed. On a glossy highlight that ray also meets the lobe near
its peak, which the density does not follow, so one sample can weigh as much as {largest} with {broad}, in a picture
whose mean is {mean}. Most pixels are then too dark and a few far too bright. At <i>N</i> = {n} there are
{fireflies_broad} fireflies with {broad} and {fireflies_narrow} with {narrow}.</p>
)";

constexpr const char* b_prose = R"(
<p>A lobe about the mirror direction sends nearly all rays where the lobe is. A Lambert surface receives light from the
whole hemisphere, and light from the sides is met only by the few rays that go there. Each of those has the weight of
many that were not sent: the largest weighs {largest} with {narrow}. A pixel is too dark until one arrives, and then far
too bright. The mean of the frame shows it: for the same scene at <i>N</i> = {n}, <i>Y</i><sub>mean</sub> is
{mean_narrow} with {narrow} and {mean_broad} with {broad}.{lost}</p>
<p>On a Lambert surface the arm still aims about the mirror direction with the scene’s <i>s</i>: it samples the lobe for
any material.</p>
)";

/// Returns those of the two failures that this run does not show.
std::string failures_not_seen(const Page& page, const ArmPair& pair) {
    const std::string broad = pair.broad->name, narrow = pair.narrow->name;
    std::string out;
    if (!larger_in(page, broad, narrow, pair.n, page.find.region_where_worst(broad, narrow, pair.n)) &&
        !all_lights(page.in.experiment).empty())
        out += not_seen(pair, broad, narrow);
    if (!larger_in(page, narrow, broad, pair.n, page.find.region_where_worst(narrow, broad, pair.n)))
        out += not_seen(pair, narrow, broad);
    return out;
}

std::string lost_words(const Page& page) {
    if (page.in.evidence.lost.empty()) return {};
    return " Off the normal there is also light that it " + html::link("wrong-support", "can never find") + ".";
}

}  // namespace

PageSection results(Page& page) {
    const std::uint64_t n = page.find.headline_n();
    if (n == 0) return {};
    std::string out = page.figures.plates(PlateKind::columns) + headline_table(page, n);
    const ArmPair pair = arm_pair(page);
    std::vector<std::string> items;
    for (const Region& region : page.in.experiment.regions)
        if (pair) items.push_back(ordering_sentence(page, pair.broad->name, pair.narrow->name, pair.n, region.name));
    if (!items.empty()) out += html::p("Region by region:") + html::list(items);
    const std::string beside = ray_words(page.in.experiment) + bias_words(page.in.experiment);
    if (!beside.empty()) out += html::p(beside.substr(1));
    if (pair && !page.in.experiment.regions.empty()) out += failures_not_seen(page, pair);
    if (const std::uint64_t bad = page.find.bad_samples())
        out += html::p(
            fmt::format("<b class=\"bad\">{}</b> came out NaN, infinite or negative, or with a pdf or a direction that "
                        "cannot be used. The figures above are not to be trusted until that is understood.",
                plural(bad, "sample")));
    return {"results", "Results", out + page.figures.plates(PlateKind::heat) + frame_footnote(page, n)};
}

PageSection failure_a(Page& page) {
    const ArmPair pair = arm_pair(page);
    if (!pair || page.in.experiment.regions.empty() || all_lights(page.in.experiment).empty()) return {};
    const std::string broad = pair.broad->name, narrow = pair.narrow->name;
    const std::string region = page.find.region_where_worst(broad, narrow, pair.n);
    const RunMetrics *of_broad = page.find.run(broad, pair.n), *of_narrow = page.find.run(narrow, pair.n);
    if (!larger_in(page, broad, narrow, pair.n, region)) return {};
    std::string out = html::p("It shows in region <b>" + escape(region) + "</b>. " +
                          ordering_sentence(page, broad, narrow, pair.n, region)) +
        broad_arms_sentence(page, pair, region);
    out += fmt::format(a_prose, fmt::arg("broad", escape(broad)), fmt::arg("narrow", escape(narrow)),
        fmt::arg("n", pair.n), fmt::arg("largest", html::value(figures(of_broad->largest))),
        fmt::arg("mean", html::value(figures(of_broad->y_mean))), fmt::arg("fireflies_broad", of_broad->fireflies),
        fmt::arg("fireflies_narrow", of_narrow->fireflies));
    const auto shows = [](const std::string& arm) {
        return [arm](const PlatePlan& plan) { return !plan.runs.empty() && plan.runs.front().arm == arm; };
    };
    for (const std::string& arm : {broad, narrow}) out += page.figures.plates(PlateKind::ladder, shows(arm));
    return {"failure-a", fmt::format("Failure A: {} misses the light in {}", escape(broad), escape(region)), out};
}

PageSection failure_b(Page& page) {
    const ArmPair pair = arm_pair(page);
    if (!pair || page.in.experiment.regions.empty()) return {};
    const std::string broad = pair.broad->name, narrow = pair.narrow->name;
    const std::string region = page.find.region_where_worst(narrow, broad, pair.n);
    const RunMetrics *of_broad = page.find.run(broad, pair.n), *of_narrow = page.find.run(narrow, pair.n);
    if (!larger_in(page, narrow, broad, pair.n, region)) return {};
    std::string out = html::p(
        "It shows in region <b>" + escape(region) + "</b>. " + ordering_sentence(page, narrow, broad, pair.n, region));
    out += fmt::format(b_prose, fmt::arg("broad", escape(broad)), fmt::arg("narrow", escape(narrow)),
        fmt::arg("n", pair.n), fmt::arg("mean_broad", html::value(figures(of_broad->y_mean))),
        fmt::arg("mean_narrow", html::value(figures(of_narrow->y_mean))),
        fmt::arg("largest", html::value(figures(of_narrow->largest))), fmt::arg("lost", lost_words(page)));
    return {"failure-b", fmt::format("Failure B: {} starves {}", escape(narrow), escape(region)),
        out + page.figures.plates(PlateKind::surround)};
}

// ---- RMSE against N with the fitted slope, and the exponent control; the sample counts are prefixes of one stream of
// samples.

namespace {

using html::words;

constexpr const char* ladder_prose = R"(
<p>The samples of one sample count are the first samples of the next. If the variance of a sample is finite, the error
falls as <i>N</i><sup>−1/2</sup>, the dashed line. Fitted is {law} by least squares on the logarithms, at the {seed}
seed; the interval is {interval}. A heavy tail breaks this rate: the error then jumps whenever a rare sample arrives,
and the slope depends on the seed more than on the arm.</p>
)";

constexpr const char* exponent_prose = R"(
<p>The control repeats {arm} at <i>N</i> = {n} with other exponents. The exponent changes in the density, in the BRDF
of {shape} and in the reference, so each column is compared with its own reference. A wider lobe sends more samples
below the horizon; a narrower one leaves more of the hemisphere rarely sampled.</p>
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
        if (const SeedSpread* band = page.find.band(l.arm, n, "rmse." + l.region, l.s); band && band->published)
            points.push_back({static_cast<double>(n), *band->published});
    return points;
}

/// The 5 % and 95 % quantiles over seeds at each N of a ladder; empty with one seed.
struct LadderBand {
    std::vector<double> n, low, high;
};
LadderBand band_of(const Page& page, const Ladder& l) {
    LadderBand out;
    for (const std::uint64_t n : l.n)
        if (const SeedSpread* spread = page.find.band(l.arm, n, "rmse." + l.region, l.s);
            spread && spread->band.seeds > 1 && spread->band.q05 > 0) {
            out.n.push_back(static_cast<double>(n));
            out.low.push_back(spread->band.q05), out.high.push_back(spread->band.q95);
        }
    return out;
}

/// Returns RMSE = c N^(-1/2) through the first point, over the whole axis.
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
    for (const Ladder* l : all) {
        const LadderBand band = band_of(page, *l);
        values.insert(values.end(), band.low.begin(), band.low.end());
        values.insert(values.end(), band.high.begin(), band.high.end());
    }
    Axis x = log_axis("N, samples per pixel", ns);
    x.ticks.assign(ns.begin(), ns.end());
    std::sort(x.ticks.begin(), x.ticks.end());
    x.ticks.erase(std::unique(x.ticks.begin(), x.ticks.end()), x.ticks.end());
    x.high *= 2.2;  // room for names at the ends of lines
    Chart chart(420, 330, x, log_axis(metric_text("rmse." + region), values), "RMSE against N in region " + region);
    for (const Ladder* l : all) {
        const auto points = points_of(*l);
        const std::string colour = page.colour(l->arm);
        if (const LadderBand band = band_of(page, *l); band.n.size() > 1)
            chart.band(band.n, band.low, band.high, colour + " faint");
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
        "Fitted slopes of log RMSE on log <i>N</i>; −0.5 if the variance is finite and no light is missed",
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
                                         : "the fit’s own, from its residuals; two sample counts leave none"));
    out += page.figures.chart("<div class=\"pair\">" + charts + "</div>",
        "RMSE against <i>N</i> at the " + page.seed_name() + " seed, by region" +
            (page.in.experiment.seeds > 1 ? ", with the 5–95 % band over seeds" : "") +
            ". Dashed: slope −1/2 through each arm’s first point." + published,
        "metrics.json, ladders");
    return {"ladders", "Ladders in N", out + slope_table(page) + page.figures.plates(PlateKind::ladder)};
}

PageSection exponent(Page& page) {
    const auto& control = page.in.experiment.exponent;
    if (!control) return {};
    std::vector<Column> columns;
    for (const double s : control->s) columns.push_back({"<i>s</i> = " + shortest(s), control->arm, control->n, s});
    const std::string table = metrics_table(page,
        fmt::format("{} at <i>N</i> = {} by exponent. Large: at the {} seed. Small: median, 5–95 % band and tail index",
            escape(control->arm), control->n, page.seed_name()),
        columns);
    if (table.empty()) return {};
    return {"exponent", "Exponent control",
        fmt::format(exponent_prose, fmt::arg("arm", escape(control->arm)), fmt::arg("n", control->n),
            fmt::arg("shape", "<b>" + escape(control->shape) + "</b>")) +
            table + page.figures.plates(PlateKind::exponent)};
}

// ---- White furnaces: one arm on a surface that reflects a known share of a light of radiance 1 from everywhere.

namespace {

using html::words;

constexpr const char* prose = R"(
<p>If every direction brings radiance 1 to a surface, its radiance is its reflectance: <i>ρ</i><sub>d</sub> +
<i>ρ</i><sub>s</sub> with both parts of the BRDF, <i>ρ</i><sub>s</sub> with the lobe alone. The camera looks along the
normal, so that <i>R</i> = <i>n</i> and no sample is below the horizon. Any difference from this value is an error of
the arm.</p>
)";

std::string state(const FurnaceResult& f) {
    if (f.tail && f.tail->heavy()) return "<b>inconclusive: heavy tail</b>";
    const double off = std::fabs(f.measured - f.expected);
    if (!(f.se > 0)) return off == 0 ? "exact" : "no standard error";
    const double z = off / f.se;
    return fmt::format("{}, {:.1f} standard errors off", z <= 3 ? "agrees" : "<b class=\"bad\">differs</b>", z);
}

std::string shortfall(const FurnaceResult& f) {
    if (!(f.tail && f.tail->heavy()) || f.expected <= 0) return {};
    const double off = f.measured / f.expected - 1;
    return html::p(fmt::format(
        "<b>{}</b> reads {} where {} is due, {} {}. Its samples have tail index {}: above 1/2 their variance "
        "is infinite, no standard error exists, and the reading says nothing for or against the arm.",
        escape(f.name), html::value(figures(f.measured)), html::value(figures(f.expected)), percent(std::fabs(off), 2),
        off < 0 ? "short" : "over", html::value(tail_html(f.tail))));
}

}  // namespace

PageSection furnaces(Page& page) {
    bool any_published = false;
    for (const FurnaceResult& f : page.in.metrics.furnaces) any_published = any_published || f.published;
    std::vector<html::Cell> head{words("Furnace"), words("Arm"), words("BRDF"), {"<i>N</i>", true},
        {"Expected <i>Y</i>", true}, {"Measured <i>Y</i>", true}, {"Standard error", true}, {"Tail index", true},
        words("Verdict")};
    if (any_published) head.insert(head.begin() + 5, {"Published", true});
    html::Table table("White furnaces at the " + page.seed_name() + " seed", head);
    std::string sentences;
    for (const FurnaceResult& f : page.in.metrics.furnaces) {
        const bool heavy = f.tail && f.tail->heavy();
        std::vector<html::Cell> row{html::heading(escape(f.name)), words(escape(f.arm)),
            words(f.part == "lobe" ? "lobe alone" : escape(f.part)), html::figure(std::to_string(f.n)),
            html::figure(figures(f.expected)), html::figure(figures(f.measured)),
            {heavy ? html::heavy_tail() : figures(f.se, 2), true}, html::figure(tail_html(f.tail)), words(state(f))};
        if (any_published) row.insert(row.begin() + 5, html::figure(f.published ? figures(*f.published) : ""));
        table.row(row);
        sentences += shortfall(f);
    }
    if (table.empty()) return {};
    return {"furnaces", "White furnaces", prose + table.str() + sentences};
}

}  // namespace crescent::inline report
