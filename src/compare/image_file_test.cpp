// Pictures of 8 and 16 bits: every format means the same, and what cannot be read as it is meant is refused.
#include <png.h>

#include <cmath>
#include <cstdint>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <random>
#include <string>
#include <vector>

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>

#include "compare/other_channels.h"
#include "compare/renders.h"
#include "output/tone_map.h"
#include "tests/support/memory_renders.h"
#include "tests/support/scratch_folder.h"

namespace crescent {

namespace image_file_test {

using ::testing::HasSubstr;

using Images = ScratchFolder;

/// Three by two pixels, rows from the top, with alpha.
constexpr int width = 3, height = 2;
const std::vector<unsigned char> rgba = {255, 0, 0, 255, 0, 128, 0, 128, 0, 0, 64, 0,  //
    255, 255, 255, 255, 10, 20, 30, 40, 1, 2, 3, 4};

std::vector<unsigned char> without_alpha() {
    std::vector<unsigned char> out;
    for (std::size_t i = 0; i < rgba.size(); ++i)
        if (i % 4 != 3) out.push_back(rgba[i]);
    return out;
}

void append(void* to, void* data, int size) {
    static_cast<std::string*>(to)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
}

/// The picture in a format, by its usual extension.
std::string picture(const std::string& format) {
    const std::vector<unsigned char> rgb = without_alpha();
    std::string out;
    if (format == "png") stbi_write_png_to_func(append, &out, width, height, 4, rgba.data(), width * 4);
    if (format == "bmp") stbi_write_bmp_to_func(append, &out, width, height, 3, rgb.data());
    if (format == "tga") stbi_write_tga_to_func(append, &out, width, height, 4, rgba.data());
    if (format == "jpg") {
        const std::vector<unsigned char> flat(64 * 64 * 3, 128);
        constexpr int quality = 95;
        stbi_write_jpg_to_func(append, &out, 64, 64, 3, flat.data(), quality);
    }
    if (format == "hdr") {
        out = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 4\n";
        for (int k = 0; k < 16; ++k) out += "\x80\x80\x80\x80";  // 0.5
    }
    if (format == "ppm") out = "P6\n# a comment\n3 2\n255\n" + std::string(rgb.begin(), rgb.end());
    return out;
}

/// A PNG of linear numbers of 16 bits, as its gAMA states.
std::string wide_png(const std::vector<std::uint16_t>& rgb) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = width;
    image.height = height;
    image.format = PNG_FORMAT_LINEAR_RGB;
    png_alloc_size_t size = 0;
    EXPECT_TRUE(png_image_write_to_memory(&image, nullptr, &size, 0, rgb.data(), 0, nullptr));
    std::string out(size, '\0');
    EXPECT_TRUE(png_image_write_to_memory(&image, out.data(), &size, 0, rgb.data(), 0, nullptr));
    return out;
}

TEST_F(Images, OfEightBitsMeanTheSameInEveryFormat) {
    const std::vector<unsigned char> rgb = without_alpha();
    for (const char* format : {"png", "bmp", "tga", "ppm"}) {
        SCOPED_TRACE(format);
        const Render r = read_render(write(std::string("a.") + format, picture(format)));
        ASSERT_EQ(r.width, width);
        ASSERT_EQ(r.height, height);
        EXPECT_TRUE(r.display_referred);
        for (std::size_t k = 0; k < r.size(); ++k) {
            const std::size_t row = k / width, x = k % width, from = ((height - 1 - row) * width + x) * 3;
            const float channels[] = {r.r[k], r.g[k], r.b[k]};
            for (std::size_t c = 0; c < 3; ++c) {
                const auto wanted = static_cast<float>(srgb_decode(rgb[from + c] / 255.0));
                EXPECT_EQ(channels[c], wanted) << k;
                EXPECT_EQ(r.steps.number_of(static_cast<double>(channels[c])), rgb[from + c]);
            }
        }
    }
    const Render jpeg = read_render(write("a.jpg", picture("jpg")));
    EXPECT_NEAR(jpeg.g[100], srgb_decode(128 / 255.0), 0.02);
    EXPECT_EQ(read_render(write("a.hdr", picture("hdr"))).b[3], 0.5f);
}

TEST_F(Images, AreReadAsTheUserStates) {
    const std::string file = write("a.png", picture("png"));
    const auto green = [&](ImageEncoding encoding, ImageSpace space) {
        return read_render(file, "", {.encoding = encoding, .space = space, .channel = ""}).g[4];
    };
    EXPECT_FLOAT_EQ(green(ImageEncoding::linear, ImageSpace::radiance), 128 / 255.0f);
    EXPECT_FLOAT_EQ(green(ImageEncoding::srgb, ImageSpace::display), 128 / 255.0f);
    EXPECT_FLOAT_EQ(green(ImageEncoding::srgb, ImageSpace::radiance), 0.2158605f);
    const Render with_alpha = read_render(file, "", {.channels = TestedChannels::rgba, .channel = ""});
    EXPECT_FLOAT_EQ(with_alpha.alpha[4], 128 / 255.0f);
    EXPECT_TRUE(read_render(file).alpha.empty());
    EXPECT_FLOAT_EQ(read_render(file, "", {.channel = "A"}).r[4], 128 / 255.0f);
    EXPECT_THAT(refusal([&] { return read_render(file, "", {.channel = "Z"}); }), HasSubstr("expected one of R, G, B"));
    const std::string opaque = write("a.bmp", picture("bmp"));
    EXPECT_THAT(refusal([&] { return read_render(opaque, "", {.channels = TestedChannels::rgba, .channel = ""}); }),
        HasSubstr("expected an alpha channel"));
}

TEST_F(Images, OfSixteenBitsAreReadInTheByteOrderAndEncodingOfTheirFormat) {
    std::vector<std::uint16_t> numbers;
    for (int i = 0; i < width * height * 3; ++i) numbers.push_back(static_cast<std::uint16_t>(1000 * i + 7));
    const Render png = read_render(write("a.png", wide_png(numbers)));
    EXPECT_FLOAT_EQ(png.r[0], 9007 / 65535.0f);  // the file states that it is linear
    EXPECT_EQ(png.steps.levels, 65536);
    std::string pgm = "P5\n1 1\n65535\n";
    pgm += '\x12';
    pgm += '\x34';
    EXPECT_FLOAT_EQ(read_render(write("a.pgm", pgm), "", {.encoding = ImageEncoding::linear, .channel = ""}).g[0],
        0x1234 / 65535.0f);
}

TEST_F(Images, ThatAreCutOffAreRefused) {
    for (const char* format : {"png", "bmp", "tga", "ppm", "jpg", "hdr"}) {
        const std::string whole = picture(format);
        // 4 bytes are more than the padding of a row of BMP.
        for (const std::size_t left : {whole.size() / 2, whole.size() - 4}) {
            const std::string file = write(std::string("cut.") + format, whole.substr(0, left));
            EXPECT_NE(refusal([&] { return read_render(file); }), "") << format << " " << left;
        }
    }
    const std::string row(32 * 4, 'x');  // as many bytes as the decoder reads at once
    std::string tga("\0\0\2\0\0\0\0\0\0\0\0\0\x20\0\2\0\x20\x28", 18);
    tga += row + row;
    EXPECT_EQ(refusal([&] { return read_render(write("rows.tga", tga)); }), "");
    for (std::size_t left = 20; left < tga.size(); left += 7)
        EXPECT_THAT(refusal([&] { return read_render(write("rows.tga", tga.substr(0, left))); }), HasSubstr("cut off"));
}

TEST_F(Images, ThatMeanSomethingElseAreRefusedByName) {
    const std::pair<std::string, const char*> bad[] = {{"P3\n1 1\n255\n1 2 3\n", "found P3: PNM as text"},
        {"P4\n8 1\nx", "found P4: a bitmap"}, {"P6\n1 1\n1023\n123456", "the largest number 255 or 65535, found 1023"},
        {"GIF89a....", "found a GIF"}, {"II*\0....", "found a TIFF"},
        {"#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n1234", ":2:1: expected FORMAT=32-bit_rle_rgbe, found XYZE"},
        {"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n+Y 1 +X 1\n1234",
            ":4:1: expected a resolution with rows from the top"}};
    for (const auto& [bytes, message] : bad)
        EXPECT_THAT(refusal([&] { return read_render(write("bad", bytes)); }), HasSubstr(message));
}

/// A header may promise more pixels than any memory holds.
TEST_F(Images, DamagedOnesAreReadOrRefused) {
    std::mt19937 random(3);
    for (const char* format : {"png", "bmp", "tga", "ppm", "jpg", "hdr"}) {
        const std::string whole = picture(format);
        for (int k = 0; k < 25; ++k) {
            std::string bytes = whole;
            for (int n = 0; n < 3; ++n)
                bytes[random() % std::min<std::size_t>(bytes.size(), 40)] = static_cast<char>(random());
            EXPECT_NO_THROW((void)refusal([&] { return read_render(write(std::string("d.") + format, bytes)); }));
        }
    }
}

TEST(Quantisation, HalfAStepIsHalfTheDistanceOfNeighbours) {
    for (const bool srgb : {false, true}) {
        const Quantisation steps{.levels = 256, .srgb = srgb};
        for (const int number : {1, 5, 20, 100, 200, 254}) {
            const auto value = [&](int k) { return srgb ? srgb_decode(k / 255.0) : k / 255.0; };
            const double distance = (value(number + 1) - value(number - 1)) / 2;
            EXPECT_NEAR(steps.half_step(value(number)), distance / 2, 0.02 * distance) << number;
            EXPECT_EQ(steps.number_of(value(number)), number);
        }
    }
}

/// With noise of a fifth of a step most pixels have one or two neighbouring numbers in all files: that is no
/// difference.
TEST(Quantisation, StepsAloneAreNoDifferenceAndLimitWhatIsFound) {
    for (const double change : {0.0, 8.0}) {
        MemoryRenders memory;
        for (const char* side : {"a", "b"})
            for (std::uint32_t k = 0; k < 6; ++k) {
                Render& r = memory.put(side + std::to_string(k), 12 * k + (*side == 'b'));
                r.steps = {.levels = 256, .srgb = false};
                r.rounding = 0;
                r.display_referred = true;
                for (std::size_t i = 0; i < r.size(); ++i) {
                    const double noise = 2 * (static_cast<double>(r.r[i]) - 1);
                    const double level = 100.5 + 0.1 * static_cast<double>(i % 7) + (*side == 'b' ? change : 0) + noise;
                    r.r[i] = r.g[i] = r.b[i] = static_cast<float>(std::round(level) / 255);
                }
            }
        const CompareResult result = memory.compare();
        EXPECT_EQ(result.differs(), change > 1) << change;
        EXPECT_GT(result.bias[0].regions.back().smallest, 1.5 / 16 / 101);  // a step and a half over 16 = sqrt(pixels)
    }
}

TEST_F(Images, OtherChannelsOfFilesWithEqualColoursAreCompared) {
    const std::string one = write("a.png", picture("png"));
    EXPECT_EQ(differing_channels(one, one, {}), "");
    std::string bytes;
    std::vector<unsigned char> other = rgba;
    other[7] = 9;
    stbi_write_png_to_func(append, &bytes, width, height, 4, other.data(), width * 4);
    EXPECT_EQ(differing_channels(one, write("b.png", bytes), {}), "A in 1 pixel");
}

TEST(Clipping, IsStatedWithItsShare) {
    MemoryRenders memory;
    for (const char* name : {"a0", "a1", "b0", "b1"}) {
        Render& r = memory.put(name, static_cast<std::uint32_t>(name[0] * 2 + name[1]));
        r.display_referred = true;
        r.steps = {.levels = 256, .srgb = true};
        for (std::size_t i = 0; i < 64; ++i) r.r[i] = r.g[i] = r.b[i] = 1;
        for (std::size_t i = 64; i < r.size(); ++i) r.r[i] = r.g[i] = r.b[i] = std::min(0.9f, 0.5f * r.r[i]);
    }
    const RenderStats all = memory.read();
    EXPECT_THAT(all.warnings, ::testing::Contains(HasSubstr("25 % of the pixels are clipped in all renders")));
    EXPECT_THAT(all.warnings, ::testing::Contains(HasSubstr("pictures for display")));
    for (const char* name : {"a0", "a1", "b0", "b1"}) {
        Render& r = memory.put(name, static_cast<std::uint32_t>(name[0] * 2 + name[1]));
        r.display_referred = true;
        std::fill(r.r.begin(), r.r.end(), 1.0f);
    }
    EXPECT_THAT(memory.read().warnings, ::testing::Contains(::testing::StartsWith("100 % of the pixels are clipped")));
}

}  // namespace image_file_test

}  // namespace crescent
