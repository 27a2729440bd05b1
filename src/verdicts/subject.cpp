#include "verdicts/subject.h"

#include <cmath>
#include <fmt/format.h>

#include "math/functions.h"
#include "simd/scalar.h"

namespace crescent::inline verdicts {

std::optional<double> TrialDisk::distance(Vec3d wi) const {
    const double c = dot(center, normal), v = dot(wi, normal);
    if (!(v < 0 && c < 0)) return {};
    const Vec3d off = wi * c - center * v;
    if (!(dot(off, off) <= sqr(radius * v))) return {};
    return c / v;
}

const TrialDisk* TrialLight::first_met(Vec3d wi) const {
    const TrialDisk* first = nullptr;
    double nearest = 0;
    for (const TrialDisk& disk : disks)
        if (const std::optional<double> d = disk.distance(wi); d && (!first || *d < nearest))
            first = &disk, nearest = *d;
    return first;
}

double TrialLight::operator()(Vec3d wi) const {
    if (wi.z <= 0) return 0;
    const TrialDisk* disk = first_met(wi);
    return disk ? disk->radiance : fill;
}

std::string Trial::text() const {
    const bool none = subject && subject->traits().wo == Traits::Asked::none;
    std::string s = none ? "no w_o" : fmt::format("w_o {:g} deg", theta_deg);
    if (theta_deg > 0) s += fmt::format(" az {:g}", azimuth_deg);
    for (const auto& [name, value] : parameters) s += fmt::format(", {}={:g}", name, value);
    for (const std::string& part : {brdf, lighting})
        if (!part.empty()) s += ", " + part;
    return s;
}

Vec3d tilt(double theta_deg, double azimuth_deg) {
    const double t = theta_deg * pi / 180, a = azimuth_deg * pi / 180;
    return {math::sin(t) * math::cos(a), math::sin(t) * math::sin(a), math::cos(t)};
}

}  // namespace crescent::inline verdicts
