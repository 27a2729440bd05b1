// The arms side by side at one N, and the two ways in which they fail: the broad density on a small light, the narrow
// one on a broad integrand. Which region shows which is found from the numbers.
#include <fmt/format.h>

#include "experiment/arm_facts.h"
#include "experiment/light_tables.h"
#include "report/arm_words.h"

namespace crescent::inline report {
namespace {

/// The arm's name, and what is to be known of it beside its numbers.
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
    return meters_table(page,
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
        if (const RunMeter* run = page.find.run(arm.name, n))
            values += fmt::format(
                "{}{} {}", values.empty() ? "" : ", ", escape(arm.name), html::value(figures(run->rmse_frame)));
    if (values.empty()) return {};
    return html::element("p", "class=\"footnote\"",
               "Footnote: the RMSE of the whole frame, which lumps the regions together, reads " + values + ".") +
        "\n";
}

/// One sentence for each other arm whose density is about the normal: how it compares with the best of them.
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
<p>A small bright light fills little of the hemisphere. A density that spreads its rays over all of it meets the light
seldom; when one ray does, it stands for all those that missed. On a glossy highlight that one ray also meets
the lobe at its height, which the density knows nothing of, so one sample can weigh as much as {largest} with {broad},
in a picture whose mean is {mean}. Where that happens, most pixels come out too dark and a few far too bright. Counted
as fireflies at <i>N</i> = {n} are {fireflies_broad} pixels with {broad} and {fireflies_narrow} with {narrow}.</p>
)";

constexpr const char* b_prose = R"(
<p>A lobe about the mirror direction sends nearly all rays where the lobe is. A matt surface gathers light from the
whole hemisphere, and what comes from the sides is left to the few rays that stray there. Each of those stands for many
that were never sent: the largest weighs {largest} with {narrow}. The pixel is dark until one arrives, and then it
sparkles. The mean of the frame tells it at a glance: for the same scene at <i>N</i> = {n}, <i>Y</i><sub>mean</sub>
reads {mean_narrow} with {narrow} and {mean_broad} with {broad}.{lost}</p>
<p>On a Lambert surface the arm still aims about the mirror direction with the scene’s <i>s</i>: it samples the lobe
whatever the material.</p>
)";

/// Of the two failures, those that this run does not show.
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
    const RunMeter *of_broad = page.find.run(broad, pair.n), *of_narrow = page.find.run(narrow, pair.n);
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
    const RunMeter *of_broad = page.find.run(broad, pair.n), *of_narrow = page.find.run(narrow, pair.n);
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

}  // namespace crescent::inline report
