// Layers in three channels: a smooth coat, a delta part, over Lambert; a rough lobe with Schlick's Fresnel over
// Lambert. The rough lobe is drawn by its visible normals, with equal alphas: Heitz 2018; Schlick 1994, "An Inexpensive
// BRDF Model for Physically-based Rendering".
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "math/functions.h"
#include "math/simd/math.h"
#include "math/simd/scalar.h"
#include "tests/known_samplers/correct/renderers.h"

namespace crescent {

namespace {

Vec3d times(Vec3d a, Vec3d b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
Vec3d cosine(const PrimarySample& u) { return math::spherical(std::sqrt(u[0]), std::sqrt(1 - u[0]), 2 * pi * u[1]); }
RoughGlass lobe_of(const Layers& l) { return {l.alpha, 1.5}; }
Vec3d schlick(Vec3d f0, double c) {
    const double k = math::pow(std::max(1 - c, 0.0), 5);
    return f0 + (Vec3d{1, 1, 1} - f0) * k;
}

}  // namespace

Draw SmoothCoat::sample(Vec3d wo, const PrimarySample& u) const {
    Draw d;
    if (u[2] < q) {
        d.wi = {-wo.x, -wo.y, wo.z};
        d.delta = q;
        d.weights = Vec3d{1, 1, 1} * (mirrored / q);
    } else {
        d.wi = cosine(u);
        d.pdf = pdf(d.wi);
        d.weights = base * ((1 - mirrored) / (1 - q));
    }
    d.weight = luminance(d.weights);
    return d;
}

SyntheticSampler recipe_of(const SmoothCoat& c) {
    SyntheticSampler r{"smooth coat", fmt::format("mirrors {:.3g}, q {:.3g}", c.mirrored, c.q), {}, {}, {}};
    r.traits.numbers = r.traits.channels = 3;
    r.traits.delta = true;
    r.sample = [c](Vec3d wo, const PrimarySample& u) { return c.sample(wo, u); };
    r.pdf = [c](Vec3d, Vec3d wi) { return c.pdf(wi); };
    r.f_channels = [c](Vec3d, Vec3d wi) { return c.f(wi); };
    return r;
}

double Layers::lobe_pdf(Vec3d wo, Vec3d wi) const {
    const RoughGlass g = lobe_of(*this);
    const Vec3d m = normalize(wo + wi);
    const double c = dot(wo, m);
    return wi.z > 0 && c > 0 && m.z > 0 ? g.D(m) * g.G1(wo, m) / (4 * wo.z) : 0;
}

double Layers::pdf(Vec3d wo, Vec3d wi) const {
    return choice * lobe_pdf(wo, wi) + (1 - choice) * std::max(wi.z, 0.0) / pi;
}

Vec3d Layers::f(Vec3d wo, Vec3d wi) const {
    if (!(wo.z > 0 && wi.z > 0)) return {};
    const RoughGlass g = lobe_of(*this);
    const Vec3d m = normalize(wo + wi), fr = schlick(normal_reflectance, dot(wo, m));
    const Vec3d down = Vec3d{1, 1, 1} - schlick(normal_reflectance, wo.z),
                up = Vec3d{1, 1, 1} - schlick(normal_reflectance, wi.z);
    return fr * (g.D(m) * g.G1(wo, m) * g.G1(wi, m) / (4 * wo.z * wi.z)) + times(times(down, up), base) * (1 / pi);
}

Draw Layers::sample(Vec3d wo, const PrimarySample& u) const {
    Draw d;
    if (u[2] < choice) {
        RoughGlass g = lobe_of(*this);
        g.reflect = [](double) { return 1.0; };
        PrimarySample v = u;
        v[2] = 0;
        d = g.sample(wo, v);
        if (!(d.pdf > 0)) return {{0, 0, 1}, 0};
    } else {
        d.wi = cosine(u);
    }
    d.pdf = pdf(wo, d.wi);
    if (d.wi.z > 0 && d.pdf > 0) d.weights = f(wo, d.wi) * (d.wi.z / d.pdf);
    d.weight = luminance(d.weights);
    return d;
}

SyntheticSampler recipe_of(const Layers& l) {
    SyntheticSampler r{"layers in colour", fmt::format("alpha {:.4g}, choice {:.3g}", l.alpha, l.choice), {}, {}, {}};
    r.traits.numbers = r.traits.channels = 3;
    r.sample = [l](Vec3d wo, const PrimarySample& u) { return l.sample(wo, u); };
    r.pdf = [l](Vec3d wo, Vec3d wi) { return l.pdf(wo, wi); };
    r.f_channels = [l](Vec3d wo, Vec3d wi) { return l.f(wo, wi); };
    return r;
}

}  // namespace crescent
