// Emitters that can be counted: one pack of pixels before the lights, and what samples gather from those that they
// meet. The kernel takes its emitters as a policy (Emitters in kernel_body.h); this is the one for lights of constant
// radiance, whose sums are kept per light. Included only by kernel_body.h.
#pragma once

#include <new>

#include "render/disk_hit.h"
#include "render/kernel.h"

namespace crescent {
namespace CRESCENT_ISA {

template <class F> F load_lanes(const std::vector<float>& a, std::size_t index) { return load_as<F>(a.data() + index); }
template <class F> UintOf<F> load_lanes(const std::vector<std::uint32_t>& a, std::size_t index) {
    return load_as<UintOf<F>>(a.data() + index);
}
template <class F> Vec3<F> load_lanes(
    const std::vector<float>& x, const std::vector<float>& y, const std::vector<float>& z, std::size_t index) {
    return {load_lanes<F>(x, index), load_lanes<F>(y, index), load_lanes<F>(z, index)};
}

/// Sums that change only for samples that meet a light.
template <class F> struct LightHitSums {
    F* light_g;
    F* light_g_lobe;
    UintOf<F> hits{0u};
    bool any = false;  // in the current block
};

/// Room for the lights of one pack of pixels, in the memory passed to a kernel.
template <class F> struct LightRoom {
    std::size_t count;
    LocalDisk<F>* disks;
    FacingDisk<F>* facing;
    LocalLight<F>* others;
    DiskCone<F>* cones;
    F *met_g, *met_g_lobe;
    double *total_g, *total_g_lobe;  // lane l of light k at k * lanes + l

    LightRoom(const ShadingPoints& shading_points, std::byte* memory)
        : count(shading_points.light_count()),
          disks(take<LocalDisk<F>>(memory, shading_points.disks.size())),
          facing(take<FacingDisk<F>>(memory, shading_points.disks.size())),
          others(take<LocalLight<F>>(memory, shading_points.others.size())),
          cones(take<DiskCone<F>>(memory, count)),
          met_g(take<F>(memory, count)),
          met_g_lobe(take<F>(memory, count)),
          total_g(take<double>(memory, count * Lanes<F>::count)),
          total_g_lobe(take<double>(memory, count * Lanes<F>::count)) {
        constexpr std::size_t of_disk = sizeof(LocalDisk<F>) + sizeof(FacingDisk<F>), of_other = sizeof(LocalLight<F>);
        static_assert((of_disk > of_other ? of_disk : of_other) + sizeof(DiskCone<F>) + 2 * sizeof(F) +
                    2 * sizeof(double) * Lanes<F>::count + 128 <=
                memory_of_light,
            "a kernel's memory holds each light, and what alignment takes");
    }

protected:
    template <class T> static T* take(std::byte*& memory, std::size_t elements) {
        const std::size_t misalignment = reinterpret_cast<std::uintptr_t>(memory) % alignof(T);
        memory += misalignment ? alignof(T) - misalignment : 0;
        T* const first = reinterpret_cast<T*>(memory);
        for (std::size_t k = 0; k < elements; ++k) ::new (static_cast<void*>(first + k)) T;
        memory += elements * sizeof(T);
        return first;
    }
};

template <class F> struct Lights;

/// Sets lane l of `to` to from[l] + partial[l], in double.
template <class F> CRESCENT_INLINE void add_lanes(F partial, const double* __restrict from, double* __restrict to) {
    float lanes[Lanes<F>::count];
    store(partial, lanes);
    for (std::size_t l = 0; l < Lanes<F>::count; ++l) to[l] = from[l] + static_cast<double>(lanes[l]);
}
/// Adds partial[lane] to sum[lane].
template <class F> CRESCENT_INLINE void add_lanes(F partial, double* sum) {
    float lanes[Lanes<F>::count];
    store(partial, lanes);
    for (std::size_t l = 0; l < Lanes<F>::count; ++l) sum[l] += static_cast<double>(lanes[l]);
}

/// Totals in double of the samples that met each light.
template <class F> struct LightTotals {
    static constexpr std::size_t count = Lanes<F>::count;
    double *g, *g_lobe;  // lane l of light k at k * count + l

    explicit LightTotals(LightRoom<F>& room) : g(room.total_g), g_lobe(room.total_g_lobe) {
        for (std::size_t element = 0; element < room.count * count; ++element) g[element] = g_lobe[element] = 0;
    }
    /// Adds the block's sums and clears them.
    void take(Lights<F>& lights) {
        LightHitSums<F>& hit_sums = lights.hit_sums;
        for (std::size_t k = 0; hit_sums.any && k < lights.light_count; ++k) {
            add_lanes(hit_sums.light_g[k], g + k * count);
            add_lanes(hit_sums.light_g_lobe[k], g_lobe + k * count);
            hit_sums.light_g[k] = hit_sums.light_g_lobe[k] = number<F>(0);
        }
        hit_sums.any = false;
    }
    /// Writes the totals so far, including the partial block.
    void write(const Lights<F>& lights, Moments& out) const {
        for (std::size_t k = 0; k < lights.light_count; ++k) {
            add_lanes(lights.hit_sums.light_g[k], g + k * count, out.light_g[k].data() + lights.start);
            add_lanes(lights.hit_sums.light_g_lobe[k], g_lobe + k * count, out.light_g_lobe[k].data() + lights.start);
        }
        store(lights.hit_sums.hits, out.hits.data() + lights.start);
    }
};

/// The lights as one pack of pixels sees them: disks first.
template <class F> struct Lights {
    using U = UintOf<F>;
    using Room = LightRoom<F>;
    using Totals = LightTotals<F>;
    using First = DiskCone<F>;  // around the first light; most scenes have only one
    const ShadingPoints& shading_points;
    std::size_t start;
    std::size_t disk_count, light_count;
    LocalDisk<F>* disks;
    FacingDisk<F>* facing;
    LocalLight<F>* others;
    DiskCone<F>* cones;
    LightHitSums<F> hit_sums;

    [[gnu::noinline]] Lights(const ShadingPoints& points, std::size_t first, LightRoom<F>& room)
        : shading_points(points),
          start(first),
          disk_count(points.disks.size()),
          light_count(points.light_count()),
          disks(room.disks),
          facing(room.facing),
          others(room.others),
          cones(room.cones),
          hit_sums{room.met_g, room.met_g_lobe} {
        for (std::size_t k = 0; k < disk_count; ++k) {
            const DiskArrays& d = shading_points.disks[k];
            disks[k] = LocalDisk<F>(load_lanes<F>(d.cx, d.cy, d.cz, start), load_lanes<F>(d.nx, d.ny, d.nz, start),
                F(d.radius), F(d.two_sided ? 1.0f : 0.0f), F(d.power));
            facing[k] = FacingDisk<F>(disks[k]);
            cones[k] = DiskCone<F>(facing[k]);
        }
        for (std::size_t k = disk_count; k < light_count; ++k) {
            LocalLight<F>& light = others[k - disk_count];
            light = light_at(shading_points.others[k - disk_count]);
            with_light_kind(light.kind,
                [&]<class Kind>() { cones[k] = DiskCone<F>(light.a, Kind::radius2(light), Kind::shines(light)); });
        }
        for (std::size_t k = 0; k < light_count; ++k) hit_sums.light_g[k] = hit_sums.light_g_lobe[k] = number<F>(0);
    }

    First first() const { return light_count > 0 ? cones[0] : DiskCone<F>{}; }
    /// Sets what samplers that aim at lights need of them.
    void show(ShadingPoint<F>& shading_point) const {
        shading_point.disks = disks;
        shading_point.disk_count = static_cast<int>(disk_count);
        shading_point.others = others;
        shading_point.other_count = static_cast<int>(light_count - disk_count);
        if (!shading_points.around) return;
        shading_point.around = shading_points.around.get();
        shading_point.position = position();
        shading_point.frame = frame();
    }

    /// Returns X of a sample with known g and lobe; x is the part from the fill.
    template <class D> [[gnu::always_inline]] F gather(
        const First& first_cone, const D& draw, F g, F lobe, F x, MaskOf<F> can_contribute) {
        if (light_count == 0) return x;
        if constexpr (requires { draw.meets_light; }) {
            if (any(can_contribute)) x = resolve_light_hit(draw, g, lobe, x, can_contribute);
        } else {
            auto is_near = first_cone.holds(draw.wi);
            for (std::size_t k = 1; k < light_count; ++k) is_near = is_near | cones[k].holds(draw.wi);
            if (any(is_near & can_contribute)) [[unlikely]]
                x = resolve_light_hit(draw, g, lobe, x, can_contribute);
        }
        return x;
    }

    LocalLight<F> light_at(const LightArrays& from) const {
        const auto& n = from.numbers;
        LocalLight<F> out;
        out.kind = from.kind;
        out.power = F(from.power);
        out.a = load_lanes<F>(n[0], n[1], n[2], start);
        out.b = load_lanes<F>(n[3], n[4], n[5], start);
        out.c = load_lanes<F>(n[6], n[7], n[8], start);
        for (std::size_t k = 0; k < out.number.size(); ++k) out.number[k] = load_lanes<F>(n[9 + k], start);
        return out;
    }

    /// The light that each direction meets, and 1 where no body hides it.
    struct Seen {
        F light, open;
        MaskOf<F> lit() const { return open > number<F>(0); }
    };
    /// Finds the nearest light, then tests the bodies before it.
    template <class D> [[gnu::always_inline]] Seen look(const D& draw, MaskOf<F> can_contribute) const {
        const Met nearest = nearest_light(draw);
        const F visibility = select(can_contribute & (nearest.distance < number<F>(far)), number<F>(1), number<F>(0));
        const WorldRay ray = ray_of(draw.wi);
        return {nearest.light,
            seen_past_bodies(
                ray, nearest.distance * number<F>(1e-5), nearest.distance * number<F>(1 - 1e-5), visibility)};
    }
    /// Returns X if a light was met; x is the part from the fill.
    template <class D> [[gnu::always_inline]] F add_seen(const D& /*draw*/, const Seen& hit, F g, F lobe, F x) {
        x = add_light(hit.light, hit.open, g, lobe, x);
        hit_sums.hits = plus_one_where(hit.lit(), hit_sums.hits);
        hit_sums.any = true;
        return x;
    }

    /// Handles samples that may have met a light. Returns X if one was met.
    template <class D>
    [[gnu::noinline]] F resolve_light_hit(const D& draw, F g, F lobe, F x, MaskOf<F> can_contribute) {
        return add_seen(draw, look(draw, can_contribute), g, lobe, x);
    }

protected:
    static constexpr double far = 1e30;

    /// The nearest light of each sample; the distance is `far`, and the light -1, if none is met.
    struct Met {
        F distance, light;
    };
    template <class D> [[gnu::always_inline]] Met nearest_light(const D& draw) const {
        const F none = number<F>(far);
        F nearest = none;
        F index = number<F>(-1);
        for (std::size_t k = 0; k < disk_count; ++k) {
            F v;
            const auto hit = meets_disk(facing[k], draw, k, light_count == 1, v);
            const F t = select(hit, facing[k].k / select(hit, v, number<F>(1)), none);
            const auto nearer = is_nearer(t, nearest);
            index = select(nearer, F(static_cast<float>(k)), index);
            nearest = select(nearer, t, nearest);
        }
        for (std::size_t k = disk_count; k < light_count; ++k) {
            F t;
            const auto hit = meets_light(others[k - disk_count], draw, k, t);
            const auto nearer = hit & is_nearer(t, nearest);
            index = select(nearer, F(static_cast<float>(k)), index);
            nearest = select(nearer, t, nearest);
        }
        return {nearest, index};
    }

    /// A direction in the world, from the surface point.
    struct WorldRay {
        Vec3<F> o, d;
    };
    [[gnu::always_inline]] WorldRay ray_of(Vec3<F> wi) const { return {position(), frame().to_world(wi)}; }
    Vec3<F> position() const { return load_lanes<F>(shading_points.px, shading_points.py, shading_points.pz, start); }
    Frame<F> frame() const {
        return {load_lanes<F>(shading_points.tx, shading_points.ty, shading_points.tz, start),
            load_lanes<F>(shading_points.bx, shading_points.by, shading_points.bz, start),
            load_lanes<F>(shading_points.nx, shading_points.ny, shading_points.nz, start)};
    }

    /// Returns `visibility`, with 0 where a body crosses the ray between lo and hi.
    [[gnu::always_inline]] F seen_past_bodies(const WorldRay& ray, F lo, F hi, F visibility) const {
        const U own_shape = load_lanes<F>(shading_points.shape, start);
        for (const OccluderF& body : shading_points.occluders) {
            const auto is_other = select(own_shape == U(body.shape), number<F>(0), number<F>(1)) > number<F>(0);
            visibility = select(is_other & blocked_by(body, ray.o, ray.d, lo, hi), number<F>(0), visibility);
        }
        return visibility;
    }

    /// Adds the samples that met a light. Returns their X, else x.
    [[gnu::always_inline]] F add_light(F index, F visibility, F g, F lobe, F x) {
        for (std::size_t k = 0; k < light_count; ++k) {
            const auto meets_k = (index == F(static_cast<float>(k))) & (visibility > number<F>(0));
            const F gk = select(meets_k, g, number<F>(0));
            hit_sums.light_g[k] = hit_sums.light_g[k] + gk;
            hit_sums.light_g_lobe[k] = hit_sums.light_g_lobe[k] + gk * lobe;
            const bool disk = k < disk_count;
            const std::vector<float>& d_of = disk ? shading_points.disks[k].d : shading_points.others[k - disk_count].d;
            const std::vector<float>& s_of = disk ? shading_points.disks[k].s : shading_points.others[k - disk_count].s;
            const F xk = g * (load_lanes<F>(d_of, start) + lobe * load_lanes<F>(s_of, start));
            x = select(meets_k, xk, x);
        }
        return x;
    }
};

}  // namespace CRESCENT_ISA
}  // namespace crescent
