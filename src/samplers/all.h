// The list of samplers. To add one, add a file in this folder and a word here; the list determines the experiment
// files, the CLI, the kernels, the documentation and the tests.
#pragma once

#include "samplers/beckmann_d.h"
#include "samplers/blinn.h"
#include "samplers/cosine.h"
#include "samplers/ggx_bounded_vndf.h"
#include "samplers/ggx_d.h"
#include "samplers/ggx_vndf.h"
#include "samplers/light_area.h"
#include "samplers/light_solid_angle.h"
#include "samplers/light_triangle.h"
#include "samplers/material.h"
#include "samplers/mis.h"
#include "samplers/mixture.h"
#include "samplers/phong.h"
#include "samplers/sampler.h"
#include "samplers/sky.h"
#include "samplers/uniform.h"

namespace crescent {

/// The types of the samplers, in the order of their indices. Each is a Sampler (samplers/sampler.h).
template <template <class> class... A>
    requires(Sampler<A<float>, float> && ...)
struct ArmList {
    static constexpr std::size_t count = sizeof...(A);
};

using Samplers = ArmList<Uniform, Cosine, Phong, Mixture, MisBalance, MisPower, LightSolidAngle, LightArea, Blinn, GgxD,
    GgxVndf, GgxBoundedVndf, BeckmannD, SkyByTexel, LightTriangle, MaterialSampler>;

/// Calls f.template operator()<A>() for every sampler A in the list's order.
template <class Call, template <class> class... A> constexpr void for_each_sampler(ArmList<A...>, Call&& f) {
    (f.template operator()<A>(), ...);
}

}  // namespace crescent
