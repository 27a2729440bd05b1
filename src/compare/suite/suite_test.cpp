// Suites: patterns, decisions over all views and power, on synthetic renders in memory.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>

#include "compare/suite/decide.h"
#include "compare/suite/measure.h"
#include "compare/suite/suite.h"
#include "compare/suite/suite_file.h"
#include "compare/suite/suite_outputs.h"
#include "math/statistics.h"
#include "output/sarif.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/synthetic_renders.h"

namespace crescent {
namespace suite_test {

using ::testing::HasSubstr;
using Kind = SyntheticNoise::Kind;

constexpr int side = 32;

/// A suite whose renders are in memory: "VIEW/baseline/K" and "VIEW/candidate/K".
class MemorySuite {
public:
    void put(
        const std::string& view, const std::string& which, int k, const SyntheticNoise& noise, std::uint32_t seed) {
        const std::string path = view + "/" + which + "/" + std::to_string(k);
        Render render(path, side, side);
        for (std::uint32_t i = 0; i < render.size(); ++i)
            render.r[i] = render.g[i] = render.b[i] = static_cast<float>(synthetic_pixel(noise, seed, i, side));
        renders[path] = std::move(render);
        auto found =
            std::find_if(suite.views.begin(), suite.views.end(), [&](const SuiteView& v) { return v.name == view; });
        if (found == suite.views.end()) {
            suite.views.emplace_back().name = view;
            found = suite.views.end() - 1;
        }
        (which == "baseline" ? found->baseline : found->candidate).push_back(path);
    }
    void put_both(const std::string& view, const SyntheticNoise& baseline, const SyntheticNoise& candidate,
        std::uint32_t seed, int count = 8) {
        for (int k = 0; k < count; ++k) {
            put(view, "baseline", k, baseline, seed + 2 * static_cast<std::uint32_t>(k));
            put(view, "candidate", k, candidate, seed + 2 * static_cast<std::uint32_t>(k) + 1);
        }
    }
    SuiteResult compare() const {
        RenderSource source;
        source.read = [this](const std::string& path, const std::string&) { return renders.at(path); };
        ProgressMonitor monitor;
        return compare_suite(suite, monitor, source);
    }
    Suite suite;
    std::map<std::string, Render> renders;
};

const ViewResult& view_of(const SuiteResult& result, const std::string& name) {
    return *std::find_if(
        result.views.begin(), result.views.end(), [&](const ViewResult& view) { return view.name == name; });
}

constexpr SyntheticNoise noise{Kind::gamma, 0.2};
constexpr SyntheticNoise brighter{Kind::gamma, 0.2, 0.05};
constexpr SyntheticNoise calmer{Kind::gamma, 0.1};

TEST(Suites, EachViewHasTheStateOfItsRenders) {
    MemorySuite s;
    s.suite.options.smallest = 0.03;
    s.put_both("same", noise, noise, 100);
    s.put_both("changed", noise, brighter, 200);
    s.put_both("improved", noise, calmer, 300);
    s.put_both("noisier", calmer, noise, 400);
    s.put_both("few", {Kind::gamma, 1}, {Kind::gamma, 1}, 500, 3);
    s.put("added", "candidate", 0, noise, 600);
    s.put("gone", "baseline", 0, noise, 700);
    for (int k = 0; k < 3; ++k)
        for (const char* which : {"baseline", "candidate"}) s.put("fixed", which, k, noise, 800);
    for (int k = 0; k < 3; ++k) {
        s.put("moved", "baseline", k, noise, 900);
        s.put("moved", "candidate", k, noise, 901);
    }
    const SuiteResult result = s.compare();
    EXPECT_EQ(view_of(result, "same").state, ViewState::same);
    EXPECT_EQ(view_of(result, "changed").state, ViewState::changed);
    EXPECT_EQ(view_of(result, "improved").state, ViewState::improved);
    EXPECT_EQ(view_of(result, "noisier").state, ViewState::noisier);
    EXPECT_EQ(view_of(result, "few").state, ViewState::too_few);
    EXPECT_EQ(view_of(result, "added").state, ViewState::added);
    EXPECT_EQ(view_of(result, "gone").state, ViewState::missing);
    EXPECT_EQ(view_of(result, "fixed").state, ViewState::same);
    EXPECT_EQ(view_of(result, "moved").state, ViewState::changed);
    EXPECT_TRUE(view_of(result, "moved").exact);
    EXPECT_EQ(result.tested_views, 5u);
    EXPECT_EQ(exit_code(result, false), 1);
    EXPECT_GT(*view_of(result, "few").renders_needed, 3u);
}

TEST(Suites, TheStatedNumberOfRendersIsEnough) {
    MemorySuite few;
    few.suite.options.smallest = 0.004;
    few.put_both("view", noise, noise, 1000, 6);
    const ViewResult first = few.compare().views[0];
    ASSERT_EQ(first.state, ViewState::too_few);
    ASSERT_TRUE(first.renders_needed);
    MemorySuite enough;
    enough.suite.options.smallest = 0.004;
    enough.put_both("view", noise, noise, 1000, static_cast<int>(*first.renders_needed * 3 / 2));
    EXPECT_EQ(enough.compare().views[0].state, ViewState::same);
}

/// Adds `size` to some pixels of a render that do not touch.
void add_bright_pixels(MemorySuite& s, const std::string& path, int count, float size = 500) {
    Render& render = s.renders.at(path);
    for (int k = 0; k < count; ++k) {
        const auto i = static_cast<std::size_t>(37 * (k + 1) % (side * side));
        render.r[i] += size;
        render.g[i] += size;
        render.b[i] += size;
    }
}

TEST(Suites, OneOutlierPixelOnEitherSideIsNoChange) {
    for (const char* which : {"baseline", "candidate"}) {
        MemorySuite s;
        s.suite.options.smallest = 0.05;
        s.put_both("view", noise, noise, 3000);
        add_bright_pixels(s, fmt::format("view/{}/3", which), 1);
        const ViewResult view = s.compare().views[0];
        EXPECT_EQ(view.state, ViewState::same) << view.sentence;
        EXPECT_TRUE(view.outliers.set_apart);
        EXPECT_EQ(view.outliers.baseline + view.outliers.candidate, 1u);
        ASSERT_EQ(view.outliers.first.size(), 1u);
        EXPECT_EQ(view.outliers.first[0].file, fmt::format("view/{}/3", which));
        EXPECT_THAT(view.sentence, HasSubstr("(5, 1) of"));
        EXPECT_NEAR(view.outliers.first[0].value, 501, 1);
    }
}

TEST(Suites, ADifferenceIsFoundBesidesAnOutlierPixel) {
    MemorySuite s;
    s.put_both("view", noise, brighter, 3100);
    add_bright_pixels(s, "view/baseline/3", 1);
    EXPECT_EQ(s.compare().views[0].state, ViewState::changed);
}

// Without a change: 5 and 5 of ten are ordinary, 10 and 0 are not (p = 2^-9).
TEST(Suites, NumbersOfOutlierPixelsAreCompared) {
    MemorySuite equal, more, fewer;
    for (MemorySuite* s : {&equal, &more, &fewer}) s->put_both("view", noise, noise, 3200);
    for (int k = 0; k < 5; ++k)
        for (const char* which : {"baseline", "candidate"})
            add_bright_pixels(equal, fmt::format("view/{}/{}", which, k), 1, 300 + 50 * static_cast<float>(k));
    for (int k = 0; k < 5; ++k) {
        for (auto [s, which] : {std::pair(&more, "candidate"), std::pair(&fewer, "baseline")}) {
            Render& render = s->renders.at(fmt::format("view/{}/{}", which, k));
            for (const int i : {100 + 7 * k, 600 + 7 * k}) render.r[static_cast<std::size_t>(i)] += 900;
        }
    }
    EXPECT_NE(equal.compare().views[0].state, ViewState::changed);
    const ViewResult found = more.compare().views[0];
    EXPECT_EQ(found.state, ViewState::changed) << found.sentence;
    EXPECT_EQ(found.outliers.candidate, 10u);
    EXPECT_NEAR(found.outliers.p, std::pow(2.0, -9), 1e-12);
    EXPECT_THAT(
        found.sentence, HasSubstr("10 outlier pixels in 8 renders of the candidate and 0 in 8 of the baseline"));
    EXPECT_EQ(fewer.compare().views[0].state, ViewState::changed);
}

TEST(Suites, TouchingOutlierPixelsAreOneEvent) {
    MemorySuite s;
    s.put_both("view", noise, noise, 3300);
    Render& render = s.renders.at("view/candidate/2");
    for (const std::size_t i : {200u, 201u, 202u, 232u, 233u, 234u, 264u, 265u, 266u}) render.g[i] += 700;
    const ViewResult view = s.compare().views[0];
    EXPECT_EQ(view.outliers.candidate, 1u);
    EXPECT_NE(view.state, ViewState::changed) << view.sentence;
}

TEST(Suites, ARenderThatDoesNotBelongToTheOthersIsNamed) {
    for (const float factor : {0.0f, 2.0f}) {
        for (const char* which : {"baseline", "candidate"}) {
            MemorySuite s;
            s.put_both("view", noise, noise, 3400);
            const std::string path = fmt::format("view/{}/6", which);
            Render& render = s.renders.at(path);
            for (std::vector<float>* plane : {&render.r, &render.g, &render.b})
                for (float& x : *plane) x *= factor;
            const ViewResult view = s.compare().views[0];
            EXPECT_EQ(view.state, ViewState::changed) << view.sentence;
            EXPECT_EQ(view.outlier_render.file, path);
            EXPECT_THAT(view.sentence, HasSubstr(path + " does not belong to the other renders of the " + which));
            EXPECT_NEAR(view.outlier_render.ratio, static_cast<double>(factor), 0.05);
        }
    }
}

TEST(Suites, ARenderWithManyOutlierPixelsIsNamedAmongManyViews) {
    MemorySuite s;
    for (int v = 0; v < 12; ++v)
        s.put_both(std::to_string(v), noise, noise, 3500 + 100 * static_cast<std::uint32_t>(v));
    add_bright_pixels(s, "7/candidate/2", 10);
    const SuiteResult result = s.compare();
    for (const ViewResult& view : result.views)
        EXPECT_EQ(view.state == ViewState::changed, view.name == "7") << view.sentence;
    EXPECT_EQ(view_of(result, "7").outlier_render.file, "7/candidate/2");
}

TEST(Suites, CopiesWithinASideAreLeftOut) {
    MemorySuite s;
    s.put_both("view", noise, noise, 2000);
    s.put("view", "candidate", 90, noise, 2001);  // the seed of candidate/0
    const SuiteResult result = s.compare();
    EXPECT_EQ(result.views[0].candidate_renders, 8u);
    ASSERT_FALSE(result.views[0].notes.empty());
    EXPECT_THAT(result.views[0].notes[0], HasSubstr("view/candidate/90 is a copy of view/candidate/0"));
}

TEST(Suites, EqualSeedsOnOneSideAreFound) {
    MemorySuite s;
    for (int k = 0; k < 6; ++k) {
        s.put("view", "baseline", k, noise, 2100 + static_cast<std::uint32_t>(k));
        s.put("view", "candidate", k, noise, 5);
    }
    const SuiteResult result = s.compare();
    const ViewResult& view = result.views[0];
    EXPECT_EQ(view.state, ViewState::too_few);
    EXPECT_THAT(view.sentence, HasSubstr("give each render its own seed"));
}

TEST(Suites, RendersWithTheSameSeedsAreComparedInPairs) {
    MemorySuite s;
    for (int k = 0; k < 6; ++k)
        for (const auto& [which, of] : {std::pair{"baseline", noise}, std::pair{"candidate", brighter}})
            s.put("view", which, k, of, 2200 + static_cast<std::uint32_t>(k));
    const SuiteResult result = s.compare();
    EXPECT_EQ(result.views[0].state, ViewState::changed);
    EXPECT_TRUE(result.views[0].means->paired);
}

TEST(Suites, AHeavyTailIsReportedAndNotDecided) {
    MemorySuite s;
    s.suite.options.smallest = 0.05;
    s.put_both("view", {Kind::pareto, 1.2}, {Kind::pareto, 1.2}, 2300);
    const ViewResult view = s.compare().views[0];
    EXPECT_EQ(view.state, ViewState::too_few);
    for (const VarianceTest& t : view.variances) EXPECT_THAT(t.why, HasSubstr("heavy tail"));
}

TEST(Suites, AFileThatCannotBeComparedHidesNoOtherView) {
    MemorySuite s;
    s.put_both("changed", noise, brighter, 2400);
    s.put_both("one", noise, noise, 2500, 2);
    s.renders["one/candidate/0"] = Render("one/candidate/0", 4, 4);
    const SuiteResult result = s.compare();
    EXPECT_EQ(view_of(result, "one").state, ViewState::unreadable);
    EXPECT_THAT(view_of(result, "one").sentence, HasSubstr("one/candidate/0"));
    EXPECT_EQ(view_of(result, "changed").state, ViewState::changed);
    EXPECT_EQ(exit_code(result, false), 2);
}

TEST(Suites, PixelsThatAreNotFiniteOnOneSideChangeAView) {
    for (const char* side_with : {"candidate", "baseline"})
        for (const float value : {std::nanf(""), HUGE_VALF}) {
            MemorySuite s;
            s.suite.options.smallest = 0.05;
            s.put_both("view", noise, noise, 2600);
            s.put_both("other", noise, noise, 2700);
            s.renders[std::string("view/") + side_with + "/3"].g[77] = value;
            const SuiteResult result = s.compare();
            EXPECT_EQ(view_of(result, "view").state, ViewState::changed);
            EXPECT_THAT(view_of(result, "view").sentence, HasSubstr(std::string(side_with) + "/3"));
            EXPECT_EQ(view_of(result, "other").state, ViewState::same);
            EXPECT_EQ(exit_code(result, false), 1);
        }
}

TEST(Suites, ATestedAlphaChannelThatIsNotFiniteChangesAView) {
    for (const bool is_noisy : {true, false}) {
        MemorySuite s;
        s.suite.options.smallest = 0.05;
        for (int k = 0; k < 6; ++k)
            for (const char* which : {"baseline", "candidate"})
                s.put("view", which, k, noise,
                    is_noisy ? 2800 + 2 * static_cast<std::uint32_t>(k) + (*which == 'c' ? 1 : 0) : 2800);
        for (auto& [path, render] : s.renders) render.alpha.assign(render.size(), 1);
        EXPECT_EQ(s.compare().views[0].state, ViewState::same);
        for (int k = 0; k < 6; ++k) s.renders[fmt::format("view/candidate/{}", k)].alpha[77] = std::nanf("");
        const ViewResult view = s.compare().views[0];
        EXPECT_EQ(view.state, ViewState::changed);
        EXPECT_THAT(view.headline, HasSubstr("1 pixel is not finite"));
    }
}

TEST(Suites, NoToleranceAllowsAPixelThatIsFiniteOnOneSideOnly) {
    MemorySuite s;
    for (int k = 0; k < 2; ++k)
        for (const char* which : {"baseline", "candidate"}) s.put("view", which, k, noise, 2900);
    s.suite.views[0].tolerance = parse_tolerance("50 %");
    for (auto& [path, render] : s.renders) {
        render.r[5] = HUGE_VALF;  // on both sides
        if (path.starts_with("view/candidate")) render.r[77] = std::nanf("");
    }
    const ViewResult view = s.compare().views[0];
    EXPECT_EQ(view.state, ViewState::changed);
    EXPECT_THAT(view.sentence, HasSubstr("1 of them is finite on one side only"));
}

/// A suite of one view with these numbers of renders.
ViewResult unbalanced(int baseline, int candidate, const SyntheticNoise& of_candidate, std::uint32_t seed) {
    MemorySuite s;
    s.suite.options.smallest = 0.05;
    for (int k = 0; k < baseline; ++k) s.put("view", "baseline", k, noise, seed + static_cast<std::uint32_t>(k));
    for (int k = 0; k < candidate; ++k)
        s.put("view", "candidate", k, of_candidate, seed + 500 + static_cast<std::uint32_t>(k));
    return s.compare().views[0];
}

TEST(Suites, ALongBaselineDoesNotWeakenATest) {
    double longer = 0, shorter = 0;
    for (std::uint32_t seed = 0; seed < 10; ++seed) {
        longer += unbalanced(20, 3, noise, 10'000 + 1000 * seed).means->regions[0].smallest / 10;
        shorter += unbalanced(3, 3, noise, 10'000 + 1000 * seed).means->regions[0].smallest / 10;
    }
    EXPECT_LT(longer, 0.5 * shorter);
    EXPECT_EQ(unbalanced(20, 3, brighter, 30'000).state, ViewState::changed);
}

TEST(Suites, OneRenderOfTheCandidateIsTestedInItsMean) {
    const ViewResult same = unbalanced(20, 1, noise, 40'000), changed = unbalanced(20, 1, brighter, 41'000);
    EXPECT_EQ(same.state, ViewState::same) << same.sentence;
    EXPECT_THAT(same.sentence, HasSubstr("its noise was not tested"));
    EXPECT_EQ(changed.state, ViewState::changed) << changed.sentence;
    EXPECT_TRUE(std::isnan(same.variance_p));
}

/// Renders with one seed for each number, whose noise is in a few pixels of a corner; the candidate is `scale` times as
/// bright.
MemorySuite few_noisy_pixels(int count, float scale) {
    MemorySuite s;
    s.suite.options.smallest = 0.05;
    for (int k = 0; k < count; ++k)
        for (const char* which : {"baseline", "candidate"}) {
            s.put("view", which, k, noise, 50'000 + static_cast<std::uint32_t>(k));
            Render& render = s.renders["view/" + std::string(which) + "/" + std::to_string(k)];
            for (std::size_t i = 0; i < render.size(); ++i) {
                const float value =
                    (i % side < 6 && i / side < 6 ? render.r[i] : 1) * (which == std::string("candidate") ? scale : 1);
                render.r[i] = render.g[i] = render.b[i] = value;
            }
        }
    return s;
}

TEST(Suites, SharedSeedsAreFoundInFewPixels) {
    for (const int count : {8, 12, 20}) {
        const SuiteResult result = few_noisy_pixels(count, 1.001F).compare();
        EXPECT_TRUE(result.views[0].means->paired) << count;
    }
}

TEST(Suites, PairsAreLookedForStatedOrIgnored) {
    MemorySuite s;
    s.suite.options.smallest = 0.05;
    for (int k = 0; k < 6; ++k)
        for (const char* which : {"baseline", "candidate"})
            s.put("view", which, k, noise, 60'000 + static_cast<std::uint32_t>(k));
    for (auto& [name, render] : s.renders)
        if (name.find("candidate") != std::string::npos)
            for (auto* plane : {&render.r, &render.g, &render.b})
                for (float& x : *plane) x *= 1.01F;
    for (const auto& [pairing, paired] :
        {std::pair{Pairing::automatic, true}, std::pair{Pairing::always, true}, std::pair{Pairing::never, false}}) {
        s.suite.options.pair = pairing;
        const SuiteResult result = s.compare();
        EXPECT_EQ(result.views[0].means->paired, paired);
    }
    s.put("view", "candidate", 77, noise, 60'500);
    s.suite.options.pair = Pairing::always;
    EXPECT_EQ(s.compare().views[0].state, ViewState::unreadable);  // a render without a partner
}

class SuiteFiles : public ScratchFolder {};

TEST_F(SuiteFiles, KeysAreReadAndMistakesHaveAPlace) {
    const std::string root = path("");
    for (const char* name : {"b-v-1.exr", "c-v-1.exr", "c-w-1.exr"}) std::ofstream(root + name) << "x";
    const auto read = [&](const std::string& more) {
        std::ofstream(root + "s.toml") << "[suite]\nbaseline = \"b-{view}-*.exr\"\ncandidate = \"c-{view}-*.exr\"\n"
                                       << more;
        return read_suite(root + "s.toml", {});
    };
    const Suite good = read("smallest = \"2 %\"\n[view.v]\nsmallest = \"0.5 %\"\nregions.lamp = [1, 2, 3, 4]\n");
    ASSERT_EQ(good.views.size(), 2u);
    EXPECT_EQ(good.options.smallest, 0.02);
    EXPECT_EQ(good.smallest(good.views[0]), 0.005);
    EXPECT_EQ(good.options.pair, Pairing::automatic);
    EXPECT_EQ(read("pair = true\n").options.pair, Pairing::always);
    EXPECT_EQ(read("pair = false\n").options.pair, Pairing::never);
    EXPECT_EQ(read("pair = \"auto\"\n").options.pair, Pairing::automatic);
    ASSERT_EQ(good.views[0].regions.size(), 1u);
    EXPECT_EQ(good.views[0].regions[0].name, "lamp");
    EXPECT_EQ(good.views[0].regions[0].box.y1, 4);
    EXPECT_TRUE(good.views[1].baseline.empty());
    const auto mistake = [&](const std::string& more) { return refusal([&] { return read(more); }); };
    EXPECT_THAT(mistake("alhpa = 0.1\n"), HasSubstr("s.toml:4:1: "));
    EXPECT_THAT(mistake("alhpa = 0.1\n"), HasSubstr("did you mean 'alpha'?"));
    EXPECT_THAT(mistake("[view.vv]\nsmallest = 0.1\n"), HasSubstr("s.toml:4:"));
    EXPECT_THAT(mistake("[view.vv]\nsmallest = 0.1\n"), HasSubstr("did you mean 'v'?"));
    EXPECT_EQ(
        read("[view.v]\ntolerance = \"2/255\"\nnoise = \"ignore\"\npair = false\n").views[0].pair, Pairing::never);
    EXPECT_THAT(mistake("[view.v]\ntolerance = \"2 nits\"\n"), HasSubstr("s.toml:5:13: view.v.tolerance: expected"));
    EXPECT_THAT(mistake("[view.v]\nnoise = \"less\"\n"), HasSubstr("s.toml:5:"));
    EXPECT_THAT(mistake("pair = \"maybe\"\n"), HasSubstr("s.toml:4:"));
    EXPECT_THAT(mistake("smallest = \"much\"\n"), HasSubstr("s.toml:4:12: "));
    EXPECT_THAT(mistake("[view.v]\nregions.lamp = [1, 2, 3]\n"), HasSubstr("s.toml:5:"));
    for (const char* text : {"1e999 %", "%", " %", "nan %", "2 % %"})
        EXPECT_THAT(mistake(std::string("smallest = \"") + text + "\"\n"), HasSubstr("s.toml:4:12: "));
    EXPECT_EQ(read("smallest = \"" + std::string(60'000, ' ') + "4 %\"\n").options.smallest, 0.04);
    EXPECT_THAT(mistake("[view.v]\nregions.frame = [1, 2, 3, 4]\n"), HasSubstr("expected another"));
}

TEST(Suites, AToleranceHoldsForViewsWithoutNoise) {
    EXPECT_EQ(parse_tolerance("1 ulp")->size, 1);
    EXPECT_EQ(parse_tolerance(" 0.5 % ")->size, 0.005);
    EXPECT_EQ(parse_tolerance("2/255")->size, 2.0 / 255);
    for (const char* text : {"", "ulp", "1", "-1 ulp", "1/0", "% 5", "1 ulps", "nan %", "  "})
        EXPECT_FALSE(parse_tolerance(text)) << text;
    const auto state = [](const char* tolerance, float factor, const Quantisation& steps, std::string* sentence) {
        MemorySuite s;
        for (int k = 0; k < 2; ++k)
            for (const char* which : {"baseline", "candidate"}) {
                s.put("view", which, k, noise, 900);
                Render& r = s.renders.at(fmt::format("view/{}/{}", which, k));
                r.steps = steps;
                for (std::vector<float>* plane : {&r.r, &r.g, &r.b})
                    for (float& value : *plane) {
                        if (steps.levels > 0) value = std::round(100 * value) / 255;
                        if (*which == 'c') value = steps.levels > 0 ? value + factor / 255 : value * factor;
                    }
            }
        s.suite.views[0].tolerance = parse_tolerance(tolerance);
        const ViewResult view = s.compare().views[0];
        EXPECT_TRUE(view.exact);
        EXPECT_LE(view.headline.size(), longest_headline);
        if (sentence) *sentence = view.sentence;
        return view.state;
    };
    const Quantisation eight_bits{.levels = 256, .srgb = false};
    const float ulp = 1 + 0x1p-23f;
    std::string sentence;
    EXPECT_EQ(state("", ulp, {}, &sentence), ViewState::changed);
    EXPECT_THAT(sentence, HasSubstr("1024 of 1024 pixels changed; the largest difference of a channel is"));
    EXPECT_THAT(sentence, HasSubstr("ulp at"));
    EXPECT_EQ(state("2 ulp", ulp, {}, &sentence), ViewState::same);
    EXPECT_THAT(sentence, HasSubstr("within the tolerance"));
    EXPECT_EQ(state("0.5 %", 1.004f, {}, nullptr), ViewState::same);
    EXPECT_EQ(state("0.5 %", 1.006f, {}, &sentence), ViewState::changed);
    EXPECT_THAT(sentence, HasSubstr("Beyond the tolerance: 1024 pixels"));
    EXPECT_EQ(state("2/255", 2, eight_bits, &sentence), ViewState::same);
    EXPECT_THAT(sentence, HasSubstr("2 of 255 steps"));
    EXPECT_EQ(state("2/255", 3, eight_bits, nullptr), ViewState::changed);
}

TEST(Suites, AToleranceComparesOneRenderOfEachSideExactly) {
    MemorySuite s;
    for (const char* which : {"baseline", "candidate"}) s.put("view", which, 0, noise, 900);
    for (float& value : s.renders["view/candidate/0"].g) value *= 1.004f;
    const ViewResult without = s.compare().views[0];
    EXPECT_EQ(without.state, ViewState::too_few);
    EXPECT_THAT(without.sentence, HasSubstr("A view without noise needs one: state tolerance"));
    s.suite.views[0].tolerance = parse_tolerance("0.5 %");
    const ViewResult within = s.compare().views[0];
    EXPECT_EQ(within.state, ViewState::same);
    EXPECT_THAT(within.headline, ::testing::StartsWith("Within the tolerance: 1024 of 1024 pixels differ"));
    s.suite.views[0].tolerance = parse_tolerance("0.3 %");
    const ViewResult beyond = s.compare().views[0];
    EXPECT_EQ(beyond.state, ViewState::changed);
    EXPECT_THAT(beyond.headline, ::testing::StartsWith("Changed: 1024 of 1024 pixels differ"));
}

TEST(Suites, AViewStatesWhatIsAskedOfItsNoise) {
    const auto state = [](NoiseDemand demand, const SyntheticNoise& before, const SyntheticNoise& after) {
        MemorySuite s;
        s.suite.options.smallest = 0.03;
        s.put_both("view", before, after, 400);
        s.suite.views[0].noise = demand;
        return s.compare().views[0].state;
    };
    EXPECT_EQ(state(NoiseDemand::not_more, calmer, noise), ViewState::noisier);
    EXPECT_EQ(state(NoiseDemand::not_more, noise, calmer), ViewState::improved);
    EXPECT_EQ(state(NoiseDemand::same, noise, calmer), ViewState::changed);
    EXPECT_EQ(state(NoiseDemand::same, noise, noise), ViewState::same);
    EXPECT_EQ(state(NoiseDemand::ignore, calmer, noise), ViewState::same);
    EXPECT_EQ(state(NoiseDemand::ignore, noise, brighter), ViewState::changed);
}

TEST(Suites, ANoisierViewSaysWhereByHowMuchAndThatTheMeanHeld) {
    MemorySuite s;
    s.put_both("view", calmer, noise, 400);
    for (auto& [path, render] : s.renders) render.spp = path.find("candidate") == std::string::npos ? 16 : 12;
    const ViewResult view = s.compare().views[0];
    EXPECT_THAT(view.sentence, ::testing::StartsWith("Candidate states 12 spp, baseline 16. The variance"));
    EXPECT_THAT(view.sentence, HasSubstr("It grew the most in x "));
    EXPECT_THAT(view.sentence, HasSubstr("times would be found with a probability of 90 %"));
    EXPECT_THAT(view.sentence, HasSubstr("The mean held."));
    EXPECT_THAT(view.headline, HasSubstr("Noisier: the variance is"));
    EXPECT_LE(view.headline.size(), longest_headline);
    EXPECT_FALSE(view.pictures.noise.empty());
    for (auto& [path, render] : s.renders)
        if (path.find("candidate") != std::string::npos)
            for (std::uint32_t i = 0; i < render.size(); ++i)
                render.r[i] = render.g[i] = render.b[i] = static_cast<float>(
                    synthetic_pixel(calmer, 9000 + static_cast<std::uint32_t>(path.back()), i, side));
    EXPECT_TRUE(s.compare().views[0].pictures.noise.empty());
}

TEST(Suites, AChangedViewIsOneShortSentence) {
    MemorySuite s;
    s.put_both("view", noise, brighter, 200);
    Region& region = s.suite.views[0].regions.emplace_back();
    region.name = std::string(200, 'r');
    region.box = {0, 0, 31, 31};
    const ViewResult view = s.compare().views[0];
    EXPECT_THAT(view.headline, ::testing::StartsWith("Changed: mean Y in "));
    EXPECT_LE(view.headline.size(), longest_headline);
    EXPECT_GT(view.sentence.size(), view.headline.size());
}

TEST(Suites, SarifNamesTheLineOfAViewInItsFile) {
    MemorySuite s;
    s.put_both("view", noise, brighter, 200);
    s.put_both("other", noise, noise, 300);
    s.suite.file = "tests/a suite.toml";
    s.suite.views[0].location = {"tests/a suite.toml", 7, 2};
    const Json sarif = Json::parse(sarif_text(suite_report(s.suite, s.compare(), false)));
    const Json& results = sarif["runs"][0]["results"];
    ASSERT_GE(results.size(), 1u);
    EXPECT_EQ(results[0]["ruleId"], "changed");
    EXPECT_EQ(results[0]["level"], "error");
    const Json& place = results[0]["locations"][0]["physicalLocation"];
    EXPECT_EQ(place["artifactLocation"]["uri"], "tests/a%20suite.toml");
    EXPECT_EQ(place["region"]["startLine"], 7);
}

TEST(Suites, SarifOfACallThatFailsNamesTheLinesOfItsMistakes) {
    const InputError error({{{"a suite.toml", 3, 1}, "unknown key"}, {{"--tolerance 1 nit", 0, 0}, "no such unit"}});
    const Json results = Json::parse(sarif_text(failure_report("a suite.toml", error, "1")))["runs"][0]["results"];
    ASSERT_EQ(results.size(), 2u);
    EXPECT_EQ(results[0]["message"]["text"], "unknown key");
    EXPECT_EQ(results[0]["locations"][0]["physicalLocation"]["region"]["startLine"], 3);
    EXPECT_EQ(results[1]["message"]["text"], "--tolerance 1 nit: no such unit");
    EXPECT_EQ(results[1]["locations"][0]["physicalLocation"]["artifactLocation"]["uri"], "a%20suite.toml");
    const Json other = Json::parse(sarif_text(failure_report("", OutputError("no space"), "1")))["runs"][0]["results"];
    EXPECT_EQ(other[0]["message"]["text"], "no space");
}

TEST(Hypotheses, SimesPIsTheLevelOfTheFirstDiscovery) {
    const std::vector<double> p{0.001, 0.004, 0.02, 0.5};
    for (const bool dependent : {false, true}) {
        const double level = simes_p(p, 10, dependent);
        EXPECT_EQ(discovered(p, 10, level * (1 - 1e-9), dependent), 0u);
        EXPECT_GT(discovered(p, 10, level * (1 + 1e-9), dependent), 0u);
    }
    EXPECT_EQ(simes_p({}, 10, false), 1);
}

}  // namespace suite_test
}  // namespace crescent
