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
    double at[Lanes<F>::count];
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
        AroundSums<F>& sums = *lights.around;
        const auto move = [](F& sum, LaneTotals<F>& total) {
            add_lanes(sum, total.at);
            sum = number<F>(0);
        };
        move(sums.g, around->g);
        move(sums.g_lobe, around->g_lobe);
        for (int c = 0; c < 3; ++c) {
            move(sums.rgb[c], around->rgb[c]);
            move(sums.rgb_lobe[c], around->rgb_lobe[c]);
        }
    }
    /// Writes the totals so far, including the partial block.
    void write(const Surrounded<F>& lights, Moments& out) const {
        LightTotals<F>::write(lights, out);
        const AroundSums<F>& sums = *lights.around;
        const auto put = [&](F sum, const LaneTotals<F>& total, std::vector<double>& to) {
            add_lanes(sum, total.at, to.data() + lights.at);
        };
        put(sums.g, around->g, out.around_g);
        put(sums.g_lobe, around->g_lobe, out.around_g_lobe);
        for (std::size_t c = 0; c < 3; ++c) {
            put(sums.rgb[c], around->rgb[c], out.around[c]);
            put(sums.rgb_lobe[c], around->rgb_lobe[c], out.around_lobe[c]);
        }
    }

private:
    template <class Work> void each(Work&& work) {
        work(around->g);
        work(around->g_lobe);
        for (int c = 0; c < 3; ++c) {
            work(around->rgb[c]);
            work(around->rgb_lobe[c]);
        }
    }
};

/// The lights and surroundings as one pack of pixels sees them.
template <class F> struct Surrounded : Lights<F> {
    using Room = SurroundedRoom<F>;
    using Totals = SurroundedTotals<F>;
    using typename Lights<F>::First;
    using Lights<F>::shading_points, Lights<F>::at, Lights<F>::met;
    AroundSums<F>* around;

    [[gnu::noinline]] Surrounded(const ShadingPoints& points, std::size_t first, SurroundedRoom<F>& room)
        : Lights<F>(points, first, room), around(room.sums) {
        const F zero = number<F>(0);
        *around = {zero, zero, {zero, zero, zero}, {zero, zero, zero}};
    }

    /// Returns X of a sample with known g and lobe; x is the part from the fill.
    template <class D>
    [[gnu::always_inline]] F gather(const First& /*around*/, const D& drawn, F g, F lobe, F x, MaskOf<F> up) {
        return any(up) ? resolve(drawn, g, lobe, x, up) : x;
    }

    /// Returns which directions are below the triangle of the surface point, though above its smooth normal.
    [[gnu::always_inline]] MaskOf<F> below_face(Vec3<F> wi) const {
        if (!shading_points.has_faces) return number<F>(1) < number<F>(0);
        return dot(load_lanes<F>(shading_points.face_x, shading_points.face_y, shading_points.face_z, at), wi) <=
            number<F>(0);
    }

    /// What each direction meets first: a light of one radiance, or an emitting triangle, or a texel of the sky.
    struct Seen {
        F light, open;  // open: 1 if one of them is met and nothing hides it
        MaskOf<F> of_lights;
        LaneIntegers<F> triangle, texel;
        MaskOf<F> lit() const { return open > number<F>(0); }
    };
    template <class D> [[gnu::noinline]] Seen look(const D& drawn, MaskOf<F> up) const {
        const F zero = number<F>(0), one = number<F>(1);
        const Surroundings& scene = *shading_points.around;
        const auto lights = this->nearest_light(drawn);
        const auto ray = this->ray_of(drawn.wi);
        const Vec3<F> to_eye = ray.o - Vec3<F>{F(scene.eye.x), F(scene.eye.y), F(scene.eye.z)};
        // What each direction meets first, as far as lights, the sky and triangles that emit are concerned.
        LaneArray<F> seen(select(up, one, zero)), nearest(lights.distance);
        LaneIntegers<F> triangle{UintOf<F>(no_triangle)};
        const bool sky = has_sky(scene);
        if (has_meshes(scene)) look_past_meshes(drawn, ray, seen, nearest, triangle);
        const F distance = nearest.pack();
        const auto met_one = distance < number<F>(Lights<F>::far);
        // Nothing that is closer than 1e-5 of the distance to the camera hides the sky.
        const F lo = select(met_one, distance, sqrt(dot(to_eye, to_eye))) * number<F>(1e-5);
        F open = select(seen.pack() > zero, number<F>(sky ? 1 : 0), zero);
        open = select((seen.pack() > zero) & met_one, one, open);
        if (any(open > zero)) open = this->seen_past_bodies(ray, lo, distance * number<F>(1 - 1e-5), open);
        // A light of one radiance, unless a triangle is before it.
        const MaskOf<F> of_lights = (distance == lights.distance) & met_one & !on_triangle(triangle);
        return {lights.light, open, of_lights, triangle, texels(drawn, ray.d, (open > zero) & !of_lights, triangle)};
    }
    /// Adds the samples to the sums and returns their X; x is the part from the fill.
    template <class D> [[gnu::noinline]] F add_seen(const D& /*drawn*/, const Seen& seen, F g, F lobe, F x) {
        const F zero = number<F>(0);
        x = this->add_light(seen.light, select(seen.of_lights, seen.open, zero), g, lobe, x);
        const auto varies = seen.lit() & !seen.of_lights;
        x = select(varies, add(radiance(seen, varies), select(varies, g, zero), lobe), x);
        met.hits = plus_one_where(seen.lit(), met.hits);
        met.any = true;
        return x;
    }

private:
    template <class D> [[gnu::noinline]] F resolve(const D& drawn, F g, F lobe, F x, MaskOf<F> up) {
        return add_seen(drawn, look(drawn, up), g, lobe, x);
    }

    static MaskOf<F> on_triangle(const LaneIntegers<F>& triangle) {
        LaneArray<F> on;
        for (std::size_t l = 0; l < Lanes<F>::count; ++l) on.at[l] = triangle.at[l] == no_triangle ? 0.0f : 1.0f;
        return on.pack() > number<F>(0);
    }

    /// Sets seen to 0 where a triangle that does not emit is met first; `triangle` and `nearest` to one that emits.
    template <class D, class Ray> void look_past_meshes(
        const D& drawn, const Ray& ray, LaneArray<F>& seen, LaneArray<F>& nearest, LaneIntegers<F>& triangle) const {
        const LaneArray<F> ox(ray.o.x), oy(ray.o.y), oz(ray.o.z), dx(ray.d.x), dy(ray.d.y), dz(ray.d.z);
        LaneIntegers<F> aimed{UintOf<F>(no_triangle)};
        if constexpr (requires { drawn.triangle; }) aimed = LaneIntegers<F>(drawn.triangle);
        for (std::size_t l = 0; l < Lanes<F>::count; ++l) {
            if (!(seen.at[l] > 0)) continue;
            const MeshesBefore before = meshes_before(*shading_points.around, {ox.at[l], oy.at[l], oz.at[l]},
                {dx.at[l], dy.at[l], dz.at[l]}, nearest.at[l], aimed.at[l]);
            if (before.hidden) seen.at[l] = 0;
            if (before.triangle != no_triangle) {
                triangle.at[l] = before.triangle;
                nearest.at[l] = before.distance;
            }
        }
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

    /// The texel of the sky in the world's direction d, in lanes of `where` that meet no triangle.
    template <class D>
    LaneIntegers<F> texels(const D& drawn, Vec3<F> d, MaskOf<F> where, const LaneIntegers<F>& triangle) const {
        const LaneArray<F> dx(d.x), dy(d.y), dz(d.z), on(select(where, number<F>(1), number<F>(0)));
        LaneIntegers<F> out{UintOf<F>(no_texel)};
        if constexpr (requires { drawn.texel; }) out = LaneIntegers<F>(drawn.texel);
        for (std::size_t l = 0; l < Lanes<F>::count; ++l)
            if (on.at[l] > 0 && triangle.at[l] == no_triangle && out.at[l] == no_texel)
                out.at[l] = sky_texel(*shading_points.around, {dx.at[l], dy.at[l], dz.at[l]});
        return out;
    }

    /// The radiance of the triangle, or of the texel of the sky, in lanes of `where`; else 0.
    Vec3<F> radiance(const Seen& seen, MaskOf<F> where) const {
        const LaneArray<F> on(select(where, number<F>(1), number<F>(0)));
        LaneArray<F> r, g, b;
        for (std::size_t l = 0; l < Lanes<F>::count; ++l) {
            float rgb[3] = {0, 0, 0};
            if (on.at[l] > 0) {
                if (seen.triangle.at[l] != no_triangle)
                    triangle_radiance(*shading_points.around, seen.triangle.at[l], rgb);
                else texel_radiance(*shading_points.around, seen.texel.at[l], rgb);
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
