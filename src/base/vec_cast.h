// Vectors from one number type to another, component by component, as static_cast rounds.
#pragma once

#include "base/vec.h"

namespace crescent::inline base {

/// `v` in doubles (exact for floats).
template <class F> constexpr Vec3d widen(Vec3<F> v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}
/// `v` rounded to F.
template <class F> constexpr Vec3<F> as(Vec3d v) {
    return {static_cast<F>(v.x), static_cast<F>(v.y), static_cast<F>(v.z)};
}

}  // namespace crescent::inline base
