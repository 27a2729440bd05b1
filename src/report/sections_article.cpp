// Every metric over seeds: the published value, the measured one, the band, and the place of the published value in it.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>

#include "math/functions.h"
#include "report/evidence_charts.h"
#include "report/wording.h"

namespace crescent::inline report {
namespace {

using html::words;

constexpr const char* published_prose = R"(
<p>A published value is one draw from one stream of random numbers. The question is whether it lies where draws lie. In
the strips the bar spans the middle 90 % of {seeds}, the tick is their median, the dot the {which} seed ({seed}) and the
diamond the published value; each strip has its own scale. Each RMSE and variance is followed by the tail index
<i>k</i> of the samples of its region: from 1/2 on their variance is infinite.</p>
)";

constexpr const char* measured_prose = R"(
<p>In the strips the bar spans the middle 90 % of {seeds}, the tick is their median and the dot the first seed ({seed});
each strip has its own scale. Each RMSE and variance is followed by the tail index <i>k</i> of the samples of its
region: from 1/2 on their variance is infinite.</p>
)";

std::string fallen(const SeedSpread& b) {
    if (!b.published || !b.published_rank || b.band.seeds < 2) return "–";
    if (b.band.q05 == *b.published && b.band.q95 == *b.published) return "the same";
    if (*b.published_rank <= 0) return "none";
    if (*b.published_rank >= 1) return "all";
    return percent(*b.published_rank, 2);
}

std::vector<html::Cell> band_row(const Page& page, const SeedSpread& b, bool published) {
    Strip strip{b.band.q05, b.band.median, b.band.q95, b.measured, !b.band.heavy && b.band.seeds > 1,
        b.published.has_value(), b.published.value_or(0)};
    std::vector<html::Cell> row{html::heading(run_html(b.key, page.in.experiment))};
    if (published) row.push_back(html::figure(b.published ? figures_of(b.metric, *b.published) : ""));
    const bool paired = page.in.experiment.reference.kind == ReferenceKind::paired;
    row.push_back(html::figure(figures_of(b.metric, b.measured, paired)));
    row.push_back(html::figure(figures_of(b.metric, b.band.median, paired)));
    row.push_back({interval_html(b.metric, b.band), true});
    row.push_back(words(strip_svg(strip)));
    if (published) row.push_back({fallen(b), true});
    row.push_back(html::figure(tail_html(page.find.tail(b))));
    return row;
}

std::vector<html::Cell> header(bool published) {
    std::vector<html::Cell> head{words("Run")};
    if (published) head.push_back({"Published", true});
    head.insert(head.end(), {{"Measured", true}, {"Median", true}, {"5–95 %", true}, words("Strip")});
    if (published) head.push_back({"Seeds below published", true});
    head.push_back({"<i>k</i>", true});
    return head;
}

/// Returns the metrics in a fixed order, then all others, without the whole frame.
std::vector<std::string> metrics_in_order(const Page& page) {
    std::vector<std::string> order = headline_metrics(page.in.experiment);
    std::set<std::string> seen(order.begin(), order.end());
    for (const SeedSpread& b : page.in.metrics.bands)
        if (b.metric != "rmse_frame" && seen.insert(b.metric).second) order.push_back(b.metric);
    return order;
}

/// Returns what the command line changed of the experiment with published values; "" if nothing.
std::string changes(const Experiment& e) {
    std::string list;
    for (const std::string& change : e.overrides)
        if (!change.starts_with("seed=") && !change.starts_with("seeds="))
            list += (list.empty() ? "" : ", ") + ("<code>" + escape(change) + "</code>");
    if (list.empty()) return {};
    return "<p><strong>This run differs from the published one</strong> in " + list +
        ": the published values show the effect of the change; they need not be matched.</p>";
}

}  // namespace

PageSection published(Page& page) {
    const bool published = page.find.anything_published();
    const Experiment& e = page.in.experiment;
    html::Table table(published ? "Published and measured" : "Every metric of every run", header(published));
    for (const std::string& metric : metrics_in_order(page)) {
        bool first = true;
        for (const SeedSpread& b : page.in.metrics.bands) {
            if (b.metric != metric) continue;
            if (first) table.group(metric_html(metric));
            first = false;
            table.row(band_row(page, b, published));
        }
    }
    if (table.empty()) return {};
    const std::string prose = published ? published_prose : measured_prose;
    const std::string intro =
        fmt::format(fmt::runtime(prose), fmt::arg("seeds", plural(static_cast<std::uint64_t>(e.seeds), "seed")),
            fmt::arg("seed", e.seed), fmt::arg("which", page.seed_name()));
    return {"published", published ? "Published and measured" : "All metrics",
        (published ? changes(e) : "") + intro + "<div class=\"wide\">" + table.str() + "</div>" +
            page.figures.plates(PlateKind::meters)};
}

// ---- Three explanations of the article that do not hold, each with the measurement that shows it; points without a
// measurement are omitted.

namespace {

using namespace mathml;

constexpr const char* furnace_prose = R"(
<h3 id="wrong-furnace">The furnace is too low because its tail is heavy</h3>
<p>The article explains the low combined furnace of the Phong arm by the limited digits of single precision in the
inverse distribution function. With <i>R</i> = <i>n</i> the weight of a Lambert sample has a closed form: it is
{weight}, which is a Pareto distribution with index</p>
{index}
<p>here {k} at <i>s</i> = {s}. Its variance is infinite from <i>k</i> = 1/2 (<i>s</i> = 3) on. The mean exists, and most
of it comes from samples so rare that a run of ordinary length has none of them: its typical result is low in any
arithmetic. The resolution of <i>u</i> adds an upper limit. If <i>u</i> is never below 2<sup>−<i>b</i></sup>, then even
infinitely many samples give only</p>
{cap}
<p>({caps}). The dashed lines below are these limits.</p>
)";

constexpr const char* lost_prose = R"(
<h3 id="wrong-support">The Phong arm is biased off the normal</h3>
<p>An estimator is unbiased if its density is positive wherever the integrand is. The Phong density is zero on the half
space behind <i>R</i>. If <i>R</i> is tilted by θ<sub>R</sub> from the normal, part of the upper hemisphere lies behind
it, where a Lambert surface still reflects. Under a uniform fill the share that no number of samples can reach is</p>
{share}
<p>A chi-square test of the directions against their density cannot detect it: both are zero there.</p>
)";

constexpr const char* rejection_prose = R"(
<h3 id="wrong-test">A t-test rejects the arm where it is right</h3>
<p>With <i>R</i> = <i>n</i> the arm reaches everything and its mean is known. If that mean is tested with Student’s t at
level {alpha}, with {n} samples per run, a correct arm should be rejected in {alpha_percent} of runs. The test uses the
sample variance, and with a heavy tail there is no variance to estimate. It rejects because of the tail.</p>
)";

std::string intro(const Page& page) {
    const char* whose = page.find.anything_published()
        ? "The article explains some of its values."
        : "This bench began with an article on a gallery lit by a spotlight, which explains some of its values.";
    return fmt::format(
        "{} Three of the explanations can be put to a measurement of their own, and below they are, with "
        "<i>ρ</i><sub>d</sub> = {}, <i>ρ</i><sub>s</sub> = {} and <i>s</i> = {}.",
        whose, html::value(figures(page.in.evidence.rho_d)), html::value(figures(page.in.evidence.rho_s)),
        shortest(page.in.evidence.s));
}

std::string furnace_point(Page& page) {
    const Evidence& e = page.in.evidence;
    if (e.furnace.empty() || !(e.rho_d > 0)) return {};  // without Lambert the furnace is not too low
    const double k = (e.s - 1) / (e.s + 1);
    const M weight = row({frac(row({mn("2"), sub(mi("ρ"), mi("d"))}), row({mi("s"), mo("+"), mn("1")})),
        sup(mi("u"), row({mo("−"), mi("k")}))});
    std::string caps;
    for (const FurnaceCap& cap : e.caps)
        caps += fmt::format("{}{} with {} bits", caps.empty() ? "" : ", ", html::value(figures(cap.y)), cap.u_bits);
    std::string out = fmt::format(furnace_prose, fmt::arg("weight", in_line(weight)),
        fmt::arg("index", display(pareto_index(), "k is s minus 1 over s plus 1")),
        fmt::arg("k", html::value(figures(k, 3))), fmt::arg("s", shortest(e.s)),
        fmt::arg("cap", display(capped_mean(), "rho s plus rho d times one minus 2 to the minus b times one minus k")),
        fmt::arg("caps", caps.empty() ? "less than is due" : caps));
    out += furnace_sentence(page);
    out += page.figures.chart(furnace_charts(page),
        "The combined furnace of the Phong arm at <i>R</i> = <i>n</i>, over replicates: median (line), middle half "
        "(dark) and middle 90 % (light). Solid rule: what is due. Dashed: what infinitely many samples read at that "
        "resolution of <i>u</i>.",
        "metrics.json, evidence.furnace");
    return out + furnace_table(e);
}

std::string lost_point(Page& page) {
    const Evidence& e = page.in.evidence;
    if (e.lost.empty()) return {};
    return fmt::format(lost_prose, fmt::arg("share", display(lost_share(), "one minus cosine theta R over two"))) +
        lost_sentence(e) +
        page.figures.chart(lost_chart(e),
            "Lost share of Lambert × fill. Line: theory. Dots: measured, with two standard errors.",
            "metrics.json, evidence.lost");
}

std::string rejection_point(Page& page) {
    const Evidence& e = page.in.evidence;
    if (e.rejections.empty()) return {};
    return fmt::format(rejection_prose, fmt::arg("alpha", shortest(e.alpha)),
               fmt::arg("alpha_percent", percent(e.alpha)), fmt::arg("n", e.rejections.front().n)) +
        rejection_sentence(e) + rejection_table(e) +
        page.figures.chart(rejection_chart(e),
            "Correct runs of the Phong arm that a plain t-test rejects, with Clopper–Pearson 95 % intervals.",
            "metrics.json, evidence.rejections");
}

}  // namespace

PageSection where_wrong(Page& page) {
    std::string points = furnace_point(page);  // one after the other: figures are numbered in order
    points += lost_point(page);
    points += rejection_point(page);
    if (points.empty()) return {};
    return {"wrong", "Where the article is wrong", html::p(intro(page)) + points};
}

// ---- Published values outside the bands of this run, and possible reasons; only reasons for which this run has the
// numbers are given. docs/scene.md explains how the geometry was inferred.

namespace {

using html::words;

std::string signed_percent(double fraction) {
    const double tenths = std::round(1000 * fraction);
    return html::value(tenths == 0 ? "0.0 %" : fmt::format("{:+.1f} %", tenths / 10));
}

std::optional<double> relative(const SeedSpread* b) {
    if (!b || !b->published || *b->published == 0) return {};
    return b->band.median / *b->published - 1;
}

/// Returns "18 to 22 % below", for deviations of one sign; empty if the signs differ or nothing was published.
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

/// The broad arms in the highlight, and why the geometry cannot simply be changed to match them.
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
        parts += (parts.empty() ? "" : ", ") + metric_html(kind + region) + " " + range;
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
            escape(control->shape), metric_html("y_mean"), shortest(s), signed_percent(*mean));
    return out;
}

/// Deviations of one metric over the exponent control.
std::string exponent_remark(const Page& page, const std::string& metric) {
    const auto& control = page.in.experiment.exponent;
    if (!control) return {};
    std::string values;
    for (const double s : control->s)
        if (const auto r = relative(page.find.band(control->arm, control->n, metric, s)))
            values += fmt::format("{}{} at <i>s</i> = {}", values.empty() ? "" : ", ", signed_percent(*r), shortest(s));
    if (values.empty()) return {};
    return fmt::format("For {}, {}: {}.", escape(control->arm), metric_html(metric), values);
}

/// Returns the largest deviation of log RMSE from a slope of -1/2, as a fraction.
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
        const RunMetrics* run = page.find.run({arm.name, n, page.find.s(), seed});
        const RegionMetrics* metric = run ? run->region(region) : nullptr;
        if (!metric || !(metric->rmse > 0)) return {};
        out.push_back(metric->rmse);
    }
    return out;
}

/// A published ladder that is smoother than that of most seeds, for an arm with a heavy tail.
std::string smooth_ladder_remark(const Page& page, const ArmPlan& narrow, const std::string& region) {
    std::vector<double> published;
    for (const std::uint64_t n : narrow.n)
        if (const SeedSpread* b = page.find.band(narrow.name, n, "rmse." + region); b && b->published)
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
        "The published ladder of {} in {} deviates from slope −1/2 by at most {}. Of {} seeds here, {} keep as "
        "close: the others meet a rare bright sample at some sample count.",
        escape(narrow.name), escape(region), percent(limit, 2), of, close);
}

/// A published rise of RMSE with N, for an arm whose square has no finite expectation.
std::string rise_remark(const Page& page, const ArmPlan& narrow, const std::string& region) {
    for (std::size_t i = 1; i < narrow.n.size(); ++i) {
        const SeedSpread *a = page.find.band(narrow.name, narrow.n[i - 1], "rmse." + region),
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
            narrow.n[i - 1], narrow.n[i], metric_html("rmse." + region), escape(narrow.name), factor, rose, of,
            so_much);
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
                    "For {}, {}: {}.", escape(broad->name), metric_html("rmse." + cold), signed_percent(*r)));
        for (const char* metric : {"fireflies", "y_mean", "horizon_frac"}) all.push_back(exponent_remark(page, metric));
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
    html::Table table("Published values outside the 5–95 % band of this run (metrics with a heavy tail have no band)",
        {words("Metric"), words("Run"), {"Published", true}, {"Median", true}, {"5–95 %", true},
            {"Median against published", true}});
    std::size_t checked = 0, outside = 0;
    for (const SeedSpread& b : page.in.metrics.bands) {
        if (!b.published || b.band.heavy || b.band.seeds < 2) continue;
        ++checked;
        if (*b.published >= b.band.q05 && *b.published <= b.band.q95) continue;
        ++outside;
        const auto off = relative(&b);
        table.row({html::heading(metric_html(b.metric)), words(run_html(b.key, page.in.experiment)),
            html::figure(figures_of(b.metric, *b.published)), html::figure(figures_of(b.metric, b.band.median)),
            {interval_html(b.metric, b.band), true}, {off ? signed_percent(*off) : "–", true}});
    }
    if (checked == 0) return {};
    std::string out = html::p(fmt::format("{} can be compared with a band; {} of them fall{} outside it.",
        plural(checked, "published value"), outside, outside == 1 ? "s" : ""));
    if (outside > 0) out += table.str() + remarks(page);
    return {"disagreements", "Where article and scene disagree", out};
}

}  // namespace crescent::inline report
