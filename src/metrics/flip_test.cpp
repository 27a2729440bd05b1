// Compares FLIP with the numbers of the program that its authors publish.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "compare/metrics.h"

namespace crescent::inline comparison {
namespace {

/// A test picture by formula, so that another program can compute the same one.
std::vector<float> plane(int c, bool changed, double lift) {
    std::vector<float> out;
    for (int y = 0; y < 60; ++y)
        for (int x = 0; x < 90; ++x) {
            const double base = c == 0 ? 0.5 + 0.4 * std::sin(x / 7.0)
                : c == 1               ? 0.3 + 0.3 * std::cos(y / 5.0)
                                       : (x / 9 + y / 7) % 2 * 0.8;
            const double off = changed ? 0.2 * std::sin(1.7 * x + 2.3 * y + c) : 0;
            out.push_back(
                static_cast<float>(std::clamp(base + off, 0.0, 1.0) * std::exp(lift * std::sin(x / 20.0 + y / 9.0))));
        }
    return out;
}

/// Means that the package flip-evaluator 1.7 returns for the same pictures at 67.0206 pixels per degree.
TEST(Flip, AgreesWithThePublishedProgram) {
    const auto mean = [](const std::vector<float>& map) {
        double sum = 0;
        for (const float v : map) sum += static_cast<double>(v);
        return sum / static_cast<double>(map.size());
    };
    for (const auto& [lift, oracle] : {std::pair{0.0, 0.17929989}, {3.0, 0.45306307}}) {
        std::vector<float> a[3], b[3];
        for (int c = 0; c < 3; ++c) a[c] = plane(c, false, lift), b[c] = plane(c, true, lift);
        const auto flip = lift > 0 ? hdr_flip : ldr_flip;
        EXPECT_NEAR(mean(flip({90, 60, a[0], a[1], a[2]}, {90, 60, b[0], b[1], b[2]}, 67.0206)), oracle, 1e-4) << lift;
    }
}

TEST(Flip, IsZeroForEqualPictures) {
    const std::vector<float> p = plane(0, false, 0);
    for (const float v : ldr_flip({90, 60, p, p, p}, {90, 60, p, p, p}, 67)) EXPECT_EQ(v, 0);
}

}  // namespace
}  // namespace crescent::inline comparison
