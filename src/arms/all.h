// The one list of arms. A new sampler is one file beside this one and one word here; the list feeds the experiment
// files, the CLI, the kernels, the manual and the laws.
#pragma once

#include "arms/beckmann_d.h"
#include "arms/blinn.h"
#include "arms/cosine.h"
#include "arms/ggx_bounded_vndf.h"
#include "arms/ggx_d.h"
#include "arms/ggx_vndf.h"
#include "arms/light_area.h"
#include "arms/light_solid_angle.h"
#include "arms/mis_balance.h"
#include "arms/mis_power.h"
#include "arms/mixture.h"
#include "arms/phong.h"
#include "arms/sampler.h"
#include "arms/uniform.h"

namespace crescent::inline arms {

/// The types of the arms, in the order of their indices. Each is a Sampler (arms/sampler.h).
template <template <class> class... A>
    requires(Sampler<A<float>, float> && ...)
struct ArmList {
    static constexpr std::size_t count = sizeof...(A);
};

using Arms = ArmList<Uniform, Cosine, Phong, Mixture, MisBalance, MisPower, LightSolidAngle, LightArea, Blinn, GgxD,
    GgxVndf, GgxBoundedVndf, BeckmannD>;

/// Calls f.template operator()<A>() for every arm A in the list's order.
template <class Call, template <class> class... A> constexpr void for_each_arm(ArmList<A...>, Call&& f) {
    (f.template operator()<A>(), ...);
}

}  // namespace crescent::inline arms
