// Emitters for shading points with surroundings (scene/surroundings.h): the lights of constant radiance as in
// kernel_lights.h, and light that varies, whose sums are kept by colour channel. Trees and tables are searched lane by
// lane in code that is not part of a kernel, so its bits are the same on every instruction set. Included only by
// kernel_body.h.
#pragma once

#include "math/simd/lanes.h"
#include "render/kernel_lights.h"

namespace crescent::inline render {
namespace CRESCENT_ISA {

/// Sums over the samples that met light that varies: g, g * lobe, and both times L by channel.
template <class N> struct AroundSums {
    N g, g_lobe;
    N rgb[3], rgb_lobe[3];
};

/// One array of doubles for each sum.
template <class F> struct LaneTotals {
    double at[Lanes<F>::count];
};

template <class F> struct SurroundedRoom : LightRoom<F> {
    AroundSums<F>* sums;
    AroundSums<LaneTotals<F>>* totals;

    SurroundedRoom(const ShadingPoints& shading_points, std::byte* at) : LightRoom<F>(shading_points, at) {
        at += memory_of_light * shading_points.light_count();
        sums = LightRoom<F>::template take<AroundSums<F>>(at, 1);
        totals = LightRoom<F>::template take<AroundSums<LaneTotals<F>>>(at, 1);
        static_assert(sizeof *sums + sizeof *totals + 256 <= memory_of_light);
    }
};

template <class F> struct Surrounded;

template <class F> struct SurroundedTotals : LightTotals<F> {
    AroundSums<LaneTotals<F>>* around;

    explicit SurroundedTotals(SurroundedRoom<F>& room) : LightTotals<F>(room), around(room.totals) {
        each([](LaneTotals<F>& total) {
            for (double& lane : total.at) lane = 0;
        });
    }
    /// Adds the block's sums and clears them.
    void take(Surrounded<F>& lights) {
        const bool any = lights.met.any;
        LightTotals<F>::take(lights);
        if (!any) return;
        AroundSums<F>& of = *lights.around;
        const auto move = [](F& sum, LaneTotals<F>& total) {
            add_lanes(sum, total.at);
            sum = number<F>(0);
        };
        move(of.g, around->g), move(of.g_lobe, around->g_lobe);
        for (int c = 0; c < 3; ++c) move(of.rgb[c], around->rgb[c]), move(of.rgb_lobe[c], around->rgb_lobe[c]);
    }
    /// Writes the totals so far, including the partial block.
    void write(const Surrounded<F>& lights, Moments& out) const {
        LightTotals<F>::write(lights, out);
        const AroundSums<F>& of = *lights.around;
        const auto put = [&](F sum, const LaneTotals<F>& total, std::vector<double>& to) {
            add_lanes(sum, total.at, to.data() + lights.at);
        };
        put(of.g, around->g, out.around_g), put(of.g_lobe, around->g_lobe, out.around_g_lobe);
        for (std::size_t c = 0; c < 3; ++c) {
            put(of.rgb[c], around->rgb[c], out.around[c]);
            put(of.rgb_lobe[c], around->rgb_lobe[c], out.around_lobe[c]);
        }
    }

private:
    template <class Work> void each(Work&& work) {
        work(around->g), work(around->g_lobe);
        for (int c = 0; c < 3; ++c) work(around->rgb[c]), work(around->rgb_lobe[c]);
    }
};

/// The lights and surroundings as one pack of pixels sees them.
template <class F> struct Surrounded : Lights<F> {
    using Room = SurroundedRoom<F>;
    using Totals = SurroundedTotals<F>;
    using typename Lights<F>::First;
    using Lights<F>::shading_points, Lights<F>::at, Lights<F>::met;
    AroundSums<F>* around;

    [[gnu::noinline]] Surrounded(const ShadingPoints& all, std::size_t first, SurroundedRoom<F>& room)
        : Lights<F>(all, first, room), around(room.sums) {
        const F zero = number<F>(0);
        *around = {zero, zero, {zero, zero, zero}, {zero, zero, zero}};
    }

    /// Returns X of a sample with known g and lobe; x is the part from the fill.
    template <class D>
    [[gnu::always_inline]] F gather(const First& /*around*/, const D& drawn, F g, F lobe, F x, MaskOf<F> up) {
        return any(up) ? resolve(drawn, g, lobe, x, up) : x;
    }

private:
    template <class D> [[gnu::noinline]] F resolve(const D& drawn, F g, F lobe, F x, MaskOf<F> up) {
        const F zero = number<F>(0), one = number<F>(1);
        const auto nearest = this->nearest_light(drawn);
        const auto lit = nearest.distance < number<F>(Lights<F>::far);
        const auto ray = this->ray_of(drawn.wi);
        const Surroundings& scene = *shading_points.around;
        // Nothing that is closer than 1e-5 of the distance to the camera hides the sky.
        const Vec3<F> to_eye = ray.o - Vec3<F>{F(scene.eye.x), F(scene.eye.y), F(scene.eye.z)};
        const F lo = select(lit, nearest.distance, sqrt(dot(to_eye, to_eye))) * number<F>(1e-5);
        const F hi = nearest.distance * number<F>(1 - 1e-5);
        F seen = select(up, one, zero);
        seen = this->seen_past_bodies(ray, lo, hi, seen);
        x = this->add_light(nearest.light, seen, g, lobe, x);
        const auto open = (seen > zero) & !lit;
        const Vec3<F> l = radiance(drawn, ray.d, open);
        const auto shines = open & (number<F>(scene.sky ? 1 : 0) > zero);
        x = select(shines, add(l, select(shines, g, zero), lobe), x);
        met.hits = plus_one_where((seen > zero) & (lit | shines), met.hits);
        met.any = true;
        return x;
    }

    /// Adds the sums of light L, and returns its X.
    [[gnu::always_inline]] F add(Vec3<F> l, F g, F lobe) {
        const F channel[3] = {l.x, l.y, l.z};
        F worth = number<F>(0);
        for (std::size_t c = 0; c < 3; ++c) {
            const F gl = g * channel[c];
            around->rgb[c] = around->rgb[c] + gl;
            around->rgb_lobe[c] = around->rgb_lobe[c] + gl * lobe;
            const F per_radiance =
                load_lanes<F>(shading_points.around_d[c], at) + lobe * load_lanes<F>(shading_points.around_s[c], at);
            worth = worth + channel[c] * per_radiance;
        }
        around->g = around->g + g;
        around->g_lobe = around->g_lobe + g * lobe;
        return g * worth;
    }

    /// The sky's radiance in the world's direction d where `open`, else 0.
    template <class D> [[gnu::always_inline]] Vec3<F> radiance(const D& drawn, Vec3<F> d, MaskOf<F> open) const {
        const LaneArray<F> wanted(select(open, number<F>(1), number<F>(0))), dx(d.x), dy(d.y), dz(d.z);
        LaneIntegers<F> known{UintOf<F>(no_texel)};
        if constexpr (requires { drawn.texel; }) known = LaneIntegers<F>(drawn.texel);
        LaneArray<F> r, g, b;
        for (std::size_t l = 0; l < Lanes<F>::count; ++l) {
            float rgb[3] = {0, 0, 0};
            if (wanted.at[l] > 0)
                sky_radiance(*shading_points.around, known.at[l], {dx.at[l], dy.at[l], dz.at[l]}, rgb);
            r.at[l] = rgb[0], g.at[l] = rgb[1], b.at[l] = rgb[2];
        }
        return {r.pack(), g.pack(), b.pack()};
    }
};

}  // namespace CRESCENT_ISA
}  // namespace crescent::inline render
