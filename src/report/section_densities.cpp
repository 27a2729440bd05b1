// The densities of the arms with the maps that draw from them, as the headers in arms/ state them.
#include <algorithm>

#include <fmt/format.h>

#include "report/page.h"

namespace crescent {
namespace {

using namespace mathml;
using html::words;

constexpr const char* plain_prose = R"(
<p>Each arm turns two uniform numbers <i>u</i><sub>1</sub>, <i>u</i><sub>2</sub> in (0, 1) into a direction. The azimuth is
2π<i>u</i><sub>2</sub> for all; they part over the polar angle θ and over the axis it is measured from.</p>
)";

constexpr const char* other_prose = R"(
<p>Each arm turns two uniform numbers <i>u</i><sub>1</sub>, <i>u</i><sub>2</sub> in (0, 1) into a direction, and a two-sample arm
does so twice. <i>m</i> is the half vector, of which the direction is a mirror image; <i>y</i> a point on a disk of radius
<i>r</i>.</p>
)";

struct Known {
    const char* sampler;
    M density, inverse;  // both as cells
    const char* axis;
};

const std::vector<Known>& all_known() {
    static const std::vector<Known> all{
        {"uniform", in_cell(density_uniform()), in_cell(inverse_uniform()), "the normal <i>n</i>"},
        {"cosine", in_cell(density_cosine()), in_cell(inverse_cosine()), "the normal <i>n</i>"},
        {"phong", in_cell(density_phong()), in_cell(inverse_phong()), "the mirror direction <i>R</i>"},
        {"mixture", in_cell(density_mixture()), "lobe where <i>u</i><sub>1</sub> &lt; <i>q</i>, else cosine",
            "<i>R</i> or <i>n</i>"},
        {"mis-balance", in_cell(density_mis()), "a mixture and a disk sample, balance heuristic", "both"},
        {"mis-power", in_cell(density_mis()), "a mixture and a disk sample, power heuristic", "both"},
        {"light-area", in_cell(density_light_area()), "even over the area of a disk", "the disk"},
        {"light-solid-angle", in_cell(density_light_cap()), in_cell(inverse_cap()), "the cap around the disk"},
        {"blinn", in_cell(density_blinn()), in_cell(inverse_blinn()), "the normal <i>n</i>"},
        {"ggx-d", in_cell(density_ggx_d()), in_cell(inverse_ggx()), "the normal <i>n</i>"},
        {"ggx-vndf", in_cell(density_ggx_vndf()), "even over a spherical cap, stretched", "the normal <i>n</i>"}};
    return all;
}

const Known* known(const std::string& sampler) {
    for (const Known& k : all_known())
        if (sampler == k.sampler) return &k;
    return nullptr;
}

std::string rungs(const ArmPlan& arm) {
    std::vector<std::string> all;
    for (const std::uint64_t n : arm.n) all.push_back(std::to_string(n));
    return html::join(all);
}

bool plain(const ArmPlan& arm) { return arm.sampler == "uniform" || arm.sampler == "cosine" || arm.sampler == "phong"; }

}  // namespace

PageSection densities(Page& page) {
    html::Table table("The densities, the maps that draw from them and the rungs of <i>N</i> each arm ran",
        {words("Arm"), words("Density <i>p</i>(ω), 1/sr"), words("Polar angle"), words("Axis"), words("<i>N</i>")});
    const auto& arms = page.in.experiment.arms;
    for (const ArmPlan& arm : arms) {
        const Known* it = known(arm.sampler);
        table.row({html::heading(escape(arm.name)), words(it ? it->density : "sampler " + html::code(arm.sampler)),
            words(it ? it->inverse : "–"), words(it ? it->axis : "–"), words(rungs(arm))});
    }
    if (table.empty()) return {};
    const char* prose = std::all_of(arms.begin(), arms.end(), plain) ? plain_prose : other_prose;
    return {"densities", arms.size() == 3 ? "Three densities" : "The densities",
        prose + table.str() + page.figures.plates(PlateKind::rose)};
}

}  // namespace crescent
