// What everything is measured against, and how much it would matter to use the Monte Carlo reference of the note
// instead.
#include <algorithm>

#include <fmt/format.h>

#include "report/page.h"

namespace crescent::inline report {
namespace {

using html::words;

constexpr const char* quadrature_prose = R"(
<p>The reference integrates each pixel to convergence: the Lambert term on the fill in closed form, the lobe on the fill
from a table of its albedo, every light by quadrature. It has no seed, and states its own error.</p>
)";

constexpr const char* both_prose = R"(
<p>Two references are computed. The quadrature integrates each pixel to convergence and has no seed. The Monte Carlo one
adds an analytic Lambert term for the fill, the lobe on the fill by {lobe} drawn from it, and each light by {disk} on
its surface, on a seed of its own ({seed}). The meters of this run use the <b>{used}</b>. The table shows how far the
two lie apart, what the random one claims as its standard error, and by how much the RMSE of any arm would change if the
other one were used.</p>
)";

/// Where the reference's own error is too large a part of an RMSE.
std::string not_good_enough(const std::vector<ReferenceMeter>& all) {
    std::string out;
    for (const ReferenceMeter& r : all)
        if (r.error_share > most_error_share)
            out += fmt::format(
                " <b>It is not good enough in region {} at <i>s</i> = {}</b>: its own error is {} of the "
                "smallest RMSE there.",
                escape(r.region), shortest(r.s), percent(r.error_share, 2));
    return out.empty() ? out : html::p("The reference that the meters use states its own error." + out);
}

std::string verdict(const std::vector<ReferenceMeter>& all) {
    const auto worst =
        std::ranges::max_element(all, {}, [](const ReferenceMeter& r) { return *r.max_relative_rmse_change; });
    const std::string out =
        fmt::format("The choice of the reference changes an RMSE by at most {}, in region {} at <i>s</i> = {}.",
            percent(*worst->max_relative_rmse_change, 2), escape(worst->region), shortest(worst->s));
    const bool explained = std::ranges::all_of(
        all, [](const ReferenceMeter& r) { return *r.rms_difference <= 2 * *r.rms_standard_error; });
    return html::p(out +
        (explained
                ? " Everywhere the two differ by no more than twice the standard error of the random one."
                : " Somewhere they differ by more than twice the standard error of the random one: that error is too "
                  "small there, or its tail too long."));
}

std::string table_of_both(const std::vector<ReferenceMeter>& all) {
    html::Table table("The Monte Carlo reference against the quadrature, root mean square over a region, in <i>Y</i>",
        {words("Region"), {"<i>s</i>", true}, {"Apart by", true}, {"Its standard error", true},
            {"Quadrature’s error", true}, {"Largest change of an RMSE", true}});
    for (const ReferenceMeter& r : all)
        table.row({html::heading(escape(r.region)), html::figure(shortest(r.s)),
            html::figure(figures(*r.rms_difference, 3)), html::figure(figures(*r.rms_standard_error, 3)),
            html::figure(figures(r.quadrature_error, 2)), html::figure(percent(*r.max_relative_rmse_change, 2))});
    return table.str() + verdict(all);
}

std::string table_of_one(const std::vector<ReferenceMeter>& all) {
    html::Table table("The reference’s own error, root mean square over a region, in <i>Y</i>",
        {words("Region"), {"<i>s</i>", true}, {"Its error", true}, {"Share of the smallest RMSE", true}});
    for (const ReferenceMeter& r : all)
        table.row({html::heading(escape(r.region)), html::figure(shortest(r.s)),
            html::figure(figures(r.quadrature_error, 2)), html::figure(percent(r.error_share, 2))});
    return table.str();
}

}  // namespace

PageSection reference(Page& page) {
    const auto& all = page.in.metrics.references;
    const ReferencePlan& plan = page.in.experiment.reference;
    const std::string plates = page.figures.plates(PlateKind::reference);
    if (all.empty() && plates.empty()) return {};
    const bool both = !all.empty() && all.front().max_relative_rmse_change.has_value();
    std::string out = quadrature_prose;
    if (both)
        out = fmt::format(both_prose, fmt::arg("lobe", plural(plan.lobe_spp, "sample")),
            fmt::arg("disk", plural(plan.disk_spp, "sample")), fmt::arg("seed", plan.seed),
            fmt::arg("used", plan.kind == ReferenceKind::quadrature ? "quadrature" : "Monte Carlo reference"));
    if (!all.empty()) out += (both ? table_of_both(all) : table_of_one(all)) + not_good_enough(all);
    return {"reference", "The reference", out + plates};
}

}  // namespace crescent::inline report
