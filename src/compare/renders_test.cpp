// Tests which files compare reads, in the formats of renderers, and which it rejects.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTiledOutputPart.h>
#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <random>

#include "base/npy.h"
#include "compare/renders.h"
#include "tests/support/memory_renders.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/written_exr.h"

namespace crescent {

namespace renders_test {

using ::testing::HasSubstr;

using Renders = ScratchFolder;

std::string raw(const std::vector<float>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)};
}

/// Two by two, rows bottom-up: red and green below, blue and white above.
const std::vector<float> four = {1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1};

void expect_four(const Render& r) {
    ASSERT_EQ(r.width, 2);
    ASSERT_EQ(r.height, 2);
    EXPECT_EQ(r.r, (std::vector<float>{1, 0, 0, 1}));
    EXPECT_EQ(r.g, (std::vector<float>{0, 1, 0, 1}));
    EXPECT_EQ(r.b, (std::vector<float>{0, 0, 1, 1}));
}

TEST_F(Renders, ReadPfmRowsFromTheBottom) { expect_four(read_render(write("a.pfm", "PF\n2 2\n-1.0\n" + raw(four)))); }

TEST_F(Renders, ReadNpyRowsFromTheTop) {
    std::vector<float> top_down(four.begin() + 6, four.end());
    top_down.insert(top_down.end(), four.begin(), four.begin() + 6);
    std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 2, 3), }";
    header.resize(117, ' ');
    expect_four(read_render(
        write("a.npy", std::string("\x93NUMPY\x01\x00", 8) + '\x76' + '\0' + header + "\n" + raw(top_down))));
}

TEST_F(Renders, ReadRadianceHdr) {
    const std::string one("\x80\0\0\x81", 4), two("\0\x80\0\x81", 4), three("\0\0\x80\x81", 4),
        all("\x80\x80\x80\x81", 4);
    expect_four(
        read_render(write("a.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 2\n" + three + all + one + two)));
}

/// Writes planes "R", "G", "B" (with a prefix) of a 2 x 2 picture into a part, tiled or not, with its own data window.
struct Part {
    std::string name, prefix;
    bool tiled = false;
    Imath::Box2i display{{0, 0}, {1, 1}}, data{{0, 0}, {1, 1}};
};
void write_exr(const std::string& path, const std::vector<Part>& parts) {
    std::vector<Imf::Header> headers;
    for (const Part& p : parts) {
        Imf::Header h(p.display, p.data);
        h.setName(p.name);
        h.setType(p.tiled ? Imf::TILEDIMAGE : Imf::SCANLINEIMAGE);
        if (p.tiled) h.setTileDescription(Imf::TileDescription(16, 16));
        for (const char* c : {"R", "G", "B"}) h.channels().insert(p.prefix + c, Imf::Channel(Imf::FLOAT));
        headers.push_back(h);
    }
    Imf::MultiPartOutputFile file(path.c_str(), headers.data(), static_cast<int>(headers.size()));
    for (std::size_t k = 0; k < parts.size(); ++k) {
        const int w = parts[k].data.max.x - parts[k].data.min.x + 1;
        std::vector<float> planes[3];
        Imf::FrameBuffer buffer;
        const char* names[] = {"R", "G", "B"};
        for (std::size_t c = 0; c < 3; ++c) {
            for (int y = parts[k].data.min.y; y <= parts[k].data.max.y; ++y)
                for (int x = parts[k].data.min.x; x <= parts[k].data.max.x; ++x)
                    planes[c].push_back(four[static_cast<std::size_t>(((1 - y) * 2 + x) * 3) + c]);
            char* base =
                reinterpret_cast<char*>(planes[c].data()) - 4 * (parts[k].data.min.y * w + parts[k].data.min.x);
            buffer.insert(parts[k].prefix + names[c], Imf::Slice(Imf::FLOAT, base, 4, static_cast<std::size_t>(4 * w)));
        }
        if (parts[k].tiled) {
            Imf::TiledOutputPart part(file, static_cast<int>(k));
            part.setFrameBuffer(buffer);
            part.writeTiles(0, 0, 0, 0);
        } else {
            Imf::OutputPart part(file, static_cast<int>(k));
            part.setFrameBuffer(buffer);
            part.writePixels(parts[k].data.max.y - parts[k].data.min.y + 1);
        }
    }
}

/// One pixel, one value per channel.
void write_planes(const std::string& path, const std::vector<std::pair<std::string, float>>& planes) {
    Imf::Header header(1, 1);
    header.insert("cycles.ViewLayer.render_time", Imf::StringAttribute("01:03.50"));
    header.setName("rgb");
    header.setType(Imf::SCANLINEIMAGE);
    for (const auto& [name, value] : planes) header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    Imf::MultiPartOutputFile file(path.c_str(), &header, 1);
    std::vector<float> values;
    for (const auto& [name, value] : planes) values.push_back(value);
    Imf::FrameBuffer buffer;
    for (std::size_t k = 0; k < planes.size(); ++k)
        buffer.insert(planes[k].first, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(&values[k]), 4, 4));
    Imf::OutputPart part(file, 0);
    part.setFrameBuffer(buffer);
    part.writePixels(1);
}

TEST_F(Renders, ReadOpenExrAsRenderersWriteIt) {
    write_exr(path("plain.exr"), {{"rgb", ""}});
    write_exr(path("tiled.exr"), {{"rgb", "", true}});
    write_exr(path("layers.exr"), {{"rgb", "RenderLayer.Combined."}});
    write_exr(path("parts.exr"), {{"crypto00", "CryptoObject00."}, {"beauty", ""}, {"N", "normal."}});
    for (const char* name : {"plain", "tiled", "layers", "parts"}) {
        SCOPED_TRACE(name);
        expect_four(read_render(path(std::string(name) + ".exr")));
    }
}

TEST_F(Renders, HaveThePixelsOfTheirDataWindow) {
    Part p{"rgb", ""};
    p.data = {{0, 1}, {1, 1}};  // only the lower row
    write_exr(path("a.exr"), {p});
    const Render r = read_render(path("a.exr"));
    EXPECT_EQ(r.data, (PixelWindow{0, 1, 1, 1}));
    EXPECT_EQ(r.display, (PixelWindow{0, 0, 1, 1}));
    EXPECT_EQ(r.r, (std::vector<float>{1, 0}));
    EXPECT_EQ(r.g, (std::vector<float>{0, 1}));
}

TEST_F(Renders, TakeVariancesAndSamplesByTheirNames) {
    write_exr(path("own.exr"), {{"rgb", ""}, {"variance", ""}});
    EXPECT_TRUE(read_render(path("own.exr")).variance.empty());  // of another part: not the variance of this radiance
    write_planes(path("pbrt.exr"),
        {{"R", 2}, {"G", 2}, {"B", 2}, {"Variance.R", 4}, {"Variance.G", 4}, {"Variance.B", 4},
            {"RelativeVariance.R", 1}});
    const Render pbrt = read_render(path("pbrt.exr"));
    EXPECT_TRUE(pbrt.per_sample);
    EXPECT_NEAR(pbrt.variance[0], 4, 1e-5);
    write_planes(path("moment.exr"), {{"R", 3}, {"G", 3}, {"B", 3}, {"nested.Y", 3}, {"m2_nested.Y", 13}});
    const Render moment = read_render(path("moment.exr"));
    EXPECT_TRUE(moment.per_sample);
    EXPECT_NEAR(moment.variance[0], 4, 1e-5);
    EXPECT_EQ(moment.variance_channels, "m2_nested.Y, nested.Y");
    write_planes(path("error.exr"), {{"R", 3}, {"G", 3}, {"B", 3}, {"stddev.Y", 0.5f}, {"Debug Sample Count.X", 64}});
    const Render error = read_render(path("error.exr"));
    EXPECT_FALSE(error.per_sample);
    EXPECT_NEAR(error.variance[0], 0.25, 1e-6);
    EXPECT_EQ(error.spp, 64);
    EXPECT_EQ(error.seconds, 63.5);
    EXPECT_EQ(error.sample_channel, "Debug Sample Count.X");
}

TEST_F(Renders, RequireALayerIfSeveralFit) {
    write_exr(path("one.exr"), {{"quadrature", ""}});
    expect_four(read_render(path("one.exr"), "quadrature"));  // selected by its name, although it is the only layer
    write_exr(path("a.exr"), {{"direct", ""}, {"indirect", ""}});
    EXPECT_THROW((void)read_render(path("a.exr")), InputError);
    expect_four(read_render(path("a.exr"), "indirect"));
    try {
        (void)read_render(path("a.exr"), "indirekt");
        FAIL();
    } catch (const InputError& e) { EXPECT_THAT(e.what(), HasSubstr("did you mean 'indirect'?")); }
}

TEST_F(Renders, HaveLayersInOpenExrAlone) {
    const std::string npy = std::string("\x93NUMPY\x01\0", 8) + std::string("\x46\0", 2) +
        "{'descr': '<f4', 'fortran_order': False, 'shape': (1, 1), }          \n" + std::string(4, '\0');
    const std::string files[] = {write("layer.pfm", "Pf\n1 1\n-1\n" + std::string(4, '\0')), write("layer.npy", npy),
        write("layer.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\x80\x80\x80\x80"),
        write("layer.png", "\x89PNG\r\n\x1a\n")};
    for (const std::string& file : files) {
        try {
            (void)read_render(file, "albedo");
            FAIL() << file;
        } catch (const InputError& e) {
            EXPECT_THAT(e.what(), HasSubstr(file + ": no layer 'albedo': only OpenEXR files have layers"));
        }
    }
    EXPECT_EQ(read_render(files[0]).width, 1);
}

TEST_F(Renders, RefusePicturesAndBrokenFiles) {
    const std::string broken[] = {write("a.png", "\x89PNG\r\n\x1a\n"), write("b.exr", "\x76\x2f\x31\x01 cut off"),
        write("c.pfm", "PF\n2 2\n-1.0\n12"), write("d.pfm", "PF\n-2 2\n-1.0\n"),
        write("e.hdr", "#?RADIANCE\n\n-Y 2 +X 2\n"), write("f.npy", std::string("\x93NUMPY\x01\x00\x04\x00{}\n\n", 14)),
        write("g.txt", "hello"), path("absent.exr")};
    for (const std::string& file : broken) EXPECT_THROW((void)read_render(file), InputError) << file;
}

TEST_F(Renders, TextHeadersAreRefusedWithTheirLine) {
    const std::pair<const char*, const char*> bad[] = {{"PF\n2 2\n\n....", ":3:1: expected a scale"},
        {"PF\n2\n\n....", ":3:1: expected a width and a height"}, {"PF4\n2 2\n-1\n", ":1:1: expected 'PF'"},
        {"PF\n2 x\n-1\n", ":2:1: expected a width"}, {"PF\n2 2\nnan\n", ":3:1: expected a scale"},
        {"PF\n2 2\n0\n", ":3:1: expected a scale"}, {"PF\n70000 2\n-1\n", ":2:1: expected 1 to 65536"},
        {"PF\n2 2", ":2:1: expected a line"}, {"Pf\n60000 60000\n-1\n....", "the file is cut off"},
        {"#?RADIANCE\nEXPOSURE=\n\n-Y 2 +X 2\n", ":2:1: expected EXPOSURE="},
        {"#?RADIANCE\nEXPOSURE=-1\n\n-Y 2 +X 2\n", ":2:1: expected EXPOSURE="},
        {"#?RADIANCE\nEXPOSURE=inf\n\n-Y 2 +X 2\n", ":2:1: expected EXPOSURE="},
        {"#?RADIANCE\nFORMAT=32-bit_rle_cmyk\n\n-Y 2 +X 2\n", ":2:1: expected FORMAT="},
        {"#?RADIANCE\nPRIMARIES=1 2 3\n\n-Y 2 +X 2\n", ":2:1: expected PRIMARIES="},
        {"#?RADIANCE\nCOLORCORR=1 0 1\n\n-Y 2 +X 2\n", ":2:1: expected COLORCORR="},
        {"#?RADIANCE\n\n-Y two +X 2\n", ":3:1: expected a resolution"},
        {"#?RADIANCE\n\n\n", ":3:1: expected a resolution"},
        {"#?RADIANCE\n\n-Y 60000 +X 60000\n....", "the file is cut off"}};
    for (const auto& [text, message] : bad)
        EXPECT_THAT(refusal([&] { return read_render(write("bad", text)); }), HasSubstr(message)) << text;
}

TEST_F(Renders, NpyHeadersAreRefusedWithWhatWasExpected) {
    const auto npy = [](const std::string& dictionary, char version = 1) {
        return std::string("\x93NUMPY") + version + '\0' + static_cast<char>(dictionary.size()) + '\0' + dictionary +
            "1234";
    };
    const std::pair<std::string, const char*> bad[] = {{npy("{}"), "expected 'descr'"},
        {npy("{'descr': '<i4', 'fortran_order': False, 'shape': (1, 1)}"), "expected a 'descr' of floats"},
        {npy("{'descr': '<f4', 'fortran_order': False, 'shape': (1, -1)}"), "expected a 'shape'"},
        {npy("{'descr': '<f4', 'fortran_order': False, 'shape': (1, 1"), "expected a 'shape'"},
        {npy("{'descr': '<f4', 'fortran_order': False, 'shape': 1}"), "expected a 'shape'"},
        {npy("{'descr': '<f4', 'shape': (1, 1)}"), "expected 'fortran_order'"},
        {npy("{'descr': '<f4', 'fortran_order': False, 'shape': (1, 1, 2)}"), "1, 3 or 4"},
        {npy("{'descr': '<f4', 'fortran_order': False, 'shape': ()}"), "1, 3 or 4"},
        {npy("{'descr': '<f4', 'fortran_order': False, 'shape': (60000, 60000)}"), "the file is cut off"},
        {npy("{'descr': '<f4', 'fortran_order': False, 'shape': (18446744073709551615, 4)}"), "pixels a side"},
        {npy("{'descr': '<f4'", 9), "byte 7: expected an NPY format of 1 to 3"},
        {std::string("\x93NUMPY\1\0\xff\xff{", 11), "expected an NPY file"},
        {std::string("\x93NUMPY\1\0\xff\x7f{}", 12), "byte 9: "}};
    for (const auto& [bytes, message] : bad)
        EXPECT_THAT(refusal([&] { return read_render(write("bad.npy", bytes)); }), HasSubstr(message)) << bytes;
    for (const char* good : {"{\"shape\": (1, 1,), 'descr': '>f4', 'fortran_order': True}",
             "{'descr':'>f4','fortran_order':False,'shape':(1,1,1)}"})
        EXPECT_FLOAT_EQ(read_render(write("a.npy", npy(good))).b[0], 2.5931515e-9f);  // the bytes of "1234"
}

TEST_F(Renders, RadianceHdrMeansTheSameInEveryEncoding) {
    const std::string pixel("\x80\x40\x20\x82", 4);
    std::string flat;
    for (int i = 0; i < 20; ++i) flat += pixel;
    const std::string size = "\n-Y 1 +X 20\n", begin = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n";
    const std::string coded = std::string("\2\2\0\x14", 4) + "\x94\x80\x94\x40\x94\x20\x94\x82";
    for (const std::string& bytes : {flat, coded}) {
        const Render r = read_render(write("a.hdr", begin + size + bytes));
        EXPECT_EQ(r.r, std::vector<float>(20, 2.0f));
        EXPECT_EQ(r.g, std::vector<float>(20, 1.0f));
        EXPECT_EQ(r.b, std::vector<float>(20, 0.5f));
    }
    const Render corrected =
        read_render(write("b.hdr", begin + "EXPOSURE=2\nEXPOSURE= 2\nCOLORCORR=1 2 4\n" + size + flat));
    EXPECT_EQ(corrected.r[0], 0.5f);
    EXPECT_EQ(corrected.g[0], 0.125f);
    EXPECT_EQ(corrected.b[0], 0.03125f);
    const Render aces =
        read_render(write("d.hdr", begin + "PRIMARIES=.713 .293 .165 .83 .128 .044 .32168 .33767\n" + size + flat));
    EXPECT_NEAR(aces.y(0), 2 * 0.2722287 + 0.6740818 + 0.5 * 0.0536895, 1e-5);
}

/// Damaged files of every format are read or rejected, without other exceptions and without a crash.
TEST_F(Renders, DamagedFilesAreReadOrRefused) {
    std::vector<std::string> whole = {"PF\n2 2\n-1.0\n" + raw(four),
        "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=1\n\n-Y 1 +X 9\n" +
            std::string("\2\2\0\x9\x89\x80\x89\x40\x89\x20\x89\x82", 12),
        std::string("\x93NUMPY\1\0\x3c\0{'descr': '<f4', 'fortran_order': False, 'shape': (1, 1)}   ....", 74)};
    for (const Imf::Compression c : {Imf::NO_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION,
             Imf::PXR24_COMPRESSION, Imf::B44_COMPRESSION, Imf::DWAA_COMPRESSION})
        for (const bool tiled : {false, true}) {
            WrittenExr exr;
            exr.compression = c;
            exr.tiled = tiled;
            exr.type = Imf::HALF;
            exr.write(path("whole.exr"));
            whole.push_back(bytes_of(path("whole.exr")));
        }
    std::mt19937 random(1);
    const auto below = [&](std::size_t n) { return n ? random() % n : 0; };
    for (int k = 0; k < 1500; ++k) {
        std::string bytes = whole[below(whole.size())];
        for (std::size_t n = 1 + below(3); n-- > 0 && !bytes.empty();) {
            const std::size_t at = below(2) ? below(bytes.size()) : below(std::min<std::size_t>(bytes.size(), 450));
            const std::size_t what = below(5);
            if (what == 0) bytes[at] = static_cast<char>(random());
            if (what == 1) bytes[at] = static_cast<char>(bytes[at] ^ 1 << below(8));
            if (what == 2) bytes.resize(at);
            if (what == 3) bytes.insert(at, 1, static_cast<char>(random()));
            if (what == 4) bytes.erase(at, 1 + below(6));
        }
        EXPECT_NO_THROW((void)refusal([&] { return read_render(write("damaged", bytes)); })) << k;
    }
}

}  // namespace renders_test

// ---- Whether renders fit each other: renders in memory.

namespace renders_test {

using ::testing::HasSubstr;

class Memory : public ::testing::Test, public MemoryRenders {
protected:
    std::string refusal(const std::vector<CompareFlag>& flags = {}) const {
        try {
            (void)read(flags);
        } catch (const InputError& error) { return error.what(); }
        return "";
    }
};

TEST_F(Memory, APixelThatIsNotFiniteIsLeftOutEverywhereAndReported) {
    put("a0", 1);
    put("a1", 2).g[17] = std::nanf("");
    put("b0", 3);
    put("b1", 4).r[18] = INFINITY;
    const RenderStats all = read();
    EXPECT_EQ(all.bad_pixels, 2u);
    EXPECT_EQ(all.regions.back().pixels.size(), 254u);
    EXPECT_THAT(all.warnings, ::testing::ElementsAre(HasSubstr("a1 (the first of 2 files): 1 pixel not finite")));
    for (const auto& render : all.arms[0].regions) EXPECT_TRUE(std::isfinite(render.back().y));
}

TEST_F(Memory, CopiesInOneArmAreRefusedAndInTwoArmsReported) {
    put("a0", 1);
    put("a1", 2);
    put("b0", 1);
    put("b1", 3);
    EXPECT_THAT(read().warnings, ::testing::ElementsAre(HasSubstr("b0 of b: the same pixels as a0 of a")));
    put("a2", 2);
    EXPECT_THAT(refusal(), HasSubstr("a2: the same pixels as a1"));
}

TEST_F(Memory, SizesThatDifferAreRefused) {
    put("a0", 1);
    put("a1", 2);
    put("b0", 3, 17);
    EXPECT_THAT(refusal(), HasSubstr("b0: expected 16 x 16 pixels as in a0, found 17 x 17"));
}

TEST_F(Memory, ConstantAndNegativePixelsAreReported) {
    put("a0", 1);
    put("a1", 2).r[3] = -1;
    put("b0", 3);
    put("b1", 4);
    for (auto* plane : {&renders["b0"].r, &renders["b0"].g, &renders["b0"].b}) plane->assign(256, 0.5f);
    EXPECT_THAT(read().warnings,
        ::testing::ElementsAre(
            HasSubstr("a1: 1 pixel with a negative channel"), HasSubstr("b0: all pixels are equal")));
}

TEST_F(Memory, VarianceOfOneSampleIsDividedByTheirNumber) {
    for (const char* name : {"a0", "b0"}) {
        Render& r = put(name, name[0]);
        r.variance.assign(r.size(), 8);
        r.per_sample = true;
        r.variance_channels = "Variance.R";
    }
    const RenderStats all = read({{{"arms", "a", "spp"}, "4", true, "--spp"}});
    EXPECT_DOUBLE_EQ(all.arms[0].film.variance(0), 2);
    EXPECT_TRUE(std::isnan(all.arms[1].film.variance(0)));
    EXPECT_THAT(all.warnings, ::testing::ElementsAre(HasSubstr("b0: Variance.R is the variance of one sample")));
}

}  // namespace renders_test

}  // namespace crescent
