// Statistics of renders with two pixels, computed by hand; tiles; the files of a pattern.
#include "compare/passes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/memory_renders.h"
#include "tests/support/scratch_folder.h"

namespace crescent {
namespace passes_test {

using ::testing::ElementsAre;

TEST(Tiles, CoverTheImageOnce) {
    const Tiles hd(1920, 1080);  // sqrt(1920 x 1080 / 512) = 63.6
    EXPECT_EQ(hd.size, 64);
    EXPECT_EQ(hd.across, 30);
    EXPECT_EQ(hd.down, 17);
    const Box last = hd.box(hd.count() - 1, 1920, 1080);
    EXPECT_EQ(last.x0, 1856);
    EXPECT_EQ(last.y0, 1024);
    EXPECT_EQ(last.y1, 1079);
    EXPECT_EQ(hd.of(1919, 1079), hd.count() - 1);
    EXPECT_EQ(hd.of(63, 64), 30u);
    EXPECT_EQ(Tiles(10, 20).count(), 6u);  // sides of at least 8
}

/// Two renders of two pixels and their reference.
MemoryRenders two_pixels() {
    MemoryRenders m;
    m.put_grey("a0", 2, {2, 2});
    m.put_grey("a1", 2, {0, 4});
    m.put_grey("reference", 2, {1, 2});
    return m;
}
const CompareFlag reference{{"reference"}, "reference", false, ""}, firefly{{"firefly_k"}, "0.9", true, ""};

TEST(SecondPass, HasTheErrorsOfEachRender) {
    const RenderStats all = two_pixels().read({reference, firefly});
    const RegionStats &first = all.arms[0].regions[0][0], &second = all.arms[0].regions[1][0];
    EXPECT_DOUBLE_EQ(first.y, 2);
    EXPECT_DOUBLE_EQ(first.mse, 0.5);   // errors 1 and 0
    EXPECT_DOUBLE_EQ(second.mse, 2.5);  // errors -1 and 2
    EXPECT_DOUBLE_EQ(first.spread, 1);  // about the means 1 and 3
    EXPECT_DOUBLE_EQ(second.spread, 1);
    EXPECT_DOUBLE_EQ(first.relmse, 1 / 1.01 / 2);
    EXPECT_DOUBLE_EQ(second.relmse, (1 / 1.01 + 4 / 4.01) / 2);
    EXPECT_DOUBLE_EQ(second.mape, (1 / 1.01 + 2 / 2.01) / 2);
    EXPECT_EQ(first.fireflies, 1);  // |1| > 0.9 x 1
    EXPECT_EQ(second.fireflies, 2);
    EXPECT_DOUBLE_EQ(first.with_sum, 0);  // errors 1 and 0 times their sums 0 and 2
    EXPECT_DOUBLE_EQ(second.with_sum, 2);
    EXPECT_THAT(all.arms[0].largest[0], ElementsAre(4));
}

TEST(SecondPass, TrimLeavesTheLargestErrorsOut) {
    const RenderStats all = two_pixels().read({reference, {{"trim"}, "0.5", true, ""}});
    EXPECT_NEAR(all.arms[0].regions[1][0].relmse, 1 / 1.01, 1e-6);
    EXPECT_NEAR(all.arms[0].regions[1][0].mape, 1 / 1.01, 1e-6);
    EXPECT_DOUBLE_EQ(all.arms[0].regions[1][0].mse, 2.5);
}

TEST(SecondPass, KeepsTheLargestOutlierOfItsPixel) {
    MemoryRenders m;
    for (std::uint32_t k = 0; k < 8; ++k) m.put("a" + std::to_string(k), k);
    Render& event = m.renders["a3"];
    event.r[40] = event.g[40] = event.b[40] = 10;
    const RenderStats all = m.read();
    const QuantityReadings& y = all.arms[0].quantities[0];
    EXPECT_NEAR(y.rise, 10 - all.arms[0].film.y()[40], 1e-5);
    EXPECT_LT(y.fall, 0.5);
    const TileReading& tile = y.tiles[3][all.tiles.of(40 % 16, 40 / 16)];
    EXPECT_NEAR(tile.largest, y.rise * y.rise / 64, 1e-5);
    EXPECT_GT(tile.largest, 0.9 * tile.spread);
}

TEST(SecondPass, RegionsAndNumbersAreThoseOfTheFiles) {
    MemoryRenders m;
    m.put_grey("a-16spp-007", 3, {1, 2, 3, 4, 5, 6});
    m.put_grey("a-16spp-008", 3, {3, 2, 3, 4, 5, 6});
    const RenderStats all = m.read({{{"regions", "right", "box"}, "[2, 0, 2, 1]", true, ""}});
    ASSERT_EQ(all.regions.size(), 2u);
    EXPECT_THAT(all.regions[0].pixels, ElementsAre(2, 5));
    EXPECT_DOUBLE_EQ(all.arms[0].quantities[0].regions[1][0], 4.5);
    EXPECT_THAT(all.arms[0].files[1].numbers, ElementsAre(16, 8));
    EXPECT_THROW((void)m.read({{{"regions", "out", "box"}, "[2, 0, 3, 1]", true, ""}}), InputError);
}

using Patterns = ScratchFolder;

TEST_F(Patterns, MatchFilesByDigitsAndWildcards) {
    for (const char* name : {"seed2", "seed010", "seedx", "seed[1]"}) write(name, "x");
    const auto found = [&](const std::string& pattern) { return expand({path(pattern)}, {}); };
    EXPECT_THAT(found("seed%d"), ElementsAre(path("seed010"), path("seed2")));
    EXPECT_THAT(found("seed%04d"), ElementsAre(path("seed010"), path("seed2")));
    EXPECT_EQ(found("seed*").size(), 4u);
    EXPECT_THAT(found("seed[1]"), ElementsAre(path("seed[1]")));  // a file of this name, not a pattern
    EXPECT_THROW((void)found("need*"), InputError);
    EXPECT_THROW((void)expand({path("seed2"), path("seed?")}, {}), InputError);  // named twice
}

}  // namespace passes_test
}  // namespace crescent
