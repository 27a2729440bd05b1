// Tables: their cells are found from where the density jumps, and summed.
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "simd/scalar.h"
#include "verdicts/mesh.h"
#include "verdicts/subject.h"

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

}  // namespace
}  // namespace crescent
