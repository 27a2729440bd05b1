// The density that a sampler without pdf(w) implies: 1/|J| of its warp, where it is a function of two numbers that
// leads from one u to each direction; else the share of draws in bins of cos theta x phi over their solid angle. By
// rings about n in any case. What is counted has its standard error, of a binomial law.
#include "verdicts/implied.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "math/functions.h"
#include "trials/trial_context.h"
#include "warps/jacobian.h"

namespace crescent::inline verdicts {

namespace {

/// A share of the draws over the solid angle that it fell into. 1/sr.
struct Counted {
    double p = 0, se = 0;
};

Counted counted(double seen, double draws, double solid_angle) {
    return {seen / (draws * solid_angle), std::sqrt(seen * std::max(1 - seen / draws, 0.0)) / (draws * solid_angle)};
}

/// Where the density is highest, and what it is known to.
struct Peak {
    Vec3d at{};
    double p = 0, se = 0;
    std::size_t of = 0;  // points of the warp, or draws in the bin
};

/// Points of the warp by the Jacobian; none where it is not at hand, or where several u lead to one direction: then the
/// mean of |J| over u is more than the solid angle of the bins that draws fall into.
std::span<const WarpPoint> by_jacobian(const TrialContext& work, double reached) {
    if (work.traits.numbers != 2 || work.traits.own_random) return {};
    const WarpFinding& warp = study_warp(work, 0);
    double mean = 0;
    for (const WarpPoint& p : warp.points) mean += p.jacobian / static_cast<double>(warp.points.size());
    if (warp.points.size() < 512 || mean > 1.1 * reached) return {};
    return warp.points;
}

Peak peak_of(std::span<const WarpPoint> points) {
    constexpr double exact = 0.01;  // relative: seams and cells of tables are known to less
    Peak out;
    out.of = points.size();
    for (const WarpPoint& p : points)
        if (p.error < exact && 1 / p.jacobian > out.p)
            out = {p.wi, 1 / p.jacobian, p.error / p.jacobian, points.size()};
    return out;
}

nlohmann::ordered_json rows_of(std::span<const WarpPoint> points) {
    constexpr std::size_t most = 512;
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const WarpPoint& p : points.first(std::min(points.size(), most)))
        rows.push_back({p.wi.x, p.wi.y, p.wi.z, 1 / p.jacobian});
    return rows;
}

/// The bins of cos theta x phi, as rows "cos theta, phi, pdf, standard error".
struct ByBins {
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    std::vector<double> p;
    double reached = 0;  // solid angle of bins that draws fell into, sr
    Peak peak;           // by what it is at least, of many draws: a bin of few may be high by chance
};

ByBins by_bins(const TrialContext& work) {
    const Density& d = work.density(0);
    const SampleBatch& b = work.first(0);
    std::vector<double> seen(d.mass.bins.size());
    const std::vector<Vec2d>& placed = work.coordinates_of(b, d.map);
    for (std::size_t i = 0; i < b.draws.size(); ++i)
        if (!is_null_sample(b.draws[i], b.pdf[i])) ++seen[d.bin_of(placed[i])];
    ByBins out;
    constexpr double beyond_chance = 4;  // standard errors, of hundreds of bins
    constexpr double many = 100;         // draws, where a bin has them
    const double needed = std::ranges::any_of(seen, [](double n) { return n >= many; }) ? many : 1;
    double least = -1e300;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        const std::size_t sectors = static_cast<std::size_t>(d.sectors), ring = i / sectors;
        const double angle = 2 * pi * (d.rings[ring + 1] - d.rings[ring]) / d.sectors,
                     a = 0.5 * (d.rings[ring] + d.rings[ring + 1]),
                     turns = (static_cast<double>(i % sectors) + 0.5) / d.sectors;
        const Counted here = counted(seen[i], static_cast<double>(b.draws.size()), angle);
        out.rows.push_back({1 - a, 2 * pi * turns, here.p, here.se});
        out.p.push_back(here.p);
        if (seen[i] > 0) out.reached += angle;
        if (seen[i] < needed || here.p - beyond_chance * here.se <= least) continue;
        least = here.p - beyond_chance * here.se;
        out.peak = {d.map.direction({a, turns}), here.p, here.se, static_cast<std::size_t>(seen[i])};
    }
    return out;
}

/// Rows "from, to, pdf, standard error": the mean over rings of 5 deg about n, as far as there are draws.
nlohmann::ordered_json by_rings(const SampleBatch& b) {
    constexpr std::size_t step = 5, rings = 180 / step;  // degrees
    std::vector<double> seen(rings);
    std::size_t last = rings / 2;
    for (std::size_t i = 0; i < b.draws.size(); ++i) {
        if (is_null_sample(b.draws[i], b.pdf[i])) continue;
        const double theta = math::acos(std::clamp(b.draws[i].wi.z, -1.0, 1.0)) * 180 / pi;
        const std::size_t ring = std::min(static_cast<std::size_t>(theta / step), rings - 1);
        ++seen[ring];
        last = std::max(last, ring + 1);
    }
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < last; ++i) {
        const double from = static_cast<double>(i * step), to = from + step;
        const double angle = 2 * pi * (math::cos(from * pi / 180) - math::cos(to * pi / 180));
        const Counted here = counted(seen[i], static_cast<double>(b.draws.size()), angle);
        rows.push_back({from, to, here.p, here.se});
    }
    return rows;
}

std::string told(const Peak& peak, bool smooth) {
    const Vec3d w = peak.at;
    if (smooth)
        return fmt::format(
            "What they imply, by 1/|Jacobian| of the warp, is highest about ({:.4g}, {:.4g}, {:.4g}): {:.4g} 1/sr, of "
            "{} points inside the square of u.",
            w.x, w.y, w.z, peak.p, peak.of);
    return fmt::format(
        "What they imply, by bins, is highest in the bin about ({:.4g}, {:.4g}, {:.4g}): {:.4g} +- {:.2g} 1/sr, of {} "
        "draws.",
        w.x, w.y, w.z, peak.p, peak.se, peak.of);
}

void note(const TrialContext& work, ByBins bins, Verdict& v) {
    const std::span<const WarpPoint> points = by_jacobian(work, bins.reached);
    const bool smooth = !points.empty();
    const Peak peak = smooth ? peak_of(points) : bins.peak;
    const Vec3d w = peak.at;
    v.evidence["implied_by"] = smooth ? "jacobian" : "bins";
    v.evidence["implied_peak"] = {{"wi", {w.x, w.y, w.z}}, {"pdf", peak.p}, {"standard_error", peak.se}};
    if (smooth) v.evidence["implied_density"] = {{"columns", {"wix", "wiy", "wiz", "pdf"}}, {"rows", rows_of(points)}};
    v.evidence["implied_rings"] = {
        {"columns", {"from_deg", "to_deg", "pdf", "standard_error"}}, {"rows", by_rings(work.first(0))}};
    v.evidence["implied_bins"] = {
        {"columns", {"cos_theta", "phi", "pdf", "standard_error"}}, {"rows", std::move(bins.rows)}};
    v.say = "There is no pdf(w) to hold the draws against. " +
        (peak.p > 0 ? told(peak, smooth) : std::string("No direction is drawn as a density.")) +
        " The whole stands in the evidence.";
}

}  // namespace

Verdict implied_density(TrialContext& work, Verdict v) {
    const Density& d = work.density(0);
    ByBins bins = by_bins(work);
    if (work.settings.pictures)
        work.maps.push_back({work.trial.arm, work.trial.text(), "cos theta x phi about n",
            static_cast<int>(d.rings.size()) - 1, d.sectors, bins.p, {}, d.rings, bins.peak.p});
    note(work, std::move(bins), v);
    v.state = State::skipped;
    const SampleBatch& b = work.first(0);
    if ((work.subject.has_f() && work.weighs()) || b.deltas == b.draws.size()) return v;
    const char* has = !work.weighs() ? "neither a pdf(w) nor a weight with the draws" : "no pdf(w), and no f";
    v.state = State::inconclusive;
    v.say += fmt::format(" There is {}: whether the draws are right could not be examined.", has);
    v.settle = work.weighs() ? "f(w), which the mean of the weights is held against."
                             : "pdf(w), or f(w) and a weight, f |cos| / p, with each draw (weight=yes).";
    return v;
}

}  // namespace crescent::inline verdicts
