// An image sky: light from infinitely far away, a latitude-longitude image that is constant over each texel. Double
// precision; radiance in W/(sr m^2), linear Rec.709.
//
//   Texel (0, 0) is at the top-left of the image. Rows go from up (+y) to down, columns once around the y axis:
//     w = (sin theta sin phi, cos theta, -sin theta cos phi),  theta = pi row / height,  phi = 2 pi column / width,
//   so the left edge of the image is towards -z, a quarter is +x, the middle +z. `rotation` turns the sky about +y,
//   counterclockwise seen from above.
//
// A direction is drawn in two steps: a texel with the probability of its mass Y(L) times its solid angle,
// 2 pi / width (cos theta_r - cos theta_(r+1)), then uniformly in solid angle within it. So p = Y(L) / sum of all
// masses.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/errors.h"
#include "base/vec.h"
#include "scene/texture.h"

namespace crescent {

inline constexpr int widest_sky = 8192, highest_sky = 4096;  // texels
inline constexpr double brightest_sky = 1e9;                 // W/(sr m^2), the limit of every radiance of a file

/// The sky of a scene.
struct SkyLight {
    std::string file;
    std::optional<std::string> layer{};    // of an OpenEXR file; none: its first part
    double rotation = 0;                   // degrees about +y
    double scale = 1;                      // of the radiance
    bool visible = true;                   // to the camera, where it sees no surface
    std::optional<std::string> content{};  // 16 hexadecimal digits of RgbImage::hash; none: not known
    SourceLocation location{};
    std::shared_ptr<const RgbImage> image{};  // none before the file is read
    std::size_t raised_count = 0;             // numbers of the file that raise_to_zero() set to 0
};

/// Filters and compression leave numbers below 0. An image is a sky if they are at most this share of its energy.
inline constexpr double negative_share = 1e-3;
/// Sets the numbers below 0 of a latitude-longitude image to 0 and returns how many there were; 0 if there are too many
/// or some is infinite, which why_no_sky() states.
std::size_t raise_to_zero(RgbImage& image);

/// Where an image cannot be a sky: the texel and what is wrong there; "" if it can.
std::string why_no_sky(const RgbImage& image, double scale);

inline constexpr std::uint32_t no_texel = 0xffffffff;

/// A direction of the world, the texel it was drawn in, and the density in 1/sr.
struct SkyDraw {
    Vec3d w;
    std::uint32_t texel;
    double pdf;
};

/// Radiance by direction, and directions by radiance. Immutable.
class SkyTable {
public:
    /// The image must be one for which why_no_sky() is "".
    explicit SkyTable(const SkyLight& light);

    /// u and v in [0, 1). Rounding the direction may move it to a neighbouring texel: the result has the drawn one.
    SkyDraw sample(double u, double v) const;
    /// As many draws as `out` has room for. What they read from memory is fetched for several together.
    void sample(std::span<const double> u, std::span<const double> v, std::span<SkyDraw> out) const;
    /// w needs no unit length.
    std::uint32_t texel_at(Vec3d w) const;
    /// The density with which a direction of this texel is drawn, 1/sr.
    double pdf(std::uint32_t texel) const;
    Rgb radiance(std::uint32_t texel) const;
    /// The solid angle of one texel of a row, sr.
    double solid_angle(int row) const;
    /// The integral of Y(L) over all directions, W/m^2.
    double total() const { return total_; }
    int width() const { return image_->width; }
    int height() const { return image_->height; }

private:
    /// 1 - |cos theta| at the two edges of a row, the one nearer to a pole first; the row that contains the equator has
    /// the same edge on both sides.
    struct RowEdges {
        double polar, equatorial;
        bool crosses_equator, is_below;  // it contains the equator; it is below it
    };
    RowEdges edges_of(int row) const;
    void sample_some(std::span<const double> u, std::span<const double> v, std::span<SkyDraw> out) const;

    std::shared_ptr<const RgbImage> image_;
    double scale_, turns_;        // of the rotation
    std::vector<double> edge_;    // 1 - cos(pi row / height), down to the last edge above the equator or on it
    std::vector<double> rows_;    // sum of the masses of all rows up to this one
    std::vector<float> columns_;  // the same within each row, over the mass of the row
    double total_ = 0;
    /// Where searches begin: entry k is the first index of a number above k / entries, of rows_, of edge_ (of its
    /// square root), and of each row of columns_. Entries are a power of two, so that k is exact.
    std::vector<std::uint16_t> row_guide_, edge_guide_, column_guide_;
    std::size_t guides_of_row_ = 1;
};

}  // namespace crescent
