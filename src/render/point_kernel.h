// The scalar kernel of one shading point whose directions were made before.
#pragma once

#include <array>

#define CRESCENT_ISA scalar
#include "render/kernel_body.h"

namespace crescent::inline render {

/// Estimates shading point `at` with an arm that hands out its directions.
template <class A> using PointKernel = void (*)(const KernelCall&, std::size_t at, const A& arm);

template <class A, class L> void estimate_point(const KernelCall& call, std::size_t at, const A& arm) {
    scalar::LightRoom<float> room(*call.shading_points, call.memory);
    scalar::estimate_pack<A, L, scalar::Lights<float>, float>(
        call, at, room, [&](const ShadingPoint<float>&) { return arm; });
}

/// [lobe + 1]
template <class A, template <class> class... L>
constexpr std::array<PointKernel<A>, sizeof...(L) + 1> point_kernels(LobeList<L...>) {
    return {estimate_point<A, NoLobe<float>>, estimate_point<A, L<float>>...};
}

/// The kernel for the lobe of these points.
template <class A> PointKernel<A> point_kernel(const ShadingPoints& points) {
    return point_kernels<A>(Lobes{})[static_cast<std::size_t>(points.lobe + 1)];
}

}  // namespace crescent::inline render
