// Held-out faults: samplers of other families, with causes written down before the diagnosis was run on them. They
// measure how often the cause is named correctly; nothing is tuned on them.
#include <algorithm>
#include <cmath>

#include "check/sources/cases.h"
#include "math/functions.h"
#include "math/simd/frame.h"
#include "math/simd/scalar.h"
#include "tests/known_samplers/correct/renderers.h"
#include "tests/known_samplers/faulty/planted.h"

namespace crescent {

namespace {

/// Beckmann's distribution, isotropic, half vectors drawn by D n.m: Walter et al. 2007, (25), (28), (29).
struct Beckmann {
    double alpha = 0.35;
    double D(Vec3d m) const {
        if (m.z <= 0) return 0;
        const double t2 = (1 - m.z * m.z) / (m.z * m.z);
        return math::exp(-t2 / sqr(alpha)) / (pi * sqr(alpha) * sqr(sqr(m.z)));
    }
    Vec3d normal(const PrimarySample& u) const {
        const double t2 = -sqr(alpha) * math::log1p(-u[0]);
        return math::spherical(1 / std::sqrt(1 + t2), 2 * pi * u[1]);
    }
    double pdf(Vec3d o, Vec3d i) const {
        const Vec3d m = normalize(o + i);
        return o.z > 0 && i.z > 0 ? D(m) * m.z / (4 * dot(o, m)) : 0;
    }
    Draw draw(Vec3d o, const PrimarySample& u) const {
        const Vec3d m = normal(u), i = m * (2 * dot(o, m)) - o;
        return i.z > 0 ? Draw{i, pdf(o, i)} : Draw{{0, 0, 1}, 0};
    }
};

/// Henyey & Greenstein 1941 about -w_o.
struct Phase {
    double g = 0.6;
    double pdf(Vec3d o, Vec3d i) const {
        const double c = -dot(o, i);
        return (1 - g * g) / (4 * pi * math::pow(1 + g * g - 2 * g * c, 1.5));
    }
    Draw draw(Vec3d o, const PrimarySample& u) const {
        const double s = (1 - g * g) / (1 - g + 2 * g * u[0]), c = (1 + g * g - s * s) / (2 * g);
        const Vec3d i = frame_about(-o).to_world(math::spherical(std::clamp(c, -1.0, 1.0), 2 * pi * u[1]));
        return {i, pdf(o, i)};
    }
};

/// cos^s about the mirror direction.
struct Power {
    double s = 45;
    double pdf(Vec3d o, Vec3d i) const { return (s + 1) / (2 * pi) * math::pow(std::max(dot(i, mirror(o)), 0.0), s); }
    Draw draw(Vec3d o, const PrimarySample& u) const {
        const Vec3d i =
            frame_about(mirror(o)).to_world(math::spherical(math::pow(1 - u[0], 1 / (s + 1)), 2 * pi * u[1]));
        return {i, pdf(o, i)};
    }
};

template <class S> SyntheticSampler recipe(const char* family, S s) {
    SyntheticSampler r{family, "", {}, {}, {}};
    r.sample = [s](Vec3d o, const PrimarySample& u) { return s.draw(o, u); };
    r.pdf = [s](Vec3d o, Vec3d i) { return s.pdf(o, i); };
    return r;
}

/// Sheen over Lambert in three channels, drawn by cosine; the weight is returned with the draw.
SyntheticSampler sheen() {
    SyntheticSampler r{"sheen", "", {}, {}, {}};
    r.traits.numbers = 2;
    r.traits.channels = 3;
    const auto f = [](Vec3d o, Vec3d i) {
        if (o.z <= 0 || i.z <= 0) return Vec3d{};
        const double c = dot(normalize(o + i), i), k = math::pow(std::max(1 - c, 0.0), 5);
        return Vec3d{0.5, 0.3, 0.1} * (1 / pi) + Vec3d{0.1, 0.4, 0.9} * (0.2 * k);
    };
    r.pdf = [](Vec3d, Vec3d i) { return std::max(i.z, 0.0) / pi; };
    r.f_channels = f;
    r.sample = [f](Vec3d o, const PrimarySample& u) {
        Draw d{math::spherical(std::sqrt(1 - u[0]), 2 * pi * u[1]), 0};
        d.pdf = d.wi.z / pi;
        d.weights = f(o, d.wi) * pi;
        d.weight = luminance(d.weights);
        return d;
    };
    return r;
}

/// Rough glass without visible-normal sampling, with another index than the other faults.
RoughGlass other_glass() {
    RoughGlass g{0.2, 1.8};
    g.visible = false;
    return g;
}

using FaultInjection = std::function<double(Vec3d o, Vec3d i, double p)>;

/// Changes p both with a draw and for queries.
SyntheticSampler with_pdf(SyntheticSampler r, FaultInjection bend) {
    r.pdf = [pdf = r.pdf, bend](Vec3d o, Vec3d i) { return bend(o, i, pdf(o, i)); };
    r.sample = [sample = r.sample, bend](Vec3d o, const PrimarySample& u) {
        Draw d = sample(o, u);
        if (d.pdf > 0) d.pdf = bend(o, d.wi, d.pdf);
        return d;
    };
    return r;
}
SyntheticSampler with_draw(SyntheticSampler r, std::function<void(Vec3d, Draw&)> bend) {
    r.sample = [sample = r.sample, bend](Vec3d o, const PrimarySample& u) {
        Draw d = sample(o, u);
        if (d.pdf > 0) bend(o, d);
        return d;
    };
    return r;
}
SyntheticSampler with_f(SyntheticSampler r, FaultInjection bend) {
    r.f = [f = r.f, bend](Vec3d o, Vec3d i) { return bend(o, i, f(o, i)); };
    return r;
}

Vec3d half(Vec3d o, Vec3d i) { return normalize(o + i); }

struct Planted {
    const char *name, *cause;
    SyntheticSampler recipe;
};

void reflections(std::vector<Planted>& out) {
    const SyntheticSampler b = recipe("beckmann", Beckmann{}), p = recipe("power", Power{}),
                           a = ggx_visible_at(0.15, 0.45);
    out.push_back({"held out: Jacobian of the half vector", "w_o.m",
        with_pdf(b, [](Vec3d o, Vec3d i, double v) { return v * 4 * dot(o, half(o, i)); })});
    out.push_back({"held out: D for D n.m", "n.m",
        with_pdf(b, [](Vec3d o, Vec3d i, double v) { return v > 0 ? v / half(o, i).z : 0; })});
    out.push_back({"held out: exponent one too large", "w_i.R",
        with_pdf(p, [](Vec3d o, Vec3d i, double v) { return v * 47.0 / 46 * std::max(dot(i, mirror(o)), 0.0); })});
    out.push_back(
        {"held out: s+1 for s+2", "a constant", with_pdf(p, [](Vec3d, Vec3d, double v) { return v * 47 / 46; })});
    SyntheticSampler swapped = a;
    swapped.pdf = ggx_visible_at(0.45, 0.15).pdf;
    out.push_back(
        {"held out: roughnesses exchanged", "exchanged", with_pdf(swapped, [](Vec3d, Vec3d, double v) { return v; })});
    out.back().recipe.sample = [sample = a.sample, pdf = swapped.pdf](Vec3d o, const PrimarySample& u) {
        Draw d = sample(o, u);
        if (d.pdf > 0) d.pdf = pdf(o, d.wi);
        return d;
    };
    SyntheticSampler mirrored = a;
    mirrored.sample = [a](Vec3d o, const PrimarySample& u) {
        Draw d = a.sample({o.x, -o.y, o.z}, u);
        if (d.pdf > 0) d.pdf = a.pdf(o, d.wi);
        return d;
    };
    out.push_back({"held out: w_o mirrored in the draw", "mirrored", mirrored});
    out.push_back({"held out: G1 left out, anisotropic", "a constant", with_pdf(a, [a](Vec3d o, Vec3d, double v) {
                       const double t2 = (sqr(0.15 * o.x) + sqr(0.45 * o.y)) / sqr(o.z);
                       return v * (1 + std::sqrt(1 + t2)) / 2;
                   })});
}

void spheres(std::vector<Planted>& out) {
    const SyntheticSampler h = recipe("phase function", Phase{});
    out.push_back({"held out: 2 pi for 4 pi", "a constant", with_pdf(h, [](Vec3d, Vec3d, double v) { return 2 * v; })});
    out.push_back({"held out: sin theta of the map left in", "sin theta_i",
        with_pdf(h, [](Vec3d, Vec3d i, double v) { return v * math::hypot(i.x, i.y); })});
    SyntheticSampler flat{"flat", "", {}, {}, {}};
    flat.sample = [](Vec3d, const PrimarySample& u) {
        Draw d{math::spherical(1 - u[0], 2 * pi * u[1]), 0};
        d.pdf = d.wi.z / pi;
        return d;
    };
    flat.pdf = [](Vec3d, Vec3d i) { return std::max(i.z, 0.0) / pi; };
    out.push_back({"held out: uniform draw, cosine pdf", "cos theta_i", flat});
    SmoothCoat coat;
    coat.q = 0.4;
    out.push_back({"held out: delta part left out of the rest", "a constant",
        with_pdf(recipe_of(coat), [](Vec3d, Vec3d, double v) { return v / 0.6; })});
}

void glasses(std::vector<Planted>& out) {
    const RoughGlass g = other_glass();
    const SyntheticSampler r = recipe_of(g);
    const auto fresnel = [g](Vec3d o, Vec3d i) { return g.fresnel(std::fabs(dot(o, g.half(o, i))), g.eta_from(o)); };
    out.push_back({"held out: refraction without eta^2", "eta^2",
        with_pdf(r, [g](Vec3d o, Vec3d i, double v) { return g.across(o, i) ? v / sqr(g.eta_from(o)) : v; })});
    out.push_back({"held out: pdf without Fresnel", "Fresnel", with_pdf(r, [g, fresnel](Vec3d o, Vec3d i, double v) {
                       const double f = fresnel(o, i), share = g.across(o, i) ? 1 - f : f;
                       return share > 0 ? v / share : 0;
                   })});
    out.push_back({"held out: refraction without its Jacobian", "Jacobian of refraction",
        with_pdf(r, [g](Vec3d o, Vec3d i, double v) {
            return g.across(o, i) && v > 0 ? v / g.jacobian(o, i, g.half(o, i)) : v;
        })});
    RoughGlass even = g;
    even.reflect = [](double) { return 0.5; };
    out.push_back({"held out: drawn by halves, weighed by Fresnel", "Fresnel", recipe_of(even)});
    out.push_back({"held out: radiance not scaled by eta^2", "eta^2",
        with_f(r, [g](Vec3d o, Vec3d i, double v) { return g.across(o, i) ? v * sqr(g.eta_from(o)) : v; })});
}

void weights(std::vector<Planted>& out) {
    const SyntheticSampler s = sheen();
    out.push_back({"held out: weight without its cosine", "cos theta_i", with_draw(s, [](Vec3d, Draw& d) {
                       d.weights = d.weights * (1 / d.wi.z);
                       d.weight = luminance(d.weights);
                   })});
    out.push_back(
        {"held out: red for blue in the weight", "channels 1 and 3 exchanged", with_draw(s, [](Vec3d, Draw& d) {
             std::swap(d.weights.x, d.weights.z);
             d.weight = luminance(d.weights);
         })});
    out.push_back({"held out: weight without 1 / pi", "a constant", with_draw(s, [](Vec3d, Draw& d) {
                       d.weights = d.weights * pi;
                       d.weight = luminance(d.weights);
                   })});
    out.push_back({"held out: weight clamped", "", with_draw(s, [](Vec3d, Draw& d) {
                       d.weights.z = std::min(d.weights.z, 0.12);
                       d.weight = luminance(d.weights);
                   })});
    SyntheticSampler gap = s;  // nothing is drawn in a band that the pdf covers
    gap.sample = [sample = s.sample](Vec3d o, const PrimarySample& u) {
        PrimarySample v = u;
        v[1] = 0.93 * u[1];
        return sample(o, v);
    };
    out.push_back({"held out: the last azimuths never drawn", "", gap});
}

}  // namespace

std::vector<PlantedFault> held_out_faults() {
    std::vector<Planted> all;
    reflections(all);
    spheres(all);
    glasses(all);
    weights(all);
    std::vector<PlantedFault> out;
    for (const Planted& p : all) {
        PlantedFault fault{p.name, p.recipe.family, {}, p.cause};
        const bool both = p.recipe.traits.wo == Traits::WoDomain::both;
        const auto adapter = make_adapter(p.recipe);
        for (const auto& [theta, azimuth] : both
                ? std::vector<std::pair<double, double>>{{20, 40}, {65, 200}, {150, 310}}
                : std::vector<std::pair<double, double>>{{20, 40}, {50, 110}, {70, 200}})
            fault.check_cases.push_back(make_user_case(adapter, theta, azimuth));
        out.push_back(std::move(fault));
    }
    return out;
}

}  // namespace crescent
