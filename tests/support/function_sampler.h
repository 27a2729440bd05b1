// Samplers made of functions, for tests of the check: a cosine sampler unless its functions are replaced.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "samplers/domains/sphere_chart.h"
#include "check/sources/check_case.h"
#include "math/simd/frame.h"

namespace crescent::check {

/// cos theta / pi, drawn exactly.
inline Vec3d cosine_draw(Vec3d, const PrimarySample& u) {
    const math::SinCos phi = math::sincos(two_pi * u[1]);
    const double r = std::sqrt(u[0]);
    return {r * phi.cos, r * phi.sin, std::sqrt(1 - u[0])};
}
inline double cosine_pdf(Vec3d, Vec3d w) { return std::max(w.z, 0.0) * 2 / two_pi; }

/// cos^s about an axis.
inline Vec3d power_draw(Vec3d axis, double s, const PrimarySample& u) {
    const double c = math::exp(math::log(1 - u[0]) / (s + 1)), r = std::sqrt(1 - c * c);
    const math::SinCos phi = math::sincos(two_pi * u[1]);
    return frame_about(axis).to_world({r * phi.cos, r * phi.sin, c});
}
inline double power_pdf(Vec3d axis, double s, Vec3d w) {
    const double c = dot(axis, w);
    return c > 0 ? (s + 1) / two_pi * math::exp(s * math::log(c)) : 0;
}

struct FunctionSampler : SamplerSource {
    std::function<Vec3d(Vec3d wo, const PrimarySample& u)> draw = cosine_draw;  // {}: no sample
    std::function<double(Vec3d wo, Vec3d wi)> p = cosine_pdf;
    std::function<double(Vec3d wo, Vec3d wi)> f_value{};          // none: without f
    std::function<Vec3d(Vec3d wo, Vec3d wi)> weights{};           // of draws, by channel; none: without weights
    std::function<void(const PrimarySample& u, Draw&)> change{};  // of each draw at last
    Traits of{};
    bool is_serial = false;
    std::string name() const override { return "made"; }
    bool serial() const override { return is_serial; }
    Traits traits() const override { return of; }
    void sample(int, Vec3d wo, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        for (std::size_t i = 0; i < u.size(); ++i) {
            const Vec3d w = draw(wo, u[i]);
            out[i] = dot(w, w) > 0 ? Draw{w, p(wo, w)} : Draw{{0, 0, 1}, 0};
            if (weights && out[i].pdf > 0) {
                out[i].weights = weights(wo, w);
                out[i].weight = out[i].weights.x;
            }
            if (change) change(u[i], out[i]);
        }
    }
    void pdf(int, std::span<const Pair> at, std::span<double> out) const override {
        for (std::size_t i = 0; i < at.size(); ++i) out[i] = p(at[i].wo, at[i].wi);
    }
    bool has_f() const override { return static_cast<bool>(f_value); }
    void f(std::span<const Pair> at, std::span<double> out) const override {
        for (std::size_t i = 0; i < at.size(); ++i) out[i] = f_value(at[i].wo, at[i].wi);
    }
};

/// cos^s about n, drawn exactly.
inline FunctionSampler power_sampler(double s) {
    FunctionSampler out;
    out.draw = [s](Vec3d, const PrimarySample& u) { return power_draw({0, 0, 1}, s, u); };
    out.p = [s](Vec3d, Vec3d w) { return power_pdf({0, 0, 1}, s, w); };
    return out;
}

/// f of a Lambert surface.
inline std::function<double(Vec3d, Vec3d)> lambert(double albedo) {
    return [albedo](Vec3d, Vec3d w) { return w.z > 0 ? albedo * 2 / two_pi : 0; };
}

}  // namespace crescent::check
