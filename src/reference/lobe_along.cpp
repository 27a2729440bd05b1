// Gauss-Kronrod with 15 points over stretches that double away from the axis, 7 where the whole is shorter than 0.3 of
// the lobe's width; stretches whose two rules differ are halved, six times at most.
#include "reference/lobe_along.h"

#include <algorithm>
#include <cmath>

#include "reference/kronrod.h"
#include "math/functions.h"

namespace crescent::inline reference {

namespace {

/// Halved a few times where two rules differ.
template <std::size_t n, class F>
AlongLobe panel(const KronrodRule<n>& rule, const F& f, double lo, double hi, double good, int halvings) {
    const auto [fine, off, spread] = by_two_rules(rule, f, lo, hi);
    const double error = std::fabs(off);
    if (halvings == 0 || error <= good || error <= 1e-7 * std::fabs(fine)) return {fine, error};
    const double middle = 0.5 * (lo + hi);
    const AlongLobe a = panel(rule, f, lo, middle, good, halvings - 1),
                    b = panel(rule, f, middle, hi, good, halvings - 1);
    return {a.value + b.value, a.error + b.error};
}

}  // namespace

double lobe_stretch(const DiskPoint& point) {
    return lobe_info(point.surface.brdf).about_mirror ? 1 : std::max(point.wo.z, 1e-6);
}

LobeShape::LobeShape(const DiskPoint& point) : stretch(lobe_stretch(point)) {
    const Surface& surface = point.surface;
    const LobeWidth across = lobe_info(surface.brdf).width(surface.s, surface.alpha);
    width = std::min(across.width, 1.0), reach = across.reach;
}

double LobeShape::width_at(double c) const {  // (al cos / width)^2 + (al sin / (width stretch))^2 = 1
    return width / std::sqrt(c * c + (1 - c * c) / sqr(stretch));
}

AlongLobe lobe_along(const DiskPoint& point, Vec3d axis, Vec3d aside, Interval part, double width) {
    const auto f = [&](double al) {
        const auto [sin, cos] = math::sincos(al);
        const Vec3d wi = cos * axis + sin * aside;
        return wi.z > 0 ? point.lobe(wi) * wi.z * sin : 0.0;
    };
    if (part.hi - part.lo < 0.3 * width) return panel(kronrod_7, f, part.lo, part.hi, 0, 2);
    AlongLobe sum;
    for (double lo = part.lo, hi; lo < part.hi; lo = hi) {
        hi = std::max(width, 2 * lo);
        if (hi > 0.75 * part.hi) hi = part.hi;
        const AlongLobe one = panel(kronrod_15, f, lo, hi, 1e-8 * sum.value, 6);
        sum.value += one.value, sum.error += one.error;
    }
    return sum;
}

}  // namespace crescent::inline reference
