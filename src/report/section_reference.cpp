// What everything is measured against, and how much it would matter to use the Monte Carlo reference of the note
// instead.
#include <algorithm>

#include <fmt/format.h>

#include "report/page.h"

namespace crescent {
namespace {

using html::words;

constexpr const char* prose = R"(
<p>Two references are computed. The Monte Carlo one adds an analytic Lambert term for the fill, the lobe on the fill by {lobe} drawn
from it, and each disk by {disk} on its surface, on a seed of its own ({seed}); it is close, and random. The quadrature
integrates the same terms to convergence and has no seed. The meters of this run use the <b>{used}</b>. The table shows how
far the two lie apart, what the random one claims as its standard error, and by how much the RMSE of any arm would change if
it were used instead.</p>
)";

std::string verdict(const std::vector<ReferenceMeter>& all) {
    const auto worst = std::max_element(all.begin(), all.end(),
        [](const ReferenceMeter& a, const ReferenceMeter& b) { return a.rmse_unlike < b.rmse_unlike; });
    std::string out = fmt::format("The choice changes an RMSE by at most {}, in region {} at <i>s</i> = {}.",
        percent(worst->rmse_unlike, 2), escape(worst->region), shortest(worst->s));
    const bool explained = std::all_of(
        all.begin(), all.end(), [](const ReferenceMeter& r) { return r.rms_difference <= 2 * r.rms_standard_error; });
    out += explained
        ? " Everywhere the two differ by no more than twice what the random one says of itself."
        : " Somewhere they differ by more than twice what the random one says of itself: its standard error is "
          "too small there, or its tail too long.";
    std::string coarse;
    for (const ReferenceMeter& r : all)
        if (r.error_share > most_error_share)
            coarse += fmt::format(
                " <b>It is not good enough in region {} at <i>s</i> = {}</b>: its own error is {} of the smallest RMSE "
                "there.",
                escape(r.region), shortest(r.s), percent(r.error_share, 2));
    return html::p(out) +
        (coarse.empty() ? "" : html::p("The reference that the meters use states its own error." + coarse));
}

}  // namespace

PageSection reference(Page& page) {
    const auto& all = page.in.metrics.references;
    const ReferencePlan& plan = page.in.experiment.reference;
    const std::string plates = page.figures.plates(PlateKind::reference);
    if (all.empty() && plates.empty()) return {};
    std::string out = fmt::format(prose, fmt::arg("lobe", plural(plan.lobe_spp, "sample")),
        fmt::arg("disk", plural(plan.disk_spp, "sample")), fmt::arg("seed", plan.seed),
        fmt::arg("used", plan.kind == ReferenceKind::quadrature ? "quadrature" : "Monte Carlo reference"));
    html::Table table("The Monte Carlo reference against the quadrature, root mean square over a region, in <i>Y</i>",
        {words("Region"), {"<i>s</i>", true}, {"Apart by", true}, {"Its standard error", true},
            {"Quadrature’s error", true}, {"Largest change of an RMSE", true}});
    for (const ReferenceMeter& r : all)
        table.row({html::heading(escape(r.region)), html::figure(shortest(r.s)),
            html::figure(figures(r.rms_difference, 3)), html::figure(figures(r.rms_standard_error, 3)),
            html::figure(figures(r.quadrature_error, 2)), html::figure(percent(r.rmse_unlike, 2))});
    if (!all.empty()) out += table.str() + verdict(all);
    return {"reference", "The reference", out + plates};
}

}  // namespace crescent
