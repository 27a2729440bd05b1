// light-solid-angle: next-event estimation (NEE), a light by solid angle: other kinds of light as in scene/lights/, a
// disk uniform over the smallest cap of directions about the disk's spherical ellipse that contains it. The disk is
// chosen by its power Y(L) pi r^2.
//   p = 1 / (2 pi (1 - cos b)),  cos = 1 - u1 (1 - cos b), phi = 2 pi u2, about the ellipse's centre a.
// The ellipse (Guillen et al. 2017, "Area-Preserving Parameterizations for Spherical Ellipses", section 3): with t the
// disk's direction away from x's foot in its plane, of its radius' length, a bisects c + t and c - t, and so meets the
// plane at
//   y = c + q t,  q = (|c-t| - |c+t|) / (|c-t| + |c+t|) = -4 c.t / (|c-t| + |c+t|)^2;
// its long half-axis b lies across, tan b = half chord / |y|, half chord^2 = r^2 (1 - q^2). A facing disk fills its
// cap; for an oblique one some directions miss, see what is behind it and have that value: no pdf changes. Outside the
// caps it reaches nothing. A direction is drawn as its difference e from a, which keeps its precision for a cap of any
// size: a + e meets the plane at y + (k e - (e.n) y) / v, k = c.n, v = (a + e).n.
#pragma once

#include "samplers/sampler.h"

namespace crescent {

template <class F> struct LightSolidAngle {
    static constexpr std::string_view name = "light-solid-angle";
    static constexpr CaseSurface check_cases[] = {{.lambert = true, .light = "disk"},
        {.lambert = true, .light = "overhead disk"}, {.lambert = true, .light = "two disks"},
        {.lobe = "phong", .sharpness = 8, .lambert = true, .light = "disk"}, {.lambert = true, .light = "fill + disk"}};
    static constexpr SamplerDoc manual = {.label = "light-solid-angle (NEE)",
        .summary = "next-event estimation: a direction to a light, even over its solid angle",
        .formula = R"(\frac{1}{\Omega})",
        .draw = R"(even over a light's solid angle $\Omega$; of a disk, over a cap around it)",
        .axis = "the light",
        .misses = light_arm_misses,
        .reaches = {.fill = false, .sky = false, .triangles = false},
        .check_cases = check_cases,
        .gl = {2.5e-6, "frames and a cap: square roots and divisions alone"}};
    static ExpectedBehaviour theory(const CasePoint& point) { return theory_of_light_arm(point); }
    const LocalDisk<F>* disks;
    int count;
    const LocalLight<F>* others;  // after the disks
    int other_count;

    struct Cap {
        Vec3<F> axis;
        F height;           // 1 - cos b
        F density;          // 1/sr; 0 if x is behind a one-sided disk
        Vec3<F> y, offset;  // where the axis meets the disk's plane, from x and from the disk's centre
    };
    Cap first;  // most scenes have only one

    explicit LightSolidAngle(const ShadingPoint<F>& shading_point)
        : disks(shading_point.disks),
          count(shading_point.disk_count),
          others(shading_point.others),
          other_count(shading_point.other_count) {
        if (count > 0) first = cap_of(disks[0]);
    }

    DrawnToDisk<F> sample(Vec3<F> /*wo*/, Vec2<F> u) const {
        const F zero = number<F>(0), one = number<F>(1);
        if (count == 1 && other_count == 0) return towards(0, first, u);
        DrawnToDisk<F> draw = {{{zero, zero, one}, {zero}}, zero, zero > zero};
        F start = zero;
        for (int k = 0; k < count;
            ++k) {  // u.x in [start, start + power) chooses disk k and is stretched back to [0,1)
            const F end = k + 1 < count + other_count ? start + disks[k].power : one;
            const auto is_chosen = (u.x >= start) & (u.x < end);
            const DrawnToDisk<F> w =
                towards(k, cap_of(disks[k]), {(u.x - start) / larger(end - start, number<F>(1e-30)), u.y});
            draw.wi = {select(is_chosen, w.wi.x, draw.wi.x), select(is_chosen, w.wi.y, draw.wi.y),
                select(is_chosen, w.wi.z, draw.wi.z)};
            draw.pdf.v = select(is_chosen, (end - start) * w.pdf.v, draw.pdf.v);
            draw.disk = select(is_chosen, w.disk, draw.disk);
            draw.meets_light = (is_chosen & w.meets_light) | (draw.meets_light & !is_chosen);
            start = end;
        }
        for (int k = 0; k < other_count; ++k) {
            const F end = k + 1 < other_count ? start + others[k].power : one;
            const auto is_chosen = (u.x >= start) & (u.x < end);
            const Aimed<F> w = on_other(others[k], {(u.x - start) / larger(end - start, number<F>(1e-30)), u.y});
            draw.wi = {select(is_chosen, w.wi.x, draw.wi.x), select(is_chosen, w.wi.y, draw.wi.y),
                select(is_chosen, w.wi.z, draw.wi.z)};
            draw.pdf.v = select(is_chosen, (end - start) * w.pdf, draw.pdf.v);
            draw.disk = select(is_chosen, number<F>(count + k), draw.disk);
            draw.meets_light = (is_chosen & (w.pdf > zero)) | (draw.meets_light & !is_chosen);
            start = end;
        }
        // Caps may overlap: every one that contains wi could have drawn it.
        draw.pdf.v = select(draw.pdf.v > zero, draw.pdf.v + density_of_others(draw.wi, draw.disk), zero);
        return draw;
    }

    PerSr<F> pdf(Vec3<F> /*wo*/, Vec3<F> wi) const { return {density_of_others(wi, number<F>(-1))}; }

private:
    /// Returns the density with which the caps except one draw wi.
    F density_of_others(Vec3<F> wi, F but) const {
        F sum = number<F>(0), start = number<F>(0);
        for (int k = 0; k < count; ++k) {
            const F share = k + 1 < count + other_count ? disks[k].power : number<F>(1) - start;
            const Cap cap = count == 1 ? first : cap_of(disks[k]);
            const Vec3<F> offset = wi - cap.axis;
            const auto is_inside = (number<F>(0.5) * dot(offset, offset) <= cap.height) & !(but == number<F>(k));
            sum = sum + select(is_inside, share * cap.density, number<F>(0));
            start = start + share;
        }
        for (int k = 0; k < other_count; ++k) {
            const F share = k + 1 < other_count ? others[k].power : number<F>(1) - start;
            const F one_light = density_of(others[k], wi);
            sum = sum + select(but == number<F>(count + k), number<F>(0), share * one_light);
            start = start + share;
        }
        return sum;
    }

    [[gnu::noinline]] static Aimed<F> on_other(const LocalLight<F>& light, Vec2<F> u) {
        Aimed<F> out = {{number<F>(0), number<F>(0), number<F>(1)}, number<F>(0)};
        with_light_kind(light.kind, [&]<class Kind>() { out = Kind::by_angle(light, u); });
        return out;
    }
    [[gnu::noinline]] static F density_of(const LocalLight<F>& light, Vec3<F> wi) {
        F out = number<F>(0);
        with_light_kind(light.kind, [&]<class Kind>() { out = Kind::angle_pdf(light, wi); });
        return out;
    }

    static Cap cap_of(const LocalDisk<F>& d) {
        const F zero = number<F>(0), one = number<F>(1), tiny = number<F>(1e-30);
        const Vec3<F> centre_offset =
            d.to_center - d.normal * d.along;  // from x's foot in the disk's plane to the centre
        const Vec3<F> t = centre_offset * (d.radius / sqrt(larger(dot(centre_offset, centre_offset), tiny)));
        const Vec3<F> near = d.to_center - t, far = d.to_center + t;
        const F sum = sqrt(dot(near, near)) + sqrt(dot(far, far));
        const F q = number<F>(-4) * dot(d.to_center, t) / larger(sqr(sum), tiny);
        const Vec3<F> offset = t * q, y = d.to_center + offset;
        const F y2 = larger(dot(y, y), tiny);
        const F tan2 = larger(sqr(d.radius) * ((one - q) * (one + q)), zero) / y2;
        const F cos = one / sqrt(one + tan2);
        const F height = larger(tan2 / (one + tan2) / (one + cos), tiny);
        return {y * (one / sqrt(y2)), height, select(d.faces(), number<F>(0.5 / pi) / height, zero), y, offset};
    }

    DrawnToDisk<F> towards(int k, const Cap& cap, Vec2<F> u) const {
        const LocalDisk<F>& d = disks[k];
        const F drop = u.x * cap.height;  // 1 - cos
        const F sin = sqrt(drop * (number<F>(2) - drop));
        const SinCos<F> phi = sincos_turns(u.y);
        const Vec3<F> e = frame_about(cap.axis).to_world({sin * phi.cos, sin * phi.sin, -drop});
        const Vec3<F> wi = cap.axis + e;
        const F v = dot(wi, d.normal);
        const Vec3<F> miss = e * d.along - cap.y * dot(e, d.normal) + cap.offset * v;
        const MaskOf<F> meets_light = (dot(miss, miss) <= sqr(d.radius) * (v * v)) & (d.along * v > number<F>(0));
        return {{wi, {cap.density}}, number<F>(k), meets_light};
    }
};

}  // namespace crescent
