// The scalar kernel of one shading point whose directions were made before.
#pragma once

#include <array>

#define CRESCENT_ISA scalar
#include "render/kernel_body.h"

namespace crescent {

/// Estimates shading point `index` with an arm that hands out its directions.
template <class A> using PointKernel = void (*)(const KernelCall&, std::size_t index, const A& arm);

template <class A, class L, class E> void estimate_point(const KernelCall& call, std::size_t index, const A& arm) {
    typename E::Room room(*call.shading_points, call.memory);
    scalar::estimate_pack<A, L, E, float>(call, index, room, [&](const ShadingPoint<float>&) { return arm; });
}

/// [lobe + 1]
template <class A, template <class> class... L>
constexpr std::array<PointKernel<A>, sizeof...(L) + 1> point_kernels(LobeList<L...>) {
    using E = scalar::Lights<float>;
    return {estimate_point<A, NoLobe<float>, E>, estimate_point<A, L<float>, E>...};
}

/// The kernel for the lobe and the surroundings of these points.
template <class A> PointKernel<A> point_kernel(const ShadingPoints& points) {
    if (points.around) return estimate_point<A, scalar::AnyLobe<float>, scalar::Surrounded<float>>;
    return point_kernels<A>(Lobes{})[static_cast<std::size_t>(points.lobe + 1)];
}

}  // namespace crescent
