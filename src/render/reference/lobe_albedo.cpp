// The directional albedo: by a one-dimensional integral if the lobe has one, else over half vectors drawn as the lobe's
// own normals are. A table in theta has five even nodes per cell; a cell is halved if its error exceeds 1e-7 (1e-6 over
// half vectors), measured half-way between nodes.
#include "render/reference/lobe_albedo.h"

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>

#include "base/parallel.h"
#include "math/functions.h"
#include "math/quadrature.h"
#include "scene/lobes/all.h"

namespace crescent {

// ---- Gauss-Kronrod with 15 points over intervals that double away from the axis, 7 if the whole is shorter than 0.3
// of the lobe's width; intervals whose two rules differ are halved, at most six times.

namespace {

/// Halves an interval a few times if two rules differ.
template <std::size_t n, class F>
AlongLobe panel(const KronrodRule<n>& rule, const F& f, double lo, double hi, double tolerance, int halvings) {
    const auto [fine, difference, spread] = by_two_rules(rule, f, lo, hi);
    const double error = std::fabs(difference);
    if (halvings == 0 || error <= tolerance || error <= 1e-7 * std::fabs(fine)) return {fine, error};
    const double middle = 0.5 * (lo + hi);
    const AlongLobe a = panel(rule, f, lo, middle, tolerance, halvings - 1),
                    b = panel(rule, f, middle, hi, tolerance, halvings - 1);
    return {a.value + b.value, a.error + b.error};
}

}  // namespace

double lobe_stretch(const DiskPoint& point) {
    return lobe_info(point.surface.brdf).about_mirror ? 1 : std::max(point.wo.z, 1e-6);
}

LobeShape::LobeShape(const DiskPoint& point) : stretch(lobe_stretch(point)) {
    const Surface& surface = point.surface;
    const LobeWidth lobe_width = lobe_info(surface.brdf).width(surface.s, surface.alpha);
    width = std::min(lobe_width.width, 1.0);
    reach = lobe_width.reach;
}

double LobeShape::width_at(double c) const {  // (al cos / width)^2 + (al sin / (width stretch))^2 = 1
    return width / std::sqrt(c * c + (1 - c * c) / sqr(stretch));
}

AlongLobe lobe_along(const DiskPoint& point, Vec3d axis, Vec3d side, Interval part, double width) {
    const auto f = [&](double al) {
        const auto [sin, cos] = math::sincos(al);
        const Vec3d wi = cos * axis + sin * side;
        return wi.z > 0 ? point.lobe(wi) * wi.z * sin : 0.0;
    };
    if (part.hi - part.lo < 0.3 * width) return panel(kronrod_7, f, part.lo, part.hi, 0, 2);
    AlongLobe sum;
    for (double lo = part.lo, hi; lo < part.hi; lo = hi) {
        hi = std::max(width, 2 * lo);
        if (hi > 0.75 * part.hi) hi = part.hi;
        const AlongLobe integral = panel(kronrod_15, f, lo, hi, 1e-8 * sum.value, 6);
        sum.value += integral.value;
        sum.error += integral.error;
    }
    return sum;
}

namespace {

constexpr std::size_t ring_steps = 40, band_steps = 5;  // for a ring of half vectors; for one in closed form

template <class Call> double integrate(Call&& f, double a, double b, double tolerance = 1e-9) {
    return b > a ? boost::math::quadrature::gauss_kronrod<double, 21>::integrate(f, a, b, 12, tolerance) : 0.0;
}

/// A lobe about the half vector m: with m drawn by the lobe's own distribution (cos(m) from u, azimuth phi, density
/// p_m) and dwi = 4 (wo.m) dm, the integrand f cos(theta_i) 4 (wo.m) / p_m is smooth over those m whose wi is above the
/// horizon: cos(phi) > (cos_o / (2 c) - cos_o c) / (sin_o sin_m). Gauss-Legendre in phi, cut there; adaptive in u.
template <class L, class Normals>
double half_vector_albedo(const L& lobe, double cos_o, const Normals& normals, const YieldToHost& yield_to_host) {
    using Rule = math::Gauss<30>;
    const double theta_o = math::acos(cos_o), sin_o = math::sin(theta_o);
    const Vec3<double> wo = {sin_o, 0, cos_o};
    const auto ring = [&](double u) {
        if (yield_to_host) yield_to_host(ring_steps);
        const double c = normals.height(u), sin = std::sqrt(std::max(0.0, 1 - c * c));
        const double cut = (0.5 / c - c) * cos_o, amplitude = sin_o * sin;
        const double last = cut <= -amplitude ? pi : cut >= amplitude ? 0 : math::acos(cut / amplitude);
        const auto value = [&](double phi) {
            const Vec3<double> m = math::spherical(sin, c, phi);
            const double d = dot(wo, m);
            const Vec3<double> wi = 2 * d * m - wo;
            return d > 0 && wi.z > 0 ? lobe(wo, wi) * wi.z * 4 * d / normals.density(c) : 0.0;
        };
        return last > 0 ? Rule::integrate(value, 0.0, last) / pi : 0.0;  // even in phi
    };
    const auto piece = [&](double a, double b) {  // stretched at both ends, where u has roots
        const auto f = [&](double t) { return ring(a + (b - a) * t * t * (3 - 2 * t)) * (b - a) * 6 * t * (1 - t); };
        return b != a ? integrate(f, 0, 1, 1e-6) : 0.0;
    };
    // u is monotone in the tilt of m: the range is split at the first m whose wi is below the horizon and ends at the
    // last m whose wi is above it.
    const double upright = normals.below(1), dips = normals.below(math::cos(0.5 * (pi / 2 - theta_o))),
                 end = normals.below(math::cos(0.5 * (pi / 2 + theta_o)));
    return std::fabs(piece(upright, dips) + piece(dips, end));
}

}  // namespace

double lobe_albedo(LobeKind kind, double s, double alpha, double cos_o, const YieldToHost& yield_to_host) {
    const double c = std::clamp(cos_o, 1e-6, 1.0);  // half vectors have no range at the horizon itself
    double out = 0;
    with_lobe(kind, [&]<template <class> class L>() {
        if constexpr (requires { typename L<double>::Normals; })
            out = half_vector_albedo(L<double>(s, alpha), c, typename L<double>::Normals(s, alpha), yield_to_host);
        else
            out = L<double>::albedo(s, alpha, std::clamp(cos_o, 0.0, 1.0), [&](const auto& f, double a, double b) {
                const auto evaluate = [&](double x) {
                    if (yield_to_host) yield_to_host(band_steps);
                    return f(x);
                };
                return integrate(evaluate, a, b);
            });
    });
    return out;
}

namespace {

/// Lagrange interpolation through five even nodes, t from 0 to 4.
double through_five(const std::array<double, 5>& v, double t) {
    const double a = t, b = t - 1, c = t - 2, d = t - 3, e = t - 4;
    return v[0] * b * c * d * e / 24 - v[1] * a * c * d * e / 6 + v[2] * a * b * d * e / 4 - v[3] * a * b * c * e / 6 +
        v[4] * a * b * c * d / 24;
}

}  // namespace

LobeAlbedo::LobeAlbedo(LobeKind kind, double s, double alpha, const YieldToHost& yield_to_host) {
    const auto exact = [&](double theta) { return lobe_albedo(kind, s, alpha, math::cos(theta), yield_to_host); };
    const bool about_mirror = lobe_info(kind).about_mirror;
    const double tolerance = about_mirror ? 1e-7 : 1e-6;  // half vectors take forty times as long
    const double rounding = about_mirror ? 1e-10 : 1e-6;
    constexpr int first_cells = 8, halvings = 12;
    std::vector<Cell> open_cells(first_cells), next;
    std::vector<std::array<double, 4>> midpoints;
    for (std::size_t k = 0; k < first_cells; ++k)
        open_cells[k] = {.from = pi / 2 * static_cast<double>(k) / first_cells,
            .size = pi / 2 / first_cells,
            .value = {},
            .error = 0};
    parallel_for(std::size_t{0}, open_cells.size() * 5, [&](std::size_t i) {
        open_cells[i / 5].value[i % 5] =
            exact(open_cells[i / 5].from + open_cells[i / 5].size * static_cast<double>(i % 5) / 4);
    });
    for (int depth = 0; !open_cells.empty(); ++depth, std::swap(open_cells, next)) {
        midpoints.resize(open_cells.size());  // the points that measure a cell's error are nodes of its halves
        parallel_for(std::size_t{0}, open_cells.size() * 4, [&](std::size_t i) {
            midpoints[i / 4][i % 4] =
                exact(open_cells[i / 4].from + open_cells[i / 4].size * (static_cast<double>(i % 4) + 0.5) / 4);
        });
        next.clear();
        for (std::size_t k = 0; k < open_cells.size(); ++k) {
            Cell& c = open_cells[k];
            const std::array<double, 5>& v = c.value;
            const std::array<double, 4>& m = midpoints[k];
            for (std::size_t i = 0; i < 4; ++i)
                c.error = std::max(c.error, std::fabs(through_five(v, static_cast<double>(i) + 0.5) - m[i]));
            if (c.error < tolerance || depth == halvings) {
                c.error = 2 * c.error + rounding;  // midpoints are not exactly where the interpolation error is largest
                cells_.push_back(c);
                continue;
            }
            next.push_back({c.from, c.size / 2, {v[0], m[0], v[1], m[1], v[2]}, 0});
            next.push_back({c.from + c.size / 2, c.size / 2, {v[2], m[2], v[3], m[3], v[4]}, 0});
        }
    }
    std::sort(cells_.begin(), cells_.end(), [](const Cell& a, const Cell& b) { return a.from < b.from; });
}

const LobeAlbedo::Cell& LobeAlbedo::cell(double theta) const {
    const auto next_cell =
        std::upper_bound(cells_.begin() + 1, cells_.end(), theta, [](double t, const Cell& c) { return t < c.from; });
    return *std::prev(next_cell);
}

double LobeAlbedo::operator()(double cos_o) const {
    const double theta = math::acos(std::clamp(cos_o, -1.0, 1.0));
    const Cell& c = cell(theta);
    return through_five(c.value, 4 * (theta - c.from) / c.size);
}

double LobeAlbedo::error(double cos_o) const { return cell(math::acos(std::clamp(cos_o, -1.0, 1.0))).error; }

}  // namespace crescent
