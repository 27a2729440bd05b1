// --accept: the candidate's files become the baseline's, with a manifest; a baseline stored as moments gives the same
// numbers as its renders.
#include "compare/suite/accept.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <functional>
#include <memory>
#include <set>

#include "base/files.h"
#include "compare/suite/decide.h"
#include "compare/suite/measure.h"
#include "compare/suite/render_plan.h"
#include "compare/suite/suite.h"
#include "compare/suite/suite_file.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/synthetic_renders.h"

namespace crescent {
namespace accept_test {

using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;
using Kind = SyntheticNoise::Kind;
namespace fs = std::filesystem;

constexpr SyntheticNoise noise{Kind::gamma, 0.2}, brighter{Kind::gamma, 0.2, 0.05};

class Accepting : public ScratchFolder {
protected:
    static constexpr int side = 64;

    /// A float render in colour, uncompressed; its first pixel is multiplied by `first`.
    void render(const std::string& name, const SyntheticNoise& of, std::uint32_t seed, double first = 1) {
        fs::create_directories(fs::path(path(name)).parent_path());
        std::vector<std::vector<float>> planes(3);
        Imf::Header header(side, side);
        header.compression() = Imf::NO_COMPRESSION;
        Imf::FrameBuffer buffer;
        const char* channels[] = {"R", "G", "B"};
        for (std::uint32_t c = 0; c < 3; ++c) {
            for (std::uint32_t i = 0; i < side * side; ++i)
                planes[c].push_back(static_cast<float>(synthetic_pixel(of, 3 * seed + c, i, side)));
            planes[c][0] *= static_cast<float>(first);
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
    std::vector<std::string> accept(std::vector<std::string> views, const std::string& more = "",
        const std::string& because = "a reason", const std::function<void()>& before_reading = {}) {
        ProgressMonitor monitor;
        const Acceptance acceptance{std::move(views), because, "2026-01-02T03:04:05Z", "crescent test"};
        const auto read = [&] {
            if (before_reading) before_reading();
            return suite(more);
        };
        return accept_views(read, acceptance, monitor);
    }
    ViewResult view(const std::string& name) {
        for (const ViewResult& each : compare().views)
            if (each.name == name) return each;
        return {};
    }
    std::set<std::string> baseline() const {
        std::set<std::string> out;
        for (const auto& entry : fs::directory_iterator(path("base"))) out.insert(entry.path().filename().string());
        return out;
    }
    nlohmann::json manifest() const { return nlohmann::json::parse(contents_of(path("base/baseline.json"))); }
};

TEST_F(Accepting, TheCandidateBecomesTheBaseline) {
    renders("base/a-", noise, 10, 3);
    renders("base/b-", noise, 20, 2);
    renders("out/a-", brighter, 30, 2);
    renders("out/b-", noise, 40, 2);
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

TEST_F(Accepting, TheBaselineIsReadAgainUnderTheLock) {
    renders("out/a-", noise, 30, 2);
    renders("out/b-", noise, 40, 2);
    int readings = 0;
    accept({"a"}, "", "a reason", [&] {
        if (++readings == 2) return;  // another process accepts b after this one has read the suite
        ProgressMonitor monitor;
        accept_views([&] { return suite(); }, {{"b"}, "", "", ""}, monitor);
    });
    EXPECT_EQ(readings, 2);
    EXPECT_EQ(manifest()["views"].size(), 2u);
    EXPECT_THAT(baseline(),
        UnorderedElementsAre("a-0.exr", "a-1.exr", "b-0.exr", "b-1.exr", "baseline.json", ".crescent-baseline"));
    for (const ViewResult& each : compare().views) EXPECT_EQ(each.state, ViewState::same) << each.sentence;
}

TEST_F(Accepting, WaitsForAnotherCallOnTheSameBaseline) {
    renders("out/a-", noise, 30, 2);
    struct EndsTheOther : ProgressMonitor {
        std::unique_ptr<Staging> other;
        void log(std::string_view line) override {
            EXPECT_THAT(std::string(line), HasSubstr("in use by another run"));
            other.reset();
        }
    };
    EndsTheOther monitor;
    monitor.other = std::make_unique<Staging>(path("base"), "baseline");
    accept_views([&] { return suite(); }, {{"a"}, "", "", ""}, monitor);
    EXPECT_EQ(monitor.other, nullptr);
    EXPECT_EQ(manifest()["views"].size(), 1u);
}

TEST_F(Accepting, ABaselineThatDiffersFromItsManifestIsUnreadable) {
    renders("out/a-", noise, 30, 3);
    renders("out/b-", noise, 40, 3);
    accept({});
    const std::string bytes = contents_of(path("base/a-1.exr"));
    std::string damaged = bytes;
    damaged.back() = static_cast<char>(damaged.back() ^ 1);
    write("base/a-1.exr", damaged);
    EXPECT_EQ(view("a").state, ViewState::unreadable);
    EXPECT_THAT(view("a").sentence, HasSubstr("base/a-1.exr: its contents are not those of baseline.json"));
    EXPECT_EQ(view("b").state, ViewState::same);
    EXPECT_EQ(exit_code(compare(), true), 2);
    EXPECT_THAT(refusal([&] { return accept({"b"}); }), HasSubstr("base/a-1.exr"));
    fs::remove(path("base/a-1.exr"));
    EXPECT_THAT(view("a").sentence, HasSubstr("base/a-1.exr: no such file of the baseline"));
    write("base/a-1.exr", "version https://git-lfs.github.com/spec/v1\noid sha256:1\nsize 1\n");
    EXPECT_THAT(view("a").sentence, HasSubstr("git lfs pull"));
    write("base/a-1.exr", bytes);
    write("base/a-7.exr", bytes);
    EXPECT_THAT(view("a").sentence, HasSubstr("base/a-7.exr: baseline.json does not list this file"));
    fs::remove(path("base/a-7.exr"));
    EXPECT_EQ(view("a").state, ViewState::same);
    for (const char* name : {"base/a-0.exr", "base/a-1.exr", "base/a-2.exr"}) fs::remove(path(name));
    fs::remove(path("out/a-0.exr"));
    fs::remove(path("out/a-1.exr"));
    fs::remove(path("out/a-2.exr"));
    EXPECT_EQ(view("a").state, ViewState::unreadable);  // nothing but the manifest has the view
    accept({"a"});
    EXPECT_EQ(compare().views.size(), 1u);
}

TEST_F(Accepting, ALessInformativeBaselineNeedsAReason) {
    renders("out/a-", noise, 30, 3);
    renders("out/b-", noise, 40, 3);
    accept({}, "", "");
    fs::remove(path("out/a-2.exr"));
    EXPECT_THAT(refusal([&] { return accept({"a"}, "", ""); }), HasSubstr("fewer renders than the 3"));
    EXPECT_THAT(accept({"a"})[0], HasSubstr("fewer renders than the 3"));
    EXPECT_EQ(manifest()["views"]["a"]["note"], "fewer renders than the 3 of the former baseline");
    for (const char* name : {"out/b-0.exr", "out/b-1.exr", "out/b-2.exr"}) fs::remove(path(name));
    EXPECT_EQ(view("b").state, ViewState::missing);
    EXPECT_THAT(refusal([&] { return accept({"b"}, "", ""); }), HasSubstr("--because"));
    accept({"b"});
    EXPECT_EQ(manifest()["views"].size(), 1u);
    EXPECT_EQ(manifest()["removed"]["b"]["because"], "a reason");
    EXPECT_THAT(baseline(), UnorderedElementsAre("a-0.exr", "a-1.exr", "baseline.json", ".crescent-baseline"));
}

TEST_F(Accepting, PixelsThatAreNotFiniteNeedAReason) {
    renders("out/a-", noise, 30, 2);
    render("out/a-2.exr", noise, 50, std::nan(""));
    const std::string refused = refusal([&] { return accept({"a"}, "", ""); });
    EXPECT_THAT(refused, HasSubstr("1 pixel not finite"));
    EXPECT_THAT(refused, HasSubstr("a-2.exr"));
    EXPECT_FALSE(fs::exists(path("base/baseline.json")));
    EXPECT_THAT(accept({"a"})[0], HasSubstr("not finite"));
}

TEST_F(Accepting, LinkedFilesAndFoldersAreFollowed) {
    renders("out/a-", noise, 30, 2);
    renders("out/b-", noise, 40, 2);
    accept({});
    fs::create_directories(path("annex"));
    for (const char* name : {"a-0.exr", "a-1.exr", "b-0.exr", "b-1.exr"}) {
        fs::rename(path(std::string("base/") + name), path(std::string("annex/") + name));
        fs::create_symlink(std::string("../annex/") + name, path(std::string("base/") + name));
    }
    for (const ViewResult& each : compare().views) EXPECT_EQ(each.state, ViewState::same) << each.sentence;
    renders("out/a-", brighter, 60, 2);
    accept({"a"});
    EXPECT_EQ(contents_of(path("base/a-1.exr")), contents_of(path("out/a-1.exr")));
    EXPECT_EQ(contents_of(path("annex/b-1.exr")), contents_of(path("base/b-1.exr")));
    EXPECT_TRUE(fs::is_symlink(path("base/b-1.exr")));
    EXPECT_NE(contents_of(path("annex/a-1.exr")), contents_of(path("out/a-1.exr")));
    fs::rename(path("base"), path("store"));
    fs::create_symlink("store", path("base"));
    renders("out/a-", noise, 70, 2);
    accept({"a"});
    EXPECT_TRUE(fs::is_symlink(path("base")));
    EXPECT_EQ(contents_of(path("store/a-1.exr")), contents_of(path("out/a-1.exr")));
}

TEST_F(Accepting, NamesThatThePatternDoesNotMatchAreRefused) {
    renders("out/a-", noise, 30, 2);
    write("s.toml", "[suite]\nbaseline = \"base/{view}-[a-c].exr\"\ncandidate = \"out/{view}-*.exr\"\n");
    ProgressMonitor monitor;
    const auto read = [&] { return read_suite(path("s.toml"), {}); };
    EXPECT_THAT(refusal([&] { return accept_views(read, {{}, "", "", ""}, monitor); }), HasSubstr("which the pattern"));
    write("s.toml", "[suite]\nbaseline = \"out/{view}-*.exr\"\ncandidate = \"out/../out/{view}-*.exr\"\n");
    EXPECT_THAT(refusal(read), HasSubstr("on both sides"));
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
    fs::rename(path("out"), path("candidate"));
    fs::rename(path("base"), path("out"));
    accept({}, "store = \"moments\"\n" + region);
    EXPECT_THAT(baseline(),
        UnorderedElementsAre("same-moments.exr", "other-moments.exr", "baseline.json", ".crescent-baseline"));
    EXPECT_LT(static_cast<double>(fs::file_size(path("base/same-moments.exr"))),
        2.1 * static_cast<double>(fs::file_size(path("out/same-0.exr"))));
    fs::remove_all(path("out"));
    fs::rename(path("candidate"), path("out"));
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
        EXPECT_EQ(a.means->tiles.test_count, b.means->tiles.test_count);
        EXPECT_NEAR(static_cast<double>(a.means->tiles.different), static_cast<double>(b.means->tiles.different), 1);
        EXPECT_NEAR(std::log(a.mean_p), std::log(b.mean_p), 0.05 * std::fabs(std::log(a.mean_p)) + 0.05);
    }
    const SuiteResult without = compare("[view.same]\nregions.other = [3, 4, 40, 50]\n");
    EXPECT_EQ(without.count(ViewState::unreadable), 1u);
    EXPECT_THAT(without.views[1].sentence, HasSubstr("s.toml:6:"));
    EXPECT_THAT(without.views[1].sentence, HasSubstr("accept the view again"));
}

TEST_F(Accepting, MomentsOfWholeNumbersAreReadAgain) {
    const auto pictures = [&](double bias, std::uint32_t seed) {  // PGM, which is known by its contents
        fs::create_directories(path("out"));
        for (std::uint32_t k = 0; k < 6; ++k) {
            std::string text = fmt::format("P5\n{} {}\n255\n", side, side);
            for (std::uint32_t i = 0; i < side * side; ++i)
                text += static_cast<char>(static_cast<unsigned char>(
                    std::min(255.0, std::round(60 * synthetic_pixel({Kind::gamma, 0.2, bias}, seed + k, i, side)))));
            write(fmt::format("out/v-{}.exr", k), text);
        }
    };
    const std::string linear = "encoding = \"linear\"\n";
    pictures(0, 100);
    accept({}, "store = \"moments\"\n" + linear);
    pictures(0, 200);
    const SuiteResult same = compare(linear);
    EXPECT_EQ(same.views[0].state, ViewState::same) << same.views[0].sentence;
    EXPECT_TRUE(same.views[0].moments);
    pictures(0.1, 300);
    EXPECT_EQ(compare(linear).views[0].state, ViewState::changed);
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
    ASSERT_TRUE(plans[0].render_counts[1] && plans[0].render_counts[2]);
    EXPECT_GT(*plans[0].render_counts[1], *plans[0].render_counts[2]);  // fewer with four times the samples
    // A pixel has a standard deviation of 20 % in each channel: that of mean Y follows from the weights.
    const double sd = 0.2 / side * std::sqrt(0.2126 * 0.2126 + 0.7152 * 0.7152 + 0.0722 * 0.0722);
    EXPECT_NEAR(plans[0].deviation, sd, 0.6 * sd);  // of 12 renders: standard error 21 %
}

}  // namespace accept_test
}  // namespace crescent
