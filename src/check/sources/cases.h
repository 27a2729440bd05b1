// A built-in arm as a sampler, its cases, and the verdicts that are expected of them. It draws in float as it renders,
// and has densities in double for quadrature. The surface is f = rho_d/pi + rho_s lobe.
#pragma once

#include <array>
#include <map>
#include <variant>

#include "base/vec.h"
#include "check/sources/check_case.h"
#include "samplers/all.h"
#include "scene/lobes/all.h"

namespace crescent {

/// f of the surface, 1/sr, without the cosine.
double brdf_value(const SurfaceSetup& surface, Vec3d wo, Vec3d wi);

/// The shading point of an arm in number type F; `disks` and `others` must outlive it.
template <class F> ShadingPoint<F> point_of(const SurfaceSetup& surface, Vec3d wo,
    const std::vector<LocalDisk<F>>& disks, const std::vector<LocalLight<F>>& others) {
    ShadingPoint<F> out{.wo = as<F>(wo),
        .s = static_cast<F>(surface.s),
        .alpha = static_cast<F>(surface.alpha),
        .diffuse = static_cast<F>(surface.rho_d),
        .lobe = static_cast<F>(surface.rho_s),
        .disks = disks.data(),
        .disk_count = static_cast<int>(disks.size()),
        .others = others.data(),
        .other_count = static_cast<int>(others.size())};
    if (surface.rho_s > 0) out.lobe_kind = surface.lobe;
    return out;
}
/// Power of the light: L r^2 of the disks plus that of the other lights.
inline double power_of(const CaseLighting& light) {
    double total = 0;
    for (const CaseDiskLight& d : light.disks) total += d.radiance * sqr(d.radius);
    for (const CaseAreaLight& area_light : light.area_lights) total += area_light.power();
    return total;
}
/// One-sided disks, each with its probability of selection among the lights.
template <class F> std::vector<LocalDisk<F>> disks_of(const CaseLighting& light) {
    const double total = power_of(light);
    std::vector<LocalDisk<F>> out;
    for (const CaseDiskLight& d : light.disks)
        out.push_back({as<F>(d.center), as<F>(d.normal), static_cast<F>(d.radius), F(0),
            static_cast<F>(d.radiance * sqr(d.radius) / total)});
    return out;
}

/// The lights that are not disks, in the frame of the surface.
template <class F> std::vector<LocalLight<F>> others_of(const CaseLighting& light) {
    const double total = power_of(light);
    const Frame<double> frame = frame_about(Vec3d{0, 0, 1});
    std::vector<LocalLight<F>> out;
    for (const CaseAreaLight& area_light : light.area_lights) {
        const LightNumbers n = std::visit(
            [&](const auto& l) -> LightNumbers {
                if constexpr (requires { l.numbers(Vec3d{}, frame); }) return l.numbers(Vec3d{}, frame);
                else return {};
            },
            area_light.form);
        out.push_back({area_light.form.index(), static_cast<F>(area_light.power() / total), as<F>(n.a), as<F>(n.b),
            as<F>(n.c), {}});
        for (std::size_t k = 0; k < n.number.size(); ++k) out.back().number[k] = static_cast<F>(n.number[k]);
    }
    return out;
}

/// The same point with the sky and triangles around it, which must outlive it.
template <class F> ShadingPoint<F> with_around(ShadingPoint<F> point, const CaseLighting& light) {
    if (!light.around) return point;
    point.around = light.around.get();
    point.position = as<F>(light.position);
    point.frame = {as<F>(light.frame.t), as<F>(light.frame.b), as<F>(light.frame.n)};
    return point;
}

/// A is an arm template; planted faults are arms too.
template <template <class> class A> class BuiltIn : public SamplerSource {
public:
    /// The arm on a surface, seen from wo.
    BuiltIn(const SurfaceSetup& surface, Vec3d wo, const CaseLighting& light)
        : surface_(surface),
          disks_single_(disks_of<float>(light)),
          disks_double_(disks_of<double>(light)),
          others_single_(others_of<float>(light)),
          others_double_(others_of<double>(light)),
          surroundings_(light.around),
          single_(with_around(point_of<float>(surface, wo, disks_single_, others_single_), light)),
          double_(with_around(point_of<double>(surface, wo, disks_double_, others_double_), light)) {}
    BuiltIn(const BuiltIn&) = delete;
    BuiltIn& operator=(const BuiltIn&) = delete;

    std::string name() const override { return std::string(A<float>::name); }
    int techniques() const override {
        if constexpr (is_paired) return A<float>::techniques;
        else return 1;
    }
    void sample(int technique, Vec3d wo, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        const Vec3<float> o = as<float>(wo);
        for (std::size_t i = 0; i < u.size(); ++i) {
            const Drawn<float> d = draw(technique, o, {static_cast<float>(u[i].x), static_cast<float>(u[i].y)});
            out[i] = {widen(d.wi), static_cast<double>(d.pdf.v), {}};
        }
    }
    void pdf(int technique, std::span<const Pair> pairs, std::span<double> out) const override {
        for (std::size_t i = 0; i < pairs.size(); ++i)
            out[i] = static_cast<double>(density(single_, technique, as<float>(pairs[i].wo), as<float>(pairs[i].wi)));
    }
    void exact_pdf(int technique, std::span<const Pair> pairs, std::span<double> out) const override {
        for (std::size_t i = 0; i < pairs.size(); ++i) out[i] = density(double_, technique, pairs[i].wo, pairs[i].wi);
    }
    void mis_weight(int technique, std::span<const Pair> pairs, std::span<double> out) const override {
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            out[i] = 1;
            if constexpr (is_paired) {
                const Vec3<float> o = as<float>(pairs[i].wo), w = as<float>(pairs[i].wi);
                const float p = density(single_, technique, o, w);
                const Drawn<float> d{w, {p}};
                out[i] = static_cast<double>(
                    technique == 0 ? single_.template weight<0>(o, d) : single_.template weight<1>(o, d));
            }
        }
    }
    bool has_f() const override { return true; }
    void f(std::span<const Pair> pairs, std::span<double> out) const override {
        for (std::size_t i = 0; i < pairs.size(); ++i) out[i] = brdf_value(surface_, pairs[i].wo, pairs[i].wi);
    }

protected:
    static constexpr bool is_paired = requires { A<float>::techniques; };

    Drawn<float> draw(int technique, Vec3<float> wo, Vec2<float> u) const {
        if constexpr (is_paired)
            return technique == 0 ? single_.template sample_technique<0>(wo, u)
                                  : single_.template sample_technique<1>(wo, u);
        else return single_.sample(wo, u);
    }
    template <class F> static F density(const A<F>& arm, int technique, Vec3<F> wo, Vec3<F> wi) {
        if constexpr (is_paired)
            return technique == 0 ? arm.template pdf_technique<0>(wo, wi).v : arm.template pdf_technique<1>(wo, wi).v;
        else return arm.pdf(wo, wi).v;
    }

    SurfaceSetup surface_;
    std::vector<LocalDisk<float>> disks_single_;
    std::vector<LocalDisk<double>> disks_double_;
    std::vector<LocalLight<float>> others_single_;
    std::vector<LocalLight<double>> others_double_;
    std::shared_ptr<const Surroundings> surroundings_;
    A<float> single_;
    A<double> double_;
};

/// Values given with --set: "s", "alpha", "rho_d", "rho_s".
using Settings = std::map<std::string, double>;

/// Directions from the normal to 89 deg, each with its own azimuth.
Grid wo_grid(bool is_full);
/// Every case of one arm, or of all arms if the name is empty, over `grid` or, if that is empty, wo_grid. Throws
/// InputError for an unknown name.
std::vector<CheckCase> make_cases(
    const std::string& arm, const Settings& settings, bool is_full, const Grid& grid = {});

/// Built-in arm `name` on the surface, light and w_o of each of these cases, with A's f if A is not built in.
std::vector<CheckCase> sampler_named_against(const std::string& name, std::span<const CheckCase> a);
/// Another sampler at the w_o of each of these cases.
std::vector<CheckCase> sampler_against(const std::shared_ptr<const SamplerAdapter>& b, std::span<const CheckCase> a);

/// The built-in arm `name` on the surface of a case, under its light, at its w_o.
std::shared_ptr<const SamplerAdapter> sampler_on(const std::string& name, const CheckCase& check_case);

/// A surface and light for a check of an arm.
struct CaseSetup {
    SurfaceSetup surface;
    CaseLighting light;
    std::string brdf, lighting;
    bool has_s = false, has_alpha = false;
};
/// A surface and light of the built-in list: a lobe, with or without a Lambert part, under "fill", "disk" or both.
CaseSetup case_setup(LobeKind lobe, bool has_lambert, const std::string& lighting, double s_or_alpha);
/// The case of `adapter` on a surface at one w_o, without its expected behaviour.
CheckCase make_case_on(const CaseSetup& setup, double theta, double azimuth, std::string arm,
    std::shared_ptr<const SamplerAdapter> adapter);

}  // namespace crescent
