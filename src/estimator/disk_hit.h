// Which disk light a direction meets first, and whether something stands before it. Local frame for the disks, world
// for the occluders; templates over the number type, the same bits for every pack width.
#pragma once

#include "arms/sampler.h"
#include "estimator/sites.h"

namespace crescent {

/// Distance along w to the disk's plane where w meets the emitting side inside the radius, else 0. With k = c.n and
/// v = w.n the ray meets the plane at (k/v) w, so |k w - v c| <= r |v| needs no division.
template <class F> CRESCENT_INLINE MaskOf<F> meets_disk(const LocalDisk<F>& disk, Vec3<F> w, F& v, F& k) {
    k = dot(disk.to_center, disk.normal);
    v = dot(w, disk.normal);
    const Vec3<F> off = w * k - disk.to_center * v;
    const F zero = number<F>(0);
    const auto inside = dot(off, off) <= sqr(disk.radius * v);
    const auto front = (v < zero) & (k < zero);
    const auto back = (v > zero) & (k > zero) & (disk.two_sided > zero);
    return inside & (front | back);
}

template <class F> Vec3<F> broadcast(const std::array<float, 3>& a) { return {F(a[0]), F(a[1]), F(a[2])}; }

/// t range of a slab; a component of 0 is nudged so that no 0/0 arises.
template <class F> void clip_slab(F lo, F hi, F o, F d, F& near, F& far) {
    const F safe = select(abs(d) > number<F>(1e-20), d, number<F>(1e-20));
    const F t0 = (lo - o) / safe, t1 = (hi - o) / safe;
    near = larger(near, smaller(t0, t1));
    far = smaller(far, larger(t0, t1));
}

template <class F> MaskOf<F> within(F t, F lo, F hi) { return (t > lo) & (t < hi); }

/// Does the body's surface cross the ray o + t d for t in (0, t_max)?
template <class F> MaskOf<F> blocked_by(const OccluderF& body, Vec3<F> o, Vec3<F> d, F t_max) {
    const F zero = number<F>(0), eps = t_max * number<F>(1e-5);
    const Vec3<F> a = broadcast<F>(body.a), b = broadcast<F>(body.b);
    switch (body.kind) {
        case Occluder::Kind::sphere: {
            const Vec3<F> c = a - o;
            const F along = dot(c, d);
            const F disc = sqr(along) - (dot(c, c) - sqr(F(body.radius)));
            const F root = sqrt(larger(disc, zero));
            return (disc > zero) & (within(along - root, eps, t_max) | within(along + root, eps, t_max));
        }
        case Occluder::Kind::box: {
            F near = number<F>(-1e30), far = number<F>(1e30);
            clip_slab(a.x, b.x, o.x, d.x, near, far);
            clip_slab(a.y, b.y, o.y, d.y, near, far);
            clip_slab(a.z, b.z, o.z, d.z, near, far);
            return (near < far) & (within(near, eps, t_max) | within(far, eps, t_max));
        }
        case Occluder::Kind::quad: {
            const Vec3<F> v = broadcast<F>(body.c), n = cross(b, v);
            const F denominator = dot(n, d);
            const F t = dot(n, a - o) / select(denominator == zero, number<F>(1e-30), denominator);
            const Vec3<F> p = o + d * t - a;
            const F nn = dot(n, n), x = dot(cross(p, v), n), y = dot(cross(b, p), n);
            return (t > eps) & (t < t_max) & (x >= zero) & (x <= nn) & (y >= zero) & (y <= nn);
        }
        case Occluder::Kind::disk:
        case Occluder::Kind::plane: {
            const F denominator = dot(b, d);
            const F t = dot(b, a - o) / select(denominator == zero, number<F>(1e-30), denominator);
            const auto crosses = (t > eps) & (t < t_max);
            if (body.kind == Occluder::Kind::plane) return crosses;
            const Vec3<F> p = o + d * t - a;
            return crosses & (dot(p, p) <= sqr(F(body.radius)));
        }
    }
    return zero > zero;
}

}  // namespace crescent
