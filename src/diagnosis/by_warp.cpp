// What is drawn against pdf(w): by 1 / |Jacobian of the warp| where one u alone leads to each direction, by lobes where
// a number chooses among them, by bins else.
#include <cmath>

#include "diagnosis/diagnosis.h"
#include "warps/jacobian.h"

namespace crescent::inline diagnosis {

std::vector<Ratio> drawn_over_claimed(const TrialContext& work, int technique) {
    const std::vector<WarpPoint>& points = study_warp(work, technique).points;
    std::vector<double>& claimed = work.kept.claimed[static_cast<std::size_t>(technique)];
    if (claimed.size() != points.size()) {
        std::vector<Vec3d> wi;
        for (const WarpPoint& p : points) wi.push_back(p.wi);
        claimed = work.pdf(technique, wi);
    }
    std::vector<Ratio> ratios;
    for (std::size_t i = 0; i < points.size(); ++i)
        ratios.push_back({points[i].wi, 1 / (claimed[i] * points[i].jacobian), points[i].error});
    return ratios;
}

std::vector<Ratio> usable(std::vector<Ratio> all) {
    std::erase_if(all, [](const Ratio& r) { return !(r.value > 0) || !std::isfinite(r.value) || r.error > 0.05; });
    return all;
}

namespace {

constexpr std::size_t least = 100;  // ratios

/// Where one u alone leads to each direction.
std::optional<Diagnosis> diagnose_by_warp(const TrialContext& work, int technique) {
    const WarpFinding& warp = study_warp(work, technique);
    const std::vector<Ratio> known = usable(drawn_over_claimed(work, technique));
    const bool enough_known = 10 * known.size() >= 9 * warp.points.size();
    if (enough_known)
        if (std::optional<Diagnosis> found = explain(work, known); found && comes_to_one(work, technique, *found)) {
            found->means = "what is drawn is pdf(w) times " + found->means;
            return found;
        }
    if (mostly_one(known) && enough_known) return {};
    return turned(work, technique, warp.points, drawn_over_claimed(work, technique));
}

}  // namespace

std::optional<Diagnosis> diagnose_density(const TrialContext& work, int technique) {
    const WarpFinding& warp = study_warp(work, technique);
    if (warp.points.size() >= least)
        if (std::optional<Diagnosis> found = diagnose_by_warp(work, technique)) return found;
    if (std::optional<Diagnosis> found = diagnose_several_lobes(work, technique)) return found;
    return diagnose_by_bins(work, technique);
}

}  // namespace crescent::inline diagnosis
