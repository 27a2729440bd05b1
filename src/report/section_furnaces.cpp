// White furnaces: an arm alone on a surface that reflects a known share of a light that is one everywhere.
#include <cmath>

#include <fmt/format.h>

#include "report/page.h"

namespace crescent::inline report {
namespace {

using html::words;

constexpr const char* prose = R"(
<p>Put a surface where every direction brings the light 1 and its radiance is what it reflects: <i>ρ</i><sub>d</sub> +
<i>ρ</i><sub>s</sub> with both parts of the BRDF, <i>ρ</i><sub>s</sub> with the lobe alone. The eye looks along the
normal, so that <i>R</i> = <i>n</i> and no sample falls under the horizon. Whatever an arm reads besides is its own
error.</p>
)";

std::string state(const FurnaceMeter& f) {
    if (f.tail && f.tail->heavy()) return "<b>inconclusive: heavy tail</b>";
    const double off = std::fabs(f.measured - f.expected);
    if (!(f.se > 0)) return off == 0 ? "exact" : "no standard error";
    const double z = off / f.se;
    return fmt::format("{}, {:.1f} standard errors off", z <= 3 ? "agrees" : "<b class=\"bad\">differs</b>", z);
}

std::string shortfall(const FurnaceMeter& f) {
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
    for (const FurnaceMeter& f : page.in.metrics.furnaces) any_published = any_published || f.published;
    std::vector<html::Cell> head{words("Furnace"), words("Arm"), words("BRDF"), {"<i>N</i>", true},
        {"Expected <i>Y</i>", true}, {"Measured <i>Y</i>", true}, {"Standard error", true}, {"Tail index", true},
        words("Verdict")};
    if (any_published) head.insert(head.begin() + 5, {"Published", true});
    html::Table table("White furnaces at the " + page.seed_name() + " seed", head);
    std::string sentences;
    for (const FurnaceMeter& f : page.in.metrics.furnaces) {
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
