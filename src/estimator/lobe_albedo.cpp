#include "estimator/lobe_albedo.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <oneapi/tbb/parallel_for.h>

#include "scene/brdf.h"

namespace crescent {

namespace {

template <class Call> double integrate(Call&& f, double a, double b, double tolerance = 1e-9) {
    return b > a ? boost::math::quadrature::gauss_kronrod<double, 21>::integrate(f, a, b, 12, tolerance) : 0.0;
}

/// Phong: polar about R at tilt theta. The cosine n.w = a + b cos(phi), a = cos(al) cos(theta), b = sin(al) sin(theta),
/// integrates over phi in closed form, cut where it turns negative; what is left is one integral over al.
double phong_albedo(double s, double cos_o) {
    const double sin_o = std::sqrt(1 - cos_o * cos_o);
    const auto ring = [&](double al) {
        const double c = std::cos(al), a = c * cos_o, b = std::sin(al) * sin_o;
        double band = 2 * pi * a;
        if (b > a) {
            const double phi = std::acos(-a / b);
            band = 2 * (a * phi + b * std::sin(phi));
        }
        return std::pow(c, s) * std::sin(al) * band;
    };
    const double horizon = std::asin(cos_o);  // al where the lobe first dips under the horizon
    const double wide = std::min(pi / 2, 12 / std::sqrt(s + 1));  // beyond, cos^s < exp(-70)
    const double cut = std::min(horizon, wide);
    return (s + 2) / (2 * pi) * (integrate(ring, 0, cut) + integrate(ring, cut, wide));
}

/// A lobe about the half vector m: with m drawn by the lobe's own distribution (cos(m) from u, azimuth phi, density p_m)
/// and dwi = 4 (wo.m) dm, the integrand f cos(theta_i) 4 (wo.m) / p_m is smooth over those m whose wi is above the
/// horizon: cos(phi) > (cos_o / (2 c) - cos_o c) / (sin_o sin_m). Gauss-Legendre in phi, cut there; adaptive in u.
/// `below`: the u of an m at a given cosine.
template <class L, class Height, class Below, class Density>
double half_vector_albedo(const L& lobe, double cos_o, Height height, Below below, Density density) {
    using Rule = boost::math::quadrature::gauss<double, 30>;
    const double theta_o = std::acos(cos_o), sin_o = std::sin(theta_o);
    const Vec3<double> wo = {sin_o, 0, cos_o};
    const auto ring = [&](double u) {
        const double c = height(u), sin = std::sqrt(std::max(0.0, 1 - c * c));
        const double cut = (0.5 / c - c) * cos_o, all = sin_o * sin;
        const double last = cut <= -all ? pi : cut >= all ? 0 : std::acos(cut / all);
        const auto at = [&](double phi) {
            const Vec3<double> m = {sin * std::cos(phi), sin * std::sin(phi), c};
            const double d = dot(wo, m);
            const Vec3<double> wi = 2 * d * m - wo;
            return d > 0 && wi.z > 0 ? lobe(wo, wi) * wi.z * 4 * d / density(c) : 0.0;
        };
        return last > 0 ? Rule::integrate(at, 0.0, last) / pi : 0.0;  // even in phi
    };
    const auto piece = [&](double a, double b) {  // stretched at both ends, where u has roots
        const auto f = [&](double t) { return ring(a + (b - a) * t * t * (3 - 2 * t)) * (b - a) * 6 * t * (1 - t); };
        return b != a ? integrate(f, 0, 1, 1e-6) : 0.0;
    };
    // u rises as m tilts away from n or towards it: from m = n to where the first wi dips, and on to where the last one has.
    const double upright = below(1), dips = below(std::cos(0.5 * (pi / 2 - theta_o))), gone = below(std::cos(0.5 * (pi / 2 + theta_o)));
    return std::fabs(piece(upright, dips) + piece(dips, gone));
}

double blinn_albedo(double s, double cos_o) {
    return half_vector_albedo(
        BlinnPhongLobe<double>(s, 0), cos_o, [s](double u) { return std::pow(u, 1 / (s + 1)); }, [s](double c) { return std::pow(c, s + 1); },
        [s](double c) { return (s + 1) / (2 * pi) * std::pow(c, s); });
}

double ggx_albedo(double alpha, double cos_o) {
    const Ggx<double> ggx{alpha};
    return half_vector_albedo(
        GgxLobe<double>(0, alpha), cos_o, [alpha](double u) { return std::sqrt((1 - u) / (1 + (alpha * alpha - 1) * u)); },
        [alpha](double c) { return (1 - c * c) / (1 + (alpha * alpha - 1) * c * c); },
        [&](double c) { return ggx.D({std::sqrt(std::max(0.0, 1 - c * c)), 0, c}) * c; });
}

}  // namespace

double lobe_albedo(BrdfKind kind, double s, double alpha, double cos_o) {
    const double c = std::clamp(cos_o, 1e-6, 1.0);  // half vectors have no room at the horizon itself
    switch (kind) {
        case BrdfKind::phong: return phong_albedo(s, std::clamp(cos_o, 0.0, 1.0));
        case BrdfKind::blinn_phong: return blinn_albedo(s, c);
        case BrdfKind::ggx: return ggx_albedo(alpha, c);
    }
    return 0;
}

LobeAlbedo::LobeAlbedo(BrdfKind kind, double s, double alpha) {
    const auto exact = [&](double x, std::size_t cells) { return lobe_albedo(kind, s, alpha, std::cos(x / static_cast<double>(cells) * pi / 2)); };
    const std::size_t first = 64, last = kind == BrdfKind::phong ? 4096 : 1024;
    const double good = kind == BrdfKind::phong ? 1e-7 : 1e-6;  // half vectors take forty times as long
    for (std::size_t k = 0; k <= first; ++k) values_.push_back(exact(static_cast<double>(k), first));
    for (std::size_t cells = first;; cells *= 2) {  // the midpoints that measure the error become the next nodes
        std::vector<double> finer(2 * cells + 1);
        error_ = 0;
        for (std::size_t k = 0; k <= cells; ++k) finer[2 * k] = values_[k];
        tbb::parallel_for(std::size_t{0}, cells, [&](std::size_t k) { finer[2 * k + 1] = exact(static_cast<double>(k) + 0.5, cells); });
        for (std::size_t k = 0; k < cells; ++k) error_ = std::max(error_, std::fabs(interpolate(static_cast<double>(k) + 0.5) - finer[2 * k + 1]));
        values_ = std::move(finer);
        if (error_ < good || cells >= last) break;
    }
    error_ += kind == BrdfKind::phong ? 1e-10 : 1e-6;
}

double LobeAlbedo::interpolate(double x) const {  // Lagrange through four neighbours
    const std::size_t cells = values_.size() - 1;
    const std::size_t k = std::min(static_cast<std::size_t>(std::max(x - 1, 0.0)), cells - 3);
    const double t = x - static_cast<double>(k);
    const double* v = values_.data() + k;
    return v[0] * (t - 1) * (t - 2) * (t - 3) / -6 + v[1] * t * (t - 2) * (t - 3) / 2 + v[2] * t * (t - 1) * (t - 3) / -2 + v[3] * t * (t - 1) * (t - 2) / 6;
}

double LobeAlbedo::operator()(double cos_o) const {
    return interpolate(std::acos(std::clamp(cos_o, -1.0, 1.0)) / (pi / 2) * static_cast<double>(values_.size() - 1));
}

}  // namespace crescent
