// The geometry pixels of a tile as the kernels read them: one float array per quantity, one entry per pixel, in the
// local frame of each pixel (n = +z), padded so that whole packs can be loaded.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "scene/scene.h"

namespace crescent {

inline constexpr std::size_t widest_pack = 32;  // AVX-512: two vectors of 16
/// Memory that a kernel needs for each light of a scene, and for the light that varies, in bytes.
inline constexpr std::size_t memory_of_light = 4096;

/// A rectangle of pixels, x1 and y1 exclusive.
struct TileBox {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};
/// Returns the tiles of an image, row by row from the bottom.
std::vector<TileBox> tiles_of(int width, int height);

/// One disk light as each pixel sees it, and the value of a sample that meets it.
struct DiskArrays {
    std::vector<float> cx, cy, cz;  // from the surface to the centre, local, m
    std::vector<float> nx, ny, nz;  // the disk's normal, local
    std::vector<float> d, s;        // Y of L rho_d / pi and of L rho_s: X = (cos/p) (d + s lobe)
    float radius = 0;
    bool two_sided = false;
    float power = 0;  // Y(L) pi r^2, relative to all disks
    Rgb radiance{};   // W/(sr m^2)
};

/// A light that is not a disk as each pixel sees it (scene/lights/light_kind.h), and the value of a sample that meets
/// it.
struct LightArrays {
    std::size_t kind = 0;  // index in LightKinds
    std::array<std::vector<float>, local_numbers> numbers;
    std::vector<float> d, s;  // like DiskArrays::d, s
    float power = 0;
    Rgb radiance{};  // W/(sr m^2)
};

/// Constants of one surface: luminance of f L for the fill and for each disk light.
struct Shading {
    Surface surface;
    Rgb lambert{};  // like ShadingPoints, and the next two
    float fill_d = 0, fill_s = 0;
    std::vector<float> disk_d, disk_s;            // like DiskArrays, one per disk
    std::array<float, 3> around_d{}, around_s{};  // like ShadingPoints
    Shading(const Scene& scene, const Surface& point_surface);
};

/// Occluders in float, as the kernels test them: relative to the scene's origin, so that a scene far from (0, 0, 0)
/// keeps its precision.
struct OccluderF {
    std::size_t kind;  // index in Bodies
    std::uint32_t shape;
    std::array<float, 3> a, b, c;
    float radius;
    float offset;  // each kind's own, see scene/body.h
};
/// Converts to float, relative to `origin`.
OccluderF occluder_about(const Occluder& o, Vec3d origin);

/// Points of one BRDF kind. `lobe` is -1 where rho_s = 0.
struct ShadingPoints {
    int lobe = -1;
    std::size_t count = 0;                    // without padding
    std::vector<std::uint32_t> pixel, shape;  // index in the image, index of the shape
    std::vector<float> wox, woy, woz;
    std::vector<float> s, alpha, diffuse, rho_s;  // diffuse: Y(rho_d)
    std::vector<float> px, py, pz;                // where rays from the surface begin (Scene::ray_start), world axes
    std::vector<float> tx, ty, tz, bx, by, bz, nx, ny, nz;  // the local frame, world
    // Normal of the triangle in the local frame, (0, 0, 1) on a shape; empty in a scene without meshes. A direction
    // below it carries nothing.
    bool has_faces = false;
    std::vector<float> face_x, face_y, face_z;
    // What its texture multiplies alpha by; empty in a scene without such textures.
    bool has_alpha_textures = false;
    std::vector<float> alpha_texel;
    std::vector<float> fill_d, fill_s;  // like DiskArrays::d, s, for the fill
    std::vector<DiskArrays> disks;
    std::vector<LightArrays> others;  // lights other than disks
    std::size_t light_count() const { return disks.size() + others.size(); }
    /// Returns the bytes of memory that a kernel needs, see KernelCall.
    std::size_t kernel_memory() const { return memory_of_light * (light_count() + (around ? 1 : 0)); }
    std::shared_ptr<const Surroundings> around;  // the scene's; null: the next two are empty
    /// By colour channel: X of light that varies is (cos/p) times the sum of (around_d + around_s lobe) L over them.
    std::array<std::vector<float>, 3> around_d, around_s;
    std::vector<OccluderF> occluders;  // those that may hide a light from one of the shading points
    std::vector<Rgb> lambert;          // rho_d / pi, for the colours of the film
    std::vector<double> rho_s_exact;
    std::vector<Rgb> tint;  // of the lobe, like Surface

    /// Adds a shading point; space must be reserved.
    void add(const Scene& scene, std::uint32_t pixel_index, const Hit& hit, const Shading& shading);
    void grow(std::size_t extra);
    void reserve(std::size_t shading_points);
    /// Repeats the last shading point until every pack is full.
    void pad();
    /// Drops the occluders that cannot lie between any shading point and any light; a sky is in every direction.
    void cull_occluders(const Scene& scene);
    /// Takes the lobe's parameters from a scene of the same view, see Scene::with_s.
    void take_s(const Scene& scene);
    /// Returns the bytes of memory of one point.
    std::size_t bytes_of_one();

private:
    template <class Work> void each_array(Work&& work);
};

/// Returns a scene's lights and occluders without any shading points.
ShadingPoints empty_points(const Scene& scene, int lobe);

/// Returns all geometry pixels of a tile, grouped by lobe, and the shape that each pixel sees.
std::vector<ShadingPoints> shading_points_of(const Scene& scene, const TileBox& tile, std::int16_t* shape_map);

}  // namespace crescent
