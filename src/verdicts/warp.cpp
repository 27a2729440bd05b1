// p |Jacobian of the warp|, which is 1 where one u alone leads to a direction and less where none does: what
// jacobian.cpp measures, held against p.
#include "verdicts/warp.h"

#include <algorithm>
#include <fmt/format.h>

#include "subjects/numbers.h"
#include "trials/trial_context.h"
#include "verdicts/normalised.h"
#include "warps/jacobian.h"
#include "warps/preimages.h"

namespace crescent::inline verdicts {

namespace {

bool tell(Verdict& v, std::string say) {
    v.state = State::wrong;
    v.say = std::move(say);
    return true;
}

/// Below 1 at some points, or at nearly all a little.
bool is_denser_than_p(const TrialContext& work, const WarpFinding& warp, const std::string& suffix, Verdict& v) {
    if (warp.below >= 3 && static_cast<double>(warp.below) > 5e-3 * static_cast<double>(warp.usable)) {
        v.evidence["smallest_p_jacobian"] = warp.smallest;
        return tell(v,
            fmt::format("p |Jacobian of the warp| is below 1 at {} of {} points, least at {}: {:.6g}. The sampler "
                        "is denser there than p says{}.",
                warp.below, warp.usable, told(warp.at, work.traits.numbers, 4), warp.smallest,
                work.traits.numbers > 2 ? "; what chooses was held, and its share counts" : ""));
    }
    v.evidence["p_jacobian_third_quartile" + suffix] = warp.nowhere_above;
    v.evidence["p_jacobian_least_region" + suffix] = warp.region_below;
    if (warp.nowhere_above < 1 - 1.5 * granted_mass)  // what normalised grants p, and half as much
        return tell(v,
            fmt::format("p |Jacobian of the warp| is {:.6g} or less at three of four points: the sampler is denser "
                        "nearly everywhere than p says, and what is left over of p is never drawn.",
                warp.nowhere_above));
    constexpr double of_a_region = 8e-4;  // a few dozen points, each known to 3e-4
    if (!(warp.region_below < 1 - of_a_region)) return false;
    return tell(v,
        fmt::format("p |Jacobian of the warp| is {:.6g} or less at three of four points with u1 from {:g} to {:g} and "
                    "u2 from {:g} to {:g}: the sampler is denser there than p says.",
            warp.region_below, warp.region.x, warp.region.x + 0.25, warp.region.y, warp.region.y + 0.25));
}

bool stands_still(const WarpFinding& warp, const std::string& suffix, Verdict& v) {
    v.evidence["steps_of_u" + suffix] = warp.steps_tried;
    v.evidence["steps_without_a_move" + suffix] = warp.stuck;
    if (warp.steps_tried < 40 || static_cast<double>(warp.stuck) <= 0.4 * static_cast<double>(warp.steps_tried))
        return false;
    return tell(v,
        fmt::format("The direction stands still for {} of {} moves of u by 2^-19: u is used with too few bits, and "
                    "only a grid of directions is ever drawn.",
            warp.stuck, warp.steps_tried));
}

/// What several lobes draw together in one direction is more than p says.
bool lobes_are_denser_than_p(const TrialContext& work, int technique, Verdict& v) {
    if (!work.traits.has_pdf) return false;
    const Reached& found = preimages_of(work, technique);
    if (found.looked_at > 0) v.evidence["reached_by_several_lobes" + work.suffix(technique)] = found.looked_at;
    if (found.denser < 3 || 20 * found.denser < found.looked_at) return false;
    v.evidence["largest_drawn_over_p"] = found.most;
    return tell(v,
        fmt::format(
            "Several lobes reach one direction, and together draw it more often than p says at {} of {} "
            "directions, most at w = ({:.6g}, {:.6g}, {:.6g}): {:.5g} times. What a lobe is chosen with, or its own "
            "density, is not what p has of it.",
            found.denser, found.looked_at, found.worst.x, found.worst.y, found.worst.z, found.most));
}

}  // namespace

bool warp_is_wrong(const TrialContext& work, int technique, WarpSummary& all, Verdict& v) {
    const WarpFinding& warp = study_warp(work, technique);
    const std::string suffix = work.suffix(technique);
    v.evidence["warp_points" + suffix] = warp.usable;
    v.evidence["p_jacobian_is_1" + suffix] = warp.one_to_one;
    all.one_to_one = std::min(all.one_to_one, warp.one_to_one);
    all.choosers = std::max(all.choosers, warp.choosers);
    return is_denser_than_p(work, warp, suffix, v) || stands_still(warp, suffix, v) ||
        lobes_are_denser_than_p(work, technique, v);
}

std::string told_of_warp(const TrialContext& work, const WarpSummary& warps) {
    if (!work.traits.has_pdf) return "; there is no pdf to hold the warp against";
    if (work.scatter().pdf()) return "";  // said already
    if (!work.subject.draws_at_will()) return "; the warp itself is not at hand";
    if (work.traits.own_random)
        return "; the sampler draws random numbers of its own, so that the warp was not looked at";
    if (warps.choosers > 1) return "; several random numbers choose among lobes, so that the warp was not looked at";
    if (!(warps.one_to_one > 0.99)) return ", and p |Jacobian of the warp| is nowhere below 1";
    return warps.choosers > 0 ? ", and p |Jacobian of the warp| is 1 on every branch of the choosing number"
                              : ", and p |Jacobian of the warp| is 1";
}

}  // namespace crescent::inline verdicts
