// SMPTE RP 177 (primaries to XYZ); Lindbloom, "Chromatic Adaptation" (Bradford's matrix).
#include "images/primaries.h"

#include <cmath>
#include <fmt/format.h>

namespace crescent {

namespace {

using Xy = std::array<double, 2>;

/// Returns x, y and z of a chromaticity.
Rgb xyz_of(const Xy& c) { return {c[0], c[1], 1 - c[0] - c[1]}; }

Matrix3 product(const Matrix3& a, const Matrix3& b) {
    Matrix3 out{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            for (std::size_t k = 0; k < 3; ++k) out[i][j] += a[i][k] * b[k][j];
    return out;
}

/// Inverts by cofactors.
Matrix3 inverse(const Matrix3& m) {
    Matrix3 out;
    const auto minor = [&](std::size_t i, std::size_t j) {
        const std::size_t i0 = (i + 1) % 3, i1 = (i + 2) % 3, j0 = (j + 1) % 3, j1 = (j + 2) % 3;
        return m[i0][j0] * m[i1][j1] - m[i0][j1] * m[i1][j0];
    };
    const double determinant = m[0][0] * minor(0, 0) + m[0][1] * minor(0, 1) + m[0][2] * minor(0, 2);
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) out[j][i] = minor(i, j) / determinant;
    return out;
}

/// Returns a matrix with a column per primary: its x, y and z times its amount.
Matrix3 columns(const Chromaticities& c, const Rgb& amounts) {
    const Rgb primary[3] = {xyz_of(c.red), xyz_of(c.green), xyz_of(c.blue)};
    Matrix3 out;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) out[i][j] = primary[j][i] * amounts[j];
    return out;
}

/// Returns the matrix that maps one white to the other, by scaling Bradford's cone responses.
Matrix3 adaptation(const Rgb& from, const Rgb& to) {
    constexpr Matrix3 bradford{{{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}};
    const Rgb a = transformed(bradford, from), b = transformed(bradford, to);
    Matrix3 scale{};
    for (std::size_t i = 0; i < 3; ++i) scale[i][i] = b[i] / a[i];
    return product(inverse(bradford), product(scale, bradford));
}

bool near(const Xy& a, const Xy& b) { return std::fabs(a[0] - b[0]) <= 1e-3 && std::fabs(a[1] - b[1]) <= 1e-3; }

/// The primaries of OpenEXR files with XYZ in channels R, G and B; their "white" is not the white of a scene.
constexpr Chromaticities xyz_primaries{.red = {1, 0}, .green = {0, 1}, .blue = {0, 0}, .white = {1. / 3, 1. / 3}};

}  // namespace

bool is_valid(const Chromaticities& c) {
    for (const Xy& p : {c.red, c.green, c.blue, c.white})
        if (!(std::fabs(p[0]) <= 10 && std::fabs(p[1]) <= 10)) return false;
    const double area =
        (c.green[0] - c.red[0]) * (c.blue[1] - c.red[1]) - (c.blue[0] - c.red[0]) * (c.green[1] - c.red[1]);
    return c.white[1] > 1e-3 && std::fabs(area) > 1e-4;
}

bool same_primaries(const Chromaticities& a, const Chromaticities& b) {
    return near(a.red, b.red) && near(a.green, b.green) && near(a.blue, b.blue) && near(a.white, b.white);
}

std::string to_string(const Chromaticities& c) {
    if (same_primaries(c, {})) return "Rec.709";
    return fmt::format("R {:.4g} {:.4g}, G {:.4g} {:.4g}, B {:.4g} {:.4g}, white {:.4g} {:.4g}", c.red[0], c.red[1],
        c.green[0], c.green[1], c.blue[0], c.blue[1], c.white[0], c.white[1]);
}

Rgb transformed(const Matrix3& m, const Rgb& v) {
    Rgb out{};
    for (std::size_t i = 0; i < 3; ++i) out[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
    return out;
}

Matrix3 rgb_to_xyz(const Chromaticities& c) {
    if (same_primaries(c, {}))
        return columns(
            c, {luminance_weights[0] / c.red[1], luminance_weights[1] / c.green[1], luminance_weights[2] / c.blue[1]});
    Rgb white = xyz_of(c.white);
    for (double& x : white) x /= c.white[1];
    return columns(c, transformed(inverse(columns(c, {1, 1, 1})), white));
}

Rgb luminance_weights_of(const Chromaticities& c) {
    if (same_primaries(c, {})) return {luminance_weights[0], luminance_weights[1], luminance_weights[2]};
    return rgb_to_xyz(c)[1];
}

Matrix3 xyz_to_rgb(const Chromaticities& c) { return inverse(rgb_to_xyz(c)); }

Matrix3 conversion(const Chromaticities& from, const Chromaticities& to) {
    const Matrix3 a = rgb_to_xyz(from), b = rgb_to_xyz(to);
    if (same_primaries(from, xyz_primaries) || same_primaries(to, xyz_primaries)) return product(inverse(b), a);
    const Rgb white{1, 1, 1};
    return product(inverse(b), product(adaptation(transformed(a, white), transformed(b, white)), a));
}

}  // namespace crescent
