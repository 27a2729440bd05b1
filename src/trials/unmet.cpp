// A tail that no draw met. Where p is tiny and f is not, X = f L cos / p is huge and nothing is drawn there: every
// sample then looks alike, and their mean is short by what comes from those directions. A mean is not accused before
// the integral of f L cos over the directions whose X exceeds the largest drawn weight W is known, and the variance of
// the weights up to W:
//
//   E[X; X <= W] = int f L cos - M,  M = int_{X > W} f L cos,  E[X^2; X <= W] = int_{X <= W} (f L cos)^2 / p
//
// Bernstein's inequality with that variance and the range W says how far a mean of n weights up to W may be off; that
// none of n draws met what p gives the chance Q = int_{X > W} p has the probability exp(-n Q).
#include "trials/unmet.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "cubature/mesh.h"
#include "math/functions.h"
#include "stats/moments.h"
#include "trials/delta.h"
#include "trials/weights.h"

namespace crescent::inline trials {

namespace {

/// Weights that differ by the rounding of a float p are alike.
constexpr double alike_weights = 1e-3;

/// What a technique makes of one direction.
struct Part {
    double share = 0;   // f cos times its MIS weight
    double weight = 0;  // X; 0 where p is
    double p = 0;
};

std::vector<Part> parts_of(const Integrals& work, int technique, std::span<const Vec3d> wi, bool even) {
    const std::vector<double> f = work.f(wi, true), p = work.pdf(technique, wi, true);
    std::vector<Pair> at;
    for (Vec3d w : wi) at.push_back({work.trial.wo, w});
    std::vector<double> mis(wi.size());
    work.subject.mis_weight(technique, at, mis);
    std::vector<Part> out(wi.size());
    for (std::size_t i = 0; i < wi.size(); ++i) {
        if (!(p[i] > 0) || !work.counts(wi[i])) continue;
        out[i].p = p[i];
        out[i].share = mis[i] * f[i] * std::fabs(wi[i].z);
        out[i].weight = out[i].share * (even ? 1 : work.light(wi[i])) / p[i];
    }
    return out;
}

/// Too few questions are left for cubatures, which follow the rim of the region: points at large tell what they can.
bool is_short(const Integrals& work, bool even) {
    constexpr std::size_t enough = 160000;
    return (even || work.trial.light.even()) && work.affordable(enough) < enough;
}

constexpr std::size_t few_points = 6000;

/// int of_light over the fill, by points.
Integral by_points(const Integrals& work, const Integrals::OfLight& of_light, bool even) {
    const SphereMap map(Vec3d{0, 0, 1});
    const double fill = even ? 1 : work.trial.light.fill;
    return integrate_by_points(
        graded_cells(work.whole() ? 2 : 1), 1,
        [&](std::span<const Vec2d> at, std::span<double> out) {
            std::vector<Vec3d> wi;
            for (Vec2d v : at) wi.push_back(map.direction(v));
            of_light(wi, out);
            for (double& v : out) v *= 2 * pi * fill;
        },
        std::min(few_points, work.affordable(2 * few_points) / 2));
}

/// int p over the whole sphere where X > W.
double chance_of(const Integrals& work, int technique, double threshold, bool even) {
    if (is_short(work, even)) {
        const double fill = even ? 1 : work.trial.light.fill;
        const auto p_above = [&](std::span<const Vec3d> wi, std::span<double> out) {
            const std::vector<Part> parts = parts_of(work, technique, wi, even);
            for (std::size_t i = 0; i < out.size(); ++i) out[i] = parts[i].weight > threshold ? parts[i].p / fill : 0;
        };
        return by_points(work, p_above, even).value;
    }
    const SphereMap map(Vec3d{0, 0, 1});
    const Batch g = [&](std::span<const Vec2d> at, std::span<double> out) {
        std::vector<Vec3d> wi;
        for (Vec2d v : at) wi.push_back(map.direction(v));
        const std::vector<Part> parts = parts_of(work, technique, wi, even);
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = parts[i].weight > threshold ? 2 * pi * parts[i].p : 0;
    };
    return integral_of(refined_at_pilots(graded_cells(work.whole() ? 2 : 1), map, work.pilot_directions()), 1, g,
        {1e-7, work.affordable(work.settings.evaluations)}, work.scatter().any())
        .value;
}

/// Two-sided, of a mean that is off by this much.
double bernstein_p(double off, double n, double variance, double range) {
    return std::min(2 * math::exp(-0.5 * n * off * off / (variance + range * off / 3 + 1e-300)), 1.0);
}

}  // namespace

namespace {

/// Where p is an estimate, its mean of eight answers tells where weights would be larger than any that was drawn; in an
/// even light alone.
Unmet unmet_of_estimates(const Integrals& work, std::span<const double> x, bool even) {
    constexpr std::size_t points = 6000;
    constexpr int answers = 8;
    const Spread s = spread(x);
    const Integral expected = due_mean(work, even);
    const double fill = even ? 1 : work.trial.light.fill;
    const SphereMap map(Vec3d{0, 0, 1});
    Unmet out;
    out.largest = s.largest;
    out.variance = sqr(s.sd);
    if (work.affordable(points * (answers + 1)) < points * (answers + 1)) return out;
    const auto over = [&](bool of_p) {
        return integrate_by_points(
            graded_cells(work.whole() ? 2 : 1), 1,
            [&](std::span<const Vec2d> at, std::span<double> to) {
                std::vector<Vec3d> wi;
                for (Vec2d v : at) wi.push_back(map.direction(v));
                const std::vector<double> f = work.f(wi, true), p = work.mean_pdf(wi, answers);
                for (std::size_t i = 0; i < to.size(); ++i) {
                    const double light = work.counts(wi[i]) ? f[i] * std::fabs(wi[i].z) * fill : 0;
                    to[i] = light > p[i] * s.largest * (1 + alike_weights) ? 2 * pi * (of_p ? p[i] : light) : 0;
                }
            },
            points, true);
    };
    const Integral mass = over(false);
    out.mass = mass.value;
    out.error = mass.error;
    if (!(out.mass > 1e-4 * expected.value + out.error)) return out;
    out.chance = over(true).value;
    const double off = std::max(std::fabs(s.mean - expected.value + out.mass) - out.error - expected.error, 0.0);
    out.heavy = s.n * out.chance < -math::log(work.settings.confirm) &&
        bernstein_p(off, s.n, out.variance, s.largest) >= work.settings.screen;
    return out;
}

}  // namespace

Unmet look_for_unmet(const Integrals& work, std::span<const double> x, bool even) {
    if (work.scatter().pdf()) return unmet_of_estimates(work, x, even);
    const Spread s = spread(x);
    const Integral expected = due_mean(work, even);
    Unmet out;
    out.largest = s.largest, out.mean = s.mean;
    const double threshold = s.largest * (1 + alike_weights);
    double squares = 0;
    const bool roughly = is_short(work, even);
    const int techniques = work.subject.techniques();
    for (int t = 0; t < techniques; ++t) {
        const auto region = [&](bool above) {
            const auto of_light = [&](std::span<const Vec3d> wi, std::span<double> to) {
                const std::vector<Part> parts = parts_of(work, t, wi, even);
                for (std::size_t i = 0; i < to.size(); ++i) {
                    const bool inside = (parts[i].weight > threshold) == above;
                    to[i] = !inside ? 0 : above ? parts[i].share : parts[i].share * parts[i].weight;
                }
            };
            return roughly ? by_points(work, of_light, even) : work.integrate_light(of_light, even);
        };
        const Integral mass = region(true);
        out.mass += mass.value;
        out.error += mass.error;
        squares += region(false).value;
        if (mass.value > 0) out.chance += chance_of(work, t, threshold, even);
    }
    const double due = expected.value - out.mass;
    out.variance = std::max(squares - sqr(due) / techniques, sqr(s.sd));
    constexpr double allowed = 1e-4;  // as mean_p grants
    const double off = std::max(std::fabs(s.mean - due) - out.error - expected.error - allowed * expected.value, 0.0);
    const bool worth_it = out.mass + (roughly ? out.error : -out.error) > allowed * expected.value;
    const bool may_be_missed = s.n * out.chance < -math::log(work.settings.confirm);
    out.heavy = worth_it && may_be_missed && bernstein_p(off, s.n, out.variance, threshold) >= work.settings.screen;
    return out;
}

const Unmet& Integrals::unmet(bool even) const {
    even = even && (!trial.light.even() || trial.light.fill != 1);
    auto& kept = unmet_[even ? 1 : 0];
    if (!kept) kept = look_for_unmet(*this, first_weights(even), even);
    return *kept;
}

bool has_unmet_tail(const Integrals& work, bool even) {
    // Which weights a direction would have is not known.
    if (!work.traits.has_pdf || !work.subject.has_f()) return false;
    const Spread s = spread(work.first_weights(even));
    return mean_p(s, due_mean(work, even)) < work.settings.screen && work.unmet(even).heavy;
}

void tell_unmet(Verdict& v, const Unmet& unmet, const Integral& expected, std::size_t draws) {
    v.state = State::inconclusive;
    const double share = unmet.mass / expected.value;
    const std::string enough =
        unmet.chance > 0 ? fmt::format("about {:.2g}", 1 / unmet.chance) : std::string("more than 1e300");
    v.evidence["unmet_share"] = share;
    v.evidence["unmet_chance_of_a_draw"] = unmet.chance;
    v.evidence["largest_drawn_weight"] = unmet.largest;
    v.say += unmet.mean > expected.value
        ? fmt::format(
              "Heavy tail: the largest of {} weights, {:.4g}, is {:.3g} % of their sum, and {:.3g} % of f L cos "
              "comes from directions with larger ones: such a mean is low at most seeds and high at some.",
              draws, unmet.largest, 100 * unmet.largest / (unmet.mean * static_cast<double>(draws)), 100 * share)
        : fmt::format(
              "Heavy tail that no draw met: {:.3g} % of f L cos comes from directions whose weight is larger "
              "than the largest of {} draws, {:.4g}, and which p gives {:.2g} of a draw.",
              100 * share, draws, unmet.largest, unmet.chance);
    v.settle = fmt::format(
        "{} draws, one of which meets such a direction on average; or an arm that does not leave them out.", enough);
    v.settle[0] = unmet.chance > 0 ? 'A' : 'M';
}

}  // namespace crescent::inline trials
