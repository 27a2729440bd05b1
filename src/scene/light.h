// What shines. Radiance in W/(sr m^2), lengths in m. Seen by sampled rays only.
#pragma once

#include <string>
#include <vector>

#include "base/errors.h"
#include "color/rgb.h"
#include "scene/lights/all.h"

namespace crescent::inline scene {

inline constexpr std::size_t most_lights = 64;  // in one scene

struct Light {
    std::string name;
    LightKinds::Any form;  // one of the kinds of lights/all.h
    Rgb radiance{};
    SourceLocation at;
    std::string_view kind() const { return LightKinds::names[form.index()]; }

    /// What it puts before the lights behind it.
    Bodies::Any body() const {
        return std::visit([](const auto& f) -> Bodies::Any { return f.body(); }, form);
    }
    /// An emitting side faces x.
    bool shines_on(Vec3d x) const {
        return std::visit([&](const auto& f) { return f.shines_on(x); }, form);
    }
    /// In whose directions it is seen from x.
    Figure seen_from(Vec3d x) const {
        return std::visit([&](const auto& f) { return f.seen_from(x); }, form);
    }
    /// How much it is worth choosing: Y(L) times the largest area that it shows, over pi.
    double power() const {
        return luminance(radiance) * std::visit([](const auto& f) { return f.disk_area(); }, form);
    }
    bool is_disk() const { return form.index() == 0; }
};

/// A disk that emits `radiance` from the side its normal points to (or both): the light of [disks.NAME].
struct DiskLight {
    std::string name;
    Vec3d center{}, normal{};
    double radius = 0;
    Rgb radiance{};
    bool two_sided = false;
    SourceLocation at;
    Light light() const { return {name, lights::Disk{center, normal, radius, two_sided}, radiance, at}; }
};

}  // namespace crescent::inline scene
