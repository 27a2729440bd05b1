// The list of lobes. To add one, add a file in this folder and a word here; the list determines the experiment files,
// the kernels, the reference, the checks, the report and the manual.
#pragma once

#include "scene/lobes/beckmann.h"
#include "scene/lobes/blinn_phong.h"
#include "scene/lobes/ggx.h"
#include "scene/lobes/phong.h"

namespace crescent {

template <template <class> class... L> struct LobeList {
    static constexpr std::size_t count = sizeof...(L);
};

using Lobes = LobeList<PhongLobe, BlinnPhongLobe, GgxLobe, BeckmannLobe>;

/// Calls f.template operator()<L>() for every lobe L in the list's order.
template <class Call, template <class> class... L> constexpr void for_each_lobe(LobeList<L...>, Call&& f) {
    (f.template operator()<L>(), ...);
}

/// Calls f.template operator()<L>() for the lobe of this kind; does nothing for none.
template <class Call> constexpr void with_lobe(LobeKind kind, Call&& f) {
    const auto among = [&]<template <class> class... L>(LobeList<L...>) {
        int k = 0;
        static_cast<void>(((k++ == static_cast<int>(kind) && (f.template operator()<L>(), true)) || ...));
    };
    among(Lobes{});
}

/// Returns the value of a built-in lobe, 1/sr; 0 for none.
template <class F> F lobe_value(LobeKind kind, F s, F alpha, Vec3<F> wo, Vec3<F> wi) {
    F out = number<F>(0);
    with_lobe(kind, [&]<template <class> class L>() { out = L<F>(s, alpha)(wo, wi); });
    return out;
}

}  // namespace crescent
