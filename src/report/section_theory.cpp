// The question, and the estimator with its meters.
#include <algorithm>

#include <fmt/format.h>

#include "base/formula.h"
#include "lobes/info.h"
#include "report/arm_words.h"

namespace crescent::inline report {
namespace {

using namespace mathml;

constexpr const char* question_prose = R"(
<p>A renderer asks how much light leaves a point towards the eye. It answers by firing <i>N</i> rays, weighing what each
brings by the density it was drawn with, and averaging. Any density that reaches wherever there is light to find gives
the right answer in the end; on the way there, the density decides how noisy the answer is, and <em>where</em> in the
picture the noise sits.</p>
<p>This run puts {arms} on trial: {names}. Every arm looks at one scene through one camera, is compared at equal
<i>N</i> and is fed the same random numbers, pixel by pixel and sample by sample. What differs is the density
<math><mi>p</mi></math>, so whatever differs in the films is its doing.{rays}{bias}{regions}</p>
<p>Every figure below is read off the linear float films, none off a picture. A value at the {seed} seed is one draw out
of many; the band beside it shows what other seeds give, and where the samples are too heavy-tailed for a band the
words {heavy} stand in its place.</p>
)";

constexpr const char* estimator_prose = R"(
<p>The light that leaves a point towards the eye after one bounce is</p>
{integral}
<p>and its estimate from <i>N</i> directions drawn with density {p} (in 1/sr) is</p>
{estimator}
<p>Three rules hold for every arm. The cosine {cosine} stays in the numerator. A direction at or under the horizon
weighs nothing and still counts in <i>N</i>; no density is rescaled to make up for it. And a direction is divided by the
density of the arm that drew it, never by another’s.</p>
)";

constexpr const char* brdf_prose = R"(
<p>A glossy surface adds a lobe to its Lambert part, <i>f</i> = <i>ρ</i><sub>d</sub>/π + <i>ρ</i><sub>s</sub> · lobe.
The lobes of this scene, in 1/sr:</p>
)";

constexpr const char* constants_prose = R"(
<p>Constants that look alike mean different things. This BRDF’s <i>s</i> + 2 makes its lobe reflect the share
<i>ρ</i><sub>s</sub> of the light at normal incidence; the <i>s</i> + 1 of a density about <i>R</i> makes that integrate
to one. Exchanging them is an error of {slip} at <i>s</i> = {s}.</p>
)";

constexpr const char* meters_prose = R"(
<h3>What is measured</h3>
<p>All on luminance <i>Y</i> (Rec. 709 weights, linear). Against the reference, over a region <i>A</i>:</p>
{rmse}
<p>Without a reference, from the samples themselves, the variance of a pixel’s mean, averaged over the region:</p>
{variance}
<p>A <b>firefly</b> is a pixel on a surface where {firefly} with <i>k</i> = {k}. The <b>horizon share</b> is the part of
all directions drawn that fell under the horizon; <b><i>Y</i><sub>mean</sub></b> is the mean over the frame. The RMSE of
the whole frame mixes regions that behave in opposite ways; it stands in a footnote and nowhere else.</p>
)";

std::string spelled(std::size_t count) {
    static const char* words[] = {"no arms", "one arm", "two arms", "three arms", "four arms", "five arms", "six arms"};
    return count < 7 ? words[count] : fmt::format("{} arms", count);
}

std::string regions_sentence(const Experiment& e) {
    if (e.regions.empty()) return {};
    std::vector<std::string> names;
    for (const Region& r : e.regions)
        names.push_back(fmt::format("<b>{}</b> ({} × {} pixels)", escape(r.name), r.box.width(), r.box.height()));
    return fmt::format(" Errors are read in {}, {}.",
        e.regions.size() == 1 ? "one region" : "regions that behave differently", html::join(names));
}

/// The lobes of the scene's glossy surfaces, in the list's order.
std::vector<const LobeInfo*> lobes_of(const Experiment& e) {
    std::vector<const LobeInfo*> out;
    for (const LobeInfo& lobe : lobe_infos())
        if (std::ranges::any_of(
                e.shapes, [&](const Shape& s) { return s.material.rho_s > 0 && s.material.brdf == lobe.kind; }))
            out.push_back(&lobe);
    return out;
}

std::string brdf_words(const Page& page) {
    const std::vector<const LobeInfo*> lobes = lobes_of(page.in.experiment);
    if (lobes.empty()) return {};
    html::Table table("Lobes of this scene", {html::words("Lobe"), html::words("Value, 1/sr"), html::words("")});
    for (const LobeInfo* lobe : lobes)
        table.row({html::heading(escape(std::string(lobe->label))),
            html::words(in_cell(formula::mathml(lobe->formula))), html::words(formula::html(lobe->summary))});
    std::string out = brdf_prose + table.str();
    const bool about_mirror = std::ranges::any_of(lobes, [](const LobeInfo* l) { return l->about_mirror; });
    if (about_mirror && page.find.s() > 0)
        out += display(mirror(), "R is the outgoing direction mirrored at the normal") +
            fmt::format(constants_prose, fmt::arg("slip", percent(1 / (page.find.s() + 1), 2)),
                fmt::arg("s", shortest(page.find.s())));
    return out;
}

}  // namespace

PageSection question(Page& page) {
    std::vector<std::string> names;
    for (const ArmPlan& arm : page.in.experiment.arms) names.push_back("<b>" + escape(arm.name) + "</b>");
    return {"question", "The question",
        fmt::format(question_prose, fmt::arg("arms", spelled(names.size())), fmt::arg("names", html::join(names)),
            fmt::arg("regions", regions_sentence(page.in.experiment)), fmt::arg("heavy", html::heavy_tail()),
            fmt::arg("seed", page.seed_name()), fmt::arg("rays", ray_words(page.in.experiment)),
            fmt::arg("bias", bias_words(page.in.experiment)))};
}

PageSection estimator(Page& page) {
    const Experiment& e = page.in.experiment;
    std::string out = fmt::format(estimator_prose,
        fmt::arg("integral", display(integral(), "the reflection integral over the upper hemisphere")),
        fmt::arg(
            "estimator", display(mathml::estimator(), "one over N times the sum of f times L times cosine over p")),
        fmt::arg("p", in_line(mi("p"))), fmt::arg("cosine", in_line(row({mi("n"), mo("⋅"), omega()}))));
    out += brdf_words(page);
    out +=
        fmt::format(meters_prose, fmt::arg("rmse", display(rmse_region(), "root mean square of Y minus Y ref over A")),
            fmt::arg("variance", display(variance(), "sample variance over N")),
            fmt::arg("firefly", in_line(firefly())), fmt::arg("k", shortest(e.firefly_k)));
    return {"estimator", "The estimator", out};
}

}  // namespace crescent::inline report
