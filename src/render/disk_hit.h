// Finds the light that a direction meets first, and whether a body blocks it. Disks are in the local frame, occluders
// in the world. Templates over the number type give the same bits for every pack width.
#pragma once

#include "render/shading_points.h"
#include "samplers/sampler.h"

namespace crescent {

/// A disk with its normal turned so that the emitting side faces the surface: c.n < 0. If no emitting side faces it, r2
/// < 0 and no ray meets the disk.
template <class F> struct FacingDisk {
    Vec3<F> c, n;  // from the surface to the centre; the normal
    F k, r2;       // c.n; radius squared

    FacingDisk() = default;
    explicit FacingDisk(const LocalDisk<F>& disk) {
        const F sign = select(disk.along > number<F>(0), number<F>(-1), number<F>(1));
        c = disk.to_center;
        n = disk.normal * sign;
        k = disk.along * sign;
        r2 = select(disk.faces(), sqr(disk.radius), number<F>(-1));
    }
};

/// Returns whether w meets the disk. With v = w.n the ray meets its plane at (k/v) w, so |k w - v c| <= r |v| needs no
/// division. If it meets the disk, the distance is k/v.
template <class F> CRESCENT_INLINE MaskOf<F> meets_disk(const FacingDisk<F>& disk, Vec3<F> w, F& v) {
    v = dot(w, disk.n);
    const Vec3<F> offset = w * disk.k - disk.c * v;
    return (dot(offset, offset) <= disk.r2 * (v * v)) & (v < number<F>(0));
}

/// Like meets_disk, for a drawn direction. A sampler that aimed at disk k already knows the result. `alone`: the scene
/// has no other disk.
template <class F, class D>
CRESCENT_INLINE MaskOf<F> meets_disk(const FacingDisk<F>& disk, const D& draw, std::size_t k, bool alone, F& v) {
    if constexpr (requires { draw.meets_light; }) {
        constexpr bool aims = !requires { D::by_any; };  // every direction is aimed at a light
        if (aims && alone) {
            v = dot(draw.wi, disk.n);
            return draw.meets_light & (v < number<F>(0));
        }
        const auto meets = meets_disk(disk, draw.wi, v), is_own = draw.disk == number<F>(static_cast<double>(k));
        return (is_own & draw.meets_light & (v < number<F>(0))) | (meets & !is_own);
    } else {
        return meets_disk(disk, draw.wi, v);
    }
}

/// Like meets_disk, for a light of another kind, at index k of all lights. Sets t to its distance.
template <class F, class D> MaskOf<F> meets_light(const LocalLight<F>& light, const D& draw, std::size_t k, F& t) {
    MaskOf<F> meets = draw.wi.x > draw.wi.x, shines = meets;
    with_light_kind(light.kind, [&]<class Kind>() {
        meets = Kind::meets(light, draw.wi, t);
        shines = Kind::shines(light);
    });
    if constexpr (requires { draw.meets_light; }) {
        const auto is_own = draw.disk == number<F>(static_cast<double>(k));
        return (is_own & draw.meets_light & shines) | (meets & !is_own);
    }
    return meets;
}

/// Compares two disks on one ray: the nearer one is met. If rounding cannot order them, the first one in the file is
/// met.
template <class F> CRESCENT_INLINE MaskOf<F> is_nearer(F t, F than) { return t < than * number<F>(1 - 1e-5); }

/// A cone from the surface that contains a disk, used as a first, cheap test of a direction. It never excludes a
/// direction that meets the disk, if the direction is unit to 1e-6.
template <class F> struct DiskCone {
    Vec3<F> axis;
    F cos;  // of its half-angle, minus the rounding error; 2 if no emitting side faces the surface

    DiskCone() = default;
    explicit DiskCone(const FacingDisk<F>& disk) { *this = DiskCone(disk.c, disk.r2, !(disk.r2 < number<F>(0))); }
    /// Makes the cone of a sphere around c.
    DiskCone(Vec3<F> c, F r2, MaskOf<F> shines) {
        const F one = number<F>(1), d2 = dot(c, c);
        const auto is_outside = d2 > r2;
        axis = c * (one / sqrt(larger(d2, number<F>(1e-30))));
        cos = select(is_outside, sqrt(larger(one - r2 / select(is_outside, d2, one), number<F>(0))) - number<F>(1e-5),
            number<F>(-2));
        cos = select(shines, cos, number<F>(2));
    }
    CRESCENT_INLINE MaskOf<F> holds(Vec3<F> w) const { return dot(w, axis) > cos; }
};

template <class F> Vec3<F> broadcast(const std::array<float, 3>& a) { return {F(a[0]), F(a[1]), F(a[2])}; }

/// Returns whether the body's surface crosses the ray o + t d between lo and hi.
template <class F> MaskOf<F> blocked_by(const OccluderF& body, Vec3<F> o, Vec3<F> d, F lo, F hi) {
    const PackedBody<F> packed = {
        broadcast<F>(body.a), broadcast<F>(body.b), broadcast<F>(body.c), F(body.radius), F(body.offset)};
    MaskOf<F> out = lo > hi;
    const auto among = [&]<class... Kind>(KindList<Kind...>) {
        std::size_t kind = 0;
        ((kind++ == body.kind ? void(out = Kind::blocks(packed, o, d, lo, hi)) : void()), ...);
    };
    among(Bodies{});
    return out;
}

/// The same before a light at `distance`. Crossings within 1e-5 of the distance from either end do not count, so a body
/// that touches the surface point or the light hides nothing there.
template <class F> MaskOf<F> blocked_by(const OccluderF& body, Vec3<F> o, Vec3<F> d, F distance) {
    return blocked_by(body, o, d, distance * number<F>(1e-5), distance * number<F>(1 - 1e-5));
}

}  // namespace crescent
