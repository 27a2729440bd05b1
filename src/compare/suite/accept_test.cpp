// --accept: the candidate's files become the baseline's, with a manifest; a baseline stored as moments gives the same
// numbers as its renders.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <set>

#include "base/files.h"
#include "compare/suite/suite.h"
#include "compare/synthetic.h"
#include "tests/support/scratch_folder.h"

namespace crescent::inline comparison {
namespace accept_test {

using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;
using Kind = SyntheticNoise::Kind;
namespace fs = std::filesystem;

constexpr SyntheticNoise noise{Kind::gamma, 0.2}, brighter{Kind::gamma, 0.2, 0.05};

class Accepting : public ScratchFolder {
protected:
    static constexpr int side = 64;

    /// A float render in colour, uncompressed.
    void render(const std::string& name, const SyntheticNoise& of, std::uint32_t seed) {
        fs::create_directories(fs::path(path(name)).parent_path());
        std::vector<std::vector<float>> planes(3);
        Imf::Header header(side, side);
        header.compression() = Imf::NO_COMPRESSION;
        Imf::FrameBuffer buffer;
        const char* channels[] = {"R", "G", "B"};
        for (std::uint32_t c = 0; c < 3; ++c) {
            for (std::uint32_t i = 0; i < side * side; ++i)
                planes[c].push_back(static_cast<float>(synthetic_pixel(of, 3 * seed + c, i, side)));
            header.channels().insert(channels[c], Imf::Channel(Imf::FLOAT));
            buffer.insert(channels[c],
                Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(planes[c].data()), 4, 4 * std::size_t{side}));
        }
        Imf::OutputFile file(path(name).c_str(), header);
        file.setFrameBuffer(buffer);
        file.writePixels(side);
    }
    void renders(const std::string& stem, const SyntheticNoise& of, std::uint32_t seed, int count = 6) {
        for (int k = 0; k < count; ++k)
            render(stem + std::to_string(k) + ".exr", of, seed + static_cast<std::uint32_t>(k));
    }
    Suite suite(const std::string& more = "") {
        write("s.toml",
            "[suite]\nsmallest = \"5 %\"\nbaseline = \"base/{view}-*.exr\"\ncandidate = \"out/{view}-*.exr\"\n" + more);
        return read_suite(path("s.toml"), {});
    }
    SuiteResult compare(const std::string& more = "") {
        ProgressMonitor monitor;
        return compare_suite(suite(more), monitor);
    }
    void accept(std::vector<std::string> views, const std::string& more = "") {
        ProgressMonitor monitor;
        accept_views(suite(more), {std::move(views), "a reason", "2026-01-02T03:04:05Z", "crescent test"}, monitor);
    }
    std::set<std::string> baseline() const {
        std::set<std::string> out;
        for (const auto& entry : fs::directory_iterator(path("base"))) out.insert(entry.path().filename().string());
        return out;
    }
    nlohmann::json manifest() const { return nlohmann::json::parse(contents_of(path("base/baseline.json"))); }
};

TEST_F(Accepting, TheCandidateBecomesTheBaseline) {
    renders("base/a-", noise, 10, 3), renders("base/b-", noise, 20, 2);
    renders("out/a-", brighter, 30, 2), renders("out/b-", noise, 40, 2);
    write("base/README", "mine");
    const std::string candidate = contents_of(path("out/a-1.exr"));
    accept({"a"});
    EXPECT_THAT(baseline(),
        UnorderedElementsAre(
            "a-0.exr", "a-1.exr", "b-0.exr", "b-1.exr", "README", "baseline.json", ".crescent-baseline"));
    EXPECT_EQ(contents_of(path("base/a-1.exr")), candidate);
    EXPECT_EQ(contents_of(path("base/README")), "mine");
    const auto entry = manifest()["views"]["a"];
    EXPECT_EQ(entry["because"], "a reason");
    EXPECT_EQ(entry["accepted"], "2026-01-02T03:04:05Z");
    EXPECT_EQ(entry["files"].size(), 2u);
    EXPECT_NEAR(entry["statistics"]["regions"]["frame"]["mean_y"].get<double>(), 1.05, 0.01);
    accept({});  // accepts the other views too; former files of the first view are not kept
    EXPECT_THAT(baseline(),
        UnorderedElementsAre(
            "a-0.exr", "a-1.exr", "b-0.exr", "b-1.exr", "README", "baseline.json", ".crescent-baseline"));
    EXPECT_EQ(manifest()["views"].size(), 2u);
    for (const ViewResult& view : compare().views) EXPECT_EQ(view.state, ViewState::same) << view.sentence;
}

TEST_F(Accepting, AFirstBaselineNeedsNoFormerOne) {
    renders("out/a-", noise, 30, 2);
    EXPECT_EQ(compare().views[0].state, ViewState::added);
    accept({});
    EXPECT_THAT(baseline(), UnorderedElementsAre("a-0.exr", "a-1.exr", "baseline.json", ".crescent-baseline"));
}

TEST_F(Accepting, UnknownViewsAreRefused) {
    renders("out/crown-", noise, 30, 2);
    EXPECT_THAT(refusal([&] { return accept({"crwon"}), 0; }), HasSubstr("did you mean 'crown'?"));
    EXPECT_FALSE(fs::exists(path("base")));
}

TEST_F(Accepting, MomentsGiveTheNumbersOfTheirRenders) {
    const std::string region = "[view.same]\nregions.box = [3, 4, 40, 50]\n";
    for (const char* folder : {"base/", "out/"}) {
        const std::uint32_t seed = folder[0] == 'b' ? 100 : 200;
        renders(std::string(folder) + "same-", noise, seed);
        renders(std::string(folder) + "other-", folder[0] == 'b' ? noise : brighter, seed + 50);
    }
    fs::create_directories(path("kept"));
    const SuiteResult before = compare(region);
    fs::rename(path("out"), path("candidate")), fs::rename(path("base"), path("out"));
    accept({}, "store = \"moments\"\n" + region);
    EXPECT_THAT(baseline(),
        UnorderedElementsAre("same-moments.exr", "other-moments.exr", "baseline.json", ".crescent-baseline"));
    EXPECT_LT(static_cast<double>(fs::file_size(path("base/same-moments.exr"))),
        2.1 * static_cast<double>(fs::file_size(path("out/same-0.exr"))));
    fs::remove_all(path("out")), fs::rename(path("candidate"), path("out"));
    const SuiteResult after = compare(region);
    for (std::size_t v = 0; v < 2; ++v) {
        const ViewResult &a = before.views[v], &b = after.views[v];
        EXPECT_EQ(a.state, b.state) << b.sentence;
        EXPECT_TRUE(b.moments);
        EXPECT_EQ(b.baseline_renders, 6u);
        for (std::size_t r = 0; r < a.means->regions.size(); ++r) {
            const MeanTest &x = a.means->regions[r], &y = b.means->regions[r];
            EXPECT_EQ(x.region, y.region);
            EXPECT_NEAR(x.b, y.b, 1e-6);
            EXPECT_NEAR(x.welch.se, y.welch.se, 1e-3 * x.welch.se);
            EXPECT_NEAR(x.smallest, y.smallest, 1e-2 * x.smallest);
            EXPECT_NEAR(a.variances[r].welch.se, b.variances[r].welch.se, 1e-3 * a.variances[r].welch.se);
        }
        EXPECT_EQ(a.means->tiles.tested, b.means->tiles.tested);
        EXPECT_NEAR(static_cast<double>(a.means->tiles.different), static_cast<double>(b.means->tiles.different), 1);
        EXPECT_NEAR(std::log(a.mean_p), std::log(b.mean_p), 0.05 * std::fabs(std::log(a.mean_p)) + 0.05);
    }
    const std::string without = refusal([&] { return compare("[view.same]\nregions.other = [3, 4, 40, 50]\n"); });
    EXPECT_THAT(without, HasSubstr("s.toml:6:"));
    EXPECT_THAT(without, HasSubstr("accept the view again"));
}

TEST_F(Accepting, ADeterministicViewIsComparedExactlyWithItsMoments) {
    for (int k = 0; k < 2; ++k) render("out/v-" + std::to_string(k) + ".exr", noise, 7);
    accept({}, "store = \"moments\"\n");
    EXPECT_EQ(compare().views[0].state, ViewState::same);
    EXPECT_TRUE(compare().views[0].exact);
    for (int k = 0; k < 2; ++k) render("out/v-" + std::to_string(k) + ".exr", noise, 8);
    EXPECT_EQ(compare().views[0].state, ViewState::changed);
}

TEST_F(Accepting, ThePlanStatesRendersThatAreEnough) {
    renders("base/v-", noise, 300, 12);
    SuiteFlags flags;
    flags.baseline_only = true;
    write("s.toml", "[suite]\nsmallest = 0.002\nbaseline = \"base/{view}-*.exr\"\n");
    ProgressMonitor monitor;
    const std::vector<ViewPlan> plans = plan_renders(read_suite(path("s.toml"), flags), monitor);
    ASSERT_EQ(plans.size(), 1u);
    EXPECT_EQ(plans[0].renders, 12u);
    ASSERT_TRUE(plans[0].needed[1] && plans[0].needed[2]);
    EXPECT_GT(*plans[0].needed[1], *plans[0].needed[2]);  // fewer with four times the samples
    // A pixel has a standard deviation of 20 % in each channel: that of mean Y follows from the weights.
    const double sd = 0.2 / side * std::sqrt(0.2126 * 0.2126 + 0.7152 * 0.7152 + 0.0722 * 0.0722);
    EXPECT_NEAR(plans[0].deviation, sd, 0.6 * sd);  // of 12 renders: standard error 21 %
}

}  // namespace accept_test
}  // namespace crescent::inline comparison
