// What compare reads, how it counts, and how often it errs: on renders made here, whose truth is known.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfTiledOutputPart.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include <unistd.h>

#include "compare/compare.h"
#include "compare/judge.h"
#include "simd/random.h"

namespace crescent {
namespace {

using ::testing::HasSubstr;

/// A folder that goes with the test.
class Renders : public ::testing::Test {
protected:
    Renders() : folder_(std::filesystem::temp_directory_path() / fmt::format("crescent-compare-{}-{}", ::getpid(), count_++)) { std::filesystem::create_directories(folder_); }
    ~Renders() override { std::filesystem::remove_all(folder_); }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    std::string write(const std::string& name, const std::string& bytes) const {
        std::ofstream(path(name), std::ios::binary) << bytes;
        return path(name);
    }

    std::filesystem::path folder_;
    static inline int count_ = 0;
};

std::string bytes_of(const std::vector<float>& values) { return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)}; }

/// Two by two, rows bottom-up: red and green below, blue and white above.
const std::vector<float> four = {1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1};

void expect_four(const Render& r) {
    ASSERT_EQ(r.width, 2);
    ASSERT_EQ(r.height, 2);
    EXPECT_EQ(r.r, (std::vector<float>{1, 0, 0, 1}));
    EXPECT_EQ(r.g, (std::vector<float>{0, 1, 0, 1}));
    EXPECT_EQ(r.b, (std::vector<float>{0, 0, 1, 1}));
}

TEST_F(Renders, ReadPfmRowsFromTheBottom) { expect_four(read_render(write("a.pfm", "PF\n2 2\n-1.0\n" + bytes_of(four)))); }

TEST_F(Renders, ReadNpyRowsFromTheTop) {
    std::vector<float> top_down(four.begin() + 6, four.end());
    top_down.insert(top_down.end(), four.begin(), four.begin() + 6);
    std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 2, 3), }";
    header.resize(117, ' ');
    expect_four(read_render(write("a.npy", std::string("\x93NUMPY\x01\x00", 8) + '\x76' + '\0' + header + "\n" + bytes_of(top_down))));
}

TEST_F(Renders, ReadRadianceHdr) {
    const std::string one("\x80\0\0\x81", 4), two("\0\x80\0\x81", 4), three("\0\0\x80\x81", 4), all("\x80\x80\x80\x81", 4);
    expect_four(read_render(write("a.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 2\n" + three + all + one + two)));
}

/// Writes planes "R", "G", "B" (prefix before them) of a 2 x 2 picture into a part, tiled or not, with a data window of its own.
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
            char* base = reinterpret_cast<char*>(planes[c].data()) - 4 * (parts[k].data.min.y * w + parts[k].data.min.x);
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

TEST_F(Renders, FillTheDisplayWindowFromASmallerDataWindow) {
    Part p{"rgb", ""};
    p.data = {{0, 1}, {1, 1}};  // the lower row alone
    write_exr(path("a.exr"), {p});
    const Render r = read_render(path("a.exr"));
    EXPECT_EQ(r.r, (std::vector<float>{1, 0, 0, 0}));
    EXPECT_EQ(r.g, (std::vector<float>{0, 1, 0, 0}));
}

TEST_F(Renders, AskWhichLayerIsMeant) {
    write_exr(path("a.exr"), {{"direct", ""}, {"indirect", ""}});
    EXPECT_THROW((void)read_render(path("a.exr")), InputError);
    expect_four(read_render(path("a.exr"), "indirect"));
    try {
        (void)read_render(path("a.exr"), "indirekt");
        FAIL();
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), HasSubstr("did you mean 'indirect'?"));
    }
}

TEST_F(Renders, RefusePicturesAndBrokenFiles) {
    const std::string broken[] = {write("a.png", "\x89PNG\r\n\x1a\n"), write("b.exr", "\x76\x2f\x31\x01 cut off"), write("c.pfm", "PF\n2 2\n-1.0\n12"),
                                  write("d.pfm", "PF\n-2 2\n-1.0\n"), write("e.hdr", "#?RADIANCE\n\n-Y 2 +X 2\n"), write("f.npy", std::string("\x93NUMPY\x01\x00\x04\x00{}\n\n", 14)),
                                  write("g.txt", "hello"), path("absent.exr")};
    for (const std::string& file : broken) EXPECT_THROW((void)read_render(file), InputError) << file;
}

TEST(CompareStatistics, KnowStudentsT) {
    EXPECT_NEAR(two_sided_p(2.228139, 10), 0.05, 1e-6);  // tables of Student's t
    EXPECT_NEAR(student_quantile(0.975, 4), 2.776445, 1e-6);
    const std::vector<double> values{1, 2, 3, 4};
    const MeanInterval m = mean_interval(values, 0.95);
    EXPECT_DOUBLE_EQ(m.mean, 2.5);
    EXPECT_NEAR(m.high - m.mean, 3.182446 * std::sqrt(5.0 / 3 / 4), 1e-6);
}

TEST(CompareStatistics, AgreeWithWelchsOwnExample) {
    const std::vector<double> a{27.5, 21.0, 19.0, 23.6, 17.0, 17.9, 16.9, 20.1, 21.9, 22.6, 23.1, 19.6, 19.0, 21.7, 21.4},
        b{27.1, 22.0, 20.8, 23.4, 23.4, 23.5, 25.8, 22.0, 24.8, 20.2, 21.9, 22.1, 22.9, 30.5, 24.4};
    const Welch w = welch_test(mean_interval(a, 0.95), mean_interval(b, 0.95));
    EXPECT_NEAR(w.difference / w.se, -2.85, 0.02);
    EXPECT_NEAR(w.df, 28, 0.5);
    EXPECT_NEAR(w.p, 0.0081, 3e-4);
}

TEST(CompareStatistics, DiscoverWhatBenjaminiAndHochbergDo) {
    const std::vector<double> p{0.001, 0.008, 0.039, 0.041, 0.042, 0.06, 0.074, 0.205, std::nan("")};
    EXPECT_EQ(discoveries(p, 0.05, false), (std::vector<bool>{true, true, false, false, false, false, false, false, false}));
    EXPECT_EQ(holm(p, 0.05), (std::vector<bool>{true, false, false, false, false, false, false, false, false}));
    const std::vector<bool> careful = discoveries(p, 0.05, true);
    EXPECT_EQ(std::count(careful.begin(), careful.end(), true), 1);
}

/// Standard normal numbers from the bench's own streams (Box and Muller 1958).
double normal(std::uint32_t seed, std::uint32_t at) {
    const Vec2<float> u = draw(seed, at, 0);
    return std::sqrt(-2 * std::log(static_cast<double>(u.x))) * std::cos(2 * std::numbers::pi * static_cast<double>(u.y));
}

/// Readings of renders that are made up, not read: K of each arm, `width` squared pixels, mean 1, sd `noise`.
class Made : public Renders {
protected:
    static constexpr int width = 24;

    void film(const std::string& name, std::uint32_t seed, double noise, double mean) const {
        std::vector<float> pixels;
        for (std::uint32_t i = 0; i < width * width; ++i)
            for (int c = 0; c < 3; ++c) pixels.push_back(static_cast<float>(mean + noise * normal(seed, i)));
        write(name, fmt::format("PF\n{0} {0}\n-1.0\n", width) + bytes_of(pixels));
    }
    CompareResult compared(std::uint32_t seed, int renders, double bias, const std::vector<CompareFlag>& more = {}) const {
        for (int k = 0; k < renders; ++k) {
            film(fmt::format("a{}.pfm", k), seed * 1000 + static_cast<std::uint32_t>(k), 0.5, 1);
            film(fmt::format("b{}.pfm", k), seed * 1000 + 500 + static_cast<std::uint32_t>(k), 0.2, 1 + bias);
        }
        film("ref.pfm", 0, 0, 1);
        std::vector<CompareFlag> flags{{{"arms", "a", "files"}, path("a*.pfm"), false, ""}, {{"arms", "b", "files"}, path("b*.pfm"), false, ""},
                                       {{"reference"}, path("ref.pfm"), false, ""}, {{"alpha"}, "0.05", true, ""}};
        flags.insert(flags.end(), more.begin(), more.end());
        const ComparePlan plan = plan_of(flags);
        Watch watch;
        return judge(plan, read_all(plan, watch), watch);
    }
};

TEST_F(Made, EqualArmsAreRarelyCalledDifferent) {
    constexpr int repeats = 60;
    int alarms = 0;
    for (std::uint32_t seed = 1; seed <= repeats; ++seed) {
        const CompareResult r = compared(seed, 4, 0);
        alarms += std::any_of(r.bias.begin(), r.bias.end(), [](const BiasResult& b) { return b.differs(); });
    }
    // alpha = 0.05 for the call: 3 of 60 on average, more than 9 with probability below 0.2 %.
    EXPECT_LE(alarms, 9);
}

TEST_F(Made, ABiasOfFivePercentIsFound) {
    for (std::uint32_t seed = 1; seed <= 10; ++seed) {
        const CompareResult r = compared(seed, 6, 0.05);
        const auto found = std::find_if(r.bias.begin(), r.bias.end(), [](const BiasResult& b) { return b.a == "b" && b.b == "the reference"; });
        ASSERT_NE(found, r.bias.end());
        EXPECT_TRUE(found->differs()) << found->sentence;
        EXPECT_THAT(found->sentence, HasSubstr("differs from the reference"));
    }
}

TEST_F(Made, IntervalsHoldTheTruthAsOftenAsTheySay) {
    constexpr int repeats = 100;
    int variance = 0, bias = 0, rmse = 0;
    for (std::uint32_t seed = 1; seed <= repeats; ++seed) {
        const CompareResult r = compared(seed + 200, 6, 0.1);
        const RegionResult& b = r.arms[1].region("frame");
        const auto holds = [](const MeterValue& m, double truth) { return m.interval && m.interval->first <= truth && truth <= m.interval->second; };
        variance += holds(b.meter("var"), 0.04);
        bias += holds(b.meter("bias2"), 0.01);
        rmse += holds(b.meter("rmse"), std::sqrt(0.05));
    }
    // 95 of 100 are meant; fewer than 86 with probability below 0.1 %.
    EXPECT_GE(variance, 86);
    EXPECT_GE(bias, 86);
    EXPECT_GE(rmse, 86);
}

TEST_F(Made, MetersAreWhatTheirNamesSay) {
    const CompareResult r = compared(7, 8, 0.1, {{{"arms", "b", "seconds"}, "2", true, ""}});
    const RegionResult& b = r.arms[1].region("frame");
    EXPECT_NEAR(*b.meter("var").value, 0.04, 0.002);
    EXPECT_NEAR(*b.meter("bias2").value, 0.01, 0.001);
    EXPECT_NEAR(*b.meter("rmse").value, std::sqrt(0.05), 0.005);
    EXPECT_NEAR(*b.meter("relmse").value, 0.05 / 1.01, 0.002);
    EXPECT_NEAR(*b.meter("y_mean").value, 1.1, 0.01);
    EXPECT_NEAR(*b.meter("efficiency").value, 1 / (2 * *b.meter("var").value), 1e-9);
    EXPECT_FALSE(r.arms[0].region("frame").meter("efficiency").value);
    EXPECT_FALSE(b.heavy());
}

TEST_F(Made, SameIsSaidOnlyWhereADifferenceWouldHaveBeenSeen) {
    const std::vector<CompareFlag> same{{{"expect"}, "same", false, ""}};
    EXPECT_EQ(compared(3, 3, 0, same).state, CompareResult::State::inconclusive);
    std::vector<CompareFlag> coarse = same;
    coarse.push_back({{"smallest"}, "0.5", true, ""});
    EXPECT_EQ(compared(3, 8, 0, coarse).state, CompareResult::State::holds);
    EXPECT_EQ(compared(3, 8, 0.3, coarse).state, CompareResult::State::fails);
}

TEST_F(Made, ASpectrumTellsFilteredNoiseFromWhite) {
    std::vector<double> white, filtered;
    const auto noise = [](int x, int y) { return normal(9, static_cast<std::uint32_t>(y * 64 + x)); };
    const Box box{0, 0, 63, 63};
    add_spectrum(white, box, noise);
    add_spectrum(filtered, box, [&](int x, int y) { return noise(x, y) + noise(x + 1, y) + noise(x, y + 1) + noise(x + 1, y + 1); });
    EXPECT_EQ(noise_colour(white), NoiseColour::white);
    EXPECT_EQ(noise_colour(filtered), NoiseColour::correlated);
}

}  // namespace
}  // namespace crescent
