// light-solid-angle: next-event estimation (NEE), a disk light by solid angle: uniform over the smallest cap of directions
// about the disk's spherical ellipse that holds all of it. The disk is chosen by its power Y(L) pi r^2.
//   p = 1 / (2 pi (1 - cos b)),  cos = 1 - u1 (1 - cos b), phi = 2 pi u2, about the ellipse's centre a.
// The ellipse (Guillen et al. 2017, "Area-Preserving Parameterizations for Spherical Ellipses", section 3): with t the disk's
// direction towards x's foot, a bisects c + r t and c - r t; its long half-axis b lies across, tan b = half chord / |y|
// where a meets the disk's plane at y. A facing disk fills its cap; of an oblique one some directions miss, see what is
// behind it and are worth that: no pdf changes. Outside the caps it reaches nothing.
#pragma once

#include "arms/sampler.h"

namespace crescent {

template <class F> struct LightSolidAngle {
    static constexpr std::string_view name = "light-solid-angle";
    const LocalDisk<F>* disks;
    int count;
    explicit LightSolidAngle(const Site<F>& site) : disks(site.disks), count(site.disk_count) {}

    Drawn<F> sample(Vec3<F> wo, Vec2<F> u) const {
        const F zero = number<F>(0), one = number<F>(1);
        Vec3<F> wi = {zero, zero, one};
        F p = zero, below = zero;
        for (int k = 0; k < count; ++k) {  // u.x in [below, below + power) chooses disk k and is stretched back to [0,1)
            const F above = k + 1 < count ? below + disks[k].power : one;
            const auto chosen = (u.x >= below) & (u.x < above);
            const Cap cap = cap_of(disks[k]);
            const Vec3<F> w = on_cap(cap, {(u.x - below) / larger(above - below, number<F>(1e-30)), u.y});
            wi = {select(chosen, w.x, wi.x), select(chosen, w.y, wi.y), select(chosen, w.z, wi.z)};
            p = select(chosen, (above - below) * cap.density, p);
            below = above;
        }
        if (count == 1) return {wi, {p}};
        return {wi, {select(p > zero, larger(pdf(wo, wi).v, p), zero)}};  // caps may overlap; p alone where rounding puts wi outside its own
    }

    PerSr<F> pdf(Vec3<F> /*wo*/, Vec3<F> wi) const {
        F sum = number<F>(0), below = number<F>(0);
        for (int k = 0; k < count; ++k) {
            const F share = k + 1 < count ? disks[k].power : number<F>(1) - below;
            const Cap cap = cap_of(disks[k]);
            const Vec3<F> off = wi - cap.axis;
            sum = sum + select(number<F>(0.5) * dot(off, off) <= cap.height, share * cap.density, number<F>(0));
            below = below + share;
        }
        return {sum};
    }

private:
    struct Cap {
        Vec3<F> axis;
        F height;   // 1 - cos b
        F density;  // 1/sr; 0 where x is behind a one-sided disk
    };

    static Cap cap_of(const LocalDisk<F>& d) {
        const F zero = number<F>(0), one = number<F>(1), tiny = number<F>(1e-30);
        const F c = dot(d.to_center, d.normal);
        const auto lit = (c < zero) | ((c > zero) & (d.two_sided > zero));
        const Vec3<F> across = d.to_center - d.normal * c;  // from x's foot in the disk's plane to the centre
        const F length2 = dot(across, across);
        const Vec3<F> t = across * (d.radius / sqrt(larger(length2, tiny)));
        const Vec3<F> near = d.to_center - t, far = d.to_center + t;
        const Vec3<F> axis = normalize(near * (one / sqrt(larger(dot(near, near), tiny))) + far * (one / sqrt(larger(dot(far, far), tiny))));
        const F v = dot(axis, d.normal);
        const Vec3<F> y = axis * (select(lit, c, one) / select(abs(v) > zero, v, one));
        const Vec3<F> off = y - d.to_center;
        const F tan2 = larger(sqr(d.radius) - dot(off, off), zero) / larger(dot(y, y), tiny);
        const F cos = one / sqrt(one + tan2);
        const F height = larger(tan2 / (one + tan2) / (one + cos), number<F>(1e-12));
        return {axis, height, select(lit, number<F>(0.5 / pi) / height, zero)};
    }

    static Vec3<F> on_cap(const Cap& cap, Vec2<F> u) {
        const F drop = u.x * cap.height;  // 1 - cos
        const F sin = sqrt(drop * (number<F>(2) - drop));
        const SinCos<F> phi = sincos_turns(u.y);
        return frame_about(cap.axis).to_world({sin * phi.cos, sin * phi.sin, number<F>(1) - drop});
    }
};

}  // namespace crescent
