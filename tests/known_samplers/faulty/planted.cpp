// One row per fault: its sampler, the lobe and light of its case, and the FaultInjection (wrap.h) of u, draw, pdf, f or
// MIS weight. Each is tested at the w_o of the grid that are 0, 45 and 75 degrees from n. Densities in 1/sr.
#include "tests/known_samplers/faulty/planted.h"

#include <algorithm>
#include <cmath>

#include "check/sources/cases.h"
#include "math/functions.h"
#include "tests/known_samplers/faulty/wrap.h"

namespace crescent {

namespace {

/// A fault of `arm`: its case, and the change there.
struct Plan {
    std::string name, arm;
    LobeKind lobe;
    bool lambert;
    std::string light;
    double sharpness;
    std::function<FaultInjection(const SurfaceSetup&)> bend;
};

double power_cos(Vec3d a, Vec3d b, double s) { return math::pow(std::max(dot(a, b), 0.0), s); }
Vec3d about_normal(double cos, double turns) { return math::spherical(cos, 2 * pi * turns); }
Vec3d about(Vec3d axis, double cos, double turns) { return frame_about(axis).to_world(about_normal(cos, turns)); }
/// Returns whether w is in a tenth of the sphere about a direction that is not an axis.
bool in_patch(Vec3d w) { return dot(w, tilt(40, 70)) > 0.8; }
double rounded(double v) { return static_cast<double>(static_cast<float>(v)); }

FaultInjection with_u(std::function<Vec2d(Vec2d)> u) { return {.u = std::move(u)}; }
FaultInjection with_pdf(std::function<double(const Pair&, double)> pdf) { return {.pdf = std::move(pdf)}; }
FaultInjection with_draw(std::function<void(Vec3d, Vec2d, Draw&)> draw) { return {.draw = std::move(draw)}; }
FaultInjection with_f(std::function<double(const Pair&, double)> f) { return {.f = std::move(f)}; }
FaultInjection with_mis(std::function<double(int, const Pair&, double)> mis) { return {.mis = std::move(mis)}; }
FaultInjection scaled_pdf(double by) {
    return with_pdf([by](const Pair&, double p) { return by * p; });
}
using S = const SurfaceSetup&;

/// Faults of the pdf of Phong's and the cosine lobe.
void lobe_density_faults(std::vector<Plan>& out) {
    const auto phong = lobe_named("phong");
    out.push_back({"s+2 for s+1 in the pdf", "phong", phong, false, "fill", 32,
        [](S f) { return scaled_pdf((f.s + 2) / (f.s + 1)); }});
    out.push_back({"exponent s+1 for s in the pdf", "phong", phong, false, "fill", 32, [](S f) {
                       return with_pdf([s = f.s](const Pair& a, double) {
                           return (s + 2) / (2 * pi) * power_cos(a.wi, mirror(a.wo), s + 1);
                       });
                   }});
    out.push_back({"1/(s+2) for 1/(s+1) in the warp", "phong", phong, false, "fill", 32, [](S f) {
                       return with_draw([s = f.s](Vec3d wo, Vec2d u, Draw& d) {
                           d.wi = about(mirror(wo), math::pow(u.x, 1 / (s + 2)), u.y);
                           d.pdf = (s + 1) / (2 * pi) * power_cos(d.wi, mirror(wo), s);
                       });
                   }});
    out.push_back({"pdf renormalised over the horizon", "phong", phong, false, "fill", 8, [](S) {
                       return with_pdf(
                           [](const Pair& a, double p) { return a.wi.z > 0 ? p / (0.5 + 0.5 * a.wo.z) : 0.0; });
                   }});
    out.push_back({"horizon samples dropped from N", "phong", phong, false, "fill", 8, [](S f) {
                       return with_draw([s = f.s](Vec3d wo, Vec2d u, Draw& d) {
                           for (int k = 0; k < 64 && d.wi.z <= 0; ++k) {  // repeated until it is above
                               u = {std::fmod(u.x * 97.13 + 0.31, 1.0), std::fmod(u.y * 89.7 + 0.73, 1.0)};
                               d.wi = about(mirror(wo), math::pow(u.x, 1 / (s + 1)), u.y);
                           }
                           d.pdf = (s + 1) / (2 * pi) * power_cos(d.wi, mirror(wo), s);
                       });
                   }});
    out.push_back({"cosine folded in twice", "cosine", phong, true, "fill", 32,
        [](S) { return with_pdf([](const Pair& a, double p) { return p * std::max(a.wi.z, 0.0); }); }});
    out.push_back({"cosine left out of the pdf", "cosine", phong, true, "fill", 32,
        [](S) { return with_pdf([](const Pair& a, double) { return a.wi.z > 0 ? 1 / pi : 0.0; }); }});
}

/// Faults of densities made from those of half vectors.
void halfway_density_faults(std::vector<Plan>& out) {
    out.push_back({"missing 4(w.h)", "blinn", lobe_named("blinn-phong"), false, "fill", 32, [](S) {
                       return with_pdf([](const Pair& a, double p) {
                           return p * 4 * std::max(dot(a.wo, normalize(a.wo + a.wi)), 0.0);
                       });
                   }});
    out.push_back({"n.h for w.h in the Jacobian", "ggx-d", lobe_named("ggx"), false, "fill", 0.3, [](S) {
                       return with_pdf([](const Pair& a, double p) {
                           const Vec3d h = normalize(a.wo + a.wi);
                           return p * std::max(dot(a.wo, h), 0.0) / std::max(h.z, 1e-9);
                       });
                   }});
    out.push_back(
        {"bound forgotten in the density", "ggx-bounded-vndf", lobe_named("ggx"), false, "fill", 0.5, [](S f) {
             return with_pdf([g = Ggx<double>{f.alpha}](const Pair& a, double p) {  // that of ggx-vndf
                 return p > 0 ? g.G1(a.wo) * g.D(normalize(a.wo + a.wi)) / (4 * a.wo.z) : 0.0;
             });
         }});
    out.push_back({"alpha for alpha^2 in the draw", "beckmann-d", lobe_named("beckmann"), false, "fill", 0.3, [](S f) {
                       return with_u(
                           [a = f.alpha](Vec2d u) { return Vec2d{-math::expm1(math::log1p(-u.x) / a), u.y}; });
                   }});
    out.push_back(
        {"missing G1 in the density of visible normals", "ggx-vndf", lobe_named("ggx"), false, "fill", 0.5, [](S f) {
             return with_pdf([a = f.alpha](const Pair& at, double p) { return p / Ggx<double>{a}.G1(at.wo); });
         }});
}

/// Faults of densities over an area, about another axis, or with a small error.
void other_density_faults(std::vector<Plan>& out) {
    const auto phong = lobe_named("phong");
    out.push_back({"area measure for solid angle", "light-area", LobeKind::none, true, "disk", 32,
        [](S) { return with_pdf([](const Pair&, double p) { return p > 0 ? 1 / (pi * 0.25) : 0.0; }); }});
    out.push_back({"light's cosine left out", "light-area", LobeKind::none, true, "disk", 32,
        [](S) { return with_pdf([](const Pair& a, double p) { return p * std::fabs(dot(a.wi, tilt(20, 60))); }); }});
    out.push_back({"axis about n but pdf about R", "phong", phong, false, "fill", 32, [](S f) {
                       return with_draw([s = f.s](Vec3d wo, Vec2d u, Draw& d) {
                           d.wi = about_normal(math::pow(u.x, 1 / (s + 1)), u.y);
                           d.pdf = (s + 1) / (2 * pi) * power_cos(d.wi, mirror(wo), s);
                       });
                   }});
    out.push_back({"pdf off by 1 %", "mixture", phong, true, "fill", 32, [](S) { return scaled_pdf(1.01); }});
    out.push_back({"pdf off by 0.2 % on a tenth of the sphere", "cosine", phong, true, "fill", 32,
        [](S) { return with_pdf([](const Pair& a, double p) { return in_patch(a.wi) ? 1.002 * p : p; }); }});
    out.push_back({"pdf 0.2 % low on a tenth of the sphere, made up for elsewhere", "uniform", LobeKind::none, true,
        "fill", 32, [](S) {
            return with_pdf([](const Pair& a, double p) {
                return in_patch(a.wi) ? 0.998 * p : in_patch({-a.wi.x, -a.wi.y, a.wi.z}) ? 1.002 * p : p;
            });
        }});
}

CaseLighting two_disks() { return case_setup(LobeKind::none, true, "two disks", 32).light; }

/// The density of A if it aims only at disk k.
template <template <class> class A> double towards(LocalDisk<double> disk, const Pair& at) {
    disk.power = 1;
    ShadingPoint<double> shading_point{};
    shading_point.disks = &disk;
    shading_point.disk_count = 1;
    return A<double>(shading_point).pdf(at.wo, at.wi).v;
}

/// Faults of samplers that select between lights. The list's first of two disks is partly behind the second.
void several_light_faults(std::vector<Plan>& out) {
    const auto lambert = [&](const std::string& name, const std::string& arm,
                             std::function<double(const std::vector<LocalDisk<double>>&, const Pair&, double)> pdf) {
        out.push_back({name, arm, LobeKind::none, true, "two disks", 32, [pdf](S) {
                           return with_pdf([pdf, disks = disks_of<double>(two_disks())](
                                               const Pair& a, double p) { return pdf(disks, a, p); });
                       }});
    };
    using Disks = const std::vector<LocalDisk<double>>&;
    lambert("second light forgotten in the pdf", "light-area",
        [](Disks d, const Pair& a, double) { return d[0].power * towards<LightArea>(d[0], a); });
    lambert("light behind another forgotten in the pdf", "light-area", [](Disks d, const Pair& a, double) {
        const double front = d[1].power * towards<LightArea>(d[1], a);
        return front > 0 ? front : d[0].power * towards<LightArea>(d[0], a);
    });
    lambert("second cap forgotten where two overlap", "light-solid-angle", [](Disks d, const Pair& a, double) {
        const double first = d[0].power * towards<LightSolidAngle>(d[0], a);
        return first > 0 ? first : d[1].power * towards<LightSolidAngle>(d[1], a);
    });
    lambert("lights chosen by power, weighed alike", "light-solid-angle", [](Disks d, const Pair& a, double) {
        return 0.5 * (towards<LightSolidAngle>(d[0], a) + towards<LightSolidAngle>(d[1], a));
    });
}

/// Faults of the map from u.
void uniform_faults(std::vector<Plan>& out) {
    const auto phong = lobe_named("phong");
    out.push_back({"phi over half a turn", "phong", phong, false, "fill", 32,
        [](S) { return with_u([](Vec2d u) { return Vec2d{u.x, 0.5 * u.y}; }); }});
    out.push_back({"phi over a turn less two degrees", "cosine", LobeKind::none, true, "fill", 32,
        [](S) { return with_u([](Vec2d u) { return Vec2d{u.x, u.y * 358 / 360}; }); }});
    out.push_back({"u's correlated", "cosine", LobeKind::none, true, "fill", 32,
        [](S) { return with_u([](Vec2d u) { return Vec2d{u.x, std::fmod(u.y * 0.5 + u.x * 0.5, 1.0)}; }); }});
    out.push_back({"one u used twice", "uniform", LobeKind::none, true, "fill", 32,
        [](S) { return with_u([](Vec2d u) { return Vec2d{u.x, u.x}; }); }});
    out.push_back({"sqrt forgotten", "cosine", LobeKind::none, true, "fill", 32, [](S) {
                       return with_draw([](Vec3d, Vec2d u, Draw& d) {
                           d.wi = about_normal(u.x, u.y);
                           d.pdf = d.wi.z / pi;
                       });
                   }});
    out.push_back({"sqrt forgotten on the disk", "light-area", LobeKind::none, true, "overhead disk", 32,
        [](S) { return with_u([](Vec2d u) { return Vec2d{u.x * u.x, u.y}; }); }});
    out.push_back({"16-bit u", "cosine", LobeKind::none, true, "fill", 32, [](S) {
                       return with_u([](Vec2d u) {
                           return Vec2d{
                               (std::floor(u.x * 65536) + 0.5) / 65536, (std::floor(u.y * 65536) + 0.5) / 65536};
                       });
                   }});
}

/// Faults of the returned directions.
void direction_faults(std::vector<Plan>& out) {
    const auto phong = lobe_named("phong");
    out.push_back({"never reaches grazing", "cosine", LobeKind::none, true, "fill", 32, [](S) {
                       return with_draw([](Vec3d, Vec2d u, Draw& d) {
                           d.wi = about_normal(std::max(std::sqrt(u.x), 0.08), u.y);
                           d.pdf = d.wi.z / pi;
                       });
                   }});
    out.push_back({"float cancellation at the pole", "phong", phong, false, "fill", 1e5, [](S f) {
                       return with_draw([s = f.s](Vec3d wo, Vec2d u, Draw& d) {
                           const double cos =
                               rounded(math::pow(u.x, 1 / (s + 1)));  // sin from a cosine rounded to float
                           d.wi = about(mirror(wo), cos, u.y);
                       });
                   }});
    out.push_back(
        {"pole artefact in the basis at n = -z", "light-area", LobeKind::none, true, "overhead disk", 32, [](S) {
             return with_draw([](Vec3d, Vec2d u, Draw& d) {
                 // A basis built for n.z > -1: at -z both tangents coincide and the disk becomes a line.
                 const double r = 0.6 * std::sqrt(u.x);
                 const Vec3d y = Vec3d{0.1, -0.05, 2} + Vec3d{1, 0, 0} * (r * math::cos(2 * pi * u.y)) +
                     Vec3d{1, 0, 0} * (r * math::sin(2 * pi * u.y));
                 d.wi = normalize(y);
             });
         }});
    out.push_back({"frame mirrored for half of the azimuths", "ggx-vndf", lobe_named("ggx"), false, "fill", 0.3, [](S) {
                       FaultInjection b;
                       b.wo = [](Vec3d wo) { return wo.y < 0 ? Vec3d{wo.x, -wo.y, wo.z} : wo; };
                       return b;
                   }});
    out.push_back({"NaN at u = 0", "phong", phong, false, "fill", 32, [](S) {
                       return with_draw([](Vec3d, Vec2d u, Draw& d) {
                           if (u.x == 0) d.pdf = std::nan("");
                       });
                   }});
    out.push_back({"directions a little too long", "cosine", LobeKind::none, true, "fill", 32,
        [](S) { return with_draw([](Vec3d, Vec2d, Draw& d) { d.wi = d.wi * 1.0002; }); }});
}

void weight_faults(std::vector<Plan>& out) {
    const auto phong = lobe_named("phong");
    out.push_back({"swapped w_o and w_i in pdf(w)", "cosine", phong, true, "fill", 32, [](S) {
                       FaultInjection b;
                       b.asked = [](const Pair& a, double) { return a.wo.z / pi; };
                       return b;
                   }});
    out.push_back({"clamped weights", "phong", phong, false, "fill", 32, [](S f) {
                       return with_draw([f](Vec3d wo, Vec2d, Draw& d) {
                           if (d.pdf > 0 && d.wi.z > 0)
                               d.weight = std::min(brdf_value(f, wo, d.wi) * d.wi.z / d.pdf, 0.3);
                       });
                   }});
    out.push_back({"cosine left out of the weight", "phong", phong, false, "fill", 32, [](S f) {
                       return with_draw([f](Vec3d wo, Vec2d, Draw& d) {
                           if (d.pdf > 0 && d.wi.z > 0) d.weight = brdf_value(f, wo, d.wi) / d.pdf;
                       });
                   }});
    out.push_back({"wrong MIS partner pdf", "mis-balance", phong, true, "fill + disk", 32,
        [](S) { return with_mis([](int t, const Pair&, double w) { return t == 0 ? w / (w + 0.5 * (1 - w)) : w; }); }});
    out.push_back({"one technique left unweighted", "mis-power", phong, true, "fill + disk", 32,
        [](S) { return with_mis([](int t, const Pair&, double w) { return t == 0 ? w : 1.0; }); }});
    out.push_back({"BRDF scaled by 1.01", "mixture", phong, true, "fill", 32,
        [](S) { return with_f([](const Pair&, double f) { return 1.01 * f; }); }});
    out.push_back({"s+1 for s+2 in the BRDF", "phong", phong, false, "fill", 32,
        [](S f) { return with_f([s = f.s](const Pair&, double v) { return v * (s + 1) / (s + 2); }); }});
    out.push_back({"non-reciprocal f", "cosine", phong, true, "fill", 32,
        [](S) { return with_f([](const Pair& a, double f) { return f * (1 + 0.05 * (1 - a.wo.z)); }); }});
    out.push_back({"one technique for two kinds of light", "phong", phong, true, "fill", 32,
        [](S) { return with_pdf([](const Pair& a, double p) { return a.wi.z < 0.2 ? 0.0 : p; }); }});
}

}  // namespace

std::vector<PlantedFault> arm_faults(bool full) {
    std::vector<Plan> plans;
    lobe_density_faults(plans);
    halfway_density_faults(plans);
    other_density_faults(plans);
    several_light_faults(plans);
    uniform_faults(plans);
    direction_faults(plans);
    weight_faults(plans);
    std::vector<PlantedFault> out;
    for (const Plan& p : plans) {
        PlantedFault fault{p.name, p.arm, {}};
        const CaseSetup on = case_setup(p.lobe, p.lambert, p.light, p.sharpness);
        for (const auto& [theta, azimuth] : wo_grid(full)) {
            if (theta != 0 && theta != 45 && theta != 75) continue;  // three of the sixteen are enough
            std::shared_ptr<const SamplerAdapter> right;
            for_each_sampler(Samplers{}, [&]<template <class> class A>() {
                if (A<float>::name == p.arm)
                    right = std::make_shared<BuiltIn<A>>(on.surface, tilt(theta, azimuth), on.light);
            });
            fault.check_cases.push_back(
                make_case_on(on, theta, azimuth, p.arm, std::make_shared<FaultySampler>(right, p.bend(on.surface))));
        }
        out.push_back(std::move(fault));
    }
    return out;
}

}  // namespace crescent
