// The one list of the kinds of light. A new one is a file beside this one and a word here; the list feeds the
// experiment files, the manual, arms, kernels, references and the report. docs/extending.md has the steps. Disks come
// first in every scene: kernels and arms have sums and tests of their own for them (arms/sampler.h,
// estimator/disk_hit.h).
#pragma once

#include "scene/lights/disk.h"
#include "scene/lights/rectangle.h"
#include "scene/lights/sphere.h"

namespace crescent::inline scene {

using LightKinds = KindList<lights::Disk, lights::Sphere, lights::Rectangle>;

/// Calls f.template operator()<Kind>() for every kind other than the disk, in order.
template <class F> void for_each_area_light(F&& f) {
    const auto among = [&]<class Disk, class... Kind>(
                           KindList<Disk, Kind...>) { (f.template operator()<Kind>(), ...); };
    among(LightKinds{});
}
/// The same for the kind at an index.
template <class F> void with_light_kind(std::size_t index, F&& f) {
    std::size_t k = 1;
    for_each_area_light([&]<class Kind>() {
        if (k++ == index) f.template operator()<Kind>();
    });
}

}  // namespace crescent::inline scene
