// Poles along a rim: light by area from a ball, whose p goes as 1 / cos at the outline.
#include <algorithm>
#include <cmath>

#include "simd/scalar.h"
#include "trials/densities.h"

namespace crescent::inline trials {

/// p grows as one over the root of the distance to the rim at this height: ten times over from 1e-4 of it to 1e-6.
bool Pilots::has_pole_at(const SphereMap& map, double height) const {
    constexpr double near = 1e-6, far = 1e-4, turn = 0.37;
    const std::vector<Vec3d> at = {
        map.direction({height * (1 - near), turn}), map.direction({height * (1 - far), turn})};
    const std::vector<double> p = any_pdf(at);
    const double grows = p[0] / std::max(p[1], 1e-300), due = std::sqrt(far / near);
    return grows > 0.8 * due && grows < 1.2 * due;
}

/// Of cells about a circle along which p grows as one over the root of the distance: a = h (1 - s^2), with which 2 h s
/// ds takes the root away; beyond h, a itself.
Integral Densities::mass_inside_pole(
    int technique, const Density& d, std::vector<Rect> cells, const Effort& effort) const {
    const double h = *pole_;
    const auto there = [h](double a) { return a < h ? h * (1 - std::sqrt(1 - a / h)) : a; };
    const auto back = [h](double t) { return t < h ? h * (1 - sqr(1 - t / h)) : t; };
    for (std::size_t i = 0, n = cells.size(); i < n; ++i) {
        if (cells[i].a0 < h && cells[i].a1 > h) cells.push_back(cells[i]), cells[i].a1 = cells.back().a0 = h;
        cells[i].a0 = there(cells[i].a0), cells[i].a1 = there(cells[i].a1);
    }
    SamplesPerBin samples = samples_per_bin_of(technique, d);
    for (auto& bin : samples.bins)
        for (SampleValue& w : bin) w.g *= w.at.x < h ? 2 * std::sqrt(1 - w.at.x / h) : 1, w.at.x = there(w.at.x);
    const Batch p = batch_of(technique, d.map);
    const auto g = [&](std::span<const Vec2d> at, std::span<double> out) {
        std::vector<Vec2d> where(at.begin(), at.end());
        for (Vec2d& v : where) v.x = back(v.x);
        p(where, out);
        for (std::size_t i = 0; i < at.size(); ++i)
            if (at[i].x < h) out[i] *= 2 * (1 - at[i].x / h);
    };
    return integrate(std::move(cells), static_cast<int>(samples.bins.size()), g, effort, &samples);
}

}  // namespace crescent::inline trials
