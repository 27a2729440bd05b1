// The list of the kinds of light. To add one, add a file in this folder and a word here; the list determines the
// experiment files, the manual, samplers, kernels, references and the report. See docs/extending.md. Disks come first
// in every scene: kernels and samplers have sums and tests of their own for them (samplers/sampler.h,
// render/disk_hit.h).
#pragma once

#include "scene/lights/disk.h"
#include "scene/lights/rectangle.h"
#include "scene/lights/sphere.h"

namespace crescent {

using LightKinds = KindList<lights::Disk, lights::Sphere, lights::Rectangle>;

/// Calls f.template operator()<Kind>() for every kind other than the disk, in order.
template <class F> void for_each_area_light(F&& f) {
    const auto among = [&]<class Disk, class... Kind>(
                           KindList<Disk, Kind...>) { (f.template operator()<Kind>(), ...); };
    among(LightKinds{});
}
/// Calls f for the kind at an index.
template <class F> void with_light_kind(std::size_t index, F&& f) {
    std::size_t k = 1;
    for_each_area_light([&]<class Kind>() {
        if (k++ == index) f.template operator()<Kind>();
    });
}

}  // namespace crescent
