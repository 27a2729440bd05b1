// Which texel is where, and which images are refused.
#include "scene/texture.h"

#include <cmath>
#include <cstring>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <limits>

#include "base/errors.h"

namespace crescent {
namespace texture_test {

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

}  // namespace texture_test

// ---- A pack gives back the texels and their hash; a damaged one is refused with the place.
namespace texture_test {

RgbImage image() {
    RgbImage out{.width = 2, .height = 3, .rgb = {}, .halves = {}};
    for (int k = 0; k < 18; ++k) out.rgb.push_back(0.25f * static_cast<float>(k));
    out.rgb[4] = std::numeric_limits<float>::infinity();  // whether a texel is usable is not decided here
    out.hash = hash_of_texels(out);
    return out;
}

std::string message_of(const std::string& bytes) {
    try {
        read_image_file(bytes, "sky.image");
    } catch (const InputError& error) { return error.what(); }
    return "";
}

std::string with(std::string bytes, std::size_t at, std::uint32_t value) {
    std::memcpy(bytes.data() + at, &value, sizeof value);
    return bytes;
}

TEST(ImagePack, GivesBackTheTexels) {
    const RgbImage from = image();
    const std::string bytes = image_file(from);
    ASSERT_TRUE(is_image_file(bytes));
    const auto to = read_image_file(bytes, "sky.image");
    EXPECT_EQ(to->width, 2);
    EXPECT_EQ(to->height, 3);
    EXPECT_EQ(to->rgb, from.rgb);
    EXPECT_EQ(to->hash, from.hash);
}

TEST(ImagePack, RefusesADamagedFileWithThePlace) {
    const std::string bytes = image_file(image());
    EXPECT_NE(message_of("no image").find("crescentimag"), std::string::npos);
    EXPECT_NE(message_of(bytes.substr(0, 20)).find("header has 32 bytes"), std::string::npos);
    EXPECT_NE(message_of(bytes.substr(0, bytes.size() - 1)).find("truncated"), std::string::npos);
    EXPECT_NE(message_of(with(bytes, 12, 2)).find("byte 12: expected version 1"), std::string::npos);
    EXPECT_NE(message_of(with(bytes, 16, 0)).find("byte 16"), std::string::npos);
    EXPECT_NE(message_of(with(bytes, 16, 100'000)).find("byte 16"), std::string::npos);
    EXPECT_NE(message_of(with(bytes, 16, 8000)).find("truncated"), std::string::npos);
    EXPECT_NE(message_of(with(bytes, 40, 1)).find("damaged"), std::string::npos);
}

}  // namespace texture_test
}  // namespace crescent
