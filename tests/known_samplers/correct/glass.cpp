// Rough glass by the equations of Walter et al. 2007 that renderers.h names for each function, visible normals after
// Heitz 2018; pdf and f in 1/sr. Across the boundary f of radiance and the weight of smooth glass are divided by the
// square of eta_from(wo), f of importance is not.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "math/functions.h"
#include "math/simd/math.h"
#include "math/simd/scalar.h"
#include "tests/known_samplers/correct/renderers.h"

namespace crescent {

Vec3d RoughGlass::half(Vec3d o, Vec3d i) const {
    const Vec3d m = normalize(o + i * (across(o, i) ? eta_from(o) : 1.0));
    return m.z < 0 ? -m : m;
}

double RoughGlass::D(Vec3d m) const {
    const double t = 1 + (sqr(alpha) - 1) * sqr(m.z);
    return m.z > 0 ? sqr(alpha) / (pi * sqr(t)) : 0;
}

double RoughGlass::G1(Vec3d w, Vec3d m) const {
    if (!(dot(w, m) * w.z > 0)) return 0;
    return 2 / (1 + std::sqrt(1 + sqr(alpha) * std::max(1 / sqr(w.z) - 1, 0.0)));
}

double RoughGlass::fresnel(double c, double eta_here) const {
    const double g2 = sqr(eta_here) - 1 + c * c;
    if (!(g2 > 0)) return 1;
    const double g = std::sqrt(g2);
    return 0.5 * sqr((g - c) / (g + c)) * (1 + sqr((c * (g + c) - 1) / (c * (g - c) + 1)));
}

double RoughGlass::jacobian(Vec3d o, Vec3d i, Vec3d m) const {
    const double om = dot(o, m), im = dot(i, m);
    if (!across(o, i)) return 1 / (4 * std::fabs(om));
    const double e = eta_from(o);
    return sqr(e) * std::fabs(im) / sqr(om + e * im);
}

double RoughGlass::normals_pdf(Vec3d o, Vec3d m) const {
    return visible ? D(m) * G1(o, m) * std::fabs(dot(o, m)) / std::fabs(o.z) : D(m) * m.z;
}

double RoughGlass::pdf(Vec3d o, Vec3d i) const {
    const Vec3d m = half(o, i);
    const double om = dot(o, m), im = dot(i, m);
    if (o.z * i.z == 0 || (om * im < 0) != across(o, i) || !(om * o.z > 0)) return 0;
    const double f = fresnel(std::fabs(om), eta_from(o));
    return normals_pdf(o, m) * jacobian(o, i, m) * (across(o, i) ? 1 - f : f);
}

double RoughGlass::f(Vec3d o, Vec3d i) const {
    const Vec3d m = half(o, i);
    const double om = dot(o, m), im = dot(i, m);
    if (o.z * i.z == 0 || (om * im < 0) != across(o, i) || !(om * o.z > 0)) return 0;
    const double fr = fresnel(std::fabs(om), eta_from(o));
    const double both = D(m) * G1(o, m) * G1(i, m) * std::fabs(om) / std::fabs(o.z * i.z) * jacobian(o, i, m);
    if (!across(o, i)) return fr * both;
    return (1 - fr) * both * (importance ? 1 : 1 / sqr(eta_from(o)));
}

Vec3d RoughGlass::normal(Vec3d o, double u1, double u2) const {
    const double phi = 2 * pi * u2;
    if (!visible) {  // D(m) m.z, (35), (36)
        const double r = alpha * std::sqrt(u1 / (1 - u1));
        return normalize(Vec3d{r * math::cos(phi), r * math::sin(phi), 1});
    }
    const Vec3d up = o.z > 0 ? o : -o, v = normalize(Vec3d{alpha * up.x, alpha * up.y, up.z});
    const double size = math::hypot(v.x, v.y);
    const Vec3d t = size > 0 ? Vec3d{-v.y / size, v.x / size, 0} : Vec3d{1, 0, 0}, b = cross(v, t);
    const double r = std::sqrt(u1), x = r * math::cos(phi), s = 0.5 * (1 + v.z);
    const double y = (1 - s) * std::sqrt(std::max(1 - x * x, 0.0)) + s * r * math::sin(phi);
    const Vec3d h = t * x + b * y + v * std::sqrt(std::max(1 - x * x - y * y, 0.0));
    return normalize(Vec3d{alpha * h.x, alpha * h.y, std::max(h.z, 1e-12)});
}

Draw RoughGlass::sample(Vec3d o, const PrimarySample& u) const {
    const Vec3d m = normal(o, u[0], u[1]);
    const double c = dot(o, m), e = eta_from(o);
    if (!(c * o.z > 0)) return {{0, 0, 1}, 0};
    const double fr = fresnel(std::fabs(c), e);
    Vec3d i = m * (2 * c) - o;  // (38)
    if (!(u[2] < (reflect ? reflect(fr) : fr))) {
        const double k = 1 - (1 - c * c) / sqr(e);
        if (!(k > 0)) return {{0, 0, 1}, 0};
        i = m * (c / e - (c > 0 ? 1 : -1) * std::sqrt(k)) - o * (1 / e);  // (40)
        if (!across(o, i)) return {{0, 0, 1}, 0};
    } else if (across(o, i)) {
        return {{0, 0, 1}, 0};
    }
    i = normalize(i);
    return {i, pdf(o, i)};
}

Traits RoughGlass::traits() const {
    Traits t;
    t.numbers = 3;
    t.wo = Traits::WoDomain::both;
    t.eta = Vec3d{eta, eta, eta};
    t.importance = importance;
    return t;
}

SyntheticSampler recipe_of(const RoughGlass& g) {
    SyntheticSampler r{g.visible ? "rough glass, visible normals" : "rough glass",
        fmt::format("alpha {:.4g}, eta {:.4g}{}", g.alpha, g.eta, g.importance ? ", importance" : ""), {}, {}, {}};
    r.sample = [g](Vec3d wo, const PrimarySample& u) { return g.sample(wo, u); };
    r.pdf = [g](Vec3d wo, Vec3d wi) { return g.pdf(wo, wi); };
    r.f = [g](Vec3d wo, Vec3d wi) { return g.f(wo, wi); };
    r.traits = g.traits();
    return r;
}

SyntheticSampler smooth_glass(double eta) {
    const RoughGlass g{0.1, eta};
    SyntheticSampler r{"smooth glass", fmt::format("eta {:.4g}", eta), {}, {}, {}};
    r.traits = g.traits();
    r.traits.delta = true;
    r.sample = [g](Vec3d wo, const PrimarySample& u) {
        const double e = g.eta_from(wo), c = wo.z, fr = g.fresnel(std::fabs(c), e), k = 1 - (1 - c * c) / sqr(e);
        Draw d;
        const bool reflects = u[2] < fr;
        d.wi = reflects ? Vec3d{-wo.x, -wo.y, wo.z}
                        : Vec3d{-wo.x / e, -wo.y / e, -(c > 0 ? 1 : -1) * std::sqrt(std::max(k, 0.0))};
        d.delta = reflects ? fr : 1 - fr;
        d.weight = reflects ? 1 : 1 / sqr(e);  // of radiance
        return d;
    };
    r.pdf = r.f = [](Vec3d, Vec3d) { return 0.0; };
    return r;
}

}  // namespace crescent
