// Phase functions, given as f |cos|, and samplers of both sides of a surface.
#include <algorithm>
#include <cmath>

#include "math/functions.h"
#include "math/simd/frame.h"
#include "tests/known_samplers/correct/renderers.h"
#include "tests/known_samplers/reported/known.h"

namespace crescent {

namespace {

/// Henyey & Greenstein 1941; drawn with g = `drawn`, p and f with `claimed`.
SyntheticSampler phase(double drawn, double claimed, double scale, Traits::WoDomain wo = Traits::WoDomain::both) {
    SyntheticSampler r{"phase", "", {}, {}, {}};
    r.traits.wo = wo;
    const auto p = [](double g, Vec3d o, Vec3d i) {
        return (1 - g * g) / (4 * pi * math::pow(1 + g * g + 2 * g * dot(o, i), 1.5));
    };
    r.pdf = [=](Vec3d o, Vec3d i) { return p(claimed, o, i); };
    r.f = [=](Vec3d o, Vec3d i) { return i.z == 0 ? 0 : scale * p(claimed, o, i) / std::fabs(i.z); };
    r.sample = [=](Vec3d o, const PrimarySample& u) {
        const double s = (1 - drawn * drawn) / (1 - drawn + 2 * drawn * u[0]);
        const double c = std::clamp((1 + drawn * drawn - s * s) / (2 * drawn), -1.0, 1.0);
        Draw d{frame_about(-o).to_world(math::spherical(c, 2 * pi * u[1])), 0};
        d.pdf = p(claimed, o, d.wi);
        d.weight = scale;
        return d;
    };
    return r;
}

/// Lambert above and below the surface, each drawn with probability one half.
SyntheticSampler paper(double above, double below) {
    SyntheticSampler r{"paper", "", {}, {}, {}};
    r.pdf = [](Vec3d, Vec3d i) { return 0.5 * std::fabs(i.z) / pi; };
    r.f = [=](Vec3d, Vec3d i) { return (i.z > 0 ? above : below) / pi; };
    r.sample = [](Vec3d, const PrimarySample& u) {
        const double x = u[0] < 0.5 ? 2 * u[0] : 2 * u[0] - 1, z = std::sqrt(1 - x);
        return Draw{math::spherical(std::sqrt(x), u[0] < 0.5 ? z : -z, 2 * pi * u[1]), 0.5 * z / pi, {}, {}};
    };
    return r;
}

/// Rough glass that supports only w_o above and states no index.
SyntheticSampler glass_from_above(double eta, bool importance) {
    RoughGlass g{0.3, eta};
    g.importance = importance;
    SyntheticSampler r = recipe_of(g);
    r.traits.wo = Traits::WoDomain::upper;
    r.traits.eta = {};
    return r;
}
SyntheticSampler scaled_f(SyntheticSampler r, double below) {
    r.f = [f = r.f, below](Vec3d o, Vec3d i) { return (i.z * o.z < 0 ? below : 1) * f(o, i); };
    return r;
}

/// Lambert about a normal that is tilted by 25 deg towards x, black if w_o is behind it.
SyntheticSampler tilted_lambert(bool draws) {
    const Vec3d n = tilt(25, 0);
    SyntheticSampler r{"tilted", "", {}, {}, {}};
    r.traits.reciprocal = false;
    r.pdf = [n](Vec3d o, Vec3d i) { return dot(o, n) > 0 && i.z > 0 ? std::max(dot(i, n), 0.0) / pi : 0; };
    r.f = [n](Vec3d o, Vec3d i) { return dot(o, n) > 0 && i.z > 0 ? 0.5 / pi * std::max(dot(i, n), 0.0) / i.z : 0; };
    r.sample = [n, draws, pdf = r.pdf](Vec3d o, const PrimarySample& u) {
        const Vec3d wi = about(n, std::sqrt(1 - u[0]), u[1]);
        return Draw{wi, draws ? pdf(o, wi) : 0};
    };
    return r;
}

/// cos / pi above for w_o above, nothing for w_o below.
SyntheticSampler one_sided() {
    SyntheticSampler r{"one side", "", {}, {}, {}};
    r.traits.wo = Traits::WoDomain::both;
    r.pdf = [](Vec3d o, Vec3d i) { return o.z > 0 ? std::max(i.z, 0.0) / pi : 0; };
    r.sample = [](Vec3d o, const PrimarySample& u) {
        const Vec3d wi = about({0, 0, 1}, std::sqrt(1 - u[0]), u[1]);
        return Draw{wi, o.z > 0 ? wi.z / pi : 0};
    };
    return r;
}

}  // namespace

std::vector<KnownSampler> phase_functions() {
    KnownList list;
    for (double g : {0.3, 0.75, -0.5}) list.right("phase function, g = " + std::to_string(g), phase(g, g, 1), {0, 150});
    list.right("phase function of w_o above alone", phase(0.75, 0.75, 1, Traits::WoDomain::upper), {60, 85});
    list.wrong("phase function of the other sign", "density", phase(0.6, -0.6, 1), {60});
    list.wrong("phase function that creates energy", "physics", phase(0.6, 0.6, 1.05), {60});
    list.wrong("the same of w_o above alone", "physics", phase(0.6, 0.6, 1.05, Traits::WoDomain::upper), {60});
    list.right("paper", paper(0.4, 0.4), {30, 150});
    list.missed("paper that creates energy below", paper(0.1, 5));  // it is not stated whether eta^2 scales f there
    for (double eta : {1.5, 1 / 1.5})
        for (bool importance : {false, true})
            list.not_wrong("rough glass from above", glass_from_above(eta, importance), {0, 60});
    list.missed("rough glass that creates energy below", scaled_f(glass_from_above(1.5, false), 5), {30});
    list.right("rough glass", recipe_of(RoughGlass{}), {45, 135});
    SyntheticSampler doubled = recipe_of(RoughGlass{});
    doubled.pdf = [pdf = doubled.pdf](Vec3d o, Vec3d i) { return (i.z < 0 ? 2 : 1) * pdf(o, i); };
    list.wrong("rough glass whose pdf below is doubled", "identity", doubled);
    list.right("tilted Lambert that draws nothing from behind", tilted_lambert(true), {45, 89});
    list.wrong("tilted Lambert that draws nothing though p is not 0", "normalised", tilted_lambert(false), {20});
    list.right("one side of a surface", one_sided(), {30, 150, 180});
    return list.take();
}

}  // namespace crescent
