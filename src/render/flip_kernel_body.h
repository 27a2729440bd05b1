// FLIP per pixel for any number type: lanes are pixels. Andersson et al. 2020, sections 4.1 to 4.4; metrics/flip.cpp
// makes the filters. kernel_<isa>.cpp includes it once for each instruction set.
//
// Opponent colours are kept as differences of relative XYZ: Y, X - Y and Y - Z are (L + 16)/116, a/500 and b/200 of the
// paper's YyCxCz, and filters are linear.
#pragma once

#include "base/vec.h"
#include "math/simd/math.h"
#include "render/flip_kernel.h"

namespace crescent {
namespace CRESCENT_ISA {

template <class F> struct FlipPixels {
    /// A row of a matrix times v; its numbers are scaled by columns, and all by `scale`.
    static CRESCENT_INLINE F row(const double (&m)[3], const double (&columns)[3], double scale, Vec3<F> v) {
        return number<F>(m[0] * columns[0] * scale) * v.x + number<F>(m[1] * columns[1] * scale) * v.y +
            number<F>(m[2] * columns[2] * scale) * v.z;
    }
    static constexpr double sum_of(const double (&row)[3]) { return row[0] + row[1] + row[2]; }
    static constexpr double white[3] = {sum_of(xyz_of_rgb[0]), sum_of(xyz_of_rgb[1]), sum_of(xyz_of_rgb[2])};
    static CRESCENT_INLINE Vec3<F> relative_xyz(Vec3<F> rgb) {
        constexpr double ones[3] = {1, 1, 1};
        return {row(xyz_of_rgb[0], ones, 1 / white[0], rgb), row(xyz_of_rgb[1], ones, 1 / white[1], rgb),
            row(xyz_of_rgb[2], ones, 1 / white[2], rgb)};
    }
    static CRESCENT_INLINE Vec3<F> rgb_of_relative(Vec3<F> xyz) {
        return {
            row(rgb_of_xyz[0], white, 1, xyz), row(rgb_of_xyz[1], white, 1, xyz), row(rgb_of_xyz[2], white, 1, xyz)};
    }
    static CRESCENT_INLINE F unit(F x) { return smaller(larger(x, number<F>(0)), number<F>(1)); }

    /// A power, compiled once.
    [[gnu::noinline]] static F power_of(F x, F y) { return pow(x, y); }

    static CRESCENT_INLINE F cube_root(F x) {
        constexpr double delta = 6.0 / 29;
        return select(x > number<F>(delta * delta * delta), power_of(x, number<F>(1.0 / 3)),
            x * number<F>(1 / (3 * delta * delta)) + number<F>(4.0 / 29));
    }
    /// CIELAB of linear Rec.709 in [0, 1], with a and b scaled by lightness: colour differences are smaller in the dark
    /// (Hunt).
    static CRESCENT_INLINE Vec3<F> hunt_lab(Vec3<F> rgb) {
        const Vec3<F> xyz = relative_xyz(rgb);
        const F x = cube_root(xyz.x), y = cube_root(xyz.y), z = cube_root(xyz.z);
        const F lightness = number<F>(116) * y - number<F>(16);
        return {lightness, number<F>(5) * lightness * (x - y), number<F>(2) * lightness * (y - z)};
    }
    /// HyAB: city-block distance in lightness, Euclidean distance in colour.
    static CRESCENT_INLINE F hyab(Vec3<F> a, Vec3<F> b) {
        const Vec3<F> d = a - b;
        return abs(d.x) + sqrt(d.y * d.y + d.z * d.z);
    }

    /// Maps a radiance to [0, 1]; one that is not finite to 0.
    static CRESCENT_INLINE F tone_mapped(F radiance, F exposure) {
        const F finite = select(abs(radiance) <= number<F>(3.4028234663852886e38), radiance, number<F>(0));
        const F x = smaller(larger(finite * exposure, number<F>(0)), number<F>(1e6));  // 1 is reached at 11
        const F x2 = x * x;
        return unit((number<F>(aces_fit.a) * x2 + number<F>(aces_fit.b) * x) /
            (number<F>(aces_fit.c) * x2 + number<F>(aces_fit.d) * x + number<F>(aces_fit.e)));
    }

    /// What of a pixel is compared: the colour as the eye sees it from a distance, and the strength of edges and
    /// points.
    struct Seen {
        Vec3<F> lab;
        F edges, points;
    };
    [[gnu::noinline]] static F difference(const Seen& a, const Seen& b, F largest) {
        const F one = number<F>(1);
        const F d = power_of(smaller(hyab(a.lab, b.lab) / largest, one), number<F>(0.7));
        constexpr double knee = 0.4, knee_height = 0.95;  // the largest differences are compressed most
        const F colour = select(d < number<F>(knee), number<F>(knee_height / knee) * d,
            number<F>(knee_height) + (d - number<F>(knee)) * number<F>((1 - knee_height) / (1 - knee)));
        const F edges = abs(a.edges - b.edges), points = abs(a.points - b.points);
        const F shape = sqrt(larger(edges, points) * number<F>(0.70710678118654752));
        return select(shape < one, power_of(colour, one - smaller(shape, one)), one);
    }
};

template <class F> class FlipWork {
public:
    explicit FlipWork(const FlipTile& tile)
        : tile_(tile),
          filters_(tile.filters),
          taps_(2 * static_cast<std::size_t>(tile.filters.reach) + 1),
          width_(static_cast<std::size_t>(tile.width)),
          height_(static_cast<std::size_t>(tile.height)),
          stride_(flip_stride(tile.width)),
          stride_in_(flip_stride(tile.width + 2 * tile.filters.reach)) {}

    void compute() {
        const F none = number<F>(0), full = number<F>(1);
        const F largest = Pixels::hyab(Pixels::hunt_lab({none, full, none}), Pixels::hunt_lab({none, none, full}));
        for (std::size_t i = 0; i < height_ * stride_; ++i) tile_.out[i] = 0;
        const std::size_t exposures = tile_.exposures.empty() ? 1 : tile_.exposures.size();
        for (std::size_t e = 0; e < exposures; ++e) {
            for (std::size_t p = 0; p < 2; ++p)
                for (std::size_t y = 0; y < height_ + taps_ - 1; ++y) filter_row(p, y, e);
            for (std::size_t y = 0; y < height_; ++y)
                for (std::size_t x = 0; x < width_; x += lanes) {
                    const F flip = Pixels::difference(look(0, x, y), look(1, x, y), largest);
                    float* out = tile_.out + y * stride_ + x;
                    store(larger(flip, load_as<F>(out)), out);
                }
        }
    }

private:
    using Pixels = FlipPixels<F>;
    using Seen = typename Pixels::Seen;
    static constexpr std::size_t lanes = Lanes<F>::count;
    /// Y, X - Y and Y - Z, the last by two Gaussians, filtered along rows by contrast sensitivities; Y by the others.
    enum Filtered : std::size_t { y_blurred, xy_blurred, yz_wide, yz_narrow, smoothed, edges, points, filtered_count };

    float* line(std::size_t plane) const { return tile_.memory + plane * (stride_in_ + 2 * flip_row_multiple); }
    float* row(std::size_t picture, Filtered filtered, std::size_t y) const {
        return line(3) + ((picture * filtered_count + filtered) * (height_ + taps_ - 1) + y) * stride_;
    }

    /// Makes opponent colours of one row.
    void convert_row(std::size_t picture, std::size_t y, std::size_t e) const {
        const auto& in = tile_.pixels[picture];
        const bool mapped = !tile_.exposures.empty();
        const F exposure(mapped ? tile_.exposures[e] : 1.0f);
        for (std::size_t x = 0; x < width_ + taps_ - 1; x += lanes) {
            const std::size_t i = y * stride_in_ + x;
            const Vec3<F> rgb = {load_as<F>(in[0] + i), load_as<F>(in[1] + i), load_as<F>(in[2] + i)};
            const auto unit_of = [&](F v) { return mapped ? Pixels::tone_mapped(v, exposure) : Pixels::unit(v); };
            const Vec3<F> xyz = Pixels::relative_xyz({unit_of(rgb.x), unit_of(rgb.y), unit_of(rgb.z)});
            store(xyz.y, line(0) + x);
            store(xyz.x - xyz.y, line(1) + x);
            store(xyz.y - xyz.z, line(2) + x);
        }
    }

    [[gnu::noinline]] void filter_row(std::size_t picture, std::size_t y, std::size_t e) const {
        convert_row(picture, y, e);
        const FlipFilters& f = filters_;
        const F zero = number<F>(0);
        for (std::size_t x = 0; x < width_; x += lanes) {
            F blurred = zero, smooth = zero, edge = zero, point = zero;
            for (std::size_t k = 0; k < taps_; ++k) {
                const F v = load_as<F>(line(0) + x + k);
                blurred = blurred + F(f.achromatic[k]) * v;
                smooth = smooth + F(f.smooth[k]) * v;
                edge = edge + F(f.edge[k]) * v;
                point = point + F(f.point[k]) * v;
            }
            store(blurred, row(picture, y_blurred, y) + x);
            store(smooth, row(picture, smoothed, y) + x);
            store(edge, row(picture, edges, y) + x);
            store(point, row(picture, points, y) + x);
            F xy = zero, wide = zero, narrow = zero;
            for (std::size_t k = 0; k < taps_; ++k) {
                const F v = load_as<F>(line(1) + x + k), w = load_as<F>(line(2) + x + k);
                xy = xy + F(f.red_green[k]) * v;
                wide = wide + F(f.blue_yellow[0][k]) * w;
                narrow = narrow + F(f.blue_yellow[1][k]) * w;
            }
            store(xy, row(picture, xy_blurred, y) + x);
            store(wide, row(picture, yz_wide, y) + x);
            store(narrow, row(picture, yz_narrow, y) + x);
        }
    }

    /// Filters along columns.
    [[gnu::noinline]] Seen look(std::size_t picture, std::size_t x, std::size_t y) const {
        const FlipFilters& f = filters_;
        const F zero = number<F>(0);
        F lightness = zero, xy = zero, yz = zero;
        for (std::size_t k = 0; k < taps_; ++k) {
            lightness = lightness + F(f.achromatic[k]) * load_as<F>(row(picture, y_blurred, y + k) + x);
            xy = xy + F(f.red_green[k]) * load_as<F>(row(picture, xy_blurred, y + k) + x);
            yz = yz +
                (F(f.blue_yellow_down[0][k]) * load_as<F>(row(picture, yz_wide, y + k) + x) +
                    F(f.blue_yellow_down[1][k]) * load_as<F>(row(picture, yz_narrow, y + k) + x));
        }
        F edge_x = zero, edge_y = zero, point_x = zero, point_y = zero;
        for (std::size_t k = 0; k < taps_; ++k) {
            const F smooth(f.smooth[k]), s = load_as<F>(row(picture, smoothed, y + k) + x);
            edge_x = edge_x + smooth * load_as<F>(row(picture, edges, y + k) + x);
            point_x = point_x + smooth * load_as<F>(row(picture, points, y + k) + x);
            edge_y = edge_y + F(f.edge[k]) * s;
            point_y = point_y + F(f.point[k]) * s;
        }
        const Vec3<F> rgb = Pixels::rgb_of_relative({lightness + xy, lightness, lightness - yz});
        return {Pixels::hunt_lab({Pixels::unit(rgb.x), Pixels::unit(rgb.y), Pixels::unit(rgb.z)}),
            sqrt(edge_x * edge_x + edge_y * edge_y), sqrt(point_x * point_x + point_y * point_y)};
    }

    const FlipTile& tile_;
    FlipFilters filters_;
    std::size_t taps_, width_, height_, stride_, stride_in_;
};

template <class F> void compute_flip(const FlipTile& tile) { FlipWork<F>(tile).compute(); }

}  // namespace CRESCENT_ISA
}  // namespace crescent
