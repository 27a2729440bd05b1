// The numbers of a pack one by one, for code that is not written for packs: a search in a table, a ray in a tree.
#pragma once

#include <cstdint>

#include "math/simd/scalar.h"

namespace crescent::inline simd {

/// One number for each lane of F: a float, or the double of a double.
template <class F> struct LaneArray {
    using Scalar = float;
    Scalar at[Lanes<F>::count];
    LaneArray() = default;
    CRESCENT_INLINE explicit LaneArray(F x) { store(x, at); }
    CRESCENT_INLINE F pack() const { return load_as<F>(at); }
};
template <> struct LaneArray<double> {
    using Scalar = double;
    double at[1];
    LaneArray() = default;
    explicit LaneArray(double x) : at{x} {}
    double pack() const { return at[0]; }
};

/// An integer for each lane of F.
template <class F> struct LaneIntegers {
    std::uint32_t at[Lanes<F>::count];
    LaneIntegers() = default;
    CRESCENT_INLINE explicit LaneIntegers(UintOf<F> x) { store(x, at); }
    CRESCENT_INLINE UintOf<F> pack() const { return load_as<UintOf<F>>(at); }
};

}  // namespace crescent::inline simd
