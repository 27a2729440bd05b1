// A density that jumps along many curves is known by its warp: one over what is drawn, and next to nothing elsewhere.
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "laws/judged.h"
#include "laws/right/right.h"

namespace crescent {
namespace {

constexpr int side = 24;
constexpr double width = 2.6, height = 2.2;  // of the window, at distance 1 above

/// A window of 24 x 24 cells, cell (i, k) chosen with (1 + (7 i + 5 k) mod 11), a point of it by area; `beside`: what p
/// has on a patch of the plane outside of it, where nothing is drawn.
Recipe window(double beside = 0) {
    std::vector<double> cdf = {0};
    for (int i = 0; i < side * side; ++i) cdf.push_back(cdf.back() + 1 + (7 * (i / side) + 5 * (i % side)) % 11);
    for (double& v : cdf) v /= cdf.back();
    cdf.back() = 1;
    const Vec3d n = tilt(20, 40), t = normalize(cross(n, {1, 0, 0})), b = cross(n, t);
    Recipe out;
    out.family = "window";
    out.traits.wo = Traits::Asked::none;
    out.traits.bits = 53;
    out.pdf = [=](Vec3d, Vec3d w) {
        const double z = dot(w, n);
        if (!(z > 0)) return 0.0;
        const double x = dot(w, t) / z / width + 0.5, y = dot(w, b) / z / height + 0.5, per_area = 1 / (z * z * z);
        if (std::fabs(x - 1.1) < 0.05 && std::fabs(y - 0.5) < 0.2) return beside * per_area;
        if (x < 0 || x >= 1 || y < 0 || y >= 1) return 0.0;
        const std::size_t cell = static_cast<std::size_t>(x * side) * side + static_cast<std::size_t>(y * side);
        return (cdf[cell + 1] - cdf[cell]) * side * side / (width * height) * per_area;
    };
    out.sample = [=, pdf = out.pdf](Vec3d, const Numbers& u) {
        const auto at = std::upper_bound(cdf.begin(), cdf.end() - 1, u.x) - cdf.begin() - 1;
        const double along = (u.x - cdf[static_cast<std::size_t>(at)]) /
            (cdf[static_cast<std::size_t>(at) + 1] - cdf[static_cast<std::size_t>(at)]);
        const double x = (static_cast<double>(at / side) + std::min(along, 1 - 1e-12)) / side,
                     y = (static_cast<double>(at % side) + u.y) / side;
        const Vec3d w = normalize(n + t * ((x - 0.5) * width) + b * ((y - 0.5) * height));
        return Draw{w, pdf({}, w), {}};
    };
    return out;
}

State normalised(const Recipe& of) {
    return named(judged_at(subject_of(of), 0, of_draws(1 << 15)), "normalised").state;
}

TEST(Reach, AWindowOfManyCellsIsOneByItsWarp) { EXPECT_EQ(normalised(window()), State::right); }

TEST(Reach, WhatPHasBesideTheWindowIsNotPassedByTheWarp) { EXPECT_NE(normalised(window(0.012)), State::right); }

}  // namespace
}  // namespace crescent
