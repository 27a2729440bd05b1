// Ratios of draws to p with a parameter that is not stated, from the derivatives of the map, which have no noise: the
// shadowing of the other direction, whose roughness is fitted; and the distance and cosine at a light in a plane.
#include "check/explain/known_forms.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>

#include "check/explain/causes.h"
#include "check/explain/constants.h"
#include "check/explain/factors.h"
#include "check/explain/hypothesis.h"
#include "check/explain/regression.h"
#include "math/statistics.h"
#include "output/format.h"

namespace crescent::check {

namespace {

using RatioModel = std::function<double(Vec3d wo, Vec3d wi)>;  // ratio of the draws to p

/// Errors of ln ratio at the points of the map, ascending, beyond those of the derivatives.
std::vector<double> errors_of(const RatioModel& model, std::span<const KnownRatio> ratios) {
    std::vector<double> out;
    for (const KnownRatio& r : ratios) {
        const double m = model(r.wo, r.wi);
        out.push_back(m > 0 ? std::max(std::fabs(math::log(r.value / m)) - 2 * r.error, 0.0) : 1e3);
    }
    std::ranges::sort(out);
    return out;
}
bool agree(const RatioModel& model, std::span<const KnownRatio> ratios) {
    const std::vector<double> errors = errors_of(model, ratios);
    return errors[static_cast<std::size_t>(share_in_agreement * static_cast<double>(errors.size() - 1))] < agreement;
}

// ---- G1 of Smith for GGX: Walter et al. 2007, (34), with the roughness along the azimuth of w.

double shadowing(Vec3d w, double alpha_x, double alpha_y) {
    const double z2 = w.z * w.z + 1e-300;
    return 2 / (1 + std::sqrt(1 + (sqr(alpha_x * w.x) + sqr(alpha_y * w.y)) / z2));
}

struct Shadowing {
    double alpha_x = 0.5, alpha_y = 0.5;
    bool is_exchanged = true;  // p has G1(w_i) for G1(w_o); false: G1(w_i) besides it
    double operator()(Vec3d wo, Vec3d wi) const {
        return (is_exchanged ? shadowing(wo, alpha_x, alpha_y) : 1) / shadowing(wi, alpha_x, alpha_y);
    }
};

/// The roughness of the least error of nine tenths of the ratios: a grid, then a search with steps that are halved.
Shadowing fitted_shadowing(std::span<const KnownRatio> ratios, bool is_exchanged) {
    constexpr int grid = 20;
    constexpr double smallest_alpha = 0.02, largest_alpha = 2, least_step = 1e-5;
    Shadowing best{.is_exchanged = is_exchanged};
    double least_error = 1e300;
    const auto attempt = [&](double x, double y) {
        const Shadowing s{x, y, is_exchanged};
        const std::vector<double> errors = errors_of(s, ratios);
        const auto count = static_cast<std::ptrdiff_t>(share_in_agreement * static_cast<double>(errors.size()));
        const double error = std::accumulate(errors.begin(), errors.begin() + count, 0.0);
        const bool is_better = error < least_error;
        if (is_better) {
            least_error = error;
            best = s;
        }
        return is_better;
    };
    const double ratio = math::exp(math::log(largest_alpha / smallest_alpha) / grid);
    for (double x = smallest_alpha; x <= largest_alpha; x *= ratio)
        for (double y = smallest_alpha; y <= largest_alpha; y *= ratio) attempt(x, y);
    for (double step = ratio - 1; step > least_step;) {
        const Shadowing s = best;
        bool is_better = false;
        for (double x : {1 - step, 1.0, 1 + step})
            for (double y : {1 - step, 1.0, 1 + step}) is_better = attempt(s.alpha_x * x, s.alpha_y * y) || is_better;
        if (!is_better) step /= 2;
    }
    return best;
}

/// p times the model, with a free constant.
Hypothesis times(const RatioModel& model, const char* name) { return check::times(Factor{name, model}, 1); }

std::optional<Cause> shadowing_cause(std::span<const KnownRatio> ratios, std::span<const Place> places) {
    if (places[0].traits.wo == Traits::WoDomain::none) return {};
    for (bool is_exchanged : {true, false}) {
        const Shadowing s = fitted_shadowing(ratios, is_exchanged);
        if (!agree(s, ratios)) continue;
        Hypothesis h = times(s, "G1");
        if (!passes(h, places, 1)) continue;
        const bool is_round = std::fabs(s.alpha_x / s.alpha_y - 1) < near_one;
        const std::string alpha = is_round ? fmt::format("alpha {:.3g}", (s.alpha_x + s.alpha_y) / 2)
                                           : fmt::format("alpha {:.3g} and {:.3g}", s.alpha_x, s.alpha_y);
        return Cause{.factor = "G1",
            .exponent = s.alpha_x,
            .error = 0,
            .text = fmt::format(
                "By the derivatives of sample(u), draws follow p with G1(w_o) {} G1(w_i): p has the shadowing of "
                "the other direction{} (Smith's G1 of GGX with {}).",
                is_exchanged ? "in place of" : "but without", is_exchanged ? "" : " too", alpha)};
    }
    return {};
}

// ---- A light in a plane with normal n at distance d: the distance along w is d / |n.w|, and the cosine there |n.w|.

struct PlanePower {
    int power;  // of 1 / |n.w| in the ratio of the draws to p
    const char* what;
};
constexpr PlanePower plane_powers[] = {{1,
                                           "the cosine at the light is missing in p: p per solid angle is p per area "
                                           "times r^2 / cos"},
    {2, "the squared distance to the light, r^2, is missing in p"},
    {3, "r^2 / cos at the light is missing in p, which is a density per area"},
    {-1, "p is divided by the cosine at the light once too often"},
    {-2, "the squared distance to the light, r^2, is once too often in p"},
    {-3, "r^2 / cos at the light is once too often in p"}};

}  // namespace

std::string plane_words(double power) {
    for (const auto& [known_power, words] : plane_powers)
        if (power == known_power) return words;
    return "";
}

namespace {

/// The vector n for which |n.w|^-power is nearest to the ratios: least squares, without the tenth with the largest
/// errors in a second and third round.
std::optional<Vec3d> fitted_plane(std::span<const KnownRatio> ratios, int power) {
    struct Row {
        Vec3d w;
        double y, error;
    };
    std::vector<Row> rows;
    for (const KnownRatio& r : ratios) rows.push_back({r.wi, math::exp(-math::log(r.value) / power), 0});
    std::optional<Vec3d> out;
    for (int round = 0; round < 3; ++round) {
        std::vector<std::vector<double>> a(3, std::vector<double>(3));
        std::vector<double> b(3);
        for (const Row& r : rows) {
            const double w[] = {r.w.x, r.w.y, r.w.z}, weight = 1 / (r.y * r.y);
            for (std::size_t i = 0; i < 3; ++i) {
                b[i] += weight * w[i] * r.y;
                for (std::size_t j = 0; j < 3; ++j) a[i][j] += weight * w[i] * w[j];
            }
        }
        const auto n = solved(a, b, 1e-12);
        if (!n) return {};
        out = Vec3d{(*n)[0], (*n)[1], (*n)[2]};
        for (Row& r : rows) r.error = std::fabs(dot(*out, r.w) / r.y - 1);
        std::ranges::sort(rows, {}, &Row::error);
        rows.resize(rows.size() * 9 / 10);
    }
    return out;
}

std::optional<Cause> plane_cause(std::span<const KnownRatio> ratios, std::span<const Place> places) {
    for (const auto& [power, what] : plane_powers) {
        const std::optional<Vec3d> n = fitted_plane(ratios, power);
        if (!n || !(length(*n) > 0)) continue;
        const RatioModel model = [normal = *n, exponent = power](Vec3d, Vec3d wi) {
            const double c = std::fabs(dot(normal, wi));
            return c > 0 ? math::exp(-exponent * math::log(c)) : 0;
        };
        if (!agree(model, ratios)) continue;
        Hypothesis h = times(model, "light in a plane");
        if (!passes(h, places, 1)) continue;
        const Vec3d normal = *n * (1 / length(*n));
        const bool is_surface_normal = std::fabs(normal.z) > 1 - same_normal;
        const std::string surface = is_surface_normal
            ? fmt::format(" For a surface with this normal, cos theta_i{} is {} in p.",
                  std::abs(power) == 1 ? "" : fmt::format("^{}", std::abs(power)),
                  power < 0 ? "missing" : "a factor too many")
            : "";
        return Cause{.factor = "light in a plane",
            .exponent = static_cast<double>(power),
            .error = 0,
            .text = fmt::format(
                "By the derivatives of sample(u), draws over p is {} |n.w_i|^{}, with n = {}.{} For a light "
                "in a plane with this normal, {}.",
                crescent::figures(math::exp(-power * math::log(length(*n))), 4), -power, direction_text(normal),
                surface, what)};
    }
    return {};
}

}  // namespace

std::optional<Cause> cause_of_known_form(std::span<const KnownRatio> ratios, std::span<const Place> places) {
    std::vector<KnownRatio> usable_ratios;
    double different_count = 0;
    for (const KnownRatio& r : ratios)
        if (r.value > 0 && std::isfinite(r.value)) {
            usable_ratios.push_back(r);
            different_count += std::fabs(r.value - 1) > 0.05;
        }
    if (usable_ratios.size() < fewest_of_form || different_count < static_cast<double>(usable_ratios.size()) / 2)
        return {};
    if (std::optional<Cause> c = plane_cause(usable_ratios, places)) return c;
    return shadowing_cause(usable_ratios, places);
}

}  // namespace crescent::check
