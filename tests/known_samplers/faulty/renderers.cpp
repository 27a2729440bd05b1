// Faults of samplers in the forms used by renderers: glass, coats, colour, skies, states. Each is a correct sampler of
// tests/known_samplers/correct with one change.
#include <algorithm>
#include <atomic>
#include <cmath>

#include "check/sources/cases.h"
#include "math/functions.h"
#include "math/simd/scalar.h"
#include "tests/known_samplers/correct/renderers.h"
#include "tests/known_samplers/faulty/planted.h"

namespace crescent {

namespace {

using Faults = std::vector<PlantedFault>;

/// At three w_o above, at two below if the sampler supports both sides, at none for a sky.
void plant(Faults& out, const std::string& name, std::string breaks, SyntheticSampler recipe, bool state = false) {
    PlantedFault fault{name, std::move(breaks), {}, cause_of(name)};
    const Traits::WoDomain asked = recipe.traits.wo;
    const std::shared_ptr<const SamplerAdapter> adapter = make_adapter(std::move(recipe));
    std::vector<std::pair<double, double>> at = {{0, 0}, {45, 130}, {75, 310}};
    if (asked == Traits::WoDomain::both) at = {{45, 130}, {75, 310}, {135, 130}, {110, 310}};
    if (asked == Traits::WoDomain::none) at = {{0, 0}};
    if (state) at.resize(1);
    for (const auto& [theta, azimuth] : at) fault.check_cases.push_back(make_user_case(adapter, theta, azimuth));
    out.push_back(std::move(fault));
}

/// Changes p, and the p returned with each draw, in the same way.
void bend_pdf(SyntheticSampler& r, std::function<double(Vec3d, Vec3d, double)> bend) {
    r.pdf = [pdf = r.pdf, bend](Vec3d wo, Vec3d wi) { return bend(wo, wi, pdf(wo, wi)); };
    r.sample = [sample = r.sample, bend](Vec3d wo, const PrimarySample& u) {
        Draw d = sample(wo, u);
        if (d.pdf > 0) d.pdf = bend(wo, d.wi, d.pdf);
        return d;
    };
}
void bend_draw(SyntheticSampler& r, std::function<void(Vec3d, const PrimarySample&, Draw&)> bend) {
    r.sample = [sample = r.sample, bend](Vec3d wo, const PrimarySample& u) {
        Draw d = sample(wo, u);
        bend(wo, u, d);
        return d;
    };
}
void bend_numbers(SyntheticSampler& r, std::function<void(PrimarySample&)> bend) {
    r.sample = [sample = r.sample, bend](Vec3d wo, const PrimarySample& u) {
        PrimarySample v = u;
        bend(v);
        return sample(wo, v);
    };
}

void glass_faults(Faults& out) {
    const RoughGlass g{0.3, 1.5};
    const char* name = "glass";
    const auto with_f = [&](const char* what, std::function<double(Vec3d, Vec3d, double)> bend) {
        SyntheticSampler r = recipe_of(g);
        r.f = [f = r.f, bend](Vec3d wo, Vec3d wi) { return bend(wo, wi, f(wo, wi)); };
        plant(out, what, name, r);
    };
    const auto with_pdf = [&](const char* what, std::function<double(Vec3d, Vec3d, double)> bend) {
        SyntheticSampler r = recipe_of(g);
        bend_pdf(r, bend);
        plant(out, what, name, r);
    };
    const auto scale = [g](Vec3d o, Vec3d i) { return g.across(o, i) ? sqr(g.eta_from(o)) : 1.0; };
    with_f("eta^2 left out of f", [scale](Vec3d o, Vec3d i, double f) { return f * scale(o, i); });
    with_f("eta^2 for 1/eta^2 in f", [scale](Vec3d o, Vec3d i, double f) { return f * sqr(scale(o, i)); });
    with_f("cosine of w_i left in f across the surface",
        [g](Vec3d o, Vec3d i, double f) { return g.across(o, i) ? f * std::fabs(i.z) : f; });
    with_pdf("transmission pdf without its Jacobian",
        [g](Vec3d o, Vec3d i, double p) { return g.across(o, i) && p > 0 ? p / g.jacobian(o, i, g.half(o, i)) : p; });
    with_pdf(
        "eta^2 left out of the transmission Jacobian", [scale](Vec3d o, Vec3d i, double p) { return p / scale(o, i); });
    with_pdf("reflection Jacobian for transmission", [g](Vec3d o, Vec3d i, double p) {
        const Vec3d m = g.half(o, i);
        return g.across(o, i) && p > 0 ? p / g.jacobian(o, i, m) / (4 * std::fabs(dot(o, m))) : p;
    });
    with_pdf("Fresnel left out of the pdf", [g](Vec3d o, Vec3d i, double p) {
        const double f = g.fresnel(std::fabs(dot(o, g.half(o, i))), g.eta_from(o));
        const double share = g.across(o, i) ? 1 - f : f;
        return share > 0 ? p / share : 0;
    });
}

/// D for D n.m, on both sides of the surface.
void half_vector_faults(Faults& out) {
    const RoughGlass g{0.3, 1.5};
    for (const bool describe : {true, false}) {
        SyntheticSampler r = recipe_of(g);
        bend_pdf(r, [g](Vec3d o, Vec3d i, double p) { return p > 0 ? p / g.half(o, i).z : 0; });
        if (!describe) r.traits.eta = {};
        plant(out,
            describe ? "n.m left out of the pdf of glass" : "n.m left out of the pdf of glass whose index is not told",
            "glass", r);
    }
}

/// Faults of the selection of reflection or refraction, and of w_o below.
void choosing_faults(Faults& out) {
    const RoughGlass g{0.3, 1.5};
    const char* name = "glass";
    RoughGlass half = g;
    half.reflect = [](double) { return 0.5; };
    plant(out, "lobe chosen by a half, weighed by Fresnel", name, recipe_of(half));
    RoughGlass squared = g;
    squared.reflect = [](double f) { return std::sqrt(f); };
    plant(out, "lobe chosen by the root of Fresnel", name, recipe_of(squared));
    SyntheticSampler reused = recipe_of(g);
    bend_numbers(reused, [](PrimarySample& u) { u[2] = u[0]; });
    plant(out, "chooser reused without stretching", name, reused);
    SyntheticSampler turned = recipe_of(g);
    bend_numbers(turned, [](PrimarySample& u) { u[2] = std::fmod(0.5 * u[2] + 0.5 * u[1], 1.0); });
    plant(out, "chooser correlated with the azimuth", name, turned);
    SyntheticSampler flipped = recipe_of(g);
    flipped.sample = [g, other = RoughGlass{0.3, 1 / 1.5}](Vec3d wo, const PrimarySample& u) {
        if (wo.z > 0) return g.sample(wo, u);
        Draw d = other.sample(wo, u);
        if (d.pdf > 0) d.pdf = g.pdf(wo, d.wi);
        return d;
    };
    plant(out, "eta not inverted for w_o below", name, flipped);
    SyntheticSampler nan = recipe_of(g);
    bend_draw(nan, [](Vec3d, const PrimarySample& u, Draw& d) {
        if (u[2] == 0) d.wi.x = std::nan("");
    });
    plant(out, "NaN where the chooser is 0", name, nan);
}

void coat_faults(Faults& out) {
    const SmoothCoat coat;
    const char* name = "coat";
    SyntheticSampler counted = recipe_of(coat);
    bend_pdf(counted, [q = coat.q](Vec3d, Vec3d, double p) { return p / (1 - q); });
    plant(out, "delta mass counted in the pdf", name, counted);
    SyntheticSampler twice = recipe_of(coat);
    bend_pdf(twice, [q = coat.q](Vec3d, Vec3d, double p) { return p * (1 - q); });
    plant(out, "delta mass taken off the pdf twice", name, twice);
    SyntheticSampler seldom = recipe_of(coat);
    bend_numbers(seldom, [](PrimarySample& u) { u[2] = std::sqrt(u[2]); });
    plant(out, "delta part drawn less often than it says", name, seldom);
    SyntheticSampler bright = recipe_of(coat);
    bend_draw(bright, [q = coat.q](Vec3d, const PrimarySample&, Draw& d) {
        if (d.delta > 0) {
            d.weights = d.weights * (1 / q);
            *d.weight /= q;
        }
    });
    plant(out, "delta weight divided by q twice", name, bright);
    SyntheticSampler dense = recipe_of(coat);
    bend_draw(dense, [](Vec3d, const PrimarySample&, Draw& d) {
        if (d.delta > 0) {
            d.pdf = d.delta;
            d.delta = 0;
        }
    });
    plant(out, "delta part told as a density", name, dense);
}

void colour_faults(Faults& out) {
    const Layers layers;
    const char* name = "layers";
    const auto with_weight = [&](const char* what, std::function<void(Draw&)> bend) {
        SyntheticSampler r = recipe_of(layers);
        bend_draw(r, [bend](Vec3d, const PrimarySample&, Draw& d) {
            if (!(d.pdf > 0)) return;
            bend(d);
            d.weight = luminance(d.weights);
        });
        plant(out, what, name, r);
    };
    const auto with_f = [&](const char* what, std::function<void(Vec3d, Vec3d, Vec3d&)> bend) {
        SyntheticSampler r = recipe_of(layers);
        r.f_channels = [f = r.f_channels, bend](Vec3d wo, Vec3d wi) {
            Vec3d v = f(wo, wi);
            bend(wo, wi, v);
            return v;
        };
        r.sample = [sample = r.sample, f = r.f_channels](Vec3d wo, const PrimarySample& u) {
            Draw d = sample(wo, u);
            if (d.pdf > 0 && d.wi.z > 0) {
                d.weights = f(wo, d.wi) * (d.wi.z / d.pdf);
                d.weight = luminance(d.weights);
            }
            return d;
        };
        plant(out, what, name, r);
    };
    with_weight("channels of the weight swapped", [](Draw& d) { std::swap(d.weights.x, d.weights.z); });
    with_weight("one channel's tail cut off", [](Draw& d) { d.weights.z = std::min(d.weights.z, 0.15); });
    with_weight("luminance for every channel of the weight",
        [](Draw& d) { d.weights = Vec3d{1, 1, 1} * luminance(d.weights); });
    with_f("one channel creates energy", [](Vec3d, Vec3d wi, Vec3d& f) { f.z += wi.z > 0 ? 0.9 / pi : 0; });
    with_f("one channel not reciprocal", [](Vec3d wo, Vec3d, Vec3d& f) { f.z *= 1 - 0.1 * wo.z; });
    SyntheticSampler weighed = recipe_of(layers);
    bend_numbers(weighed, [](PrimarySample& u) { u[2] = u[2] < 0.6 ? u[2] / 1.2 : 0.5 + (u[2] - 0.6) / 0.8; });
    plant(out, "lobe chosen by one weight, weighed by another", name, weighed);
}

void sky_faults(Faults& out) {
    Rng dice(7);
    const std::shared_ptr<const Sky> sky = sky_with_sun(dice, 32, 64, 0.5, false),
                                     alias = sky_with_sun(dice, 32, 64, 0.5, true);
    const char* name = "sky";
    SyntheticSampler flat = recipe_of(sky);
    bend_pdf(flat, [](Vec3d, Vec3d wi, double p) { return p * math::hypot(wi.x, wi.y); });
    plant(out, "environment pdf without sin theta", name, flat);
    SyntheticSampler sphere = recipe_of(sky);
    bend_pdf(sphere, [](Vec3d, Vec3d wi, double p) { return p * pi / 2 * math::hypot(wi.x, wi.y); });
    plant(out, "4 pi for 2 pi^2 sin theta", name, sphere);
    SyntheticSampler centre = recipe_of(sky);
    centre.sample = [sky](Vec3d, const PrimarySample& u) {
        Sky::Spot s = sky->spot(u);
        s.x = s.y = 0.5;
        return sky->at(s);
    };
    plant(out, "texel centre for texel", name, centre);
    SyntheticSampler next = recipe_of(sky);
    next.pdf = [sky](Vec3d, Vec3d wi) {
        const double c = math::cos(2 * pi / sky->columns), s = math::sin(2 * pi / sky->columns);
        return sky->pdf({c * wi.x - s * wi.y, s * wi.x + c * wi.y, wi.z});
    };
    bend_draw(
        next, [pdf = next.pdf](Vec3d wo, const PrimarySample&, Draw& d) { d.pdf = d.pdf > 0 ? pdf(wo, d.wi) : 0; });
    plant(out, "pdf of the next texel", name, next);
    SyntheticSampler own = recipe_of(alias);
    own.sample = [alias](Vec3d, const PrimarySample& u) {
        const double cell = u.x * static_cast<double>(alias->mass.size());
        const int k = std::min(static_cast<int>(cell), static_cast<int>(alias->mass.size()) - 1);
        return alias->at({k / alias->columns, k % alias->columns, cell - k, u.y});
    };
    plant(out, "alias forgotten", name, own);
    SyntheticSampler unstretched = recipe_of(alias);
    unstretched.sample = [alias](Vec3d, const PrimarySample& u) {
        Sky::Spot s = alias->spot(u);
        const double cell = u.x * static_cast<double>(alias->mass.size());
        s.x = cell - std::floor(cell);
        return alias->at(s);
    };
    plant(out, "alias table's number reused without stretching", name, unstretched);
}

void state_faults(Faults& out) {
    SyntheticSampler own = recipe_of(SmoothCoat{});
    const auto count = std::make_shared<std::atomic<std::uint64_t>>(0);
    bend_numbers(own, [count](PrimarySample& u) {
        Rng dice(++*count);
        u[0] = dice.uniform(0, 1);
    });
    plant(out, "draws numbers of its own and does not say so", "coat", own, true);
}

}  // namespace

std::vector<PlantedFault> renderer_faults() {
    Faults out;
    glass_faults(out);
    half_vector_faults(out);
    choosing_faults(out);
    coat_faults(out);
    colour_faults(out);
    sky_faults(out);
    state_faults(out);
    return out;
}

}  // namespace crescent
