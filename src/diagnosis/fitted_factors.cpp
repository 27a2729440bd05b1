// Factors with a parameter that nobody told, read off the ratios by least squares: powers of the cosine about an axis,
// as where the area of a flat light is taken for solid angle, and Smith's G1 of a roughness along x and one along y.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "math/functions.h"
#include "simd/scalar.h"
#include "diagnosis/diagnosis.h"
#include "stats/least_squares.h"
#include "stats/quantiles.h"

namespace crescent::inline diagnosis {

namespace {

constexpr std::size_t fewest = 24;

/// 5 % to 95 % of the logarithms of the ratios.
double spread_of(std::span<const Ratio> ratios) {
    std::vector<double> logs;
    for (const Ratio& r : ratios) logs.push_back(math::log(r.value));
    std::sort(logs.begin(), logs.end());
    return logs.empty() ? 0 : logs[logs.size() * 19 / 20] - logs[logs.size() / 20];
}

/// Of a flat light with normal n, seen from a point at h from its plane: the cosine at the light is c = w_i.n and the
/// distance h / c, so that area over solid angle is h^2 / c^3.
struct Power {
    int exponent;
    const char* name;
};
constexpr Power powers[] = {{-3, "distance^2 / cosine at a flat light"}, {-2, "distance^2 to a flat light"},
    {-1, "1 / (cosine at a flat light)"}, {1, "cosine at a flat light"}, {2, "1 / (distance^2 to a flat light)"},
    {3, "cosine / distance^2 at a flat light"}};

double power(double c, int exponent) {
    double out = 1;
    for (int k = 0; k < std::abs(exponent); ++k) out *= c;
    return exponent < 0 ? 1 / out : out;
}

/// The axis a with ratio = (w_i.a)^exponent, and the median of what is left in the logarithm.
struct Axis {
    Vec3d a{};
    double left = 0;
};
std::optional<Axis> axis_of(std::span<const Ratio> ratios, int exponent) {
    std::vector<std::vector<double>> rows;
    for (const Ratio& r : ratios) {
        const double root = math::exp(math::log(r.value) / exponent);
        rows.push_back({r.wi.x / root, r.wi.y / root, r.wi.z / root});
    }
    const auto a = solved_for_one(rows, fewest, 1e-7);
    if (!a) return {};
    Axis out{{(*a)[0], (*a)[1], (*a)[2]}, 0};
    std::vector<double> left;
    for (const Ratio& r : ratios) {
        const double c = dot(r.wi, out.a);
        left.push_back(c > 0 ? std::fabs(math::log(r.value / power(c, exponent))) : 1);
    }
    out.left = median_of(std::move(left));
    return out;
}

/// Over few directions one power looks like another: the one that fits best must do so by far.
void add_flat_light(std::vector<Factor>& out, std::span<const Ratio> ratios) {
    constexpr double by_far = 5;
    const Power* best = nullptr;
    Axis of_best;
    double second = 1;
    for (const Power& p : powers) {
        const std::optional<Axis> axis = axis_of(ratios, p.exponent);
        if (!axis) continue;
        if (best && axis->left >= of_best.left) {
            second = std::min(second, axis->left);
            continue;
        }
        if (best) second = std::min(second, of_best.left);
        best = &p, of_best = *axis;
    }
    if (!best || !(by_far * of_best.left < second)) return;
    const Vec3d n = normalize(of_best.a);
    out.push_back({best->name,
        [n, e = best->exponent](Vec3d w) {
            const double c = dot(w, n);
            return c > 0 ? power(c, e) : 0;
        },
        false, fmt::format(", of a light that lies across ({:.3f}, {:.3f}, {:.3f})", n.x, n.y, n.z)});
}

/// Smith's G1 of GGX, 2 / (1 + root(1 + ((ax x)^2 + (ay y)^2) / z^2)): Walter et al. 2007, (34), Heitz 2014, (86).
struct Smith {
    double xx = 0, yy = 0;  // squares of the roughnesses
    double operator()(Vec3d w) const {
        return w.z > 0 ? 2 / (1 + std::sqrt(1 + (xx * sqr(w.x) + yy * sqr(w.y)) / sqr(w.z))) : 0;
    }
};

/// Of ratio = c / G1 follows ratio^2 = c ratio + c^2 ((ax x)^2 + (ay y)^2) / (4 z^2), where c is 1, or G1 at w_o.
void add_smith(std::vector<Factor>& out, const TrialContext& work, std::span<const Ratio> ratios, bool inverse) {
    constexpr double close = 3e-3, smoothest = 1e-4, roughest = 4;
    std::vector<std::vector<double>> rows;
    for (const Ratio& r : ratios) {
        if (!(r.wi.z > 0)) return;
        const double q = inverse ? 1 / r.value : r.value;
        rows.push_back({1 / q, sqr(r.wi.x / (r.wi.z * q)), sqr(r.wi.y / (r.wi.z * q))});
    }
    const auto x = solved_for_one(rows, fewest, 1e-7);
    if (!x || !((*x)[0] > 0)) return;
    const double c = (*x)[0];
    const Smith g{4 * (*x)[1] / sqr(c), 4 * (*x)[2] / sqr(c)};
    const auto is_square = [](double v) { return v > smoothest && v < roughest; };
    if (!is_square(g.xx) || !is_square(g.yy)) return;
    const double at_o = g(work.trial.wo);
    const bool plain = std::fabs(c - 1) < close, both = !plain && std::fabs(c / at_o - 1) < close;
    if (!plain && !both) return;
    const double scale = both ? at_o : 1;
    const char* name =
        both ? (inverse ? "G1(w_i) / G1(w_o)" : "G1(w_o) / G1(w_i)") : (inverse ? "G1(w_i)" : "1 / G1(w_i)");
    const double ax = std::sqrt(g.xx), ay = std::sqrt(g.yy);
    out.push_back({name,
        [g, scale, inverse](Vec3d w) {
            const double v = g(w);
            return v > 0 ? (inverse ? v / scale : scale / v) : 0;
        },
        true,
        std::fabs(ax / ay - 1) < 0.01
            ? fmt::format(", of GGX with alpha = {:.3g}", ax)
            : fmt::format(", of GGX with alpha = {:.3g} along x and {:.3g} along y", ax, ay)});
}

}  // namespace

std::vector<Factor> fitted_factors(const TrialContext& work, std::span<const Ratio> ratios) {
    constexpr double least = 0.05;  // of the logarithm: of less, much looks alike
    std::vector<Factor> out;
    if (spread_of(ratios) < least) return out;
    for (bool inverse : {false, true}) add_smith(out, work, ratios, inverse);
    add_flat_light(out, ratios);
    return out;
}

}  // namespace crescent::inline diagnosis
