#include "estimator/sites.h"

#include <algorithm>

#include "films/film.h"
#include "scene/shadow.h"

namespace crescent {

namespace {

double reflected(const Rgb& light, const Rgb& albedo) {
    return luminance(Rgb{light[0] * albedo[0], light[1] * albedo[1], light[2] * albedo[2]});
}

void push(std::vector<float>& x, std::vector<float>& y, std::vector<float>& z, Vec3d v) {
    x.push_back(static_cast<float>(v.x));
    y.push_back(static_cast<float>(v.y));
    z.push_back(static_cast<float>(v.z));
}

std::array<float, 3> single(Vec3d v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

}  // namespace

std::vector<TileBox> tiles_of(int width, int height) {
    constexpr int side = 64;  // pixels: small enough to share out evenly, large enough to fill packs
    std::vector<TileBox> tiles;
    for (int y = 0; y < height; y += side)
        for (int x = 0; x < width; x += side) tiles.push_back({x, y, std::min(x + side, width), std::min(y + side, height)});
    return tiles;
}

Sites empty_sites(const Scene& scene, int lobe) {
    Sites sites;
    sites.lobe = lobe;
    ensure(scene.disks().size() <= 64, "the parser lets at most 64 disk lights through");
    double total = 0;
    for (const DiskLight& disk : scene.disks()) total += luminance(disk.radiance) * sqr(disk.radius);
    for (const DiskLight& disk : scene.disks()) {
        DiskArrays arrays;
        arrays.radius = static_cast<float>(disk.radius);
        arrays.two_sided = disk.two_sided;
        arrays.power = total > 0 ? static_cast<float>(luminance(disk.radiance) * sqr(disk.radius) / total) : 0.0f;
        sites.disks.push_back(std::move(arrays));
    }
    for (const Occluder& o : scene.occluders())
        sites.occluders.push_back({o.kind, static_cast<std::uint32_t>(o.shape), single(o.a), single(o.b), single(o.c), static_cast<float>(o.radius)});
    return sites;
}

void Sites::add(const Scene& scene, std::uint32_t pixel_index, const Hit& hit, const Surface& surface) {
    const Frame<double> frame = frame_about(hit.n);
    ++count;
    pixel.push_back(pixel_index);
    shape.push_back(static_cast<std::uint32_t>(hit.shape));
    push(wox, woy, woz, frame.to_local(hit.wo));
    s.push_back(static_cast<float>(surface.s));
    alpha.push_back(static_cast<float>(surface.alpha));
    diffuse.push_back(static_cast<float>(luminance(surface.rho_d)));
    rho_s.push_back(static_cast<float>(surface.rho_s));
    push(px, py, pz, hit.x);
    push(tx, ty, tz, frame.t);
    push(bx, by, bz, frame.b);
    push(nx, ny, nz, frame.n);
    const double fill = reflected(scene.fill(), surface.rho_d);
    fill_d.push_back(static_cast<float>(fill / pi));
    fill_s.push_back(static_cast<float>(luminance(scene.fill()) * surface.rho_s));
    pivot.push_back(static_cast<float>(fill));  // Lambert under the fill alone
    for (std::size_t k = 0; k < disks.size(); ++k) {
        const DiskLight& light = scene.disks()[k];
        push(disks[k].cx, disks[k].cy, disks[k].cz, frame.to_local(light.center - hit.x));
        push(disks[k].nx, disks[k].ny, disks[k].nz, frame.to_local(light.normal));
        disks[k].d.push_back(static_cast<float>(reflected(light.radiance, surface.rho_d) / pi));
        disks[k].s.push_back(static_cast<float>(luminance(light.radiance) * surface.rho_s));
    }
    rho_d.push_back(surface.rho_d);
    rho_s_exact.push_back(surface.rho_s);
}

template <class Work> void Sites::each_array(Work&& work) {
    const auto all = [&](auto&... arrays) { (work(arrays), ...); };
    all(pixel, shape, wox, woy, woz, s, alpha, diffuse, rho_s, px, py, pz, tx, ty, tz, bx, by, bz, nx, ny, nz, fill_d, fill_s, pivot);
    for (DiskArrays& k : disks) all(k.cx, k.cy, k.cz, k.nx, k.ny, k.nz, k.d, k.s);
}

void Sites::reserve(std::size_t sites) {
    const std::size_t full = (sites + widest_pack - 1) / widest_pack * widest_pack;
    each_array([&](auto& array) { array.reserve(full); });
    rho_d.reserve(full);
    rho_s_exact.reserve(full);
}

void Sites::pad() {
    const std::size_t full = (count + widest_pack - 1) / widest_pack * widest_pack;
    if (count > 0) each_array([&](auto& array) { array.resize(full, array.back()); });
}

void Sites::prune(const Scene& scene) {
    const auto range = [](const std::vector<float>& v) {
        const auto [lo, hi] = std::minmax_element(v.begin(), v.end());
        return std::pair(0.5 * (static_cast<double>(*lo) + *hi), 0.5 * (static_cast<double>(*hi) - *lo));
    };
    const auto [x, half_x] = range(px);
    const auto [y, half_y] = range(py);
    const auto [z, half_z] = range(pz);
    const Extent extent = {{x, y, z}, {half_x, half_y, half_z}};
    std::size_t kept = 0;
    for (std::size_t k = 0; k < occluders.size(); ++k) {  // in the scene's order, as empty_sites made them
        const bool clear = std::all_of(scene.disks().begin(), scene.disks().end(), [&](const DiskLight& disk) { return stands_clear(scene.occluders()[k], extent, disk); });
        if (!clear) occluders[kept++] = occluders[k];
    }
    occluders.resize(kept);
}

std::vector<Sites> sites_of(const Scene& scene, const TileBox& tile, std::int16_t* shape_map) {
    std::vector<Sites> groups;
    const int width = scene.experiment().image.width;
    for (int j = tile.y0; j < tile.y1; ++j) {
        for (int i = tile.x0; i < tile.x1; ++i) {
            const std::size_t index = static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i);
            const std::optional<Hit> hit = scene.primary(i, j);
            if (shape_map) shape_map[index] = static_cast<std::int16_t>(hit ? hit->shape : -1);
            if (!hit) continue;
            const Surface surface = scene.surface(*hit);
            const int lobe = surface.rho_s > 0 ? static_cast<int>(surface.brdf) : -1;
            auto group = std::find_if(groups.begin(), groups.end(), [&](const Sites& g) { return g.lobe == lobe; });
            if (group == groups.end()) {
                group = groups.insert(group, empty_sites(scene, lobe));
                group->reserve(static_cast<std::size_t>(tile.x1 - tile.x0) * static_cast<std::size_t>(tile.y1 - tile.y0));
            }
            group->add(scene, static_cast<std::uint32_t>(index), *hit, surface);
        }
    }
    for (Sites& group : groups) {
        group.pad();
        group.prune(scene);
    }
    return groups;
}

}  // namespace crescent
