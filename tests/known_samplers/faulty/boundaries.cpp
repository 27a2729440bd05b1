// Faults of surfaces under a smooth boundary: Fresnel, the passes through a coat, the selection between coat and base,
// and the shadowing of a rough lobe. Each has one factor in the wrong place.
#include <algorithm>
#include <cmath>

#include "check/sources/cases.h"
#include "math/functions.h"
#include "tests/known_samplers/correct/renderers.h"
#include "tests/known_samplers/faulty/planted.h"

namespace crescent {

namespace {

constexpr double alpha = 0.3, eta = 1.5;
using Faults = std::vector<PlantedFault>;

void plant(Faults& out, const std::string& name, std::string breaks, SyntheticSampler recipe) {
    PlantedFault fault{name, std::move(breaks), {}, cause_of(name)};
    std::vector<std::pair<double, double>> at = {{20, 40}, {45, 130}, {75, 310}};
    if (recipe.traits.wo == Traits::WoDomain::both) at = {{45, 130}, {75, 310}, {135, 130}};
    const auto adapter = make_adapter(std::move(recipe));
    for (const auto& [theta, azimuth] : at) fault.check_cases.push_back(make_user_case(adapter, theta, azimuth));
    out.push_back(std::move(fault));
}

double fresnel(double c) { return RoughGlass{alpha, eta}.fresnel(std::fabs(c), eta); }
double fresnel_at_m(Vec3d o, Vec3d i) { return fresnel(dot(o, normalize(o + i))); }
double lambda(Vec3d w) { return 0.5 * (std::sqrt(1 + sqr(alpha) * (1 / sqr(w.z) - 1)) - 1); }

using Share = std::function<double(Vec3d o, Vec3d i)>;

/// GGX with visible normals and Fresnel, f = F D G / (4 cos cos), its weight times `weight` and its f times `f`.
SyntheticSampler lacquer(const Share& weight, const Share& f) {
    const SyntheticSampler visible = ggx_visible_at(alpha, alpha);
    SyntheticSampler r{"lacquer", "", {}, visible.pdf, {}};
    // The density of visible normals has D G1(w_o) / (4 cos theta_o).
    const auto right = [pdf = visible.pdf](Vec3d o, Vec3d i) {
        return i.z > 0 && o.z > 0 ? fresnel_at_m(o, i) * pdf(o, i) / (1 + lambda(i)) / i.z : 0;
    };
    r.f = [right, f](Vec3d o, Vec3d i) { return i.z > 0 ? right(o, i) * f(o, i) : 0; };
    r.sample = [sample = visible.sample, right, weight](Vec3d o, const PrimarySample& u) {
        Draw d = sample(o, u);
        d.weight = d.pdf > 0 && d.wi.z > 0 ? right(o, d.wi) * d.wi.z / d.pdf * weight(o, d.wi) : 0;
        return d;
    };
    return r;
}

/// A mirroring coat, selected by its Fresnel at w_o, over Lambert seen through it.
SyntheticSampler coat(const Share& chooser, const Share& f) {
    constexpr double base = 0.6;
    SyntheticSampler r{"coat", "", {}, {}, {}};
    r.traits.numbers = 3;
    r.traits.delta = true;
    const auto through = [](Vec3d o, Vec3d i) { return (1 - fresnel(o.z)) * (1 - fresnel(i.z)); };
    r.pdf = [chooser](Vec3d o, Vec3d i) { return i.z > 0 ? chooser(o, i) * i.z / pi : 0; };
    r.f = [through, f](Vec3d o, Vec3d i) { return i.z > 0 ? through(o, i) * f(o, i) * base / pi : 0; };
    r.sample = [through, pdf = r.pdf](Vec3d o, const PrimarySample& u) {
        Draw d;
        const double q = fresnel(o.z);
        if (u[2] < q) {
            d.wi = {-o.x, -o.y, o.z};
            d.delta = q;
            d.weight = 1;
            return d;
        }
        d.wi = math::spherical(std::sqrt(u[0]), std::sqrt(1 - u[0]), 2 * pi * u[1]);
        d.pdf = pdf(o, d.wi);
        d.weight = d.pdf > 0 ? through(o, d.wi) * base / pi * d.wi.z / d.pdf : 0;
        return d;
    };
    return r;
}

double one(Vec3d, Vec3d) { return 1; }
double at_w_o(Vec3d o, Vec3d) { return 1 - fresnel(o.z); }

}  // namespace

std::vector<PlantedFault> boundary_faults() {
    Faults out;
    plant(out, "Fresnel twice in the weight", "lacquer", lacquer(fresnel_at_m, one));
    plant(
        out, "Fresnel left out of f", "lacquer", lacquer(one, [](Vec3d o, Vec3d i) { return 1 / fresnel_at_m(o, i); }));
    plant(out, "Fresnel at n for the half vector in the weight", "lacquer",
        lacquer([](Vec3d o, Vec3d i) { return fresnel(o.z) / fresnel_at_m(o, i); }, one));
    plant(out, "height-correlated shadowing in f alone", "lacquer",
        lacquer(one, [](Vec3d o, Vec3d i) { return (1 + lambda(o)) * (1 + lambda(i)) / (1 + lambda(o) + lambda(i)); }));
    plant(
        out, "chooser's Fresnel at w_i in the pdf", "coat", coat([](Vec3d, Vec3d i) { return 1 - fresnel(i.z); }, one));
    plant(out, "passes through the coat left out of f", "coat",
        coat(at_w_o, [](Vec3d o, Vec3d i) { return 1 / ((1 - fresnel(o.z)) * (1 - fresnel(i.z))); }));
    plant(out, "one pass through the coat left out of f", "coat",
        coat(at_w_o, [](Vec3d, Vec3d i) { return 1 / (1 - fresnel(i.z)); }));
    const RoughGlass g{alpha, eta};
    SyntheticSampler jacobian = recipe_of(g);
    const auto bend = [g](Vec3d o, Vec3d i, double p) {
        const Vec3d m = g.half(o, i);
        return g.across(o, i) && p > 0 ? p * std::fabs(dot(o, m) / dot(i, m)) : p;
    };
    jacobian.pdf = [pdf = jacobian.pdf, bend](Vec3d o, Vec3d i) { return bend(o, i, pdf(o, i)); };
    jacobian.sample = [sample = jacobian.sample, bend](Vec3d o, const PrimarySample& u) {
        Draw d = sample(o, u);
        if (d.pdf > 0) d.pdf = bend(o, d.wi, d.pdf);
        return d;
    };
    plant(out, "w_o.m for w_i.m in the Jacobian of refraction", "glass", jacobian);
    return out;
}

}  // namespace crescent
