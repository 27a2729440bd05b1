// Where a density is off most: the bin, in degrees of the local frame, how many fell there and how many ought to have.
#include "verdicts/worst_bin.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "judgements/pictures.h"
#include "math/functions.h"
#include "stats/bins.h"
#include "stats/p_values.h"
#include "trials/trial_context.h"

namespace crescent::inline verdicts {

void tell_worst(
    Verdict& v, const Density& d, const std::vector<double>& observed, const std::vector<double>& expected) {
    const std::size_t worst = worst_bin(observed, expected), sectors = static_cast<std::size_t>(d.sectors),
                      ring = worst / sectors;
    const double a = 0.5 * (d.rings[ring] + d.rings[ring + 1]);
    const Vec3d at = d.map.direction({a, (static_cast<double>(worst % sectors) + 0.5) / static_cast<double>(sectors)});
    const double theta = math::acos(std::clamp(at.z, -1.0, 1.0)) * 180 / pi, turn = math::atan2(at.y, at.x) * 180 / pi;
    const double phi = turn < 0 ? turn + 360 : turn;
    v.say += fmt::format(" Most at theta {:.1f} deg, phi {:.1f} deg: {:.0f} seen, {:.1f} due.", theta, phi,
        observed[worst], expected[worst]);
    v.evidence["worst_bin"] = {
        {"theta_deg", theta}, {"phi_deg", phi}, {"seen", observed[worst]}, {"due", expected[worst]}};
}

}  // namespace crescent::inline verdicts
