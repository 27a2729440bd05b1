// The shading points of a rectangle of pixels, in the CPU's arrays and as the array texture that src/gl/shaders/shading
// point.glsl reads: one texel a pixel, six layers and two more a disk light, five more any other light. The numbers are
// the same floats.
#pragma once

#include <array>
#include <vector>

#include "context.h"
#include "program.h"

namespace crescent::gl {

/// Rows of pixels that are drawn together at least: renderers shade blocks of 4 x 4 or 8 x 4 pixels.
inline constexpr int strip_rows = 4;

/// Where the pixels of one lobe stand in a rectangle.
struct LobePixels {
    std::vector<std::uint64_t> strips;  // how many stand in each strip of rows
    int x0 = 0, x1 = 0;                 // columns outside have none
};

/// Shading points in groups of one lobe, as shading_points_of() makes them, tile by tile.
class PointTexture {
public:
    PointTexture(const Context& context, const Scene& scene, const TileBox& box, ProgressMonitor& monitor);
    ~PointTexture();
    PointTexture(const PointTexture&) = delete;
    PointTexture& operator=(const PointTexture&) = delete;

    const TileBox& box() const { return box_; }
    int width() const { return box_.x1 - box_.x0; }
    int height() const { return box_.y1 - box_.y0; }
    const std::vector<ShadingPoints>& groups() const { return groups_; }
    /// Lobes, their places in the list or -1, that some pixel here has.
    std::vector<int> lobes() const;
    LobePixels pixels_of(int lobe) const;
    /// Where shading point i of a group stands in the rectangle, row by row.
    std::size_t texel(const ShadingPoints& group, std::size_t i) const;

    /// Binds the texture to unit 0.
    void bind() const;

private:
    void fill_point(std::vector<float>& layers, const ShadingPoints& group, std::size_t i) const;
    void upload(const std::vector<float>& layers, std::size_t layer_count);

    const Context& context_;
    TileBox box_;
    std::size_t image_width_;
    std::vector<ShadingPoints> groups_;
    GLuint texture_ = 0;
};

/// How many lights a scene has: disks, and others, which come after them.
struct LightCounts {
    std::size_t disks = 0, others = 0;
    std::size_t all() const { return disks + others; }
};
LightCounts count_lights(const Scene& scene);

/// Texture layers for so many lights.
constexpr std::size_t point_layers(const LightCounts& lights) { return 6 + 2 * lights.disks + 5 * lights.others; }

/// The image in rectangles whose textures stay under about 256 MiB and the driver's largest texture.
std::vector<TileBox> rectangles_of(int width, int height, const LightCounts& lights, int largest_texture);

/// The bodies that stand before lights, in the order that src/gl/shaders/disk_hit.glsl expects.
struct Bodies {
    std::vector<std::array<float, 4>> vectors;  // three a body
    std::array<std::size_t, 5> counts{};        // spheres, boxes, quads, disks, planes
};
Bodies bodies_of(const std::vector<OccluderF>& occluders);

}  // namespace crescent::gl
