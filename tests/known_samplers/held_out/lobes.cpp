// Faults of samplers of several lobes, of lights and of shadowing. Their causes were written down, with thirty-four
// others over the pipe, before the diagnosis was run on them, and not by its author. Initially two of these had their
// cause named (the cosine twice in a mixture of two, the selection probability omitted), and s+2 for s+1 in one lobe
// was reported as the selection probability; the diagnosis was extended for the others afterwards, so they no longer
// measure unseen faults.
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

struct Lobe {
    std::function<Vec3d(Vec3d o, const PrimarySample& u)> draw;  // {} if nothing is drawn
    std::function<double(Vec3d o, Vec3d i)> pdf;
};

Vec3d half(Vec3d o, Vec3d i) { return normalize(o + i); }

Lobe cosine() {
    return {[](Vec3d, const PrimarySample& u) { return math::spherical(std::sqrt(1 - u[0]), 2 * pi * u[1]); },
        [](Vec3d, Vec3d i) { return std::max(i.z, 0.0) / pi; }};
}
Lobe uniform() {
    return {[](Vec3d, const PrimarySample& u) { return math::spherical(1 - u[0], 2 * pi * u[1]); },
        [](Vec3d, Vec3d i) { return i.z > 0 ? 1 / (2 * pi) : 0; }};
}
/// cos^s about the mirror direction.
Lobe power(double s) {
    return {[s](Vec3d o, const PrimarySample& u) {
                return frame_about(mirror(o)).to_world(
                    math::spherical(math::pow(1 - u[0], 1 / (s + 1)), 2 * pi * u[1]));
            },
        [s](Vec3d o, Vec3d i) { return (s + 1) / (2 * pi) * math::pow(std::max(dot(i, mirror(o)), 0.0), s); }};
}
Lobe cone(Vec3d axis, double cos) {
    const Vec3d a = normalize(axis);
    return {[=](Vec3d, const PrimarySample& u) {
                return frame_about(a).to_world(math::spherical(1 - u[0] * (1 - cos), 2 * pi * u[1]));
            },
        [=](Vec3d, Vec3d i) { return dot(a, i) >= cos ? 1 / (2 * pi * (1 - cos)) : 0; }};
}
/// GGX half vectors by D n.m: Walter et al. 2007, (33), (35).
Lobe ggx(double alpha) {
    const RoughGlass g{alpha, 1.5};
    return {[=](Vec3d o, const PrimarySample& u) {
                const double t2 = sqr(alpha) * u[0] / (1 - u[0]);
                const Vec3d m = math::spherical(1 / std::sqrt(1 + t2), 2 * pi * u[1]), i = m * (2 * dot(o, m)) - o;
                return i.z > 0 && dot(o, m) > 0 ? i : Vec3d{};
            },
        [=](Vec3d o, Vec3d i) {
            const Vec3d m = half(o, i);
            return i.z > 0 && m.z > 0 ? g.D(m) * m.z / (4 * dot(o, m)) : 0;
        }};
}
/// A rectangle, by area.
Lobe rectangle() {
    const Vec3d n = normalize(Vec3d{-0.3, 0.1, -1}), centre{0.5, -0.2, 1.4};
    const Frame<double> f = frame_about(n);
    constexpr double w = 1.2, h = 0.9;
    return {[=](Vec3d, const PrimarySample& u) {
                return normalize(centre + f.t * ((u[0] - 0.5) * w) + f.b * ((u[1] - 0.5) * h));
            },
        [=](Vec3d, Vec3d i) {
            const double c = dot(i, n), d = c < 0 ? dot(centre, n) / c : 0;
            const Vec3d q = i * d - centre;
            const bool met = d > 0 && std::fabs(dot(q, f.t)) <= w / 2 && std::fabs(dot(q, f.b)) <= h / 2;
            return met ? d * d / (w * h * -c) : 0;
        }};
}

using FaultInjection = std::function<double(Vec3d o, Vec3d i)>;
Lobe with_pdf(Lobe l, FaultInjection by) {
    l.pdf = [pdf = l.pdf, by](Vec3d o, Vec3d i) {
        const double p = pdf(o, i);
        return p > 0 ? p * by(o, i) : 0;
    };
    return l;
}

struct Mixture {
    std::vector<Lobe> lobes;
    std::vector<double> drawn, claimed;
    bool third = true;    // the third number selects, else the first
    bool stretch = true;  // the first number, after selecting, is rescaled to its part of the interval
};

/// A mixture, with p changed as a whole.
SyntheticSampler recipe_of(const Mixture& m, const FaultInjection& by = [](Vec3d, Vec3d) { return 1.0; }) {
    SyntheticSampler r{"mixture", "", {}, {}, {}};
    r.traits.numbers = m.third ? 3 : 2;
    r.pdf = [=](Vec3d o, Vec3d i) {
        double p = 0;
        for (std::size_t k = 0; k < m.lobes.size(); ++k) p += m.claimed[k] * m.lobes[k].pdf(o, i);
        return p > 0 ? p * by(o, i) : 0;
    };
    r.sample = [=, pdf = r.pdf](Vec3d o, const PrimarySample& u) {
        PrimarySample v = u;
        double c = u[m.third ? 2 : 0];
        std::size_t k = 0;
        while (k + 1 < m.lobes.size() && c >= m.drawn[k]) c -= m.drawn[k++];
        if (!m.third && m.stretch) v[0] = std::clamp(c / m.drawn[k], 0.0, 1 - 0x1p-24);
        const Vec3d i = m.lobes[k].draw(o, v);
        return dot(i, i) > 0 ? Draw{i, pdf(o, i)} : Draw{{0, 0, 1}, 0};
    };
    return r;
}
SyntheticSampler alone(const Lobe& l) { return recipe_of(Mixture{{l}, {1}, {1}, false, false}); }
SyntheticSampler of_light(SyntheticSampler r) {
    r.traits.wo = Traits::WoDomain::none;
    return r;
}

struct Planted {
    const char *name, *cause;
    SyntheticSampler recipe;
};

void choosers(std::vector<Planted>& out) {
    const Lobe a = cone({0, 0.3, 1}, 0.93), b = cone({0.8, 0, 0.4}, 0.95), c = cone({-0.5, -0.5, 0.3}, 0.97);
    const char *chooser = "the chooser's probability", *again = "used again without stretching";
    out.push_back({"lobes: chosen by 0.3, weighed by a half", chooser,
        recipe_of({{cosine(), ggx(0.3)}, {0.3, 0.7}, {0.5, 0.5}})});
    out.push_back({"lobes: the weights of two of three exchanged", chooser,
        recipe_of({{cosine(), ggx(0.3), power(40)}, {0.2, 0.5, 0.3}, {0.5, 0.2, 0.3}})});
    out.push_back({"lobes: one weight of three off", "one lobe",
        recipe_of({{cosine(), ggx(0.3), power(60)}, {0.3, 0.3, 0.4}, {0.3, 0.3, 0.5}})});
    out.push_back({"lobes: two that do not overlap", chooser, recipe_of({{a, b}, {0.3, 0.7}, {0.5, 0.5}})});
    out.push_back({"lobes: three that do not overlap", chooser,
        recipe_of({{a, b, c}, {0.2, 0.5, 0.3}, {1.0 / 3, 1.0 / 3, 1.0 / 3}})});
    out.push_back({"lobes: the first number chooses, weights off", chooser,
        recipe_of({{cosine(), power(30)}, {0.25, 0.75}, {0.5, 0.5}, false})});
    out.push_back({"lobes: the first number chooses among three", chooser,
        recipe_of({{uniform(), ggx(0.4), power(20)}, {0.2, 0.3, 0.5}, {0.4, 0.3, 0.3}, false})});
    out.push_back({"lobes: the chooser used again", again,
        recipe_of({{cosine(), ggx(0.3)}, {0.4, 0.6}, {0.4, 0.6}, false, false})});
    out.push_back({"lobes: the chooser used again, three of them", again,
        recipe_of({{cosine(), ggx(0.3), uniform()}, {0.3, 0.4, 0.3}, {0.3, 0.4, 0.3}, false, false})});
    out.push_back({"lobes: the chooser used again, no overlap", again,
        recipe_of({{a, b}, {0.4, 0.6}, {0.4, 0.6}, false, false})});
    out.push_back({"lobes: the chooser left out of the pdf", "a constant",
        recipe_of({{cosine(), ggx(0.2)}, {0.5, 0.5}, {1, 1}})});
}

void factors(std::vector<Planted>& out) {
    const FaultInjection cos = [](Vec3d, Vec3d i) { return std::max(i.z, 1e-9); };
    const FaultInjection less_cos = [](Vec3d, Vec3d i) { return 1 / std::max(i.z, 1e-3); };
    const FaultInjection jacobian = [](Vec3d o, Vec3d i) { return 4 * dot(o, half(o, i)); };
    const std::vector<double> even = {0.5, 0.5};
    out.push_back({"lobes: the cosine twice", "cos theta_i", recipe_of({{cosine(), ggx(0.3)}, even, even}, cos)});
    out.push_back({"lobes: over the cosine, three of them", "cos theta_i",
        recipe_of({{cosine(), ggx(0.2), power(20)}, {0.3, 0.3, 0.4}, {0.3, 0.3, 0.4}}, less_cos)});
    out.push_back({"lobes: no cosine in one of two", "cos theta_i",
        recipe_of({{with_pdf(cosine(), less_cos), ggx(0.3)}, even, even})});
    out.push_back({"lobes: no Jacobian of the half vector in one of two", "w_o.m",
        recipe_of({{cosine(), with_pdf(ggx(0.3), jacobian)}, even, even})});
    out.push_back({"lobes: s+2 for s+1 in one of two", "a constant",
        recipe_of({{cosine(), with_pdf(power(30), [](Vec3d, Vec3d) { return 32.0 / 31; })}, {0.4, 0.6}, {0.4, 0.6}})});
    SyntheticSampler mirrored = recipe_of({{cosine(), power(40)}, {0.3, 0.7}, {0.3, 0.7}, false});
    mirrored.sample = [sample = mirrored.sample, pdf = mirrored.pdf](Vec3d o, const PrimarySample& u) {
        Draw d = sample(o, u);
        d.wi.y = -d.wi.y;
        if (d.pdf > 0) d.pdf = pdf(o, d.wi);
        return d;
    };
    out.push_back({"lobes: all drawn in a mirrored frame", "mirrored", mirrored});
}

void of_lights(std::vector<Planted>& out) {
    const Vec3d n = normalize(Vec3d{0.3, -0.1, 1});
    const double h = dot(Vec3d{0.5, -0.2, 1.4}, n);
    const FaultInjection by_area = [=](Vec3d, Vec3d i) { return math::pow(dot(i, n), 3) / sqr(h); };
    out.push_back(
        {"light: area for solid angle", "distance^2 / cosine", of_light(alone(with_pdf(rectangle(), by_area)))});
    out.push_back({"light: cosine left out", "cosine at a flat light",
        of_light(alone(with_pdf(rectangle(), [=](Vec3d, Vec3d i) { return dot(i, n); })))});
    out.push_back({"light: distance left out", "distance^2 to a flat light",
        of_light(alone(with_pdf(rectangle(), [=](Vec3d, Vec3d i) { return sqr(dot(i, n) / h); })))});
    out.push_back({"light: area for solid angle, beside a lobe", "distance^2 / cosine",
        recipe_of({{cosine(), with_pdf(rectangle(), by_area)}, {0.5, 0.5}, {0.5, 0.5}})});
    Rng dice(3);
    const std::shared_ptr<const Sky> sky = sky_with_sun(dice, 24, 48, 0.3, false);
    SyntheticSampler turned = recipe_of(sky);
    turned.sample = [sky](Vec3d, const PrimarySample& u) {
        Draw d = sky->sample(u);
        std::swap(d.wi.y, d.wi.z);
        d.pdf = sky->pdf(d.wi);
        return d;
    };
    out.push_back({"light: y up for z up", "y and z exchanged", turned});
}

void surfaces(std::vector<Planted>& out) {
    const RoughGlass glass{0.25, 1.7};
    SyntheticSampler untold = recipe_of(glass);
    untold.traits.eta = {};
    untold.pdf = [glass](
                     Vec3d o, Vec3d i) { return glass.pdf(o, i) / (glass.across(o, i) ? sqr(glass.eta_from(o)) : 1); };
    untold.sample = [glass, p = untold.pdf](Vec3d o, const PrimarySample& u) {
        Draw d = glass.sample(o, u);
        if (d.pdf > 0) d.pdf = p(o, d.wi);
        return d;
    };
    out.push_back({"glass: eta^2 left out, the index not told", "a constant across the surface", untold});
    const auto g1 = [](Vec3d w) { return 2 / (1 + std::sqrt(1 + (sqr(0.15 * w.x) + sqr(0.45 * w.y)) / sqr(w.z))); };
    SyntheticSampler visible = ggx_visible_at(0.15, 0.45);
    visible.pdf = [g1, p = visible.pdf](Vec3d o, Vec3d i) { return i.z > 0 ? p(o, i) * g1(i) / g1(o) : 0; };
    visible.sample = [draw = visible.sample, p = visible.pdf](Vec3d o, const PrimarySample& u) {
        Draw d = draw(o, u);
        if (d.pdf > 0) d.pdf = p(o, d.wi);
        return d;
    };
    out.push_back({"visible normals: G1 at w_i for that at w_o", "G1(w_o) / G1(w_i)", visible});
}

}  // namespace

std::vector<PlantedFault> held_out_lobe_faults() {
    std::vector<Planted> all;
    choosers(all);
    factors(all);
    of_lights(all);
    surfaces(all);
    std::vector<PlantedFault> out;
    for (const Planted& p : all) {
        PlantedFault fault{p.name, p.recipe.family, {}, p.cause};
        const auto adapter = make_adapter(p.recipe);
        for (const auto& [theta, azimuth] : {std::pair{20.0, 40.0}, {50.0, 110.0}, {70.0, 200.0}})
            fault.check_cases.push_back(make_user_case(adapter, theta, azimuth));
        out.push_back(std::move(fault));
    }
    return out;
}

}  // namespace crescent
