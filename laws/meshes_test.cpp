// Tables: their cells are found from where the density jumps, and summed.
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "cubature/mesh.h"
#include "simd/scalar.h"
#include "subjects/subject.h"

namespace crescent {
namespace {

/// 12 x 20 cells of cos theta x phi over the upper hemisphere.
double in_cells(double a, double b) { return a >= 1 ? 0 : 1 + (int((1 - a) * 12) * 7 + int(b * 20) * 5) % 11; }

TEST(Meshes, AreFoundInATableAndSummedExactly) {
    const Batch g = [](std::span<const Vec2d> at, std::span<double> out) {
        for (std::size_t i = 0; i < at.size(); ++i) out[i] = in_cells(at[i].x, at[i].y);
    };
    const std::optional<Mesh> mesh = find_mesh(g);
    ASSERT_TRUE(mesh);
    double sum = 0;
    for (int i = 0; i < 12; ++i)
        for (int k = 0; k < 20; ++k) sum += in_cells(1 - (i + 0.5) / 12, (k + 0.5) / 20) / 240;
    const double rings[] = {0, 0.31, 1.3, 2};
    const std::optional<Integral> found = integrate_mesh(*mesh, rings, 3, g, {2.5e-6, 100000, 5e-5});
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->value, sum, 1e-12);
    EXPECT_EQ(found->error, 0);
}

TEST(Meshes, AreNotSeenInASmoothDensityOrInACone) {
    const Batch smooth = [](std::span<const Vec2d> at, std::span<double> out) {
        for (std::size_t i = 0; i < at.size(); ++i) out[i] = 1 + at[i].x + std::sin(2 * pi * at[i].y);
    };
    EXPECT_FALSE(find_mesh(smooth));
    const SphereMap map(Vec3d{0, 0, 1});
    const Batch cone = [&map](std::span<const Vec2d> at, std::span<double> out) {
        for (std::size_t i = 0; i < at.size(); ++i) out[i] = dot(map.direction(at[i]), tilt(40, 70)) > 0.6 ? 1 : 0;
    };
    EXPECT_FALSE(find_mesh(cone));
}

/// A table of rows x 32 texels evenly spaced in theta and in phi (turns), and its integral over both.
struct Texels {
    int rows;
    double at(double theta, double b) const { return 1 + (int(theta / pi * rows) * 7 + int(b * 32) * 5) % 11; }
    double sum() const {
        double out = 0;
        for (int i = 0; i < rows; ++i)
            for (int k = 0; k < 32; ++k) out += at(pi * (i + 0.5) / rows, (k + 0.5) / 32) * pi / rows / 32;
        return out;
    }
};

/// 16 x 32 texels evenly spaced in theta, g sin theta constant in each; and the same from points at random.
TEST(Meshes, OfTexelsInThetaAndPhiAreSummedOrSampled) {
    const Texels texels{16};
    const Batch g = [&](std::span<const Vec2d> at, std::span<double> out) {
        for (std::size_t i = 0; i < at.size(); ++i)
            out[i] = texels.at(std::acos(1 - at[i].x), at[i].y) / std::sqrt(at[i].x * (2 - at[i].x));
    };
    const std::optional<Mesh> mesh = find_mesh(g);
    ASSERT_TRUE(mesh);
    const double sum = texels.sum();
    const double rings[] = {0, 0.31, 1.3, 2};
    const std::optional<Integral> found = integrate_mesh(*mesh, rings, 3, g, {2.5e-6, 100000, 5e-5});
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->value, sum, 1e-9);
    const Integral by_points = integrate_by_points(graded_cells(2), 1, g, 200000);
    EXPECT_NEAR(by_points.value, sum, by_points.error);
    EXPECT_LT(by_points.error, 0.05 * sum);
    EXPECT_GT(by_points.error, 1e-4 * sum);
}

/// A renderer that works in single precision rounds the direction before it looks up theta: near the poles sin theta is
/// known to per cents there.
TEST(Meshes, OfTexelsOfASkyInSinglePrecisionAreSummed) {
    const Texels texels{64};
    const Batch g = [&](std::span<const Vec2d> at, std::span<double> out) {
        for (std::size_t i = 0; i < at.size(); ++i) {
            const float theta = std::acos(std::clamp(static_cast<float>(1 - at[i].x), -1.0f, 1.0f));
            out[i] = texels.at(std::acos(1 - at[i].x), at[i].y) / std::max(std::sin(theta), 1e-12f);
        }
    };
    const std::optional<Mesh> mesh = find_mesh(g);
    ASSERT_TRUE(mesh);
    const double sum = texels.sum();
    const double rings[] = {0, 0.31, 1.3, 2};
    const std::optional<Integral> found = integrate_mesh(*mesh, rings, 3, g, {2.5e-6, 100000, 5e-5}, 0x1p-24);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->value, sum, 1e-5 * sum);
    EXPECT_EQ(found->error, 0);
}

/// 12 x 20 cells, even in cos^2 theta and in phi from 0.0137 turns on, p / cos theta alike in each, nothing below.
TEST(Meshes, EvenInTheSquareOfTheCosineAndTurnedAboutTheAxisAreSummed) {
    constexpr double turned = 0.0137;
    const auto held = [](int i, int k) { return 1.0 + (i * 7 + k * 5) % 11; };
    const Batch g = [&](std::span<const Vec2d> at, std::span<double> out) {
        for (std::size_t n = 0; n < at.size(); ++n) {
            const double c = 1 - at[n].x, b = at[n].y - turned + (at[n].y < turned);
            out[n] = c > 0 ? c * held(std::min(int(c * c * 12), 11), std::min(int(b * 20), 19)) : 0;
        }
    };
    double sum = 0;
    for (int i = 0; i < 12; ++i)
        for (int k = 0; k < 20; ++k) sum += held(i, k) / (2 * 12 * 20);
    const std::optional<Mesh> mesh = find_mesh(g);
    ASSERT_TRUE(mesh);
    const double rings[] = {0, 0.31, 1.3, 2};
    const std::optional<Integral> found = integrate_mesh(*mesh, rings, 3, g, {2.5e-6, 100000, 5e-5});
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->value, sum, 1e-9 * sum);
    EXPECT_EQ(found->error, 0);
}

/// p of 40 x 40 texels of the equal-area octahedral map (Clarberg 2008), from a direction back to the square.
double in_octahedral_texels(Vec3d w) {
    const double x = std::fabs(w.x), y = std::fabs(w.y), r = std::sqrt(std::max(1 - std::fabs(w.z), 0.0));
    const double phi = std::atan2(y, x) * 2 / pi, v = phi * r, u = r - v;
    const double a = w.z < 0 ? 1 - v : u, b = w.z < 0 ? 1 - u : v;
    const double s = (std::copysign(a, w.x) + 1) / 2, t = (std::copysign(b, w.y) + 1) / 2;
    return 1 + (int(std::min(s, 1 - 1e-9) * 40) * 7 + int(std::min(t, 1 - 1e-9) * 40) * 5) % 11;
}

/// p sin theta of points 48 x 24 in phi x theta, bilinear between them.
double in_bilinear_texels(Vec3d w) {
    const double theta = std::acos(std::clamp(w.z, -1.0, 1.0)), turns = std::atan2(w.y, w.x) / (2 * pi);
    const double x = 48 * (turns < 0 ? turns + 1 : turns), y = 24 * theta / pi;
    const int i = std::min(int(x), 47), k = std::min(int(y), 23);
    const auto at = [](int column, int row) { return 1.0 + (column % 48 * 7 + row * 5) % 11; };
    const double f = x - i, g = y - k;
    return ((1 - g) * ((1 - f) * at(i, k) + f * at(i + 1, k)) + g * ((1 - f) * at(i, k + 1) + f * at(i + 1, k + 1))) /
        std::max(std::sin(theta), 1e-9);
}

DirectionBatch batch_of(double (*p)(Vec3d), int turned) {
    return [=](std::span<const Vec3d> at, std::span<double> out) {
        for (std::size_t i = 0; i < at.size(); ++i) out[i] = p(turned ? Vec3d{at[i].y, at[i].z, at[i].x} : at[i]);
    };
}

/// p of 16 x 16 texels of each face of a cube, alike per area of the face.
double in_cube_texels(Vec3d w) {
    const double v[3] = {w.x, w.y, w.z};
    int axis = 0;
    for (int k = 1; k < 3; ++k)
        if (std::fabs(v[k]) > std::fabs(v[axis])) axis = k;
    const double far = std::fabs(v[axis]), s = v[(axis + 1) % 3] / far, t = v[(axis + 2) % 3] / far;
    const auto cell = [](double x) { return std::clamp(static_cast<int>((x + 1) / 2 * 16), 0, 15); };
    return std::pow(1 + s * s + t * t, 1.5) * (1 + (axis + (v[axis] < 0) * 3 + cell(s) * 7 + cell(t) * 5) % 11);
}

TEST(Texels, OfACubesFacesAreSummed) {
    double sum = 0;
    for (int face = 0; face < 6; ++face)
        for (int i = 0; i < 16; ++i)
            for (int k = 0; k < 16; ++k) sum += 4.0 / 256 * (1 + (face + i * 7 + k * 5) % 11);
    for (int turned : {0, 1}) {
        const std::optional<Integral> found = integrate_texels(batch_of(in_cube_texels, turned), 200000);
        ASSERT_TRUE(found) << turned;
        EXPECT_NEAR(found->value, sum, 1e-9 * sum);
    }
}

TEST(Texels, OfAnOctahedralMapAndBilinearOnesAreSummedAboutAnyAxis) {
    double octahedral = 0, bilinear = 0;
    for (int i = 0; i < 40; ++i)
        for (int k = 0; k < 40; ++k) octahedral += 4 * pi / 1600 * (1 + (i * 7 + k * 5) % 11);
    for (int i = 0; i < 48; ++i)
        for (int k = 0; k < 24; ++k)
            for (int corner = 0; corner < 4; ++corner)
                bilinear += 2 * pi * pi / (48 * 24) / 4 * (1 + ((i + corner % 2) % 48 * 7 + (k + corner / 2) * 5) % 11);
    for (int turned : {0, 1}) {
        const std::optional<Integral> one = integrate_texels(batch_of(in_octahedral_texels, turned), 200000);
        ASSERT_TRUE(one) << turned;
        EXPECT_NEAR(one->value, octahedral, 1e-9 * octahedral);
        const std::optional<Integral> two = integrate_texels(batch_of(in_bilinear_texels, turned), 200000);
        ASSERT_TRUE(two) << turned;
        EXPECT_NEAR(two->value, bilinear, 1e-5 * bilinear);
    }
    const auto smooth = [](Vec3d w) { return 1 + 0.5 * w.z + 0.2 * w.x * w.y; };
    EXPECT_FALSE(integrate_texels(batch_of(smooth, 0), 200000));
}

}  // namespace
}  // namespace crescent
