// The densities of the arms with the maps that draw from them, as the arms' own files state them.
#include <algorithm>

#include <fmt/format.h>

#include "arms/info.h"
#include "base/formula.h"
#include "report/page.h"

namespace crescent::inline report {
namespace {

using html::words;

constexpr const char* plain_prose = R"(
<p>Each arm turns two uniform numbers <i>u</i><sub>1</sub>, <i>u</i><sub>2</sub> in (0, 1) into a direction. The azimuth
is 2π<i>u</i><sub>2</sub> for all; they part over the polar angle θ and over the axis it is measured from.</p>
)";

constexpr const char* other_prose = R"(
<p>Each arm turns two uniform numbers <i>u</i><sub>1</sub>, <i>u</i><sub>2</sub> in (0, 1) into a direction, and a
two-sample arm does so twice. <i>m</i> is the half vector, of which the direction is a mirror image; <i>y</i> a point
of a light of area <i>A</i> and <i>θ</i><sub>y</sub> the angle there between its normal and the ray; Ω the solid angle
that the directions to a light are drawn from.</p>
)";

std::string rungs(const ArmPlan& arm) {
    std::vector<std::string> all;
    for (const std::uint64_t n : arm.n) all.push_back(std::to_string(n));
    return html::join(all);
}

/// What draws in place of a built-in arm.
std::string source_of(const ArmPlan& arm) {
    if (arm.plugin) return "that of the plugin " + html::code(*arm.plugin);
    return "that of the program " + html::code(arm.exec.value_or(""));
}

/// One density about one direction: a polar angle is all that there is to it.
bool plain(const ArmPlan& arm) {
    const ArmInfo* info = find_arm_info(arm.sampler);
    return info && info->about != PdfAxis::none;
}

/// The arm's name, with its sampler where that is another, and what light it cannot reach.
std::string name_of(const ArmPlan& arm, const ArmInfo& info, bool fill) {
    std::string out = escape(arm.name == arm.sampler ? std::string(info.label) : arm.name);
    if (arm.name != arm.sampler) out += ", sampler " + html::code(arm.sampler);
    if (!info.misses.empty() && fill)
        out += fmt::format("<br /><small>cannot reach {}: biased here</small>", info.misses);
    return out;
}

}  // namespace

PageSection densities(Page& page) {
    html::Table table("The densities, the maps that draw from them and the rungs of <i>N</i> each arm ran",
        {words("Arm"), words("Density <i>p</i>(ω), 1/sr"), words("Polar angle"), words("Axis"), words("<i>N</i>")});
    const auto& arms = page.in.experiment.arms;
    const Rgb& fill = page.in.experiment.fill;
    for (const ArmPlan& arm : arms) {
        const ArmInfo* info = find_arm_info(arm.sampler);
        if (!info) {
            table.row(
                {html::heading(escape(arm.name)), words(source_of(arm)), words(""), words(""), words(rungs(arm))});
            continue;
        }
        table.row({html::heading(name_of(arm, *info, fill[0] + fill[1] + fill[2] > 0)),
            words(mathml::in_cell(formula::mathml(info->density))), words(formula::html(info->draw)),
            words(formula::html(info->axis)), words(rungs(arm))});
    }
    if (table.empty()) return {};
    const char* prose = std::all_of(arms.begin(), arms.end(), plain) ? plain_prose : other_prose;
    return {"densities", arms.size() == 3 ? "Three densities" : "The densities",
        prose + table.str() + page.figures.plates(PlateKind::rose)};
}

}  // namespace crescent::inline report
