// Pilots are drawn by an even cover of u; the rim is where the sides of the unit square go.
#include "trials/pilots.h"

#include <algorithm>
#include <cmath>

#include "math/functions.h"
#include "simd/random.h"
#include "subjects/numbers.h"

namespace crescent::inline trials {

namespace {

constexpr std::size_t fixed_pilots = 768;

/// The axis of the circle on which directions lie: the rim of a cone or a ring, whose jump is then a coordinate line.
std::optional<Vec3d> axis_of_circle(std::span<const Vec3d> rim, double known_to) {
    const Vec3d p = rim[0], normal = cross(rim[rim.size() / 3] - p, rim[2 * rim.size() / 3] - p);
    if (!(dot(normal, normal) > 1e-12)) return {};
    const Vec3d axis = normalize(normal);
    for (Vec3d w : rim)
        if (std::fabs(dot(w - p, axis)) > known_to) return {};
    return axis;
}

/// The rim where p ends, to the last digit, about an axis that is known to a rounding; none where p ends elsewhere. p
/// may have a pole there, and a rounding then hides a thousandth of it.
std::vector<Vec3d> exact_rim(const Questions& work, Vec3d axis, double height) {
    constexpr std::size_t around = 7;
    const SphereMap map(axis);
    std::vector<double> low(around, height * (1 - 1e-4)), high(around, height * (1 + 1e-4));
    const auto at = [&](std::span<const double> a) {
        std::vector<Vec3d> out;
        for (std::size_t k = 0; k < around; ++k)
            out.push_back(map.direction({a[k], (static_cast<double>(k) + 0.37) / around}));
        return out;
    };
    const std::vector<double> inside = work.any_pdf(at(low)), outside = work.any_pdf(at(high));
    for (std::size_t k = 0; k < around; ++k)
        if (!(inside[k] > 0) || outside[k] > 0) return {};
    std::vector<double> mid(around);
    for (int step = 0; step < 44; ++step) {
        for (std::size_t k = 0; k < around; ++k) mid[k] = 0.5 * (low[k] + high[k]);
        const std::vector<double> p = work.any_pdf(at(mid));
        for (std::size_t k = 0; k < around; ++k) (p[k] > 0 ? low : high)[k] = mid[k];
    }
    return at(low);
}

}  // namespace

/// Where the sampler draws, by an even cover of u, and where a mirror lobe would be, at every scale.
void Pilots::find_pilot_directions() {
    for (int t = 0; t < subject.techniques(); ++t) {
        std::vector<Draw> pilot;
        if (subject.draws_at_will()) {
            Numbers middle;
            for (int k = 0; k < Numbers::most; ++k) middle[k] = 0.5;
            std::vector<Numbers> u;
            for (std::uint64_t i = 0; i < 2048; ++i) u.push_back(even_cover(i, middle, traits.numbers));
            pilot.resize(u.size());
            subject.sample(t, trial.wo, u, pilot);
        } else {
            const auto& all = first(0).draws;
            pilot.assign(
                all.begin(), all.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(all.size(), 2048)));
        }
        for (const Draw& d : pilot)
            if (d.pdf > 0 && is_finite(d.wi)) pilot_directions_.push_back(d.wi);
        if (subject.draws_at_will()) find_support_boundary(t);
    }
    drawn_pilots_ = pilot_directions_.size();
    // About the mirror, where lobes stand, and about w_o, where 1 / (w_o.h) has a pole for half vectors along the
    // surface.
    for (const SphereMap& about : {SphereMap(mirror(trial.wo)), SphereMap(-trial.wo)})
        for (std::uint64_t i = 0; i < fixed_pilots / 2; ++i) {
            const Vec2d v = even_cover(i, {0.1, 0.7}, 2);
            pilot_directions_.push_back(about.direction({0.5 * math::pow(10.0, -7 * v.x), v.y}));
        }
}

/// Where the sides of the unit square go: for most warps the rim of what is drawn, to the last digit. What chooses
/// among lobes is held at a few values.
void Pilots::find_support_boundary(int technique) {
    constexpr std::size_t along = 32;
    const std::uint64_t choices = traits.numbers > 2 ? 4 : 1;
    std::vector<Numbers> u;
    for (std::uint64_t c = 0; c < choices; ++c)
        for (double side : {0.0, 1 - 0x1p-24})
            for (std::size_t i = 0; i < along; ++i) {
                const double v = (static_cast<double>(i) + 0.5) / along;
                for (const Vec2d at : {Vec2d{side, v}, Vec2d{v, side}}) {
                    u.push_back(even_cover(c, {}, traits.numbers));
                    u.back()[0] = at.x, u.back()[1] = at.y;
                }
            }
    std::vector<Draw> drawn(u.size());
    subject.sample(technique, trial.wo, u, drawn);
    for (const Draw& d : drawn)
        if (d.pdf > 0 && is_finite(d.wi)) support_boundary_.push_back(d.wi);
    std::optional<Vec3d> nearly;  // a circle along which p does not end
    for (std::size_t side = 0; side < 4 * choices && !circle_; ++side) {
        std::vector<Vec3d> rim;
        for (std::size_t i = 0; i < along; ++i) {
            const Draw& d = drawn[(side / 2) * 2 * along + 2 * i + side % 2];
            if (d.pdf > 0 && is_finite(d.wi)) rim.push_back(d.wi);
        }
        if (rim.size() < along) continue;
        constexpr double closely = 1e-7;
        const std::optional<Vec3d> about = axis_of_circle(rim, std::max(closely, 16 * direction_resolution()));
        if (!about) continue;
        const double height = SphereMap(*about).height(rim[0]);
        const std::vector<Vec3d> exact = exact_rim(*this, *about, height);
        if (exact.empty() && !nearly) nearly = axis_of_circle(rim, closely);
        if (!exact.empty()) circle_ = axis_of_circle(exact, 1e-10);
        if (!circle_) continue;
        const SphereMap map(*circle_);
        std::erase_if(support_boundary_, [&](Vec3d w) { return std::fabs(map.height(w) / height - 1) < 1e-5; });
        support_boundary_.insert(support_boundary_.end(), exact.begin(), exact.end());
        for (Vec3d w : exact) pole_ = std::max(pole_.value_or(0), map.height(w));
        if (!has_pole_at(map, *pole_)) pole_.reset();
    }
    if (!circle_) circle_ = nearly;
}

}  // namespace crescent::inline trials
