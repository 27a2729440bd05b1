// What fits together and what does not: renders that stand in memory.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/memory_renders.h"

namespace crescent::inline comparison {
namespace {

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

TEST_F(Memory, APixelThatIsNotFiniteIsLeftOutEverywhereAndTold) {
    put("a0", 1), put("a1", 2).g[17] = std::nanf(""), put("b0", 3), put("b1", 4).r[18] = INFINITY;
    const RenderStats all = read();
    EXPECT_EQ(all.bad_pixels, 2u);
    EXPECT_EQ(all.regions.back().pixels.size(), 254u);
    EXPECT_THAT(all.warnings, ::testing::ElementsAre(HasSubstr("a1 (the first of 2 files): 1 pixel not finite")));
    for (const auto& render : all.arms[0].regions) EXPECT_TRUE(std::isfinite(render.back().y));
}

TEST_F(Memory, CopiesInOneArmAreRefusedAndInTwoArmsTold) {
    put("a0", 1), put("a1", 2), put("b0", 1), put("b1", 3);
    EXPECT_THAT(read().warnings, ::testing::ElementsAre(HasSubstr("b0 of b: the same pixels as a0 of a")));
    put("a2", 2);
    EXPECT_THAT(refusal(), HasSubstr("a2: the same pixels as a1"));
}

TEST_F(Memory, SizesThatDifferAreRefused) {
    put("a0", 1), put("a1", 2), put("b0", 3, 17);
    EXPECT_THAT(refusal(), HasSubstr("b0: expected 16 x 16 pixels as in a0, found 17 x 17"));
}

TEST_F(Memory, ConstantAndNegativePixelsAreTold) {
    put("a0", 1), put("a1", 2).r[3] = -1, put("b0", 3), put("b1", 4);
    for (auto* plane : {&renders["b0"].r, &renders["b0"].g, &renders["b0"].b}) plane->assign(256, 0.5f);
    EXPECT_THAT(read().warnings,
        ::testing::ElementsAre(
            HasSubstr("a1: 1 pixel with a negative channel"), HasSubstr("b0: all pixels are equal")));
}

TEST_F(Memory, VarianceOfOneSampleIsDividedByTheirNumber) {
    for (const char* name : {"a0", "b0"}) {
        Render& r = put(name, name[0]);
        r.variance.assign(r.size(), 8), r.per_sample = true, r.variance_channels = "Variance.R";
    }
    const RenderStats all = read({{{"arms", "a", "spp"}, "4", true, "--spp"}});
    EXPECT_DOUBLE_EQ(all.arms[0].film.variance(0), 2);
    EXPECT_TRUE(std::isnan(all.arms[1].film.variance(0)));
    EXPECT_THAT(all.warnings, ::testing::ElementsAre(HasSubstr("b0: Variance.R is the variance of one sample")));
}

}  // namespace
}  // namespace crescent::inline comparison
