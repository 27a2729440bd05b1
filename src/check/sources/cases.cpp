// Every built-in arm on its declared surfaces, or on every lobe; under a fill, disks, a ball or a rectangle; at 8 w_o,
// or 16 in full mode. --set changes a surface.
#include "check/sources/cases.h"
#include "check/sources/decorators.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/errors.h"
#include "check/sources/reciprocal_weights.h"
#include "check/sources/check_case.h"
#include "math/functions.h"

namespace crescent {

namespace {

/// A sky of 16 x 8 texels, brighter towards the horizon, with one bright texel at 56 deg from up; and five triangles,
/// of which the nearest hides a part of the others.
std::shared_ptr<const Surroundings> surroundings_named(bool has_sky, bool has_triangles) {
    auto out = std::make_shared<Surroundings>();
    if (has_sky) {
        auto image = std::make_shared<RgbImage>();
        image->width = 16;
        image->height = 8;
        for (int row = 0; row < 8; ++row)
            for (int column = 0; column < 16; ++column) {
                const float grey = row == 2 && column == 5 ? 40.0f : 0.5f + 0.1f * static_cast<float>(row + column % 3);
                image->rgb.insert(image->rgb.end(), {grey, grey, grey});
            }
        SkyLight light;
        light.rotation = 20;
        light.image = std::move(image);
        out->sky.emplace(light);
    }
    if (has_triangles) {
        const std::array<Vec3d, 7> p = {{{0.5, 0.1, 1.1}, {1.5, 0.3, 1.0}, {0.8, 1.1, 1.3}, {1.6, 1.3, 1.2},
            {-1.2, 0.4, 0.9}, {-0.4, -0.9, 1.6}, {0.9, 0.5, 0.7}}};
        const std::array<std::array<std::size_t, 3>, 5> corners = {
            {{0, 1, 2}, {1, 3, 2}, {4, 5, 0}, {4, 2, 5}, {0, 6, 2}}};
        std::vector<EmittingTriangle> emitting;
        for (std::uint32_t k = 0; k < corners.size(); ++k) {
            EmittingTriangle& t = emitting.emplace_back();
            for (std::size_t c = 0; c < 3; ++c) t.corner[c] = p[corners[k][c]];
            const Vec3d normal = cross(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0]);
            if (dot(normal, t.corner[0]) > 0) std::swap(t.corner[1], t.corner[2]);  // its front faces the point
            const double radiance = 5.0 + 4.0 * k;
            t.radiance = {radiance, radiance, radiance};
            t.triangle = k;
        }
        out->triangles.emplace(std::move(emitting));
    }
    return out;
}

/// A disk at 35 deg from the normal at an oblique angle; a larger one partly behind it and first in the list, so that
/// distance decides and not order; one directly above that faces down (the axis of its frame is -z); and the example of
/// every other kind of light. Radiances, m.
CaseLighting light_named(const std::string& name) {
    const CaseDiskLight oblique_disk{
        .radiance = 20, .center = 2.0 * tilt(35, 20), .normal = -1.0 * tilt(20, 60), .radius = 0.5};
    const CaseDiskLight far_disk{
        .radiance = 12, .center = 3.2 * tilt(48, 35), .normal = -1.0 * tilt(60, 40), .radius = 0.9};
    const CaseDiskLight overhead_disk{.radiance = 20, .center = {0.1, -0.05, 2}, .normal = {0, 0, -1}, .radius = 0.6};
    const auto has = [&](std::string_view word) { return name.find(word) != std::string::npos; };
    CaseLighting light;
    light.fill = has("fill") ? 1 : 0;
    if (has("two disks")) light.disks = {far_disk, oblique_disk};
    else if (has("overhead")) light.disks = {overhead_disk};
    else if (has("disk")) light.disks = {oblique_disk};
    for_each_area_light([&]<class Kind>() {
        if (has(Kind::name)) light.area_lights.push_back({10, Kind::example()});
    });
    if (has("sky") || has("triangles")) light.around = surroundings_named(has("sky"), has("triangles"));
    if (light.around) light.frame = {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}};  // y is up
    if (has("triangles")) light.frame = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    return light;
}

using Setups = std::vector<CaseSetup>;

/// The surfaces that an arm declares; without any, every lobe at a medium width, and Lambert.
Setups setups_of(const SamplerInfo& arm) {
    Setups setups;
    for (const CaseSurface& surface : arm.check_cases)
        setups.push_back(
            case_setup(lobe_named(surface.lobe), surface.lambert, std::string(surface.light), surface.sharpness));
    // An arm that is checked only under a disk samples lights, so it is also checked under every other kind.
    const auto add = [&](std::string_view light) {
        setups.push_back(case_setup(LobeKind::none, true, std::string(light), 32));
    };
    if (std::ranges::any_of(arm.check_cases, [](const CaseSurface& surface) { return surface.light == "disk"; })) {
        for_each_area_light([&]<class Kind>() { add(Kind::name); });
        add("disk + rectangle");
    }
    if (!setups.empty()) return setups;
    setups.push_back(case_setup(LobeKind::none, true, "fill", 32));
    for (const LobeInfo& lobe : lobe_infos())
        setups.push_back(case_setup(lobe.kind, true, "fill", lobe.parameter == LobeParameter::alpha ? 0.3 : 32));
    return setups;
}

/// The expected behaviour of an arm on a surface at theta_R = theta.
ExpectedBehaviour theory_of(const SamplerInfo& arm, const CaseSetup& setup, double theta_deg) {
    const SurfaceSetup& f = setup.surface;
    return arm.theory ? arm.theory({.rho_d = f.rho_d,
                            .rho_s = f.rho_s,
                            .s = f.s,
                            .alpha = f.alpha,
                            .fill = setup.light.fill,
                            .theta_deg = theta_deg})
                      : ExpectedBehaviour{};
}

/// Sets the parameters of this surface and light; removes the keys that it uses from `unused`.
void apply(const Settings& settings, CaseSetup& setup, Settings& unused) {
    const auto set = [&](const char* key, bool applies, double& to) {
        const auto setting = settings.find(key);
        if (setting == settings.end() || !applies) return;
        to = setting->second;
        unused.erase(key);
    };
    SurfaceSetup& f = setup.surface;
    set("s", setup.has_s, f.s);
    set("alpha", setup.has_alpha, f.alpha);
    set("rho_d", f.rho_d > 0, f.rho_d);
    set("rho_s", f.rho_s > 0, f.rho_s);
    if (setup.has_alpha && f.alpha < lobe_info(f.lobe).checked_from)
        throw InputError({"--set", 0, 0},
            fmt::format("alpha must be at least {:g} for the lobe {}: the quadrature of a sharper lobe is not known",
                lobe_info(f.lobe).checked_from, lobe_info(f.lobe).label));
    if (f.rho_d + f.rho_s > 1)
        throw InputError({"--set", 0, 0},
            fmt::format("rho_d = {:g} and rho_s = {:g} together reflect more than arrives", f.rho_d, f.rho_s));
}

std::shared_ptr<const SamplerAdapter> make_adapter(const std::string& arm, const CaseSetup& setup, Vec3d wo) {
    std::shared_ptr<const SamplerAdapter> out;
    for_each_sampler(Samplers{}, [&]<template <class> class A>() {
        if (A<float>::name == arm) out = std::make_shared<BuiltIn<A>>(setup.surface, wo, setup.light);
    });
    return out;
}

/// Whether two setups are equal after --set.
bool alike(const CaseSetup& a, const CaseSetup& b) {
    return a.brdf == b.brdf && a.lighting == b.lighting && (!a.has_s || a.surface.s == b.surface.s) &&
        (!a.has_alpha || a.surface.alpha == b.surface.alpha);
}

}  // namespace

double brdf_value(const SurfaceSetup& f, Vec3d wo, Vec3d wi) {
    if (wo.z <= 0 || wi.z <= 0) return 0;
    return f.rho_d / pi + f.rho_s * lobe_value(f.lobe, f.s, f.alpha, wo, wi);
}

std::shared_ptr<const SamplerAdapter> sampler_on(const std::string& name, const CheckCase& check_case) {
    CaseSetup setup;
    setup.surface = check_case.surface;
    setup.light = check_case.light;
    return make_adapter(name, setup, check_case.wo);
}

std::vector<std::pair<double, double>> wo_grid(bool is_full) {
    std::vector<std::pair<double, double>> grid = {
        {0, 0}, {1, 200}, {30, 0}, {45, 130}, {60, 250}, {75, 310}, {85, 75}, {89, 180}};
    if (is_full)
        for (std::pair<double, double> direction : {std::pair{0.1, 10.0}, {5.0, 100.0}, {15.0, 20.0}, {40.0, 90.0},
                 {55.0, 300.0}, {70.0, 45.0}, {80.0, 165.0}, {87.0, 270.0}})
            grid.push_back(direction);
    return grid;
}

CaseSetup case_setup(LobeKind lobe, bool has_lambert, const std::string& lighting, double sharpness) {
    CaseSetup out;
    const LobeInfo* info = lobe == LobeKind::none ? nullptr : &lobe_info(lobe);
    out.surface.lobe = lobe;
    out.surface.rho_d = has_lambert ? 0.5 : 0;
    out.surface.rho_s = lobe == LobeKind::none ? 0 : 0.4;
    out.has_alpha = info && info->parameter == LobeParameter::alpha;
    out.has_s = info && info->parameter == LobeParameter::s;
    (out.has_alpha ? out.surface.alpha : out.surface.s) = sharpness;
    out.brdf = info ? info->label : "";
    if (has_lambert) out.brdf = out.brdf.empty() ? "Lambert" : "Lambert + " + out.brdf;
    out.lighting = lighting;
    out.light = light_named(lighting);
    return out;
}

CheckCase make_case_on(const CaseSetup& setup, double theta, double azimuth, std::string arm,
    std::shared_ptr<const SamplerAdapter> adapter) {
    CheckCase t;
    t.arm = std::move(arm);
    t.brdf = setup.brdf;
    t.lighting = setup.lighting;
    t.wo = tilt(theta, azimuth);
    t.theta_deg = theta;
    t.azimuth_deg = azimuth;
    if (setup.has_s) t.parameters.emplace_back("s", setup.surface.s);
    if (setup.has_alpha) t.parameters.emplace_back("alpha", setup.surface.alpha);
    t.surface = setup.surface;
    t.light = setup.light;
    t.adapter = std::move(adapter);
    return t;
}

std::vector<CheckCase> make_cases(
    const std::string& arm, const Settings& settings, bool is_full, const Grid& given_grid) {
    std::vector<CheckCase> check_cases;
    const std::vector<std::string> names = sampler_names();
    if (!arm.empty() && std::find(names.begin(), names.end(), arm) == names.end()) {
        const std::string suggestion = nearest(arm, names);
        throw InputError({"crescent check", 0, 0},
            "no sampler '" + arm + "'" +
                (suggestion.empty() ? fmt::format("; the list has {}", fmt::join(names, ", "))
                                    : "; did you mean '" + suggestion + "'?"));
    }
    Settings unused = settings;
    for (const std::string& name : names) {
        if (!arm.empty() && name != arm) continue;
        Setups setups;
        for (CaseSetup s : setups_of(*find_arm_info(name))) {
            apply(settings, s, unused);
            bool is_listed = false;
            for (const CaseSetup& other : setups) is_listed = is_listed || alike(s, other);
            if (!is_listed) setups.push_back(s);
        }
        for (const CaseSetup& s : setups)
            for (const auto& [theta, azimuth] : given_grid.empty() ? wo_grid(is_full) : given_grid) {
                CheckCase t = make_case_on(s, theta, azimuth, name, make_adapter(name, s, tilt(theta, azimuth)));
                t.theory = theory_of(*find_arm_info(name), s, theta);
                check_cases.push_back(std::move(t));
            }
    }
    if (!unused.empty())
        throw InputError({"--set " + unused.begin()->first, 0, 0}, "no surface of the checks of '" + arm + "' has it");
    return check_cases;
}

// ---- Cases of a user's sampler, with built-in arms that sample the same BRDF.

namespace {

/// A built-in arm with a user's f.
std::shared_ptr<const SamplerAdapter> with_f_of(
    std::shared_ptr<const SamplerAdapter> arm, const std::shared_ptr<const SamplerAdapter>& owner) {
    using Kind = SamplerQuery::Kind;
    const auto evaluate = [owner](const SamplerAdapter& inner, SamplerQuery query, const SamplerAnswers& out) {
        if (query.kind == Kind::f_channels) {
            std::vector<double> values(out.channels.size());
            owner->f(query.pairs, values);
            for (std::size_t i = 0; i < values.size(); ++i) out.channels[i] = {values[i], values[i], values[i]};
            return;
        }
        const bool is_f = query.kind == Kind::f || query.kind == Kind::target || query.kind == Kind::reference_f;
        if (is_f) owner->f(query.pairs, out.values);
        else inner.evaluate(query, out);
    };
    const auto declare = [owner](SamplerDeclaration& declaration) {
        const SamplerDeclaration owner_declaration = owner->declaration();
        declaration.has_f = declaration.has_drawn_f = owner_declaration.has_f;
        declaration.serial = owner_declaration.serial;
        declaration.limited = owner_declaration.limited;
    };
    return std::make_shared<DecoratedSampler>(std::move(arm), evaluate, declare);
}

}  // namespace

CheckCase make_user_case(const std::shared_ptr<const SamplerAdapter>& adapter, double theta, double azimuth) {
    CheckCase t;
    t.arm = adapter->name();
    t.wo = tilt(theta, azimuth);
    t.theta_deg = theta;
    t.azimuth_deg = azimuth;
    t.adapter = adapter;
    return t;
}

namespace {

/// The grid of w_o of a sampler: one w_o if it does not depend on w_o, and w_o below the surface too if it accepts both
/// sides.
Grid grid_for(const Traits& traits, bool is_full) {
    if (traits.wo == Traits::WoDomain::none) return {{0, 0}};
    Grid grid = wo_grid(is_full);
    if (traits.wo != Traits::WoDomain::both) return grid;
    for (const auto& [theta, azimuth] : wo_grid(is_full))
        if (is_full || theta == 0 || theta == 30 || theta == 60 || theta == 85) grid.emplace_back(180 - theta, azimuth);
    return grid;
}

}  // namespace

std::vector<CheckCase> make_user_cases(
    const std::shared_ptr<const SamplerAdapter>& sampler, bool is_full, const Grid& given_grid) {
    std::vector<CheckCase> check_cases;
    const std::shared_ptr<const SamplerAdapter> adapter =
        sampler->traits().reciprocal_weight ? with_bounded_weights(sampler) : sampler;
    const Traits traits = adapter->traits();
    const Grid grid = given_grid.empty() ? grid_for(traits, is_full) : given_grid;
    for (const auto& [theta, azimuth] : grid) {
        check_cases.push_back(make_user_case(adapter, theta, azimuth));
        const bool can_be_ranked =
            adapter->has_f() && traits.has_pdf && !traits.delta && theta < 90 && traits.has_surface();
        if (!can_be_ranked) continue;  // cosine and uniform sample neither delta parts nor the other side
        const Vec3d wo = tilt(theta, azimuth);
        for (const char* peer : {"uniform", "cosine"}) {
            check_cases.push_back(make_user_case(with_f_of(make_adapter(peer, {}, wo), adapter), theta, azimuth));
            check_cases.back().baseline = true;
        }
    }
    return check_cases;
}

namespace {

std::string domain_name(const SamplerAdapter& sampler) {
    const Traits traits = sampler.traits();
    return traits.number ? "numbers" : traits.domain ? "points of " + traits.domain->domain().name() : "directions";
}

}  // namespace

std::vector<CheckCase> sampler_named_against(const std::string& name, std::span<const CheckCase> a) {
    std::vector<CheckCase> out;
    for (const CheckCase& t : a) {
        if (domain_name(*t.adapter) != "directions")
            throw InputError({"--against " + name, 0, 0},
                fmt::format("draws directions, and {} {}", t.adapter->name(), domain_name(*t.adapter)));
        CheckCase b = t;
        b.arm = name;
        b.theory = {};
        b.adapter = with_f_of(sampler_on(name, t), named_side(t.adapter, "A"));  // f is A's
        out.push_back(std::move(b));
    }
    return out;
}

namespace {

/// A sampler over a domain with an infinite line, on the chart of another sampler: directions of both are then those of
/// the same points.
std::shared_ptr<const SamplerAdapter> on_chart(
    std::shared_ptr<const SamplerAdapter> sampler, const std::shared_ptr<const DomainChart>& chart) {
    const Traits traits = sampler->traits();
    const auto evaluate = [own_chart = traits.domain, chart, has_pdf = traits.has_pdf](
                              const SamplerAdapter& inner, SamplerQuery query, const SamplerAnswers& out) {
        std::vector<Pair> own_pairs(query.pairs.begin(), query.pairs.end());
        for (Pair& p : own_pairs) p.wi = chart->in_chart(*own_chart, p.wi);
        const std::span<const Pair> pairs = query.pairs;
        query.pairs = own_pairs;
        inner.evaluate(query, out);
        for (Draw& d : out.draws) {
            if (!(d.pdf > 0) || !std::isfinite(dot(d.wi, d.wi))) continue;
            const Vec3d wi = own_chart->in_chart(*chart, d.wi);
            if (has_pdf) d.pdf = own_chart->density(d.wi, d.pdf) / chart->density(wi, 1);
            d.wi = wi;
        }
        if (query.kind == SamplerQuery::Kind::mis_weight) return;
        // From a density on the sampler's own chart to one on the common chart.
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            const double factor = own_chart->density(own_pairs[i].wi, 1) / chart->density(pairs[i].wi, 1);
            if (!out.values.empty()) out.values[i] *= factor;
            if (!out.channels.empty()) out.channels[i] = out.channels[i] * factor;
        }
    };
    return std::make_shared<DecoratedSampler>(
        std::move(sampler), evaluate, [chart](SamplerDeclaration& d) { d.traits.domain = chart; });
}

/// B over the domain of A. Throws InputError if it has another one.
std::shared_ptr<const SamplerAdapter> over_the_domain_of(
    const SamplerAdapter& a, const std::shared_ptr<const SamplerAdapter>& b) {
    if (domain_name(a) != domain_name(*b))
        throw InputError({"--against", 0, 0},
            fmt::format("{} draws {}, and {} {}", a.name(), domain_name(a), b->name(), domain_name(*b)));
    if (a.traits().reciprocal_weight || b->traits().reciprocal_weight)
        throw InputError({"--against", 0, 0}, "is not for samplers with weight=reciprocal, which have no density");
    const std::shared_ptr<const DomainChart> chart = a.traits().domain;
    const bool is_infinite = chart && chart->domain().is_infinite();
    return is_infinite ? on_chart(b, chart) : b;
}

}  // namespace

std::vector<CheckCase> sampler_against(
    const std::shared_ptr<const SamplerAdapter>& sampler, std::span<const CheckCase> a) {
    std::vector<CheckCase> out;
    const std::shared_ptr<const SamplerAdapter> adapter =
        a.empty() || !a.front().adapter ? sampler : over_the_domain_of(*a.front().adapter, sampler);
    for (const CheckCase& t : a) {
        out.push_back(t);
        out.back().arm = adapter->name();
        out.back().adapter = adapter;
        out.back().theory = {};
    }
    return out;
}

}  // namespace crescent
