// What lies under the surface: whether f is not 0 there, whether the sampler reaches it, and what may come through.
//
// An albedo over the whole sphere may exceed 1 and be right: radiance scales by eta^2 across the surface, so that f,
// seen from the denser side, sums to as much as eta^2 (Walter et al. 2007, section 5.2; Veach 1997, section 5.2). What
// light from one direction below gives to all directions above, int f(a, b) cos a da, is at most 1 for such an f, and
// what leaves as importance is at most 1 for an f that is not scaled. An f that breaks both creates energy whatever the
// indices are.
#include "trials/transmission.h"

#include <algorithm>
#include <cmath>

#include "math/functions.h"
#include "math/spherical.h"

namespace crescent::inline trials {

namespace {

/// All over the lower half, straight through, and where a smooth surface of common indices would refract to.
std::vector<Vec3d> directions_below(const Questions& work) {
    std::vector<Vec3d> out;
    for (double z : {-0.02, -0.1, -0.25, -0.4, -0.6, -0.8, -0.95, -1.0})
        for (int k = 0; k < 8; ++k) out.push_back(math::spherical(z, 2 * pi * (k + 0.37) / 8));
    const Vec3d wo = work.trial.wo;
    for (double eta : {1 / 2.4, 1 / 1.5, 1 / 1.33, 1.0, 1.33, 1.5, 1.8, 2.4}) {  // below over above
        const double x = -wo.x / eta, y = -wo.y / eta, rest = 1 - x * x - y * y;
        if (rest > 0) out.push_back({x, y, -std::sqrt(rest)});
    }
    return out;
}

}  // namespace

void Draws::look_below() {
    std::vector<Vec3d> drawn;
    for (const SampleBatch& b : first_)
        for (std::size_t i = 0; i < b.draws.size(); ++i) {
            const Draw& d = b.draws[i];
            if (!(d.wi.z < 0) || !is_finite(d.wi)) continue;
            if (d.delta > 0 && d.weight.value_or(0) > 0) below_ = {true, true, d.wi, 0};
            if (is_null_sample(d, b.pdf[i])) continue;
            const double told = d.f ? *d.f : d.weight.value_or(0);
            if (!subject.has_f() && told > 0) below_ = {true, true, d.wi, told};
            if (drawn.size() < 64) drawn.push_back(d.wi);
        }
    if (!subject.has_f()) return;
    std::vector<Vec3d> at = directions_below(*this);
    at.insert(at.end(), drawn.begin(), drawn.end());
    const std::vector<double> value = f(at);
    std::vector<Vec3d> carrying;
    for (std::size_t i = 0; i < at.size(); ++i) {
        if (!(value[i] > 0)) continue;
        carrying.push_back(at[i]);
        if (value[i] > below_.f) below_.f = value[i], below_.at = at[i];
    }
    if (carrying.empty()) return;
    below_.transmits = true;
    const std::vector<double> p = any_pdf(carrying);
    below_.reached =
        below_.reached || !drawn.empty() || std::any_of(p.begin(), p.end(), [](double v) { return v > 0; });
}

Integral from_below(const Draws& work, Vec3d b) {
    const SphereMap map(Vec3d{0, 0, 1}), about(work.trial.wo);
    std::vector<Vec3d> pilot_directions;  // f(., b) is high about the w_o for which b was drawn
    for (int i = 0; i < 256; ++i) {
        const double turns = 0.618033988749895 * i;
        pilot_directions.push_back(about.direction({0.5 * math::pow(10.0, -6.0 * i / 256), turns - std::floor(turns)}));
    }
    return integral_of(
        refined_at_pilots(graded_cells(1), map, pilot_directions), 1,
        [&](std::span<const Vec2d> at, std::span<double> out) {
            std::vector<Pair> pairs;
            for (Vec2d v : at) pairs.push_back({map.direction(v), b});
            work.subject.f(pairs, out);
            for (std::size_t i = 0; i < out.size(); ++i) out[i] *= pairs[i].wo.z > 0 ? 2 * pi * pairs[i].wo.z : 0;
        },
        {work.tolerance(), work.affordable(work.settings.evaluations / 2)}, work.scatter().f());
}

std::vector<Vec3d> drawn_below(const Draws& work) {
    const SampleBatch& b = work.first(0);
    std::vector<Vec3d> out;
    double highest = 0;
    for (std::size_t i = 0; i < b.draws.size(); ++i) {
        const Draw& d = b.draws[i];
        if (!(d.wi.z < 0) || is_null_sample(d, b.pdf[i])) continue;
        if (out.size() < 3) out.push_back(normalize(d.wi));
        if (d.pdf > highest) highest = d.pdf, out.front() = normalize(d.wi);
    }
    if (out.empty()) out.push_back(work.below().at);
    return out;
}

}  // namespace crescent::inline trials
