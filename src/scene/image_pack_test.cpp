// A pack gives back the texels and their hash; a damaged one is refused with the place.
#include "scene/image_pack.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "base/errors.h"

namespace crescent {
namespace {

RgbImage image() {
    RgbImage out{2, 3, {}, 0};
    for (int k = 0; k < 18; ++k) out.rgb.push_back(0.25f * static_cast<float>(k));
    out.rgb[4] = std::numeric_limits<float>::infinity();  // whether a texel is usable is not decided here
    out.hash = hash_of_texels(out.width, out.height, out.rgb);
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

}  // namespace
}  // namespace crescent
