// light-area: next-event estimation (NEE), a disk light by area, the disk chosen by its power Y(L) pi r^2.
//   y = c + r sqrt(u1) (cos 2 pi u2, sin 2 pi u2);  p_A = 1/(pi r^2);  p = p_A |y - x|^2 / cos(light).
// It reaches nothing but the disks: under a fill it is wrong by the fill, unless another technique adds that.
#pragma once

#include "arms/sampler.h"

namespace crescent {

template <class F> struct LightArea {
    static constexpr std::string_view name = "light-area";
    const LocalDisk<F>* disks;
    int count;
    explicit LightArea(const Site<F>& site) : disks(site.disks), count(site.disk_count) {}

    [[gnu::always_inline]] Drawn<F> sample(Vec3<F> wo, Vec2<F> u) const {
        const F zero = number<F>(0), one = number<F>(1);
        Drawn<F> drawn = {{zero, zero, one}, {zero}};
        F below = zero;
        for (int k = 0; k < count; ++k) {  // u.x in [below, below + power) chooses disk k and is stretched back to [0,1)
            const F above = k + 1 < count ? below + disks[k].power : one;
            const auto chosen = (u.x >= below) & (u.x < above);
            const Drawn<F> one_disk = on_disk(disks[k], {(u.x - below) / (above - below), u.y});
            drawn.wi = {select(chosen, one_disk.wi.x, drawn.wi.x), select(chosen, one_disk.wi.y, drawn.wi.y), select(chosen, one_disk.wi.z, drawn.wi.z)};
            drawn.pdf.v = select(chosen, (above - below) * one_disk.pdf.v, drawn.pdf.v);
            below = above;
        }
        if (count > 1)  // disks may stand one behind another: every one that wi meets could have drawn it
            drawn.pdf.v = select(drawn.pdf.v > zero, larger(pdf(wo, drawn.wi).v, drawn.pdf.v), zero);
        return drawn;
    }

    [[gnu::always_inline]] PerSr<F> pdf(Vec3<F> /*wo*/, Vec3<F> wi) const {
        F sum = number<F>(0);
        for (int k = 0; k < count; ++k) {
            const LocalDisk<F>& d = disks[k];
            const F c = dot(d.to_center, d.normal), v = dot(wi, d.normal);
            const Vec3<F> off = wi * c - d.to_center * v;
            const auto met = (dot(off, off) <= sqr(d.radius * v)) & faces(d, c) & (c * v > number<F>(0));
            const F t = c / select(met, v, number<F>(1));
            sum = sum + select(met, d.power * density(d, sqr(t), abs(v)).v, number<F>(0));
        }
        return {sum};
    }

private:
    /// The surface stands before the emitting side.
    [[gnu::always_inline]] static auto faces(const LocalDisk<F>& d, F c) { return (c < number<F>(0)) | ((c > number<F>(0)) & (d.two_sided > number<F>(0))); }
    [[gnu::always_inline]] static PerSr<F> density(const LocalDisk<F>& d, F r2, F cos_light) {
        return per_sr(PerM2<F>{number<F>(1 / pi) / sqr(d.radius)}, r2, cos_light);
    }

    [[gnu::always_inline]] static Drawn<F> on_disk(const LocalDisk<F>& d, Vec2<F> u) {
        const F r = d.radius * sqrt(u.x);
        const SinCos<F> phi = sincos_turns(u.y);
        const Frame<F> about = frame_about(d.normal);
        const Vec3<F> y = d.to_center + about.t * (r * phi.cos) + about.b * (r * phi.sin);
        const F r2 = dot(y, y);
        const Vec3<F> wi = y * (number<F>(1) / sqrt(r2));
        const F v = abs(dot(wi, d.normal));
        const auto lit = faces(d, dot(d.to_center, d.normal)) & (v > number<F>(0));
        return {wi, {select(lit, density(d, r2, select(lit, v, number<F>(1))).v, number<F>(0))}};
    }
};

}  // namespace crescent
