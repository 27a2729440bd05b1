// The lights of a case of `crescent check`: a uniform fill, area lights, and those of a scene.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/vec.h"
#include "math/simd/frame.h"
#include "scene/lights/all.h"
#include "scene/surroundings.h"

namespace crescent {

/// A one-sided disk light: radiance, centre relative to the surface point and radius in m, unit normal.
struct CaseDiskLight {
    double radiance = 0;
    Vec3d center{}, normal{};
    double radius = 0;
    /// Distance along wi to the emitting side.
    std::optional<double> distance(Vec3d wi) const;
};

/// A light of another kind, as in scenes; the surface point is at 0. m.
struct CaseAreaLight {
    double radiance = 0;
    LightKinds::Any form;
    /// Distance along wi to an emitting side.
    std::optional<double> distance(Vec3d wi) const;
    /// Selection weight, as in scenes: radiance times projected area, over pi.
    double power() const;
};

/// The lights of a case: a uniform fill of the upper hemisphere, and lights that occlude it and each other.
struct CaseLighting {
    double fill = 1;  // radiance
    std::vector<CaseDiskLight> disks;
    std::vector<CaseAreaLight> area_lights{};              // other than disks
    std::shared_ptr<const Surroundings> around{};          // a sky and emitting triangles; null: none
    Vec3d position{};                                      // of the surface point in the world of `around`, m
    Frame<double> frame{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  // of the surface point in that world
    bool even() const { return disks.empty() && area_lights.empty() && !around; }
    /// The nearest light along wi: its distance and its radiance.
    struct Hit {
        double distance, radiance;
    };
    std::optional<Hit> first_hit(Vec3d wi) const;
    /// Radiance from wi.
    double operator()(Vec3d wi) const;
};

}  // namespace crescent
