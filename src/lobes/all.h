// The one list of lobes. A new one is one file beside this one and one word here; the list feeds the experiment files,
// the kernels, the reference, the verdicts, the report and the manual.
#pragma once

#include "lobes/beckmann.h"
#include "lobes/blinn_phong.h"
#include "lobes/ggx.h"
#include "lobes/phong.h"

namespace crescent::inline lobes {

template <template <class> class... L> struct LobeList {
    static constexpr std::size_t count = sizeof...(L);
};

using Lobes = LobeList<PhongLobe, BlinnPhongLobe, GgxLobe, BeckmannLobe>;

/// Calls f.template operator()<L>() for every lobe L in the list's order.
template <class Call, template <class> class... L> constexpr void for_each_lobe(LobeList<L...>, Call&& f) {
    (f.template operator()<L>(), ...);
}

/// The same until one call gives true.
template <class Call, template <class> class... L> constexpr void for_each_lobe_until(LobeList<L...>, Call&& f) {
    (f.template operator()<L>() || ...);
}

/// A built-in lobe, 1/sr; 0 for none.
template <class F> F lobe_value(LobeKind kind, F s, F alpha, Vec3<F> wo, Vec3<F> wi) {
    F out = number<F>(0);
    int index = 0;
    for_each_lobe_until(Lobes{}, [&]<template <class> class L>() {
        if (index++ != static_cast<int>(kind)) return false;
        out = L<F>(s, alpha)(wo, wi);
        return true;
    });
    return out;
}

}  // namespace crescent::inline lobes
