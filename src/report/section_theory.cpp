// The question, and the estimator with its meters.
#include <fmt/format.h>

#include "report/page.h"

namespace crescent {
namespace {

using namespace mathml;

constexpr const char* question_prose = R"(
<p>A renderer asks how much light leaves a point towards the eye. It answers by firing <i>N</i> rays, weighing what each
brings by the density it was drawn with, and averaging. Any density that reaches wherever there is light to find gives the
right answer in the end; on the way there, the density decides how noisy the answer is, and <em>where</em> in the picture
the noise sits.</p>
<p>This run puts {arms} on trial: {names}. Every arm looks at one scene through one camera, takes the same number of
samples and is fed the same random numbers, pixel by pixel and sample by sample. The density
<math><mi>p</mi></math> is all that differs, so whatever differs in the films is its doing.{regions}</p>
<p>Every figure below is read off the linear float films, none off a picture. A value at the {seed} seed is one draw out of
many; the band beside it shows what other seeds give, and where the samples are too heavy-tailed for a band the
words {heavy} stand in its place.</p>
)";

constexpr const char* estimator_prose = R"(
<p>The light that leaves a point towards the eye after one bounce is</p>
{integral}
<p>and its estimate from <i>N</i> directions drawn with density {p} (in 1/sr) is</p>
{estimator}
<p>Three rules hold for every arm. The cosine {cosine} stays in the numerator. A direction at or under the horizon weighs
nothing and still counts in <i>N</i>; no density is rescaled to make up for it. And a direction is divided by the density
of the arm that drew it, never by another’s.</p>
)";

constexpr const char* lobe_prose = R"(
<p>A glossy surface adds a normalised Phong lobe to its Lambert part:</p>
{brdf}{mirror}
<p>The constants look alike and mean different things. The BRDF’s <i>s</i> + 2 makes the lobe reflect the share {rho_s} of
the light at normal incidence; the density’s <i>s</i> + 1, below, makes it integrate to one. Exchanging them is an error of
{slip} at <i>s</i> = {s}.</p>
)";

constexpr const char* meters_prose = R"(
<h3>What is measured</h3>
<p>All on luminance <i>Y</i> (Rec. 709 weights, linear). Against the reference, over a region <i>A</i>:</p>
{rmse}
<p>Without a reference, from the samples themselves, the variance of a pixel’s mean, averaged over the region:</p>
{variance}
<p>A <b>firefly</b> is a pixel on a surface where {firefly} with <i>k</i> = {k}. The <b>horizon share</b> is the part of all
directions drawn that fell under the horizon; <b><i>Y</i><sub>mean</sub></b> is the mean over the frame. The RMSE of the whole frame
mixes regions that behave in opposite ways; it stands in a footnote and nowhere else.</p>
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

bool any_phong_lobe(const Experiment& e) {
    for (const Shape& shape : e.shapes)
        if (shape.material.rho_s > 0 && shape.material.brdf == lobe_named("phong")) return true;
    return false;
}

}  // namespace

PageSection question(Page& page) {
    std::vector<std::string> names;
    for (const ArmPlan& arm : page.in.experiment.arms) names.push_back("<b>" + escape(arm.name) + "</b>");
    return {"question", "The question",
        fmt::format(question_prose, fmt::arg("arms", spelled(names.size())), fmt::arg("names", html::join(names)),
            fmt::arg("regions", regions_sentence(page.in.experiment)), fmt::arg("heavy", html::heavy_tail()),
            fmt::arg("seed", page.seed_name()))};
}

PageSection estimator(Page& page) {
    const Experiment& e = page.in.experiment;
    std::string out = fmt::format(estimator_prose,
        fmt::arg("integral", display(integral(), "the reflection integral over the upper hemisphere")),
        fmt::arg(
            "estimator", display(mathml::estimator(), "one over N times the sum of f times L times cosine over p")),
        fmt::arg("p", in_line(mi("p"))), fmt::arg("cosine", in_line(row({mi("n"), mo("⋅"), omega()}))));
    if (any_phong_lobe(e)) {
        const double s = page.find.s();
        out += fmt::format(lobe_prose, fmt::arg("brdf", display(brdf_phong(), "Lambert plus normalised Phong lobe")),
            fmt::arg("mirror", display(mirror(), "R is the outgoing direction mirrored at the normal")),
            fmt::arg("rho_s", in_line(sub(mi("ρ"), mi("s")))), fmt::arg("slip", percent(1 / (s + 1), 2)),
            fmt::arg("s", shortest(s)));
    }
    out +=
        fmt::format(meters_prose, fmt::arg("rmse", display(rmse_region(), "root mean square of Y minus Y ref over A")),
            fmt::arg("variance", display(variance(), "sample variance over N")),
            fmt::arg("firefly", in_line(firefly())), fmt::arg("k", shortest(e.firefly_k)));
    return {"estimator", "The estimator", out};
}

}  // namespace crescent
