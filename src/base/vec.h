// Small vectors over any number type F: float, double or a pack of floats.
// Directions are unit vectors; lengths are in scene units.
#pragma once

#include <array>

namespace crescent {

template <class F> struct Vec2 {
    F x, y;
};

template <class F> struct Vec3 {
    F x, y, z;
};

template <class F> [[gnu::always_inline]] constexpr Vec3<F> operator+(Vec3<F> a, Vec3<F> b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class F> [[gnu::always_inline]] constexpr Vec3<F> operator-(Vec3<F> a, Vec3<F> b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class F> [[gnu::always_inline]] constexpr Vec3<F> operator-(Vec3<F> a) { return {-a.x, -a.y, -a.z}; }
template <class F> [[gnu::always_inline]] constexpr Vec3<F> operator*(F s, Vec3<F> a) {
    return {s * a.x, s * a.y, s * a.z};
}
template <class F> [[gnu::always_inline]] constexpr Vec3<F> operator*(Vec3<F> a, F s) {
    return {a.x * s, a.y * s, a.z * s};
}

template <class F> [[gnu::always_inline]] constexpr F sqr(F x) { return x * x; }
template <class F> [[gnu::always_inline]] constexpr F dot(Vec3<F> a, Vec3<F> b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class F> [[gnu::always_inline]] constexpr Vec3<F> cross(Vec3<F> a, Vec3<F> b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

using Vec3d = Vec3<double>;
using Vec3f = Vec3<float>;

// ---- Points of the plane in doubles: coordinates of directions, random numbers.

using Vec2d = Vec2<double>;

// ---- Converts vectors from one number type to another, component by component, with the rounding of static_cast.

/// Returns `v` in doubles (exact for floats).
template <class F> constexpr Vec3d widen(Vec3<F> v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}
/// Returns `v` rounded to F.
template <class F> constexpr Vec3<F> as(Vec3d v) {
    return {static_cast<F>(v.x), static_cast<F>(v.y), static_cast<F>(v.z)};
}

}  // namespace crescent

// ---- A colour: three numbers of linear Rec.709, and its luminance.

namespace crescent {

using Rgb = std::array<double, 3>;  // linear Rec.709

/// Weights of linear Rec.709 luminance, ITU-R BT.709.
inline constexpr double luminance_weights[3] = {0.2126, 0.7152, 0.0722};

template <class C> double luminance(const C& rgb) {
    return luminance_weights[0] * rgb[0] + luminance_weights[1] * rgb[1] + luminance_weights[2] * rgb[2];
}

}  // namespace crescent
