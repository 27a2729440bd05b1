// Emitters for shading points with surroundings (scene/surroundings.h): the lights of constant radiance as in
// kernel_lights.h, and light that varies, whose sums are kept by colour channel. Trees and tables are searched lane by
// lane in code that is not part of a kernel, so its bits are the same on every instruction set. Included only by
// kernel_body.h.
#pragma once

#include "math/simd/scalar.h"
#include "render/kernel_lights.h"

namespace crescent {
namespace CRESCENT_ISA {

/// Sums over the samples that met light that varies: g, g * lobe, and both times L by channel.
template <class N> struct AroundSums {
    N g, g_lobe;
    N rgb[3], rgb_lobe[3];
};

/// One array of doubles for each sum.
template <class F> struct LaneTotals {
    double lanes[Lanes<F>::count];
};

template <class F> struct SurroundedRoom : LightRoom<F> {
    AroundSums<F>* sums;
    AroundSums<LaneTotals<F>>* totals;

    SurroundedRoom(const ShadingPoints& shading_points, std::byte* memory) : LightRoom<F>(shading_points, memory) {
        memory += memory_of_light * shading_points.light_count();
        sums = LightRoom<F>::template take<AroundSums<F>>(memory, 1);
        totals = LightRoom<F>::template take<AroundSums<LaneTotals<F>>>(memory, 1);
        static_assert(sizeof *sums + sizeof *totals + 256 <= memory_of_light);
    }
};

template <class F> struct Surrounded;

template <class F> struct SurroundedTotals : LightTotals<F> {
    AroundSums<LaneTotals<F>>* totals;

    explicit SurroundedTotals(SurroundedRoom<F>& room) : LightTotals<F>(room), totals(room.totals) {
        each([](LaneTotals<F>& total) {
            for (double& lane : total.lanes) lane = 0;
        });
    }
    /// Adds the block's sums and clears them.
    void take(Surrounded<F>& lights) {
        const bool any = lights.hit_sums.any;
        LightTotals<F>::take(lights);
        if (!any) return;
        AroundSums<F>& sums = *lights.sums;
        const auto move = [](F& sum, LaneTotals<F>& total) {
            add_lanes(sum, total.lanes);
            sum = number<F>(0);
        };
        move(sums.g, totals->g);
        move(sums.g_lobe, totals->g_lobe);
        for (int c = 0; c < 3; ++c) {
            move(sums.rgb[c], totals->rgb[c]);
            move(sums.rgb_lobe[c], totals->rgb_lobe[c]);
        }
    }
    /// Writes the totals so far, including the partial block.
    void write(const Surrounded<F>& lights, Moments& out) const {
        LightTotals<F>::write(lights, out);
        const AroundSums<F>& sums = *lights.sums;
        const auto put = [&](F sum, const LaneTotals<F>& total, std::vector<double>& to) {
            add_lanes(sum, total.lanes, to.data() + lights.start);
        };
        put(sums.g, totals->g, out.around_g);
        put(sums.g_lobe, totals->g_lobe, out.around_g_lobe);
        for (std::size_t c = 0; c < 3; ++c) {
            put(sums.rgb[c], totals->rgb[c], out.around_rgb[c]);
            put(sums.rgb_lobe[c], totals->rgb_lobe[c], out.around_rgb_lobe[c]);
        }
    }

private:
    template <class Work> void each(Work&& work) {
        work(totals->g);
        work(totals->g_lobe);
        for (int c = 0; c < 3; ++c) {
            work(totals->rgb[c]);
            work(totals->rgb_lobe[c]);
        }
    }
};

/// The lights and surroundings as one pack of pixels sees them.
template <class F> struct Surrounded : Lights<F> {
    using Room = SurroundedRoom<F>;
    using Totals = SurroundedTotals<F>;
    using typename Lights<F>::First;
    using Lights<F>::shading_points, Lights<F>::start, Lights<F>::hit_sums;
    AroundSums<F>* sums;

    [[gnu::noinline]] Surrounded(const ShadingPoints& points, std::size_t first, SurroundedRoom<F>& room)
        : Lights<F>(points, first, room), sums(room.sums) {
        const F zero = number<F>(0);
        *sums = {zero, zero, {zero, zero, zero}, {zero, zero, zero}};
    }

    /// Returns X of a sample with known g and lobe; x is the part from the fill.
    template <class D> [[gnu::always_inline]] F gather(
        const First& /*first_cone*/, const D& draw, F g, F lobe, F x, MaskOf<F> can_contribute) {
        return any(can_contribute) ? resolve(draw, g, lobe, x, can_contribute) : x;
    }

    /// Returns which directions are below the triangle of the surface point, though above its smooth normal.
    [[gnu::always_inline]] MaskOf<F> below_face(Vec3<F> wi) const {
        if (!shading_points.has_faces) return number<F>(1) < number<F>(0);
        return dot(load_lanes<F>(shading_points.face_x, shading_points.face_y, shading_points.face_z, start), wi) <=
            number<F>(0);
    }

    /// What each direction meets first: a light of one radiance, or an emitting triangle, or a texel of the sky.
    struct Seen {
        F light, open;  // open: 1 if one of them is met and nothing hides it
        MaskOf<F> of_lights;
        LaneIntegers<F> triangle, texel;
        MaskOf<F> lit() const { return open > number<F>(0); }
    };
    template <class D> [[gnu::noinline]] Seen look(const D& draw, MaskOf<F> can_contribute) const {
        const F zero = number<F>(0), one = number<F>(1);
        const Surroundings& scene = *shading_points.around;
        const auto lights = this->nearest_light(draw);
        const auto ray = this->ray_of(draw.wi);
        const Vec3<F> to_eye = ray.o - Vec3<F>{F(scene.eye.x), F(scene.eye.y), F(scene.eye.z)};
        // What each direction meets first, as far as lights, the sky and triangles that emit are concerned.
        LaneArray<F> visibility(select(can_contribute, one, zero)), nearest(lights.distance);
        LaneIntegers<F> triangle{UintOf<F>(no_triangle)};
        const bool sky = has_sky(scene);
        if (has_meshes(scene)) look_past_meshes(draw, ray, visibility, nearest, triangle);
        const F distance = nearest.pack();
        const auto meets_emitter = distance < number<F>(Lights<F>::far);
        // Nothing that is closer than 1e-5 of the distance to the camera hides the sky.
        const F lo = select(meets_emitter, distance, sqrt(dot(to_eye, to_eye))) * number<F>(1e-5);
        F open = select(visibility.pack() > zero, number<F>(sky ? 1 : 0), zero);
        open = select((visibility.pack() > zero) & meets_emitter, one, open);
        if (any(open > zero)) open = this->seen_past_bodies(ray, lo, distance * number<F>(1 - 1e-5), open);
        // A light of one radiance, unless a triangle is before it.
        const MaskOf<F> of_lights = (distance == lights.distance) & meets_emitter & !on_triangle(triangle);
        return {lights.light, open, of_lights, triangle, texels(draw, ray.d, (open > zero) & !of_lights, triangle)};
    }
    /// Adds the samples to the sums and returns their X; x is the part from the fill.
    template <class D> [[gnu::noinline]] F add_seen(const D& /*draw*/, const Seen& hit, F g, F lobe, F x) {
        const F zero = number<F>(0);
        x = this->add_light(hit.light, select(hit.of_lights, hit.open, zero), g, lobe, x);
        const auto varies = hit.lit() & !hit.of_lights;
        x = select(varies, add(radiance(hit, varies), select(varies, g, zero), lobe), x);
        hit_sums.hits = plus_one_where(hit.lit(), hit_sums.hits);
        hit_sums.any = true;
        return x;
    }

private:
    template <class D> [[gnu::noinline]] F resolve(const D& draw, F g, F lobe, F x, MaskOf<F> can_contribute) {
        return add_seen(draw, look(draw, can_contribute), g, lobe, x);
    }

    static MaskOf<F> on_triangle(const LaneIntegers<F>& triangle) {
        LaneArray<F> flags;
        for (std::size_t l = 0; l < Lanes<F>::count; ++l) flags.at[l] = triangle.at[l] == no_triangle ? 0.0f : 1.0f;
        return flags.pack() > number<F>(0);
    }

    /// Sets visibility to 0 where a triangle that does not emit is met first; `triangle` and `nearest` to one that
    /// emits.
    template <class D, class Ray> void look_past_meshes(const D& draw, const Ray& ray, LaneArray<F>& visibility,
        LaneArray<F>& nearest, LaneIntegers<F>& triangle) const {
        const LaneArray<F> ox(ray.o.x), oy(ray.o.y), oz(ray.o.z), dx(ray.d.x), dy(ray.d.y), dz(ray.d.z);
        LaneIntegers<F> aimed_triangle{UintOf<F>(no_triangle)};
        if constexpr (requires { draw.triangle; }) aimed_triangle = LaneIntegers<F>(draw.triangle);
        for (std::size_t l = 0; l < Lanes<F>::count; ++l) {
            if (!(visibility.at[l] > 0)) continue;
            const MeshesBefore meshes = meshes_before(*shading_points.around, {ox.at[l], oy.at[l], oz.at[l]},
                {dx.at[l], dy.at[l], dz.at[l]}, nearest.at[l], aimed_triangle.at[l]);
            if (meshes.is_hidden) visibility.at[l] = 0;
            if (meshes.triangle != no_triangle) {
                triangle.at[l] = meshes.triangle;
                nearest.at[l] = meshes.distance;
            }
        }
    }

    /// Adds the sums of light L, and returns its X.
    [[gnu::always_inline]] F add(Vec3<F> l, F g, F lobe) {
        const F channel[3] = {l.x, l.y, l.z};
        F worth = number<F>(0);
        for (std::size_t c = 0; c < 3; ++c) {
            const F gl = g * channel[c];
            sums->rgb[c] = sums->rgb[c] + gl;
            sums->rgb_lobe[c] = sums->rgb_lobe[c] + gl * lobe;
            const F per_radiance = load_lanes<F>(shading_points.around_d[c], start) +
                lobe * load_lanes<F>(shading_points.around_s[c], start);
            worth = worth + channel[c] * per_radiance;
        }
        sums->g = sums->g + g;
        sums->g_lobe = sums->g_lobe + g * lobe;
        return g * worth;
    }

    /// The texel of the sky in the world's direction d, in lanes of `where` that meet no triangle.
    template <class D>
    LaneIntegers<F> texels(const D& draw, Vec3<F> d, MaskOf<F> where, const LaneIntegers<F>& triangle) const {
        const LaneArray<F> dx(d.x), dy(d.y), dz(d.z), flags(select(where, number<F>(1), number<F>(0)));
        LaneIntegers<F> out{UintOf<F>(no_texel)};
        if constexpr (requires { draw.texel; }) out = LaneIntegers<F>(draw.texel);
        for (std::size_t l = 0; l < Lanes<F>::count; ++l)
            if (flags.at[l] > 0 && triangle.at[l] == no_triangle && out.at[l] == no_texel)
                out.at[l] = sky_texel(*shading_points.around, {dx.at[l], dy.at[l], dz.at[l]});
        return out;
    }

    /// The radiance of the triangle, or of the texel of the sky, in lanes of `where`; else 0.
    Vec3<F> radiance(const Seen& hit, MaskOf<F> where) const {
        const LaneArray<F> flags(select(where, number<F>(1), number<F>(0)));
        LaneArray<F> r, g, b;
        for (std::size_t l = 0; l < Lanes<F>::count; ++l) {
            float rgb[3] = {0, 0, 0};
            if (flags.at[l] > 0) {
                if (hit.triangle.at[l] != no_triangle)
                    triangle_radiance(*shading_points.around, hit.triangle.at[l], rgb);
                else texel_radiance(*shading_points.around, hit.texel.at[l], rgb);
            }
            r.at[l] = rgb[0];
            g.at[l] = rgb[1];
            b.at[l] = rgb[2];
        }
        return {r.pack(), g.pack(), b.pack()};
    }
};

}  // namespace CRESCENT_ISA
}  // namespace crescent
