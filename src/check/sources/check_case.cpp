// Texts of a case, and the devices of its samplers.
#include "check/sources/check_case.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "math/functions.h"
#include "output/format.h"

namespace crescent {

std::string CheckCase::text() const {
    const bool has_no_wo = adapter && adapter->traits().wo == Traits::WoDomain::none;
    std::string s = has_no_wo ? std::string(without_wo) : fmt::format("w_o {:g} deg", theta_deg);
    if (theta_deg > 0) s += fmt::format(" az {:g}", azimuth_deg);
    for (const auto& [name, value] : parameters) s += fmt::format(", {}={:g}", name, value);
    for (const std::string& part : {brdf, lighting})
        if (!part.empty()) s += ", " + part;
    return s;
}

std::string place_text(const Traits& traits, Vec3d w) {
    if (std::isnan(w.x + w.y + w.z)) return traits.domain ? traits.domain->first_outside() : "w_i NaN";
    return traits.domain ? traits.domain->text(w) : "w_i = " + direction_text(w);
}

Vec3d tilt(double theta_deg, double azimuth_deg) {
    const math::SinCos theta = math::sincos(theta_deg * pi / 180);
    return math::spherical(theta.sin, theta.cos, azimuth_deg * pi / 180);
}

void add_device(const std::string& arm, const SamplerAdapter& sampler, DevicesByArm& to) {
    const bool is_listed = std::ranges::any_of(to, [&](const auto& one) { return one.first == arm; });
    if (const EvaluationDevice device = sampler.declaration().device; device.declared() && !is_listed)
        to.emplace_back(arm, device);
}

}  // namespace crescent
