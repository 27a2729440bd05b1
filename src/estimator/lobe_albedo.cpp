#include "estimator/lobe_albedo.h"

#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>

#include "scene/brdf.h"

namespace crescent {

namespace {

template <class Call> double integrate(Call&& f, double a, double b, double tolerance = 1e-11) {
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

/// Any lobe: polar about the mirror direction, the azimuth by a nested quadrature.
template <class L> double nested_albedo(const L& lobe, double cos_o) {
    const Vec3<double> wo = {std::sqrt(1 - cos_o * cos_o), 0, cos_o};
    const Frame<double> about = frame_about(mirror(wo));
    const auto ring = [&](double al) {
        const double c = std::cos(al), sin = std::sin(al);
        const auto f = [&](double phi) {
            const Vec3<double> wi = about.to_world({sin * std::cos(phi), sin * std::sin(phi), c});
            return wi.z > 0 ? lobe(wo, wi) * wi.z : 0.0;
        };
        return sin * integrate(f, 0, 2 * pi, 1e-8);
    };
    const double horizon = std::asin(cos_o);
    return integrate(ring, 0, horizon, 1e-8) + integrate(ring, horizon, pi - horizon, 1e-8);
}

}  // namespace

double lobe_albedo(BrdfKind kind, double s, double alpha, double cos_o) {
    const double c = std::clamp(cos_o, 1e-6, 1.0);
    switch (kind) {
        case BrdfKind::phong: return phong_albedo(s, c);
        case BrdfKind::blinn_phong: return nested_albedo(BlinnPhongLobe<double>(s, alpha), c);
        case BrdfKind::ggx: return nested_albedo(GgxLobe<double>(s, alpha), c);
    }
    return 0;
}

LobeAlbedo::LobeAlbedo(BrdfKind kind, double s, double alpha) {
    const auto exact = [&](double x, std::size_t cells) { return lobe_albedo(kind, s, alpha, std::cos(x / static_cast<double>(cells) * pi / 2)); };
    constexpr std::size_t first = 64, last = 4096;
    constexpr double good = 1e-7;
    for (std::size_t k = 0; k <= first; ++k) values_.push_back(exact(static_cast<double>(k), first));
    for (std::size_t cells = first;; cells *= 2) {  // the midpoints that measure the error become the next nodes
        std::vector<double> finer(2 * cells + 1);
        error_ = 0;
        for (std::size_t k = 0; k <= cells; ++k) finer[2 * k] = values_[k];
        for (std::size_t k = 0; k < cells; ++k) {
            const double x = static_cast<double>(k) + 0.5;
            finer[2 * k + 1] = exact(x, cells);
            error_ = std::max(error_, std::fabs(interpolate(x) - finer[2 * k + 1]));
        }
        values_ = std::move(finer);
        if (error_ < good || cells >= last) break;
    }
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
