// GGX in single and double precision. Heitz 2014, "Understanding the Masking-Shadowing Function in Microfacet-Based
// BRDFs"; Heitz 2018, "Sampling the GGX Distribution of Visible Normals".
#pragma once

#include "tests/calibration/geometry.h"
#include "tests/calibration/sampler.h"

namespace crescent::calibration {

template <class F> struct Ggx2 {
    F ax, ay;
    F D(Vec3<F> m) const {
        const F t = sqr(m.x / ax) + sqr(m.y / ay) + sqr(m.z);
        return m.z > 0 ? 1 / (pi_of<F> * ax * ay * sqr(t)) : F(0);
    }
    F lambda(Vec3<F> w) const { return (std::sqrt(1 + (sqr(ax * w.x) + sqr(ay * w.y)) / sqr(w.z)) - 1) / 2; }
    F f(Vec3<F> o, Vec3<F> i) const {
        if (!(o.z > 0 && i.z > 0)) return 0;
        return D(unit(o + i)) / (1 + lambda(o) + lambda(i)) / (4 * o.z * i.z);
    }
    /// Density of directions by visible normals: D G1(o) / (4 o.z).
    F visible_pdf(Vec3<F> o, Vec3<F> i) const {
        const Vec3<F> m = unit(o + i);
        return o.z > 0 && dot(o, m) > 0 ? D(m) / (1 + lambda(o)) / (4 * o.z) : F(0);
    }
    Vec3<F> visible_normal(Vec3<F> o, F u1, F u2) const {
        const Vec3<F> v = unit(Vec3<F>{ax * o.x, ay * o.y, o.z});
        const F size = sqr(v.x) + sqr(v.y), s = (1 + v.z) / 2;
        const Vec3<F> t1 = size > 0 ? Vec3<F>{-v.y, v.x, 0} * (1 / std::sqrt(size)) : Vec3<F>{1, 0, 0};
        const F r = std::sqrt(u1), phi = 2 * pi_of<F> * u2, x = r * std::cos(phi);
        const F y = (1 - s) * std::sqrt(std::max(1 - x * x, F(0))) + s * r * std::sin(phi);
        const Vec3<F> n = t1 * x + cross(v, t1) * y + v * std::sqrt(std::max(1 - x * x - y * y, F(0)));
        return unit(Vec3<F>{ax * n.x, ay * n.y, std::max(n.z, F(1e-6))});
    }
    Functions<F> visible() const {
        const Ggx2 g = *this;
        Functions<F> out;
        out.pdf = [g](Vec3<F> o, Vec3<F> i) { return g.visible_pdf(o, i); };
        out.f = [g](Vec3<F> o, Vec3<F> i) { return g.f(o, i); };
        out.sample = [g](Vec3<F> o, const F* u) {
            const Vec3<F> i = reflected(o, g.visible_normal(o, u[0], u[1]));
            return Drawn<F>{i, g.visible_pdf(o, i)};
        };
        return out;
    }
};

/// Half vectors drawn by `normal` with density `D` m.z per solid angle; p = D m.z / (4 w_o.m). A half vector that faces
/// away from w_o gives no sample. f is D G / (4 cos cos) with the shadowing of V-cavities, Cook and Torrance 1982.
template <class F> Functions<F> by_normals(std::function<Vec3<F>(F u1, F u2)> normal, std::function<F(Vec3<F> m)> D) {
    Functions<F> out;
    out.pdf = [D](Vec3<F> o, Vec3<F> i) {
        const Vec3<F> m = unit(o + i);
        const F c = dot(o, m);
        return c > 0 && m.z > 0 ? D(m) * m.z / (4 * c) : F(0);
    };
    out.f = [D](Vec3<F> o, Vec3<F> i) {
        if (!(o.z > 0 && i.z > 0)) return F(0);
        const Vec3<F> m = unit(o + i);
        const F g = std::min(F(1), 2 * m.z * std::min(o.z, i.z) / dot(o, m));
        return F(0.9) * D(m) * g / (4 * o.z * i.z);
    };
    out.sample = [normal, pdf = out.pdf](Vec3<F> o, const F* u) {
        const Vec3<F> m = normal(u[0], u[1]);
        if (!(dot(o, m) > 0)) return Drawn<F>{{0, 0, 1}, 0};
        const Vec3<F> i = reflected(o, m);
        return Drawn<F>{i, pdf(o, i)};
    };
    return out;
}

}  // namespace crescent::calibration
