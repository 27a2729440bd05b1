#include "verdicts/list.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/errors.h"
#include "math/functions.h"

namespace crescent {

namespace {

/// A disk at 35 deg off the normal seen obliquely; a larger one that it stands before in part, first in the list so
/// that distance decides and not order; one straight above facing down (its frame's axis is -z). Radiances, m.
TrialLight light_named(const std::string& name) {
    const TrialDisk oblique{20, 2.0 * tilt(35, 20), -1.0 * tilt(20, 60), 0.5};
    const TrialDisk behind{12, 3.2 * tilt(48, 35), -1.0 * tilt(60, 40), 0.9};
    const TrialDisk overhead{20, {0.1, -0.05, 2}, {0, 0, -1}, 0.6};
    const auto has = [&](const char* word) { return name.find(word) != std::string::npos; };
    TrialLight light;
    light.fill = has("fill") ? 1 : 0;
    if (has("two disks")) light.disks = {behind, oblique};
    else if (has("overhead")) light.disks = {overhead};
    else if (has("disk")) light.disks = {oblique};
    return light;
}

using Stages = std::vector<Stage>;

void add_lobe(Stages& to, LobeKind lobe, std::initializer_list<double> sharpness, bool lambert = false,
    const std::string& light = "fill") {
    for (double v : sharpness) to.push_back(stage(lobe, lambert, light, v));
}

/// Each arm on the surfaces it is made for, and on those where the note uses it.
Stages stages_of(const std::string& arm) {
    Stages all;
    const auto lambert = [&](const std::string& light) { all.push_back(stage(LobeKind::none, true, light, 32)); };
    if (arm == "uniform" || arm == "cosine") {
        lambert("fill");
        add_lobe(all, LobeKind::phong, {32}, true);
        add_lobe(all, LobeKind::ggx, {0.5}, true);
        lambert("fill + disk");
    } else if (arm == "phong") {
        add_lobe(all, LobeKind::phong, {8, 32, 128, 1e4, 1e5});
        add_lobe(all, LobeKind::phong, {32}, true);
        lambert("fill");
    } else if (arm == "mixture" || arm == "mis-balance" || arm == "mis-power") {
        add_lobe(all, LobeKind::phong, {32}, true);
        add_lobe(all, LobeKind::phong, {32}, true, "fill + disk");
        add_lobe(all, LobeKind::phong, {1000}, true);
        if (arm != "mixture") add_lobe(all, LobeKind::phong, {32}, true, "fill + two disks");
    } else if (arm == "light-solid-angle" || arm == "light-area") {
        lambert("disk");
        lambert("overhead disk");
        lambert("two disks");
        add_lobe(all, LobeKind::phong, {8}, true, "disk");
        lambert("fill + disk");
    } else if (arm == "blinn") {
        add_lobe(all, LobeKind::blinn_phong, {8, 32, 128, 1e4, 1e5});
        add_lobe(all, LobeKind::blinn_phong, {32}, true);
    } else {
        add_lobe(all, LobeKind::ggx, {0.5, 0.1, 0.01, 0.001});
        add_lobe(all, LobeKind::ggx, {0.3}, true);
    }
    return all;
}

/// A power of n.h or w.R that is less than the smallest double, 2^-1074, somewhere above the surface, where Lambert is
/// not 0. n.h is least for wi in the surface on w_o's side: the cosine of (theta + 90 deg) / 2.
bool power_underflows(const std::string& arm, const SurfaceSetup& f, double theta_deg) {
    if (f.rho_d <= 0) return false;
    const double least =
        arm == "blinn" ? math::cos((theta_deg + 90) * pi / 360) : 1e-3;  // w.R: 1e-6 of Lambert's light lies below
    return (arm == "blinn" || arm == "phong") && f.s * math::log(least) < -1074 * math::log(2.0) + math::log(f.s + 1);
}

/// What is known of an arm on a stage at theta_R = theta.
Theory theory_of(const std::string& arm, const Stage& stage, double theta_deg) {
    Theory t;
    const SurfaceSetup& f = stage.surface;
    const double tilted = theta_deg * pi / 180;
    if (power_underflows(arm, f, theta_deg))
        t.underflows =
            "the lobe's power is less than the smallest number there is where Lambert is not 0: p is 0 in the arm's "
            "own arithmetic";
    if (arm == "phong" && f.rho_d > 0) {
        t.lost = (1 - math::cos(tilted)) / 2;
        t.lost_of = f.rho_d;
        t.tail_k = theta_deg == 0 ? (f.s - 1) / (f.s + 1) : f.s / (f.s + 1);
        if (theta_deg > 0) t.wrong = "support";
        t.why = theta_deg > 0
            ? "the lobe about R does not reach all of n's hemisphere, and Lambert does: the note's second error"
            : "p falls off as (w.R)^s while Lambert only falls off as cos: the weight is Pareto, k = (s-1)/(s+1)";
        return t;
    }
    if ((arm == "light-area" || arm == "light-solid-angle") && stage.light.fill > 0) {
        t.wrong = "support";
        t.why = "an arm that aims at the disk alone cannot find the fill";
        return t;
    }
    t.bounded = arm == "uniform" || arm == "cosine" || arm == "mixture" || arm == "mis-balance" || arm == "mis-power" ||
        arm == "ggx-vndf" || (arm == "phong" && f.rho_d == 0) || (arm == "blinn" && f.rho_d == 0) ||
        (arm == "ggx-d" && f.rho_d == 0);
    return t;
}

/// Sets what this stage has; the keys that it read are crossed out of `unread`.
void apply(const Settings& settings, Stage& stage, Settings& unread) {
    const auto set = [&](const char* key, bool has, double& to) {
        const auto at = settings.find(key);
        if (at == settings.end() || !has) return;
        to = at->second;
        unread.erase(key);
    };
    SurfaceSetup& f = stage.surface;
    set("s", stage.tells_s, f.s);
    set("alpha", stage.tells_alpha, f.alpha);
    set("rho_d", f.rho_d > 0, f.rho_d);
    set("rho_s", f.rho_s > 0, f.rho_s);
    if (f.rho_d + f.rho_s > 1)
        throw InputError({"--set", 0, 0},
            fmt::format("rho_d = {:g} and rho_s = {:g} together reflect more than arrives", f.rho_d, f.rho_s));
}

std::shared_ptr<const JudgedSampler> subject_of(const std::string& arm, const Stage& stage, Vec3d wo) {
    std::shared_ptr<const JudgedSampler> out;
    for_each_arm(Arms{}, [&]<template <class> class A>() {
        if (A<float>::name == arm) out = std::make_shared<BuiltIn<A>>(stage.surface, wo, stage.light);
    });
    return out;
}

/// Two stages that --set made alike count once.
bool alike(const Stage& a, const Stage& b) {
    return a.brdf == b.brdf && a.lighting == b.lighting && (!a.tells_s || a.surface.s == b.surface.s) &&
        (!a.tells_alpha || a.surface.alpha == b.surface.alpha);
}

}  // namespace

double brdf_value(const SurfaceSetup& f, Vec3d wo, Vec3d wi) {
    if (wo.z <= 0 || wi.z <= 0) return 0;
    double lobe = 0;
    switch (f.lobe) {
        case LobeKind::none: break;
        case LobeKind::phong: lobe = PhongLobe<double>(f.s, f.alpha)(wo, wi); break;
        case LobeKind::blinn_phong: lobe = BlinnPhongLobe<double>(f.s, f.alpha)(wo, wi); break;
        case LobeKind::ggx: lobe = GgxLobe<double>(f.s, f.alpha)(wo, wi); break;
    }
    return f.rho_d / pi + f.rho_s * lobe;
}

std::vector<std::string> arm_names() {
    std::vector<std::string> names;
    for_each_arm(Arms{}, [&]<template <class> class A>() { names.emplace_back(A<float>::name); });
    return names;
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

Stage stage(LobeKind lobe, bool lambert, const std::string& lighting, double sharpness) {
    Stage out;
    const std::string names[] = {"", "Phong", "Blinn-Phong", "GGX"};
    out.surface.lobe = lobe;
    out.surface.rho_d = lambert ? 0.5 : 0;
    out.surface.rho_s = lobe == LobeKind::none ? 0 : 0.4;
    out.tells_alpha = lobe == LobeKind::ggx;
    out.tells_s = lobe == LobeKind::phong || lobe == LobeKind::blinn_phong;
    (out.tells_alpha ? out.surface.alpha : out.surface.s) = sharpness;
    out.brdf = names[static_cast<int>(lobe)];
    if (lambert) out.brdf = out.brdf.empty() ? "Lambert" : "Lambert + " + out.brdf;
    out.lighting = lighting;
    out.light = light_named(lighting);
    return out;
}

Trial trial_on(
    const Stage& stage, double theta, double azimuth, std::string arm, std::shared_ptr<const JudgedSampler> subject) {
    Trial t;
    t.arm = std::move(arm);
    t.brdf = stage.brdf;
    t.lighting = stage.lighting;
    t.wo = tilt(theta, azimuth);
    t.theta_deg = theta;
    t.azimuth_deg = azimuth;
    if (stage.tells_s) t.parameters.emplace_back("s", stage.surface.s);
    if (stage.tells_alpha) t.parameters.emplace_back("alpha", stage.surface.alpha);
    t.light = stage.light;
    t.subject = std::move(subject);
    return t;
}

namespace {

/// A built-in arm aimed at a user's BRDF.
template <template <class> class A> class Borrowed : public BuiltIn<A> {
public:
    Borrowed(std::shared_ptr<const JudgedSampler> owner, Vec3d wo) : BuiltIn<A>({}, wo, {}), owner_(std::move(owner)) {}
    void f(std::span<const Pair> at, std::span<double> out) const override { owner_->f(at, out); }
    bool serial() const override { return owner_->serial(); }

private:
    std::shared_ptr<const JudgedSampler> owner_;
};

}  // namespace

Trial trial_of_subject(const std::shared_ptr<const JudgedSampler>& subject, double theta, double azimuth) {
    Trial t;
    t.arm = subject->name();
    t.wo = tilt(theta, azimuth);
    t.theta_deg = theta;
    t.azimuth_deg = azimuth;
    t.subject = subject;
    return t;
}

std::vector<Trial> trials_of_subject(const std::shared_ptr<const JudgedSampler>& subject, bool full) {
    std::vector<Trial> trials;
    for (const auto& [theta, azimuth] : wo_grid(full)) {
        trials.push_back(trial_of_subject(subject, theta, azimuth));
        if (!subject->has_f()) continue;
        const Vec3d wo = tilt(theta, azimuth);
        for (const std::shared_ptr<const JudgedSampler>& peer :
            {std::shared_ptr<const JudgedSampler>(std::make_shared<Borrowed<Uniform>>(subject, wo)),
                std::shared_ptr<const JudgedSampler>(std::make_shared<Borrowed<Cosine>>(subject, wo))}) {
            trials.push_back(trial_of_subject(peer, theta, azimuth));
            trials.back().yardstick = true;
        }
    }
    return trials;
}

std::vector<Trial> trials_of(const std::string& arm, const Settings& settings, bool full) {
    std::vector<Trial> trials;
    const std::vector<std::string> names = arm_names();
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
        Stages stages;
        for (Stage s : stages_of(name)) {
            apply(settings, s, unread);
            bool seen = false;
            for (const Stage& other : stages) seen = seen || alike(s, other);
            if (!seen) stages.push_back(s);
        }
        for (const Stage& s : stages)
            for (const auto& [theta, azimuth] : wo_grid(full)) {
                Trial t = trial_on(s, theta, azimuth, name, subject_of(name, s, tilt(theta, azimuth)));
                t.theory = theory_of(name, s, theta);
                trials.push_back(std::move(t));
            }
    }
    if (!unread.empty())
        throw InputError({"--set " + unread.begin()->first, 0, 0}, "no surface that '" + arm + "' is judged on has it");
    return trials;
}

}  // namespace crescent
