// The shading points of a rectangle of pixels, in the CPU's arrays and as the array texture that
// src/gl/shaders/shading_point.glsl reads: one texel per pixel, six layers, two more per disk light, five more per
// other light. The numbers are the same floats.
#pragma once

#include <array>
#include <vector>

#include "context.h"
#include "program.h"

namespace crescent::gl {

/// The smallest number of rows drawn together: renderers shade blocks of 4 x 4 or 8 x 4 pixels.
inline constexpr int strip_rows = 4;

/// The place of the pixels of one lobe in a rectangle.
struct LobePixels {
    std::vector<std::uint64_t> strips;  // the number in each strip of rows
    int x0 = 0, x1 = 0;                 // columns outside this range have none
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
    /// Returns the lobes of the pixels here, as indices in the list or -1.
    std::vector<int> lobes() const;
    LobePixels pixels_of(int lobe) const;
    /// Returns the place of shading point i of a group in the rectangle, row by row.
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

/// The numbers of lights of a scene: disks, and others, which follow them.
struct LightCounts {
    std::size_t disks = 0, others = 0;
    std::size_t total() const { return disks + others; }
};
LightCounts count_lights(const Scene& scene);

/// Returns the number of texture layers for these lights.
constexpr std::size_t point_layers(const LightCounts& lights) { return 6 + 2 * lights.disks + 5 * lights.others; }

/// Cuts the image into rectangles whose textures stay below about 256 MiB and the driver's largest texture.
std::vector<TileBox> rectangles_of(int width, int height, const LightCounts& lights, int largest_texture);

/// The bodies that can hide lights, in the order that src/gl/shaders/disk_hit.glsl expects.
struct Bodies {
    std::vector<std::array<float, 4>> vectors;  // three per body
    std::array<std::size_t, 5> counts{};        // spheres, boxes, quads, disks, planes
};
Bodies bodies_of(const std::vector<OccluderF>& occluders);

}  // namespace crescent::gl
