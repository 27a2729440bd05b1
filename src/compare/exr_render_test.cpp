// Tests OpenEXR files of every kind: pixels as OpenEXR itself reads them, names of channels, primaries, and rejected
// files.
#include "compare/exr_render.h"

#include <OpenEXR/ImfDeepFrameBuffer.h>
#include <OpenEXR/ImfDeepScanLineOutputFile.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfRgbaFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <cmath>
#include <cstring>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <limits>

#include "images/exr_file.h"
#include "compare/renders.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/written_exr.h"

namespace crescent {

namespace exr_file_test {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::vector<Imf::Compression> compressions = {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION,
    Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION, Imf::PXR24_COMPRESSION, Imf::B44_COMPRESSION, Imf::B44A_COMPRESSION,
    Imf::DWAA_COMPRESSION, Imf::DWAB_COMPRESSION};

/// Returns the dataWindow attribute of a file with other corners.
std::string with_data_window(std::string bytes, int x1, int y1) {
    const std::string key = std::string("dataWindow\0box2i\0", 17);
    const std::size_t at = bytes.find(key) + key.size() + 4 + 8;
    std::memcpy(&bytes[at], &x1, 4);
    std::memcpy(&bytes[at + 4], &y1, 4);
    return bytes;
}

class ExrFiles : public ScratchFolder {
protected:
    std::string file(const WrittenExr& exr) {
        const std::string name = path(fmt::format("{}.exr", count_++));
        exr.write(name);
        return name;
    }
    std::string refused(const WrittenExr& exr, const std::string& layer = "") {
        return refusal([&] { return read_render(file(exr), layer); });
    }
    /// Returns a channel as read by OpenEXR's C++ library, bottom row first.
    static std::vector<float> reference(const std::string& name, const char* channel) {
        Imf::InputFile in(name.c_str());
        const Imath::Box2i d = in.header().dataWindow();
        const int w = d.max.x - d.min.x + 1, h = d.max.y - d.min.y + 1;
        std::vector<float> plane(static_cast<std::size_t>(w * h));
        Imf::FrameBuffer buffer;
        buffer.insert(channel,
            Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(plane.data() + (h - 1) * w - d.min.x) + 4L * w * d.min.y, 4,
                static_cast<std::size_t>(-4L * w)));
        in.setFrameBuffer(buffer);
        in.readPixels(d.min.y, d.max.y);
        return plane;
    }
    int count_ = 0;
};

TEST_F(ExrFiles, EveryCompressionHasThePixelsThatOpenExrReads) {
    for (const Imf::Compression compression : compressions)
        for (const Imf::PixelType type : {Imf::FLOAT, Imf::HALF, Imf::UINT})
            for (const bool tiled : {false, true}) {
                SCOPED_TRACE(fmt::format(
                    "compression {} type {} tiled {}", static_cast<int>(compression), static_cast<int>(type), tiled));
                WrittenExr exr;
                exr.channels = {"A", "B", "G", "R"};
                exr.data = {{-3, 5}, {36, 60}};
                exr.compression = compression;
                exr.type = type;
                exr.tiled = tiled;
                const std::string name = file(exr);
                const Render r = read_render(name);
                ASSERT_EQ(r.size(), 40u * 56u);
                EXPECT_EQ(r.r, reference(name, "R"));
                EXPECT_EQ(r.g, reference(name, "G"));
                EXPECT_EQ(r.b, reference(name, "B"));
                if (compression == Imf::NO_COMPRESSION && type == Imf::FLOAT)
                    EXPECT_EQ(r.r[0], WrittenExr::value(3, -3, 60));
            }
}

TEST_F(ExrFiles, TilesAreReadAtFullResolution) {
    for (const Imf::LevelMode levels : {Imf::MIPMAP_LEVELS, Imf::RIPMAP_LEVELS}) {
        WrittenExr exr;
        exr.tiled = true;
        exr.levels = levels;
        const Render r = read_render(file(exr));
        ASSERT_EQ(r.size(), 21u * 13u);
        for (int y = 0; y < 13; ++y)
            for (int x = 0; x < 21; ++x)
                ASSERT_EQ(r.g[static_cast<std::size_t>((12 - y) * 21 + x)], WrittenExr::value(1, x, y));
    }
}

TEST_F(ExrFiles, ColoursAreFoundByTheirNames) {
    const std::vector<std::vector<std::string>> spellings = {{"rgba.red", "rgba.green", "rgba.blue"},
        {"C.r", "C.g", "C.b"}, {"Beauty.[red]", "Beauty.[green]", "Beauty.[blue]"}, {"Color.R", "Color.G", "Color.B"},
        {"red", "green", "blue"}, {"RED", "Green", "bLUE"},
        {"RenderLayer.Combined.R", "RenderLayer.Combined.G", "RenderLayer.Combined.B"},
        {"beauty_R", "beauty_G", "beauty_B"}, {"a.b.c.R", "a.b.c.G", "a.b.c.B"}};
    for (const auto& names : spellings) {
        SCOPED_TRACE(names[0]);
        WrittenExr exr;
        exr.channels = names;
        exr.constant = {{"depth.Z", 7}, {"N.X", 1}, {"N.Y", 1}, {"N.Z", 1}, {"motion.X", 1}, {"motion.Y", 1}};
        const std::string name = file(exr);
        const Render r = read_render(name);
        EXPECT_EQ(r.r, reference(name, names[0].c_str()));
        EXPECT_EQ(r.g, reference(name, names[1].c_str()));
        EXPECT_EQ(r.b, reference(name, names[2].c_str()));
    }
}

TEST_F(ExrFiles, SeveralLayersAreListedAndOneIsRequired) {
    WrittenExr exr;
    exr.channels = {"direct.R", "direct.G", "direct.B", "indirect.R", "indirect.G", "indirect.B"};
    EXPECT_THAT(refused(exr), AllOf(HasSubstr("--layer"), HasSubstr("'direct', 'indirect'"), HasSubstr("indirect.G")));
    EXPECT_EQ(read_render(file(exr), "indirect").r[0], WrittenExr::value(3, 0, 12));
    exr.channels = {"beauty.R", "beauty.G", "beauty.B", "rgba.R", "rgba.G", "rgba.B"};  // ambiguous
    EXPECT_THAT(refused(exr), HasSubstr("--layer"));
    exr.channels = {"beauty.R", "beauty.G", "beauty.B", "diffuse.R", "diffuse.G", "diffuse.B"};
    EXPECT_EQ(read_render(file(exr)).layer, "beauty");
    exr.channels = {"P.X", "P.Y", "P.Z"};  // positions
    EXPECT_THAT(refused(exr), HasSubstr("channels found: P.X, P.Y, P.Z"));
    EXPECT_EQ(refused(exr, "P"), "");
    exr.channels = {"r", "red", "green", "blue"};  // two reds
    EXPECT_THAT(refused(exr), HasSubstr("'r' and 'red' are the same colour"));
    exr.channels = {"R", "G", "B", "red"};
    EXPECT_EQ(read_render(file(exr)).r[0], WrittenExr::value(0, 0, 12));
    exr.channels = {"u", "v", "objectId"};
    EXPECT_THAT(refused(exr), HasSubstr("channels found: objectId, u, v"));
}

TEST_F(ExrFiles, XyzBecomesRgbOfTheSameLuminance) {
    WrittenExr exr;
    exr.channels = {};
    exr.constant = {{"X", 0.4f}, {"Y", 0.5f}, {"Z", 0.3f}};
    const Render r = read_render(file(exr));
    EXPECT_NEAR(r.y(0), 0.5, 1e-6);
    const Rgb xyz = transformed(rgb_to_xyz({}), {r.r[0], r.g[0], r.b[0]});
    EXPECT_NEAR(xyz[0], 0.4, 1e-6);
    EXPECT_NEAR(xyz[2], 0.3, 1e-6);
    exr.constant = {{"Y", 0.5f}, {"Z", 30.0f}};  // grey and depth
    EXPECT_EQ(read_render(file(exr)).g[0], 0.5f);
}

TEST_F(ExrFiles, LuminanceFollowsThePrimaries) {
    WrittenExr exr;
    exr.channels = {};
    exr.constant = {{"R", 1.0f}, {"G", 2.0f}, {"B", 4.0f}};
    EXPECT_NEAR(read_render(file(exr)).y(0), 0.2126 + 2 * 0.7152 + 4 * 0.0722, 1e-6);
    Imf::addChromaticities(exr.more, {{0.713f, 0.293f}, {0.165f, 0.83f}, {0.128f, 0.044f}, {0.32168f, 0.33767f}});
    EXPECT_NEAR(read_render(file(exr)).y(0), 0.2722287 + 2 * 0.6740818 + 4 * 0.0536895, 1e-5);
    exr.more = {};
    Imf::addChromaticities(exr.more, {{0.3f, 0.3f}, {0.3f, 0.3f}, {0.3f, 0.3f}, {0.3f, 0.3f}});
    EXPECT_THAT(refused(exr), HasSubstr("'chromaticities'"));
}

TEST_F(ExrFiles, LuminanceAndChromaAreReadByOpenExr) {
    constexpr int w = 32, h = 38;
    std::vector<Imf::Rgba> pixels(static_cast<std::size_t>(w * h), Imf::Rgba(0.5f, 0.25f, 0.125f));
    for (const Imf::Compression compression : compressions) {
        SCOPED_TRACE(static_cast<int>(compression));
        const std::string name = path("yc.exr");
        {
            Imf::RgbaOutputFile out(name.c_str(), w, h, Imf::WRITE_YC, 1, {0, 0}, 1, Imf::INCREASING_Y, compression);
            out.setFrameBuffer(pixels.data(), 1, w);
            out.writePixels(h);
        }
        const Render r = read_render(name);
        ASSERT_EQ(r.size(), pixels.size());
        for (const std::size_t i : {std::size_t{0}, std::size_t{700}, r.size() - 1}) {
            EXPECT_NEAR(r.r[i], 0.5, 5e-3);
            EXPECT_NEAR(r.g[i], 0.25, 5e-3);
            EXPECT_NEAR(r.b[i], 0.125, 5e-3);
        }
        const std::string bytes = bytes_of(name);
        EXPECT_NE(
            refusal([&] { return read_render(write("wide.exr", with_data_window(bytes, 2 * w - 1, h - 1))); }), "");
    }
    WrittenExr lower;  // which OpenEXR does not accept as luminance and chroma
    lower.channels = {"y", "ry", "by"};
    EXPECT_THAT(refused(lower), HasSubstr("channels Y, RY and BY"));
}

TEST_F(ExrFiles, DeepImagesAreNotSupported) {
    const std::string name = path("deep.exr");
    {
        Imf::Header header(2, 1);
        header.setType(Imf::DEEPSCANLINE);
        header.compression() = Imf::ZIPS_COMPRESSION;
        header.channels().insert("R", Imf::Channel(Imf::FLOAT));
        Imf::DeepScanLineOutputFile out(name.c_str(), header);
        unsigned counts[2] = {1, 1};
        float a = 1, b = 2;
        float* samples[2] = {&a, &b};
        Imf::DeepFrameBuffer buffer;
        buffer.insertSampleCountSlice(Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts), 4, 8));
        buffer.insert("R", Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(samples), 8, 16, 4));
        out.setFrameBuffer(buffer);
        out.writePixels(1);
    }
    EXPECT_THAT(refusal([&] { return read_render(name); }), HasSubstr("deep images are not supported"));
}

TEST_F(ExrFiles, CountsAndTimesAreFiniteAndNotNegative) {
    const float bad[] = {std::numeric_limits<float>::infinity(), std::nanf(""), -1.0f};
    for (const float value : bad) {
        WrittenExr exr;
        exr.more.insert("samplesPerPixel", Imf::FloatAttribute(value));
        EXPECT_THAT(refused(exr), HasSubstr("'samplesPerPixel'"));
        exr.more = {};
        exr.more.insert("cycles.ViewLayer.render_time", Imf::DoubleAttribute(static_cast<double>(value)));
        EXPECT_THAT(refused(exr), HasSubstr("render_time"));
        exr.more = {};
        exr.constant = {{"samples", value}};
        EXPECT_THAT(refused(exr), HasSubstr("'samples'"));
    }
    for (const char* text : {"nan", "inf", "-3", "1e999", "01:nan"}) {
        WrittenExr exr;
        exr.more.insert("renderTime", Imf::StringAttribute(text));
        EXPECT_THAT(refused(exr), HasSubstr("'renderTime'")) << text;
    }
    WrittenExr exr;
    exr.more.insert("spp", Imf::IntAttribute(64));
    exr.more.insert("renderTime", Imf::StringAttribute("unknown"));
    EXPECT_EQ(read_render(file(exr)).spp, 64);
}

TEST_F(ExrFiles, HeadersWithMorePixelsThanTheFileAreRefused) {
    for (const Imf::Compression compression : compressions)
        for (const Imf::PixelType type : {Imf::FLOAT, Imf::HALF}) {
            SCOPED_TRACE(fmt::format("compression {} type {}", static_cast<int>(compression), static_cast<int>(type)));
            WrittenExr exr;
            exr.data = exr.display = {{0, 0}, {31, 15}};
            exr.compression = compression;
            exr.type = type;
            const std::string bytes = bytes_of(file(exr));
            ASSERT_EQ(refusal([&] { return read_render(write("same.exr", with_data_window(bytes, 31, 15))); }), "");
            for (const auto& [x, y] : {std::pair{63, 15}, {31, 31}, {14090263, 15}, {31, 2147483647}, {-1, 15}})
                EXPECT_THAT(refusal([&] { return read_render(write("more.exr", with_data_window(bytes, x, y))); }),
                    HasSubstr("more.exr: "))
                    << x << " " << y;
        }
}

TEST_F(ExrFiles, TruncatedFilesAreRefused) {
    for (const Imf::Compression compression : {Imf::NO_COMPRESSION, Imf::PIZ_COMPRESSION, Imf::DWAA_COMPRESSION}) {
        WrittenExr exr;
        exr.compression = compression;
        const std::string bytes = bytes_of(file(exr));
        for (std::size_t n = 0; n < bytes.size(); n += n < 500 ? 7 : 31)
            EXPECT_THAT(
                refusal([&] { return read_render(write("cut.exr", bytes.substr(0, n))); }), HasSubstr("cut.exr: "))
                << n;
    }
}

}  // namespace exr_file_test

// ---- Primaries: published matrices, white is preserved, XYZ keeps its luminance.

namespace exr_file_test {

constexpr Chromaticities ap1{{0.713, 0.293}, {0.165, 0.83}, {0.128, 0.044}, {0.32168, 0.33767}};  // ACEScg
constexpr Chromaticities rec2020{{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, {0.3127, 0.3290}};

void expect_near(const Rgb& a, const Rgb& b, double within) {
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], within) << c;
}

TEST(Primaries, LuminanceWeightsAreThosePublished) {
    expect_near(luminance_weights_of(ap1), {0.2722287, 0.6740818, 0.0536895}, 1e-6);  // Academy S-2014-004
    expect_near(luminance_weights_of(rec2020), {0.2627, 0.6780, 0.0593}, 1e-4);       // ITU-R BT.2020
    expect_near(luminance_weights_of({}), {0.2126, 0.7152, 0.0722}, 0);
}

TEST(Primaries, ConversionsAreThosePublished) {
    // ITU-R BT.2087: linear Rec.709 in Rec.2020.
    const Matrix3 m = conversion({}, rec2020);
    expect_near(m[0], {0.6274, 0.3293, 0.0433}, 2e-4);
    expect_near(m[1], {0.0691, 0.9195, 0.0114}, 2e-4);
    expect_near(m[2], {0.0164, 0.0880, 0.8956}, 2e-4);
    // ACEScg to linear sRGB with Bradford's adaptation, as OpenColorIO's ACES configurations have it.
    const Matrix3 a = conversion(ap1, {});
    expect_near(a[0], {1.70505, -0.62179, -0.08326}, 3e-4);
    expect_near(a[1], {-0.13026, 1.14080, -0.01055}, 3e-4);
    expect_near(a[2], {-0.02400, -0.12897, 1.15297}, 3e-4);
}

TEST(Primaries, WhiteIsPreservedAndConversionsAreInvertible) {
    expect_near(transformed(conversion(ap1, {}), {1, 1, 1}), {1, 1, 1}, 1e-12);
    const Rgb colour{0.2, 0.7, 0.4};
    expect_near(transformed(conversion({}, ap1), transformed(conversion(ap1, {}), colour)), colour, 1e-12);
}

TEST(Primaries, XyzKeepsItsLuminance) {
    const Rgb rgb = transformed(xyz_to_rgb({}), {0.3, 0.5, 0.9});
    EXPECT_NEAR(luminance(rgb), 0.5, 1e-12);
    expect_near(transformed(rgb_to_xyz({}), rgb), {0.3, 0.5, 0.9}, 1e-12);
    constexpr Chromaticities itself{{1, 0}, {0, 1}, {0, 0}, {1. / 3, 1. / 3}};
    EXPECT_TRUE(is_valid(itself));
    expect_near(luminance_weights_of(itself), {0, 1, 0}, 1e-12);
    expect_near(transformed(conversion(itself, {}), {0.3, 0.5, 0.9}), rgb, 1e-12);
}

TEST(Primaries, DegeneratePrimariesAreNotValid) {
    EXPECT_TRUE(is_valid({}) && is_valid(ap1));
    EXPECT_FALSE(is_valid({{0.64, 0.33}, {0.64, 0.33}, {0.15, 0.06}, {0.3127, 0.3290}}));
    EXPECT_FALSE(is_valid({{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {0.3127, 0}}));
    EXPECT_FALSE(is_valid({{0.64, std::nan("")}, {0.30, 0.60}, {0.15, 0.06}, {0.3127, 0.3290}}));
    EXPECT_FALSE(is_valid({{0, 0}, {0, 0}, {0, 0}, {0, 0}}));
}

}  // namespace exr_file_test

}  // namespace crescent
