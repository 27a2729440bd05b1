// Positions are kept in float relative to the scene's origin, directions in the local frame, one group of shading
// points for each lobe. Arrays end with copies of the last shading point, so that every pack is full; `count` is the
// number without padding.
#include "render/shading_points.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/vec.h"
#include "scene/shadow.h"

namespace crescent {

namespace {

double reflected(const Rgb& light, const Rgb& albedo) {
    return luminance(Rgb{light[0] * albedo[0], light[1] * albedo[1], light[2] * albedo[2]});
}

void put(std::vector<float>& x, std::vector<float>& y, std::vector<float>& z, std::size_t i, Vec3d v) {
    x[i] = static_cast<float>(v.x);
    y[i] = static_cast<float>(v.y);
    z[i] = static_cast<float>(v.z);
}

std::size_t whole_packs(std::size_t shading_points) {
    return (shading_points + widest_pack - 1) / widest_pack * widest_pack;
}

std::array<float, 3> single(Vec3d v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// Stores the numbers of a light that is not a disk, in the order of LocalLight.
void put_light(LightArrays& to, std::size_t i, const Light& light, Vec3d x, const Frame<double>& frame) {
    with_light_kind(to.kind, [&]<class Kind>() {
        const LightNumbers n = std::get<Kind>(light.form).numbers(x, frame);
        const std::array vectors = {n.a, n.b, n.c};
        for (std::size_t k = 0; k < 3; ++k)
            put(to.numbers[3 * k], to.numbers[3 * k + 1], to.numbers[3 * k + 2], i, vectors[k]);
        for (std::size_t k = 0; k < n.number.size(); ++k) to.numbers[9 + k][i] = static_cast<float>(n.number[k]);
    });
}

/// Returns the luminance as float, never -0, so that X is never -0.
float worth(double y) { return static_cast<float>(y + 0.0); }

}  // namespace

OccluderF occluder_about(const Occluder& o, Vec3d origin) {
    const BodyNumbers n = std::visit([&](const auto& body) { return body.numbers(origin); }, o.body);
    return {.kind = o.body.index(),
        .shape = static_cast<std::uint32_t>(o.shape),
        .a = single(n.a),
        .b = single(n.b),
        .c = single(n.c),
        .radius = static_cast<float>(n.radius),
        .offset = static_cast<float>(n.offset)};
}

std::vector<TileBox> tiles_of(int width, int height) {
    constexpr int side = 64;  // pixels: small enough to distribute evenly, large enough to fill packs
    std::vector<TileBox> tiles;
    for (int y = 0; y < height; y += side)
        for (int x = 0; x < width; x += side)
            tiles.push_back({x, y, std::min(x + side, width), std::min(y + side, height)});
    return tiles;
}

ShadingPoints empty_points(const Scene& scene, int lobe) {
    ShadingPoints shading_points;
    shading_points.lobe = lobe;
    shading_points.around = scene.surroundings();
    shading_points.has_faces = scene.has_meshes();
    shading_points.has_alpha_textures = scene.has_alpha_textures();
    double total = 0;
    for (const Light& light : scene.lights()) total += light.power();
    const auto share = [&](const Light& light) { return total > 0 ? static_cast<float>(light.power() / total) : 0.0f; };
    for (const Light& light : scene.lights()) {
        if (const auto* disk = std::get_if<lights::Disk>(&light.form)) {
            DiskArrays& arrays = shading_points.disks.emplace_back();
            arrays.radius = static_cast<float>(disk->radius);
            arrays.two_sided = disk->two_sided;
            arrays.power = share(light);
            arrays.radiance = light.radiance;
        } else {
            LightArrays& arrays = shading_points.others.emplace_back();
            arrays.kind = light.form.index();
            arrays.power = share(light);
            arrays.radiance = light.radiance;
        }
    }
    for (const Occluder& o : scene.occluders()) shading_points.occluders.push_back(occluder_about(o, scene.origin()));
    return shading_points;
}

Shading::Shading(const Scene& scene, const Surface& point_surface) : surface(point_surface) {
    for (std::size_t c = 0; c < 3; ++c) lambert[c] = surface.rho_d[c] / pi;
    const double fill = reflected(scene.fill(), surface.rho_d);
    fill_d = worth(fill / pi);
    fill_s = worth(surface.tinted(scene.fill()) * surface.rho_s);
    for (const Light& light : scene.lights()) {
        disk_d.push_back(worth(reflected(light.radiance, surface.rho_d) / pi));
        disk_s.push_back(worth(surface.tinted(light.radiance) * surface.rho_s));
    }
    for (std::size_t c = 0; c < 3; ++c) {
        around_d[c] = worth(luminance_weights[c] * lambert[c]);
        around_s[c] = worth(luminance_weights[c] * surface.tint[c] * surface.rho_s);
    }
}

void ShadingPoints::add(const Scene& scene, std::uint32_t pixel_index, const Hit& hit, const Shading& shading) {
    const Frame<double> frame = frame_about(hit.n);
    const std::size_t i = count++;
    pixel[i] = pixel_index;
    shape[i] = static_cast<std::uint32_t>(hit.shape);
    put(wox, woy, woz, i, frame.to_local(hit.wo));
    s[i] = static_cast<float>(shading.surface.s);
    alpha[i] = static_cast<float>(shading.surface.alpha);
    diffuse[i] = static_cast<float>(luminance(shading.surface.rho_d));
    rho_s[i] = static_cast<float>(shading.surface.rho_s);
    put(px, py, pz, i, scene.ray_start(hit));
    if (has_alpha_textures) alpha_texel[i] = static_cast<float>(scene.texels(hit).alpha);
    if (has_faces) put(face_x, face_y, face_z, i, hit.is_mesh() ? frame.to_local(hit.face) : Vec3d{0, 0, 1});
    put(tx, ty, tz, i, frame.t);
    put(bx, by, bz, i, frame.b);
    put(nx, ny, nz, i, frame.n);
    fill_d[i] = shading.fill_d;
    fill_s[i] = shading.fill_s;
    for (std::size_t k = 0; k < disks.size(); ++k) {
        const lights::Disk& light = std::get<lights::Disk>(scene.lights()[k].form);
        put(disks[k].cx, disks[k].cy, disks[k].cz, i, frame.to_local(light.center - hit.x));
        put(disks[k].nx, disks[k].ny, disks[k].nz, i, frame.to_local(light.normal));
        disks[k].d[i] = shading.disk_d[k];
        disks[k].s[i] = shading.disk_s[k];
    }
    for (std::size_t k = 0; k < others.size(); ++k) {
        const std::size_t light = disks.size() + k;
        put_light(others[k], i, scene.lights()[light], hit.x, frame);
        others[k].d[i] = shading.disk_d[light];
        others[k].s[i] = shading.disk_s[light];
    }
    for (std::size_t c = 0; around && c < 3; ++c) {
        around_d[c][i] = shading.around_d[c];
        around_s[c][i] = shading.around_s[c];
    }
    lambert[i] = shading.lambert;
    rho_s_exact[i] = shading.surface.rho_s;
    tint[i] = shading.surface.tint;
}

template <class Work> void ShadingPoints::each_array(Work&& work) {
    const auto each = [&](auto&... arrays) { (work(arrays), ...); };
    each(pixel, shape, wox, woy, woz, s, alpha, diffuse, rho_s, px, py, pz, tx, ty, tz, bx, by, bz, nx, ny, nz, fill_d,
        fill_s, lambert, rho_s_exact, tint);
    for (std::size_t c = 0; around && c < 3; ++c) each(around_d[c], around_s[c]);
    if (has_faces) each(face_x, face_y, face_z);
    if (has_alpha_textures) each(alpha_texel);
    for (DiskArrays& k : disks) each(k.cx, k.cy, k.cz, k.nx, k.ny, k.nz, k.d, k.s);
    for (LightArrays& k : others) {
        for (std::vector<float>& numbers : k.numbers) each(numbers);
        each(k.d, k.s);
    }
}

void ShadingPoints::reserve(std::size_t shading_points) {
    each_array([&](auto& array) { array.reserve(whole_packs(shading_points)); });
}

void ShadingPoints::grow(std::size_t extra) {
    each_array([&](auto& array) { array.resize(count + extra); });
}

void ShadingPoints::pad() {
    if (count == 0) return;
    each_array([&](auto& array) {
        array.resize(whole_packs(count));
        std::fill(array.begin() + static_cast<std::ptrdiff_t>(count), array.end(), array[count - 1]);
        array.shrink_to_fit();
    });
}

void ShadingPoints::take_s(const Scene& scene) {
    for (std::size_t i = 0; i < shape.size(); ++i) {
        const Surface surface = scene.surface_of_shape(shape[i]);
        s[i] = static_cast<float>(surface.s);
        const double texel = has_alpha_textures ? static_cast<double>(alpha_texel[i]) : 1;
        alpha[i] = static_cast<float>(surface.alpha * texel);
    }
}

std::size_t ShadingPoints::bytes_of_one() {
    std::size_t bytes = 0;
    each_array([&](auto& array) { bytes += sizeof(array[0]); });
    return bytes;
}

void ShadingPoints::cull_occluders(const Scene& scene) {
    if (around && (around->sky || around->triangles)) return;
    const auto range = [](const std::vector<float>& v) {
        const auto [lo, hi] = std::minmax_element(v.begin(), v.end());
        return std::pair(0.5 * (static_cast<double>(*lo) + *hi), 0.5 * (static_cast<double>(*hi) - *lo));
    };
    const auto [x, half_x] = range(px);
    const auto [y, half_y] = range(py);
    const auto [z, half_z] = range(pz);
    const auto round_up = [](double middle, double half) { return half + 0x1p-23 * (std::fabs(middle) + half); };
    const Extent extent = {
        scene.origin() + Vec3d{x, y, z}, {round_up(x, half_x), round_up(y, half_y), round_up(z, half_z)}};
    std::size_t occluder_count = 0;
    for (std::size_t k = 0; k < occluders.size(); ++k) {  // in the scene's order, as empty_points created them
        const bool clear = std::all_of(scene.lights().begin(), scene.lights().end(),
            [&](const Light& light) { return is_separated(scene.occluders()[k], extent, light.body()); });
        if (!clear) occluders[occluder_count++] = occluders[k];
    }
    occluders.resize(occluder_count);
}

namespace {

/// Groups the pixels of a tile by lobe. Neighbours mostly see the same surface and texel, whose shading is then cached.
class Sorter {
public:
    Sorter(const Scene& scene, const TileBox& tile)
        : scene_(scene),
          columns_(static_cast<std::size_t>(tile.x1 - tile.x0)),
          area_(columns_ * static_cast<std::size_t>(tile.y1 - tile.y0)) {}

    void next_row() {
        for (ShadingPoints& group : groups) group.grow(columns_);
    }

    void add(std::uint32_t pixel, const Hit& hit) {
        const Texels texels = scene_.texels(hit);
        if (!shading_ || hit.shape != shape_ || hit.reveal != reveal_ || hit.is_below != is_below_ ||
            texels != texels_) {
            shading_.emplace(scene_, scene_.surface(hit));
            shape_ = hit.shape;
            reveal_ = hit.reveal;
            is_below_ = hit.is_below;
            texels_ = texels;
        }
        const int lobe = shading_->surface.rho_s > 0 ? static_cast<int>(shading_->surface.brdf) : -1;
        auto group = std::find_if(groups.begin(), groups.end(), [&](const ShadingPoints& g) { return g.lobe == lobe; });
        if (group == groups.end()) {
            group = groups.insert(group, empty_points(scene_, lobe));
            group->reserve(area_);
            group->grow(columns_);
        }
        group->add(scene_, pixel, hit, *shading_);
    }

    std::vector<ShadingPoints> groups;

private:
    const Scene& scene_;
    std::size_t columns_, area_;  // pixels in a row, and in the tile
    std::optional<Shading> shading_;
    int shape_ = -1;
    bool reveal_ = false, is_below_ = false;
    Texels texels_;
};

}  // namespace

std::vector<ShadingPoints> shading_points_of(const Scene& scene, const TileBox& tile, std::int16_t* shape_map) {
    Sorter sorter(scene, tile);
    const int width = scene.image().width;
    for (int j = tile.y0; j < tile.y1; ++j) {
        sorter.next_row();
        for (int i = tile.x0; i < tile.x1; ++i) {
            const std::size_t index =
                static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i);
            const std::optional<Hit> hit = scene.primary(i, j);
            if (shape_map) shape_map[index] = static_cast<std::int16_t>(hit ? hit->shape : -1);
            if (hit) sorter.add(static_cast<std::uint32_t>(index), *hit);
        }
    }
    for (ShadingPoints& group : sorter.groups) {
        group.pad();
        group.cull_occluders(scene);
    }
    return std::move(sorter.groups);
}

}  // namespace crescent
