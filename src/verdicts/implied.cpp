// The density that a sampler without pdf(w) implies: 1/|J| of its warp, where it is a function of two numbers that
// leads from one u to each direction; else the share of draws in bins of cos theta x phi over their solid angle.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "math/functions.h"
#include "verdicts/ordered.h"

namespace crescent::inline verdicts {

namespace {

/// Rows "wix, wiy, wiz, pdf" by the Jacobian; none where it is not at hand, or where several u lead to one direction:
/// then the mean of |J| over u is more than the solid angle of the bins that draws fall into.
nlohmann::ordered_json by_jacobian(const TrialContext& work, double reached) {
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    if (work.traits.numbers != 2 || work.traits.own_random) return rows;
    const WarpFinding& warp = study_warp(work, 0);
    double mean = 0;
    for (const WarpPoint& p : warp.points) mean += p.jacobian / static_cast<double>(warp.points.size());
    if (warp.points.size() < 512 || mean > 1.1 * reached) return rows;
    for (std::size_t i = 0; i < std::min<std::size_t>(warp.points.size(), 512); ++i) {
        const WarpPoint& p = warp.points[i];
        rows.push_back({p.wi.x, p.wi.y, p.wi.z, 1 / p.jacobian});
    }
    return rows;
}

}  // namespace

Verdict implied_density(TrialContext& work, Verdict v) {
    const Density& d = work.density(0);
    const SampleBatch& b = work.first(0);
    std::vector<double> seen(d.mass.bins.size());
    for (std::size_t i = 0; i < b.draws.size(); ++i)
        if (!is_null_sample(b.draws[i], b.pdf[i])) ++seen[d.bin_of(d.map.coordinates(b.draws[i].wi))];
    const double n = static_cast<double>(b.draws.size());
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    double highest = 0, reached = 0;
    Vec3d at{};
    for (std::size_t i = 0; i < seen.size(); ++i) {
        const std::size_t ring = i / static_cast<std::size_t>(d.sectors),
                          sector = i % static_cast<std::size_t>(d.sectors);
        const double angle = 2 * pi * (d.rings[ring + 1] - d.rings[ring]) / d.sectors,
                     a = 0.5 * (d.rings[ring] + d.rings[ring + 1]);
        const double phi = 2 * pi * (static_cast<double>(sector) + 0.5) / d.sectors, p = seen[i] / (n * angle);
        rows.push_back({1 - a, phi, p, std::sqrt(seen[i]) / (n * angle)});
        if (seen[i] > 0) reached += angle;
        if (p > highest) highest = p, at = d.map.direction({a, phi / (2 * pi)});
    }
    nlohmann::ordered_json of_warp = by_jacobian(work, reached);
    const bool smooth = !of_warp.empty();
    v.evidence["implied_by"] = smooth ? "jacobian" : "bins";
    if (smooth)
        v.evidence["implied_density"] = {{"columns", {"wix", "wiy", "wiz", "pdf"}}, {"rows", std::move(of_warp)}};
    v.evidence["implied_bins"] = {
        {"columns", {"cos_theta", "phi", "pdf", "standard_error"}}, {"rows", std::move(rows)}};
    if (work.settings.pictures)
        work.maps.push_back({work.trial.arm, work.trial.text(), "cos theta x phi about n",
            static_cast<int>(d.rings.size()) - 1, d.sectors, seen, seen});
    v.state = State::skipped;
    v.say = fmt::format(
        "There is no pdf(w) to hold the draws against. What they imply stands in the evidence, by {}: highest in the "
        "bin about ({:.4g}, {:.4g}, {:.4g}), {:.4g} 1/sr.",
        smooth ? "1/|Jacobian| of the warp and by bins" : "bins", at.x, at.y, at.z, highest);
    if ((work.subject.has_f() && work.weighs()) || b.deltas == b.draws.size()) return v;
    const char* has = !work.weighs() ? "neither a pdf(w) nor a weight with the draws" : "no pdf(w), and no f";
    v.state = State::inconclusive;
    v.say += fmt::format(" There is {}: whether the draws are right could not be examined.", has);
    v.settle = work.weighs() ? "f(w), which the mean of the weights is held against."
                             : "pdf(w), or f(w) and a weight, f |cos| / p, with each draw (weight=yes).";
    return v;
}

}  // namespace crescent::inline verdicts
