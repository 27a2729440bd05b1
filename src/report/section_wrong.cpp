// Three explanations of the note that do not hold, each with the measurement that says so. A point without its
// measurement is left out.
#include <fmt/format.h>

#include "report/evidence_charts.h"

namespace crescent::inline report {
namespace {

using namespace mathml;

constexpr const char* furnace_prose = R"(
<h3 id="wrong-furnace">The furnace falls short because its tail is heavy</h3>
<p>The note reads the low combined furnace of the Phong arm as single precision running out of digits in the inverse
distribution function. With <i>R</i> = <i>n</i> the weight of a Lambert sample can be written down: it is
{weight}, which is a Pareto distribution with index</p>
{index}
<p>here {k} at <i>s</i> = {s}. Its variance is infinite from <i>k</i> = 1/2 (<i>s</i> = 3) on. The mean exists, and most
of it is carried by samples so rare that a run of ordinary length holds none of them: its typical reading is low in any
arithmetic. What the resolution of <i>u</i> does add is a ceiling. If <i>u</i> is never below 2<sup>−<i>b</i></sup>,
then even infinitely many samples read only</p>
{cap}
<p>({caps}). The dashed lines below are these ceilings.</p>
)";

constexpr const char* lost_prose = R"(
<h3 id="wrong-support">The Phong arm is biased off the normal</h3>
<p>An estimator is unbiased if its density is positive wherever the integrand is. The Phong density is zero on the half
space behind <i>R</i>. Tilt <i>R</i> by θ<sub>R</sub> from the normal and part of the upper hemisphere lies behind it,
where a Lambert surface reflects all the same. Under a uniform fill the share that no number of samples can find is</p>
{share}
<p>A chi-square test of the directions against their density sees nothing of it: both are zero there.</p>
)";

constexpr const char* rejection_prose = R"(
<h3 id="wrong-test">A t-test condemns the arm where it is right</h3>
<p>With <i>R</i> = <i>n</i> the arm reaches everything and its mean is known. Test that mean with Student’s t at level
{alpha}, with {n} samples a run, and a correct arm ought to be rejected in {alpha_percent} of runs. The test uses the
sample variance, and a heavy tail has none to estimate. What it rejects is the tail.</p>
)";

std::string intro(const Page& page) {
    const char* whose = page.find.anything_published()
        ? "The note explains some of its figures."
        : "This bench began with a note on a gallery lit by a spotlight, which explains some of its figures.";
    return fmt::format(
        "{} Three of the explanations can be put to a measurement of their own, and below they are, with "
        "<i>ρ</i><sub>d</sub> = {}, <i>ρ</i><sub>s</sub> = {} and <i>s</i> = {}.",
        whose, html::value(figures(page.in.evidence.rho_d)), html::value(figures(page.in.evidence.rho_s)),
        shortest(page.in.evidence.s));
}

std::string furnace_point(Page& page) {
    const Evidence& e = page.in.evidence;
    if (e.furnace.empty() || !(e.rho_d > 0)) return {};  // without Lambert nothing falls short
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
    std::string points = furnace_point(page);  // one after the other: figures are numbered as they come
    points += lost_point(page);
    points += rejection_point(page);
    if (points.empty()) return {};
    return {"wrong", "Where the note is wrong", html::p(intro(page)) + points};
}

}  // namespace crescent::inline report
