// The operations of the kernels on plain numbers: float (with uint32_t and bool as mask) and double. simd/pack.h has
// the same names for packs; a template written with these names gives the same bits on both.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

/// For functions inside the sample loop, where a call costs more than the work. CRESCENT_INLINE is for those of several
/// operations: clang compiles the kernels in three quarters of the time if it may simplify such functions before it
/// inlines them, and the code is as fast. kernels.cmake defines CRESCENT_INLINE_HINTS together with a limit at which
/// all of them are inlined.
#define CRESCENT_ALWAYS_INLINE inline __attribute__((always_inline))
#ifdef CRESCENT_INLINE_HINTS
#define CRESCENT_INLINE inline
#else
#define CRESCENT_INLINE CRESCENT_ALWAYS_INLINE
#endif

namespace crescent {

/// The types that belong to a number type F: its mask and, for single precision, its 32-bit integers.
template <class F> struct Lanes;
template <> struct Lanes<float> {
    using Mask = bool;
    using Uint = std::uint32_t;
    static constexpr std::size_t count = 1;
};
template <> struct Lanes<double> {
    using Mask = bool;
    using Uint = std::uint32_t;
    static constexpr std::size_t count = 1;
};
template <class F> using MaskOf = typename Lanes<F>::Mask;
template <class F> using UintOf = typename Lanes<F>::Uint;

/// a if m holds, else b: the operations of packs (pack.h) for one number.
constexpr float select(bool m, float a, float b) { return m ? a : b; }
constexpr double select(bool m, double a, double b) { return m ? a : b; }
constexpr std::uint32_t select(bool m, std::uint32_t a, std::uint32_t b) { return m ? a : b; }
constexpr bool any(bool m) { return m; }
constexpr std::uint32_t plus_one_where(bool m, std::uint32_t u) { return u + static_cast<std::uint32_t>(m); }

/// Correctly rounded.
inline float sqrt(float x) { return std::sqrt(x); }
inline double sqrt(double x) { return std::sqrt(x); }
inline float abs(float x) { return std::fabs(x); }
inline double abs(double x) { return std::fabs(x); }

/// A float's representation, and back.
inline std::uint32_t bits(float x) { return std::bit_cast<std::uint32_t>(x); }
template <class F> F from_bits(UintOf<F> u);
template <> inline float from_bits<float>(std::uint32_t u) { return std::bit_cast<float>(u); }
/// Exact for u < 2^24.
template <class F> F to_float(UintOf<F> u);
template <> inline float to_float<float>(std::uint32_t u) { return static_cast<float>(static_cast<std::int32_t>(u)); }
template <int n> constexpr std::uint32_t shift_right(std::uint32_t u) { return u >> n; }
template <int n> constexpr std::uint32_t shift_left(std::uint32_t u) { return u << n; }

/// b if either is NaN, like maxps.
template <class F> CRESCENT_INLINE F larger(F a, F b) { return select(a > b, a, b); }
template <class F> CRESCENT_INLINE F smaller(F a, F b) { return select(a < b, a, b); }

inline constexpr double pi = 3.14159265358979323846;
/// A constant in the current number type.
template <class F> CRESCENT_INLINE F number(double x) { return F(static_cast<float>(x)); }
template <> inline double number<double>(double x) { return x; }
template <> inline float number<float>(double x) { return static_cast<float>(x); }

/// Loads and stores as many numbers as F has lanes.
template <class F> F load_as(const float* p);
template <> inline float load_as<float>(const float* p) { return *p; }
template <class U> U load_as(const std::uint32_t* p);
template <> inline std::uint32_t load_as<std::uint32_t>(const std::uint32_t* p) { return *p; }
inline void store(float a, float* p) { *p = a; }
inline void store(std::uint32_t a, std::uint32_t* p) { *p = a; }

// ---- The numbers of a pack one by one, for code that is not written for packs: a search in a table, a ray in a tree.

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

}  // namespace crescent
