// Where the lobes of a trial stand, where the rim of what is drawn runs, and how many samples draw nothing.
#include <algorithm>
#include <cmath>

#include "math/functions.h"
#include "simd/random.h"
#include "verdicts/numbers.h"
#include "verdicts/trial_context.h"

namespace crescent::inline verdicts {

namespace {

constexpr std::size_t fixed_guides = 768;

/// The axis of the circle on which directions lie: the rim of a cone or a ring, whose jump is then a coordinate line.
std::optional<Vec3d> axis_of_circle(std::span<const Vec3d> rim) {
    const Vec3d p = rim[0], normal = cross(rim[rim.size() / 3] - p, rim[2 * rim.size() / 3] - p);
    if (!(dot(normal, normal) > 1e-12)) return {};
    const Vec3d axis = normalize(normal);
    for (Vec3d w : rim)
        if (std::fabs(dot(w - p, axis)) > 1e-7) return {};
    return axis;
}

}  // namespace

/// Where the sampler draws, by an even cover of u, and where a mirror lobe would be, at every scale.
void TrialContext::find_guides() {
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
            const auto& all = first_[0].draws;
            pilot.assign(
                all.begin(), all.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(all.size(), 2048)));
        }
        for (const Draw& d : pilot)
            if (d.pdf > 0 && is_finite(d.wi)) guides_.push_back(d.wi);
        if (subject.draws_at_will()) find_rims(t);
    }
    drawn_guides_ = guides_.size();
    // About the mirror, where lobes stand, and about w_o, where 1 / (w_o.h) has a pole for half vectors along the
    // surface.
    for (const SphereMap& about : {SphereMap(mirror(trial.wo)), SphereMap(-trial.wo)})
        for (std::uint64_t i = 0; i < fixed_guides / 2; ++i) {
            const Vec2d v = even_cover(i, {0.1, 0.7}, 2);
            guides_.push_back(about.direction({0.5 * math::pow(10.0, -7 * v.x), v.y}));
        }
}

/// Where the sides of the unit square go: for most warps the rim of what is drawn, to the last digit. What chooses
/// among lobes is held at a few values.
void TrialContext::find_rims(int technique) {
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
        if (d.pdf > 0 && is_finite(d.wi)) rims_.push_back(d.wi);
    for (std::size_t side = 0; side < 4 * choices && !circle_; ++side) {
        std::vector<Vec3d> rim;
        for (std::size_t i = 0; i < along; ++i) {
            const Draw& d = drawn[(side / 2) * 2 * along + 2 * i + side % 2];
            if (d.pdf > 0 && is_finite(d.wi)) rim.push_back(d.wi);
        }
        if (rim.size() == along) circle_ = axis_of_circle(rim);
    }
}

void TrialContext::share_nothing(int technique, Density& d) const {
    const SampleBatch& b = first(technique);
    if (b.nothing > 0 && subject.draws_at_will()) estimate_null_fraction(technique, d, rigour.full ? 16384 : 2048);
    else {
        d.nothing = static_cast<double>(b.nothing) / static_cast<double>(b.draws.size());
        d.delta = static_cast<double>(b.deltas) / static_cast<double>(b.draws.size());
    }
    // Too rare to have been met: half a million draws show a share of 5e-5 twenty times over.
    if (std::fabs(d.mass.value + d.nothing - 1) > 5e-5 && d.mass.value < 1 && subject.draws_at_will())
        estimate_null_fraction(technique, d, 32768);
}

/// Sixteen random shifts of an even cover give the share of u that draws nothing and its standard error.
void TrialContext::estimate_null_fraction(int technique, Density& d, std::uint64_t wanted) const {
    constexpr int shifts = 16;
    const std::uint64_t n = affordable(2 * shifts * wanted, for_later) / (2 * shifts);  // a draw, and p at it
    double sum = 0, square = 0, deltas = 0;
    std::vector<Numbers> u(n);
    std::vector<Draw> draws(n);
    for (int k = 0; k < shifts; ++k) {
        const Numbers shift = drawn_numbers(seed_of(rigour.seed, 0x51f7u), index_, static_cast<std::uint64_t>(k),
            8u + static_cast<std::uint32_t>(technique), traits.numbers);
        for (std::uint64_t i = 0; i < n; ++i) u[i] = even_cover(i, shift, traits.numbers);
        subject.sample(technique, trial.wo, u, draws);
        const std::vector<double> p = pdf_of_drawn(technique, draws);
        double none = 0;
        for (std::size_t i = 0; i < n; ++i)
            if (is_null_sample(draws[i], p[i])) ++none, deltas += draws[i].delta > 0;
        sum += none / static_cast<double>(n);
        square += sqr(none / static_cast<double>(n));
    }
    d.nothing = sum / shifts;
    d.delta = deltas / (shifts * static_cast<double>(n));
    d.nothing_se = std::sqrt(std::max(square / shifts - sqr(d.nothing), 0.0) / (shifts - 1));
}

}  // namespace crescent::inline verdicts
