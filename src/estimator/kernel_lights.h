// One pack of pixels before the disk lights: what a sample that may meet one finds, and what is gathered from those
// that do. Included by kernel_body.h alone.
#pragma once

#include "estimator/disk_hit.h"
#include "estimator/kernel.h"

namespace crescent {
namespace CRESCENT_ISA {

template <class F> F load_lanes(const std::vector<float>& a, std::size_t at) { return load_as<F>(a.data() + at); }
template <class F> UintOf<F> load_lanes(const std::vector<std::uint32_t>& a, std::size_t at) {
    return load_as<UintOf<F>>(a.data() + at);
}
template <class F> Vec3<F> load_lanes(
    const std::vector<float>& x, const std::vector<float>& y, const std::vector<float>& z, std::size_t at) {
    return {load_lanes<F>(x, at), load_lanes<F>(y, at), load_lanes<F>(z, at)};
}

/// The part that samples which meet a disk add to.
template <class F> struct Met {
    F disk_g[most_disks], disk_g_lobe[most_disks];
    UintOf<F> hits{0u};
    bool any = false;  // in the current block
};

/// The disk lights as one pack of pixels sees them.
template <class F> struct Lights {
    using U = UintOf<F>;
    const Sites& sites;
    std::size_t at;
    std::size_t disk_count;
    LocalDisk<F> disks[most_disks];
    FacingDisk<F> facing[most_disks];
    DiskCone<F> cones[most_disks];
    Met<F> met;

    [[gnu::noinline]] Lights(const Sites& all, std::size_t first)
        : sites(all), at(first), disk_count(all.disks.size()) {
        for (std::size_t k = 0; k < disk_count; ++k) {
            const DiskArrays& d = sites.disks[k];
            disks[k] = LocalDisk<F>(load_lanes<F>(d.cx, d.cy, d.cz, at), load_lanes<F>(d.nx, d.ny, d.nz, at),
                F(d.radius), F(d.two_sided ? 1.0f : 0.0f), F(d.power));
            facing[k] = FacingDisk<F>(disks[k]);
            cones[k] = DiskCone<F>(facing[k]);
            met.disk_g[k] = met.disk_g_lobe[k] = number<F>(0);
        }
    }

    /// Samples that may have met a disk: nearest disk first, then what stands before it. Returns X where one was met.
    template <class D> [[gnu::noinline]] F meet(const D& drawn, F g, F lobe, F x, MaskOf<F> up) {
        const Vec3<F> wi = drawn.wi;
        const F far = number<F>(1e30);
        F nearest = far;
        F index = number<F>(-1);
        for (std::size_t k = 0; k < disk_count; ++k) {
            F v;
            const auto hit = meets_disk(facing[k], drawn, k, disk_count == 1, v);
            const F t = select(hit, facing[k].k / select(hit, v, number<F>(1)), far);
            const auto nearer = is_nearer(t, nearest);
            index = select(nearer, F(static_cast<float>(k)), index);
            nearest = select(nearer, t, nearest);
        }
        const Vec3<F> o = load_lanes<F>(sites.px, sites.py, sites.pz, at);
        const Frame<F> frame = {load_lanes<F>(sites.tx, sites.ty, sites.tz, at),
            load_lanes<F>(sites.bx, sites.by, sites.bz, at), load_lanes<F>(sites.nx, sites.ny, sites.nz, at)};
        const Vec3<F> d = frame.to_world(wi);
        const U own = load_lanes<F>(sites.shape, at);
        F seen = select(up & (nearest < far), number<F>(1), number<F>(0));
        for (const OccluderF& body : sites.occluders) {
            const auto other = select(own == U(body.shape), number<F>(0), number<F>(1)) > number<F>(0);
            seen = select(other & blocked_by(body, o, d, nearest), number<F>(0), seen);
        }
        for (std::size_t k = 0; k < disk_count; ++k) {
            const auto this_one = (index == F(static_cast<float>(k))) & (seen > number<F>(0));
            const F gk = select(this_one, g, number<F>(0));
            met.disk_g[k] = met.disk_g[k] + gk;
            met.disk_g_lobe[k] = met.disk_g_lobe[k] + gk * lobe;
            const F xk = g * (load_lanes<F>(sites.disks[k].d, at) + lobe * load_lanes<F>(sites.disks[k].s, at));
            x = select(this_one, xk, x);
        }
        met.hits = plus_one_where(seen > number<F>(0), met.hits);
        met.any = true;
        return x;
    }
};

}  // namespace CRESCENT_ISA
}  // namespace crescent
