// Small vectors over any number type F: float, double or a pack of floats.
// Directions are unit vectors; lengths are in scene units.
#pragma once

namespace crescent::inline base {

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

}  // namespace crescent::inline base
