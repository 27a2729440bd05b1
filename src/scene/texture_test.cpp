// Which texel is where, and which images are refused.
#include "scene/texture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace crescent::inline scene {
namespace {

using testing::HasSubstr;

/// Texels 0.1, 0.2, ... row by row from the top, or `value` in one of them.
RgbImage image_of(int width, int height) {
    RgbImage image{width, height, {}};
    for (std::size_t k = 0; k < image.texels(); ++k)
        image.rgb.insert(image.rgb.end(), 3, 0.1f * static_cast<float>(k + 1));
    return image;
}

TEST(Textures, HaveTheirOriginAtTheBottomLeftAndRepeat) {
    const RgbImage image = image_of(3, 2);  // 0.1 0.2 0.3 over 0.4 0.5 0.6
    const auto at = [&](double u, double v) { return std::lround(10 * texel_at(image, u, v)[1]); };
    EXPECT_EQ(at(0, 0), 4);
    EXPECT_EQ(at(0.99, 0.49), 6);
    EXPECT_EQ(at(0.34, 0.51), 2);
    EXPECT_EQ(at(1, 1), 4);
    EXPECT_EQ(at(-0.01, -0.01), 3);
    EXPECT_EQ(at(7.5, -3.25), 2);
    EXPECT_EQ(at(-1e-18, 0), 6);  // less its floor, it rounds to 1
    EXPECT_EQ(at(1e30, -1e30), 4);
}

TEST(Textures, AreRefusedWithTheTexel) {
    const auto why = [](float value, TextureOf of) {
        RgbImage image = image_of(3, 2);
        for (std::size_t c = 0; c < 3; ++c) image.rgb[3 * 5 + c] = value;
        return why_no_texture(image, of);
    };
    EXPECT_EQ(why(0, TextureOf::rho_d), "");
    EXPECT_EQ(why(1, TextureOf::alpha), "");
    for (const float bad : {-1e-30f, std::nanf(""), HUGE_VALF, 1.01f})
        for (const TextureOf of : {TextureOf::rho_d, TextureOf::alpha})
            EXPECT_THAT(why(bad, of), HasSubstr("texel (2, 1)"));
    EXPECT_THAT(why(0, TextureOf::alpha), HasSubstr("above 0"));
    RgbImage coloured = image_of(3, 2);
    coloured.rgb[3 * 4] = 0.7f;
    EXPECT_EQ(why_no_texture(coloured, TextureOf::rho_d), "");
    EXPECT_THAT(why_no_texture(coloured, TextureOf::alpha), HasSubstr("texel (1, 1)"));
}

}  // namespace
}  // namespace crescent::inline scene
