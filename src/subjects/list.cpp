// Every built-in arm on the surfaces that it states, or on every lobe; under a fill, disks, a ball or a rectangle; at 8
// w_o, 16 in full mode. --set changes what a surface has.
#include "subjects/list.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/errors.h"
#include "math/functions.h"

namespace crescent::inline subjects {

namespace {

/// A disk at 35 deg off the normal seen obliquely; a larger one that it stands before in part, first in the list so
/// that distance decides and not order; one straight above facing down (its frame's axis is -z); and of every other
/// kind of light its example. Radiances, m.
TrialLight light_named(const std::string& name) {
    const TrialDisk oblique{20, 2.0 * tilt(35, 20), -1.0 * tilt(20, 60), 0.5};
    const TrialDisk behind{12, 3.2 * tilt(48, 35), -1.0 * tilt(60, 40), 0.9};
    const TrialDisk overhead{20, {0.1, -0.05, 2}, {0, 0, -1}, 0.6};
    const auto has = [&](std::string_view word) { return name.find(word) != std::string::npos; };
    TrialLight light;
    light.fill = has("fill") ? 1 : 0;
    if (has("two disks")) light.disks = {behind, oblique};
    else if (has("overhead")) light.disks = {overhead};
    else if (has("disk")) light.disks = {oblique};
    for_each_lamp([&]<class Kind>() {
        if (has(Kind::name)) light.lamps.push_back({10, Kind::example()});
    });
    return light;
}

using Setups = std::vector<TrialSetup>;

/// The surfaces that an arm states; where it states none, every lobe at a middling width, and Lambert.
Setups setups_of(const ArmInfo& arm) {
    Setups all;
    for (const TrialSurface& on : arm.trials)
        all.push_back(trial_setup(lobe_named(on.lobe), on.lambert, std::string(on.light), on.sharpness));
    // What is judged under a disk alone aims at lights, and is judged under every kind too.
    const auto add = [&](std::string_view light) {
        all.push_back(trial_setup(LobeKind::none, true, std::string(light), 32));
    };
    if (std::ranges::any_of(arm.trials, [](const TrialSurface& on) { return on.light == "disk"; })) {
        for_each_lamp([&]<class Kind>() { add(Kind::name); });
        add("disk + rectangle");
    }
    if (!all.empty()) return all;
    all.push_back(trial_setup(LobeKind::none, true, "fill", 32));
    for (const LobeInfo& lobe : lobe_infos())
        all.push_back(trial_setup(lobe.kind, true, "fill", lobe.parameter == LobeParameter::alpha ? 0.3 : 32));
    return all;
}

/// What is known of an arm on such a surface at theta_R = theta.
ExpectedBehaviour theory_of(const ArmInfo& arm, const TrialSetup& on, double theta_deg) {
    const SurfaceSetup& f = on.surface;
    return arm.theory ? arm.theory({f.rho_d, f.rho_s, f.s, f.alpha, on.light.fill, theta_deg}) : ExpectedBehaviour{};
}

/// Sets what this surface and light have; the keys that it read are crossed out of `unread`.
void apply(const Settings& settings, TrialSetup& setup, Settings& unread) {
    const auto set = [&](const char* key, bool has, double& to) {
        const auto at = settings.find(key);
        if (at == settings.end() || !has) return;
        to = at->second;
        unread.erase(key);
    };
    SurfaceSetup& f = setup.surface;
    set("s", setup.tells_s, f.s);
    set("alpha", setup.tells_alpha, f.alpha);
    set("rho_d", f.rho_d > 0, f.rho_d);
    set("rho_s", f.rho_s > 0, f.rho_s);
    if (setup.tells_alpha && f.alpha < lobe_info(f.lobe).judged_from)
        throw InputError({"--set", 0, 0},
            fmt::format(
                "alpha is judged from {:g} on where the lobe is {}: the quadrature of a sharper one is not known",
                lobe_info(f.lobe).judged_from, lobe_info(f.lobe).label));
    if (f.rho_d + f.rho_s > 1)
        throw InputError({"--set", 0, 0},
            fmt::format("rho_d = {:g} and rho_s = {:g} together reflect more than arrives", f.rho_d, f.rho_s));
}

std::shared_ptr<const JudgedSampler> subject_of(const std::string& arm, const TrialSetup& setup, Vec3d wo) {
    std::shared_ptr<const JudgedSampler> out;
    for_each_arm(Arms{}, [&]<template <class> class A>() {
        if (A<float>::name == arm) out = std::make_shared<BuiltIn<A>>(setup.surface, wo, setup.light);
    });
    return out;
}

/// Two setups that --set made alike count once.
bool alike(const TrialSetup& a, const TrialSetup& b) {
    return a.brdf == b.brdf && a.lighting == b.lighting && (!a.tells_s || a.surface.s == b.surface.s) &&
        (!a.tells_alpha || a.surface.alpha == b.surface.alpha);
}

}  // namespace

double brdf_value(const SurfaceSetup& f, Vec3d wo, Vec3d wi) {
    if (wo.z <= 0 || wi.z <= 0) return 0;
    return f.rho_d / pi + f.rho_s * lobe_value(f.lobe, f.s, f.alpha, wo, wi);
}

std::shared_ptr<const JudgedSampler> arm_on(const std::string& name, const Trial& trial) {
    TrialSetup on;
    const auto value = [&](const char* key, double& to) {
        for (const auto& [known, v] : trial.parameters)
            if (known == key) to = v;
    };
    value("s", on.surface.s);
    value("alpha", on.surface.alpha);
    on.surface.rho_d = trial.brdf.empty() || trial.brdf.starts_with("Lambert") ? 0.5 : 0;
    for (const LobeInfo& lobe : lobe_infos())
        if (trial.brdf == lobe.label || trial.brdf == "Lambert + " + std::string(lobe.label))
            on.surface.lobe = lobe.kind;
    on.surface.rho_s = on.surface.lobe == LobeKind::none ? 0 : 0.4;
    on.light = trial.light;
    return subject_of(name, on, trial.wo);
}

std::vector<std::pair<double, double>> wo_grid(bool full) {
    std::vector<std::pair<double, double>> grid = {
        {0, 0}, {1, 200}, {30, 0}, {45, 130}, {60, 250}, {75, 310}, {85, 75}, {89, 180}};
    if (full)
        for (std::pair<double, double> extra : {std::pair{0.1, 10.0}, {5.0, 100.0}, {15.0, 20.0}, {40.0, 90.0},
                 {55.0, 300.0}, {70.0, 45.0}, {80.0, 165.0}, {87.0, 270.0}})
            grid.push_back(extra);
    return grid;
}

TrialSetup trial_setup(LobeKind lobe, bool lambert, const std::string& lighting, double sharpness) {
    TrialSetup out;
    const LobeInfo* info = lobe == LobeKind::none ? nullptr : &lobe_info(lobe);
    out.surface.lobe = lobe;
    out.surface.rho_d = lambert ? 0.5 : 0;
    out.surface.rho_s = lobe == LobeKind::none ? 0 : 0.4;
    out.tells_alpha = info && info->parameter == LobeParameter::alpha;
    out.tells_s = info && info->parameter == LobeParameter::s;
    (out.tells_alpha ? out.surface.alpha : out.surface.s) = sharpness;
    out.brdf = info ? info->label : "";
    if (lambert) out.brdf = out.brdf.empty() ? "Lambert" : "Lambert + " + out.brdf;
    out.lighting = lighting;
    out.light = light_named(lighting);
    return out;
}

Trial trial_on(const TrialSetup& setup, double theta, double azimuth, std::string arm,
    std::shared_ptr<const JudgedSampler> subject) {
    Trial t;
    t.arm = std::move(arm);
    t.brdf = setup.brdf;
    t.lighting = setup.lighting;
    t.wo = tilt(theta, azimuth);
    t.theta_deg = theta;
    t.azimuth_deg = azimuth;
    if (setup.tells_s) t.parameters.emplace_back("s", setup.surface.s);
    if (setup.tells_alpha) t.parameters.emplace_back("alpha", setup.surface.alpha);
    t.light = setup.light;
    t.subject = std::move(subject);
    return t;
}

std::vector<Trial> trials_of(const std::string& arm, const Settings& settings, bool full, const Grid& own) {
    std::vector<Trial> trials;
    const std::vector<std::string> names = sampler_names();
    if (!arm.empty() && std::find(names.begin(), names.end(), arm) == names.end()) {
        const std::string near = nearest(arm, names);
        throw InputError({"crescent check", 0, 0},
            "no sampler '" + arm + "'" +
                (near.empty() ? fmt::format("; the list has {}", fmt::join(names, ", "))
                              : "; did you mean '" + near + "'?"));
    }
    Settings unread = settings;
    for (const std::string& name : names) {
        if (!arm.empty() && name != arm) continue;
        Setups setups;
        for (TrialSetup s : setups_of(*find_arm_info(name))) {
            apply(settings, s, unread);
            bool seen = false;
            for (const TrialSetup& other : setups) seen = seen || alike(s, other);
            if (!seen) setups.push_back(s);
        }
        for (const TrialSetup& s : setups)
            for (const auto& [theta, azimuth] : own.empty() ? wo_grid(full) : own) {
                Trial t = trial_on(s, theta, azimuth, name, subject_of(name, s, tilt(theta, azimuth)));
                t.theory = theory_of(*find_arm_info(name), s, theta);
                trials.push_back(std::move(t));
            }
    }
    if (!unread.empty())
        throw InputError({"--set " + unread.begin()->first, 0, 0}, "no surface that '" + arm + "' is judged on has it");
    return trials;
}

}  // namespace crescent::inline subjects
