// Outliers of renders in memory: which pixels and renders are found, and which are noise.
#include "compare/outliers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "compare/renders.h"
#include "tests/support/synthetic_renders.h"

namespace crescent {
namespace outliers_test {

using ::testing::ElementsAre;
using Kind = SyntheticNoise::Kind;

constexpr int width = 40;

/// Renders of two sides with equal noise, to be changed before they are read.
struct TwoSides {
    TwoSides(const SyntheticNoise& noise, int baseline, int candidate, std::uint32_t seed, int pixels = width) {
        SyntheticScene scene;
        scene.width = pixels;
        plan.arms.resize(2);
        for (const auto& [side, count] : {std::pair(0, baseline), std::pair(1, candidate)}) {
            for (int k = 0; k < count; ++k) {
                const std::string path = std::to_string(side) + " " + std::to_string(k);
                plan.arms[static_cast<std::size_t>(side)].files.push_back(path);
                renders[path] = synthetic_render(
                    path, noise, seed + 2 * static_cast<std::uint32_t>(k) + static_cast<std::uint32_t>(side), scene);
            }
        }
        plan.find_outliers = true;
    }
    void add(const std::string& path, std::uint32_t pixel, float size) {
        Render& render = renders.at(path);
        render.r[pixel] += size;
        render.g[pixel] += size;
        render.b[pixel] += size;
    }
    RenderStats read() const {
        RenderSource source;
        source.expand = [](const std::vector<std::string>& paths, const SourceLocation&) { return paths; };
        source.read = [this](const std::string& path, const std::string&) { return renders.at(path); };
        ProgressMonitor monitor;
        return read_all(plan, monitor, source);
    }
    ComparePlan plan;
    std::map<std::string, Render> renders;
};

TEST(Outliers, AreFoundWithTheirRenderAndLeftOut) {
    TwoSides sides({Kind::gamma, 0.3}, 5, 3, 10);
    sides.add("1 2", 805, 400);
    const RenderStats all = sides.read();
    ASSERT_EQ(all.outliers.pixels.size(), 1u);
    const OutlierPixel& found = all.outliers.pixels[0];
    EXPECT_EQ(found.side, 1u);
    EXPECT_EQ(found.render, 2u);
    EXPECT_EQ(found.pixel, 805u);
    EXPECT_NEAR(found.value, 401, 1);
    EXPECT_NEAR(found.others, 1, 0.3);
    EXPECT_THAT(all.outliers.groups, ElementsAre(0u, 1u));
    EXPECT_TRUE(all.outliers.set_apart);
    EXPECT_EQ(all.regions.back().pixels.size(), 1599u);
    EXPECT_EQ(all.bad_pixels, 0u);  // it is finite
}

TEST(Outliers, ManyDoNotHideEachOther) {
    TwoSides sides({Kind::gamma, 0.3}, 4, 4, 20);
    for (std::uint32_t k = 0; k < 100; ++k) sides.add("1 " + std::to_string(k % 4), 16 * k + 2 * (k % 4), 300);
    const RenderStats all = sides.read();
    EXPECT_THAT(all.outliers.groups, ElementsAre(0u, 100u));
    EXPECT_FALSE(all.outliers.set_apart);
    EXPECT_EQ(all.regions.back().pixels.size(), 1600u);
}

// A light that is there in every render of one side, or in two, is no event of one render.
TEST(Outliers, APixelThatIsBrightInSeveralRendersIsNone) {
    TwoSides sides({Kind::gamma, 0.3}, 4, 4, 30);
    for (const char* path : {"1 0", "1 1", "1 2", "1 3", "0 1"}) sides.add(path, 500, 300);
    for (const char* path : {"1 0", "1 1"}) sides.add(path, 700, 300);
    EXPECT_EQ(sides.read().outliers.total(), 0u);
}

TEST(Outliers, TheRuleIsSymmetric) {
    for (std::uint32_t seed = 100; seed < 110; ++seed) {
        TwoSides sides({Kind::lognormal, 1.5}, 4, 4, seed * 50), turned = sides;
        for (auto& [path, render] : turned.renders) {
            const std::string other = (path[0] == '0' ? "1" : "0") + path.substr(1);
            render = sides.renders.at(other);
            render.file = path;
        }
        const auto one = sides.read().outliers.groups, two = turned.read().outliers.groups;
        EXPECT_THAT(one, ElementsAre(two[1], two[0]));
    }
}

TEST(Outliers, LightTailsHaveNone) {
    for (std::uint32_t seed = 0; seed < 20; ++seed)
        EXPECT_EQ(TwoSides({Kind::gamma, 0.5}, 3, 3, 1000 + 10 * seed).read().outliers.total(), 0u);
}

// p of the render that deviates the most: below 0.05 in at most 5 % of equal renders, for any noise.
TEST(Outliers, RendersOfOneViewDeviateByChance) {
    for (const SyntheticNoise& noise :
        {SyntheticNoise{Kind::gamma, 0.5}, SyntheticNoise{Kind::lognormal, 1.5}, SyntheticNoise{Kind::events, 1e-3}}) {
        int small = 0;
        for (std::uint32_t seed = 0; seed < 40; ++seed) {
            const auto found = outlier_render(TwoSides(noise, 3, 5, 2000 + 20 * seed).read());
            ASSERT_TRUE(found);
            small += found->p < 0.05;
        }
        EXPECT_LE(small, 4) << to_string(noise);
    }
}

TEST(Outliers, ARenderWithAnotherExposureDeviates) {
    TwoSides sides({Kind::gamma, 0.3}, 5, 5, 40);
    for (std::vector<float>* plane :
        {&sides.renders.at("0 3").r, &sides.renders.at("0 3").g, &sides.renders.at("0 3").b})
        for (float& x : *plane) x *= 1.5f;
    const auto found = outlier_render(sides.read());
    ASSERT_TRUE(found);
    EXPECT_EQ(found->side, 0u);
    EXPECT_EQ(found->render, 3u);
    EXPECT_NEAR(found->ratio, 1.5, 0.03);
    EXPECT_LT(found->p, 1e-3);
}

// Of 16 x 16 pixels there are four tiles: a bright pixel decides the mean of one of them.
TEST(Outliers, AFewBrightPixelsOfASmallViewMakeNoOutlierRender) {
    for (std::uint32_t seed = 0; seed < 30; ++seed) {
        const auto found = outlier_render(TwoSides({Kind::pareto, 1.5}, 12, 8, 3000 + 50 * seed, 16).read());
        ASSERT_TRUE(found);
        EXPECT_GT(found->p, 0.01) << seed;
    }
    TwoSides sides({Kind::gamma, 0.3}, 5, 5, 40, 16);
    for (std::vector<float>* plane :
        {&sides.renders.at("1 2").r, &sides.renders.at("1 2").g, &sides.renders.at("1 2").b})
        for (float& x : *plane) x = 0;
    EXPECT_LT(outlier_render(sides.read())->p, 1e-3);
    EXPECT_FALSE(outlier_render(TwoSides({Kind::gamma, 0.3}, 5, 5, 40, 8).read()));  // one tile
}

TEST(Outliers, TwoRendersOfEachSideHaveNoOutlierRender) {
    EXPECT_FALSE(outlier_render(TwoSides({Kind::gamma, 0.3}, 2, 2, 50).read()));
}

}  // namespace outliers_test
}  // namespace crescent
