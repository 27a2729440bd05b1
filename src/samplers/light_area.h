// light-area: next-event estimation (NEE), a light by area, chosen by its power: Y(L) times its largest projected area,
// pi r^2 for a disk. A point y is uniform over the light's area A (for a ball, over the part visible from x):
//   p_A = 1/A;  p = p_A |y - x|^2 / cos(light).  Of a disk y = c + r sqrt(u1) (cos 2 pi u2, sin 2 pi u2).
// Other kinds of light: scene/lights/. It reaches only the lights: under a fill it is biased by the fill, unless
// another technique adds that.
#pragma once

#include "samplers/sampler.h"

namespace crescent {

template <class F> struct LightArea {
    static constexpr std::string_view name = "light-area";
    static constexpr CaseSurface check_cases[] = {{.lambert = true, .light = "disk"},
        {.lambert = true, .light = "overhead disk"}, {.lambert = true, .light = "two disks"},
        {.lobe = "phong", .sharpness = 8, .lambert = true, .light = "disk"}, {.lambert = true, .light = "fill + disk"}};
    static constexpr SamplerDoc manual = {.label = "light-area (NEE)",
        .summary = "next-event estimation: a point of a light, even over its area",
        .formula = R"(\frac{\lvert y-x\rvert^2}{A\cos\theta_y})",
        .draw = "even over a light's area",
        .axis = "the light",
        .misses = light_arm_misses,
        .reaches = {.fill = false, .sky = false, .triangles = false},
        .check_cases = check_cases,
        .gl = {3.5e-6, "as light-solid-angle, over cos at the light"}};
    static ExpectedBehaviour theory(const CasePoint& point) { return theory_of_light_arm(point); }
    const LocalDisk<F>* disks;
    int count;
    const LocalLight<F>* others;  // after the disks
    int other_count;

    /// A disk with the values that are constant over samples.
    struct Aim {
        Vec3<F> center, t, b;  // t and b span the disk: as long as its radius
        F scale;               // p = scale |y|^3: r^2 / cos(light) = |y|^3 / |c.n|; 0 if no emitting side faces x

        Aim() = default;
        explicit Aim(const LocalDisk<F>& d) {
            const Frame<F> frame = frame_about(d.normal);
            const auto is_lit = d.faces();
            center = d.to_center;
            t = frame.t * d.radius;
            b = frame.b * d.radius;
            scale = select(
                is_lit, number<F>(1 / pi) / (sqr(d.radius) * select(is_lit, abs(d.along), number<F>(1))), number<F>(0));
        }
    };
    Aim first;  // most scenes have only one

    explicit LightArea(const ShadingPoint<F>& shading_point)
        : disks(shading_point.disks),
          count(shading_point.disk_count),
          others(shading_point.others),
          other_count(shading_point.other_count) {
        if (count > 0) first = Aim(disks[0]);
    }

    [[gnu::always_inline]] DrawnToDisk<F> sample(Vec3<F> /*wo*/, Vec2<F> u) const {
        const F zero = number<F>(0), one = number<F>(1);
        if (count == 1 && other_count == 0) {
            const Drawn<F> draw = on_disk(first, u);
            return {draw, zero, draw.pdf.v > zero};
        }
        Drawn<F> draw = {{zero, zero, one}, {zero}};
        F start = zero, chosen_light = zero;
        for (int k = 0; k < count;
            ++k) {  // u.x in [start, start + power) chooses disk k and is stretched back to [0,1)
            const F end = k + 1 < count + other_count ? start + disks[k].power : one;
            const auto is_chosen = (u.x >= start) & (u.x < end);
            const Drawn<F> one_disk = on_disk(Aim(disks[k]), {(u.x - start) / (end - start), u.y});
            draw.wi = {select(is_chosen, one_disk.wi.x, draw.wi.x), select(is_chosen, one_disk.wi.y, draw.wi.y),
                select(is_chosen, one_disk.wi.z, draw.wi.z)};
            draw.pdf.v = select(is_chosen, (end - start) * one_disk.pdf.v, draw.pdf.v);
            chosen_light = select(is_chosen, number<F>(k), chosen_light);
            start = end;
        }
        for (int k = 0; k < other_count; ++k) {
            const F end = k + 1 < other_count ? start + others[k].power : one;
            const auto is_chosen = (u.x >= start) & (u.x < end);
            const Aimed<F> light_draw =
                on_other(others[k], {(u.x - start) / larger(end - start, number<F>(1e-30)), u.y});
            draw.wi = {select(is_chosen, light_draw.wi.x, draw.wi.x), select(is_chosen, light_draw.wi.y, draw.wi.y),
                select(is_chosen, light_draw.wi.z, draw.wi.z)};
            draw.pdf.v = select(is_chosen, (end - start) * light_draw.pdf, draw.pdf.v);
            chosen_light = select(is_chosen, number<F>(count + k), chosen_light);
            start = end;
        }
        const auto meets_light = draw.pdf.v > zero;
        // Disks may lie one behind another: every one that wi meets could have drawn it.
        draw.pdf.v = select(meets_light, draw.pdf.v + density_of_others(draw.wi, chosen_light), zero);
        return {draw, chosen_light, meets_light};
    }

    [[gnu::always_inline]] PerSr<F> pdf(Vec3<F> /*wo*/, Vec3<F> wi) const {
        return {density_of_others(wi, number<F>(-1))};
    }

private:
    /// Returns the density with which the disks except one draw wi. Whether wi meets a disk is tested as in the
    /// estimator (meets_disk in render/disk_hit.h), bit for bit, so that value and density of a sample are consistent.
    [[gnu::always_inline]] F density_of_others(Vec3<F> wi, F but) const {
        F sum = number<F>(0);
        for (int k = 0; k < count; ++k) {
            const LocalDisk<F>& d = disks[k];
            const F c = d.along, v = dot(wi, d.normal);
            const Vec3<F> offset = wi * c - d.to_center * v;
            const auto meets = (dot(offset, offset) <= sqr(d.radius) * (v * v)) & d.faces() & (c * v > number<F>(0)) &
                !(but == number<F>(k));
            const F t = c / select(meets, v, number<F>(1));
            sum = sum + select(meets, d.power * density(d, sqr(t), abs(v)).v, number<F>(0));
        }
        for (int k = 0; k < other_count; ++k) {
            const F one_light = density_of(others[k], wi);
            sum = sum + select(but == number<F>(count + k), number<F>(0), others[k].power * one_light);
        }
        return sum;
    }

    [[gnu::noinline]] static Aimed<F> on_other(const LocalLight<F>& light, Vec2<F> u) {
        Aimed<F> out = {{number<F>(0), number<F>(0), number<F>(1)}, number<F>(0)};
        with_light_kind(light.kind, [&]<class Kind>() { out = Kind::by_area(light, u); });
        return out;
    }
    [[gnu::noinline]] static F density_of(const LocalLight<F>& light, Vec3<F> wi) {
        F out = number<F>(0);
        with_light_kind(light.kind, [&]<class Kind>() { out = Kind::area_pdf(light, wi); });
        return out;
    }

    [[gnu::always_inline]] static PerSr<F> density(const LocalDisk<F>& d, F r2, F cos_light) {
        return per_sr(PerM2<F>{number<F>(1 / pi) / sqr(d.radius)}, r2, cos_light);
    }

    [[gnu::always_inline]] static Drawn<F> on_disk(const Aim& aim, Vec2<F> u) {
        const F r = sqrt(u.x);
        const SinCos<F> phi = sincos_turns(u.y);
        const Vec3<F> y = aim.center + aim.t * (r * phi.cos) + aim.b * (r * phi.sin);
        const F r2 = dot(y, y), distance = sqrt(r2);
        return {y * (number<F>(1) / distance), {aim.scale * r2 * distance}};
    }
};

}  // namespace crescent
