// Compares FLIP with the numbers of the program that its authors publish.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/simd/random.h"
#include "metrics/flip.h"
#include "render/kernel.h"

namespace crescent {
namespace flip_test {

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
        for (int c = 0; c < 3; ++c) {
            a[c] = plane(c, false, lift);
            b[c] = plane(c, true, lift);
        }
        const auto flip = lift > 0 ? hdr_flip : ldr_flip;
        EXPECT_NEAR(mean(flip({90, 60, a[0], a[1], a[2]}, {90, 60, b[0], b[1], b[2]}, 67.0206, "")), oracle, 1e-4)
            << lift;
    }
}

/// The mean over a box is that of the whole map: the filters see the pixels around the box, and no others.
TEST(Flip, OfABoxIsThatOfTheWholePictureThere) {
    std::vector<float> a[3], b[3];
    for (int c = 0; c < 3; ++c) {
        a[c] = plane(c, false, 3);
        b[c] = plane(c, true, 3);
    }
    const FlipImage reference{90, 60, a[0], a[1], a[2]}, test{90, 60, b[0], b[1], b[2]};
    const std::vector<float> map = hdr_flip(reference, test, 30);
    const Box boxes[] = {{40, 20, 52, 29}, {0, 0, 7, 59}, {89, 59, 89, 59}};
    const FlipImage tests[] = {reference, test};
    ShapeMap shapes{90, 60, std::vector<std::int16_t>(90 * 60, 0)};
    for (std::size_t index = 0; index < map.size(); index += 7) shapes.shape[index] = 1;
    std::vector<AreaPixels> areas;
    for (const Box& box : boxes) areas.emplace_back(Area{box}, shapes);
    areas.emplace_back(Area{boxes[0], 1}, shapes);
    const auto means = mean_hdr_flips(reference, flip_exposures(reference), tests, areas, 30);
    for (std::size_t k = 0; k < std::size(boxes); ++k) {
        double sum = 0;
        for (int y = boxes[k].y0; y <= boxes[k].y1; ++y)
            for (int x = boxes[k].x0; x <= boxes[k].x1; ++x)
                sum += static_cast<double>(map[static_cast<std::size_t>(90 * y + x)]);
        EXPECT_EQ(means[1][k], sum / (boxes[k].width() * boxes[k].height())) << k;
        EXPECT_EQ(means[0][k], 0) << k;
    }
    double of_surface = 0;
    int pixels = 0;
    for (int y = boxes[0].y0; y <= boxes[0].y1; ++y)
        for (int x = boxes[0].x0; x <= boxes[0].x1; ++x)
            if ((90 * y + x) % 7 == 0) {
                of_surface += static_cast<double>(map[static_cast<std::size_t>(90 * y + x)]);
                ++pixels;
            }
    EXPECT_EQ(means[1][std::size(boxes)], of_surface / pixels);
}

/// Over several tiles, with radiances that no tone map can show.
TEST(Flip, ReturnsTheSameBitsOnEveryInstructionSet) {
    constexpr int width = 150, height = 70;
    std::vector<float> a[3], b[3];
    for (std::uint32_t c = 0; c < 3; ++c)
        for (std::uint32_t i = 0; i < width * height; ++i) {
            const Vec2<float> u = crescent::draw(c, i, 0);
            a[c].push_back(u.x * 100);
            b[c].push_back(u.y < 0.5f ? u.x * 100 : u.y);
        }
    const float odd[] = {
        0, -1, 1e-38f, 1e30f, 3e38f, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()};
    for (std::size_t k = 0; k < std::size(odd); ++k) b[k % 3][100 * k] = odd[k];
    const FlipImage reference{width, height, a[0], a[1], a[2]}, test{width, height, b[0], b[1], b[2]};
    const std::vector<float> hdr = hdr_flip(reference, test, 67, "scalar"),
                             ldr = ldr_flip(reference, test, 67, "scalar");
    for (const float v : hdr) EXPECT_TRUE(v >= 0 && v <= 1) << v;
    for (const std::string& isa : isas()) {
        EXPECT_EQ(hdr_flip(reference, test, 67, isa), hdr) << isa;
        EXPECT_EQ(ldr_flip(reference, test, 67, isa), ldr) << isa;
    }
}

TEST(Flip, IsZeroForEqualPictures) {
    const std::vector<float> p = plane(0, false, 0);
    for (const float v : ldr_flip({90, 60, p, p, p}, {90, 60, p, p, p}, 67)) EXPECT_EQ(v, 0);
}

}  // namespace flip_test
}  // namespace crescent
