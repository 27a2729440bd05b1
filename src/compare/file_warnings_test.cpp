// Warnings of several files on one line; groups of pixels that are not finite, and tests of their counts with known p.
#include "compare/file_warnings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace crescent {
namespace file_warnings_test {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(FileWarnings, OfOneKindShareALine) {
    FileWarnings warnings;
    warnings.add("a", "not finite", 3);
    warnings.add("b", "constant");
    warnings.add("c", "not finite", 1);
    warnings.add("d", "copy of a", 0, "copy");
    warnings.add("e", "copy of b", 0, "copy");
    EXPECT_THAT(warnings.lines(),
        ElementsAre("a (the first of 2 files): 1 to 3 pixels not finite", "b: constant",
            "d (the first of 2 files): copy of a"));
    EXPECT_EQ(warnings.line("not finite"), warnings.lines()[0]);
    EXPECT_EQ(warnings.line("negative"), "");
    FileWarnings one;
    one.add("a", "not finite", 1);
    EXPECT_THAT(one.lines(), ElementsAre("a: 1 pixel not finite"));
}

/// An 8 x 4 image whose left_out pixels are these, in a left half and the whole frame.
RenderStats image(const std::vector<std::uint32_t>& failing) {
    RenderStats all;
    all.width = 8;
    all.height = 4;
    for (const char* name : {"left", "frame"}) {
        PixelSet& set = all.regions.emplace_back();
        set.name = name;
        for (const std::uint32_t i : failing)
            if (all.regions.size() == 2 || i % 8 < 4) set.left_out.push_back(i);
    }
    return all;
}

TEST(FailedGroups, AreJoinedByAnyOfEightNeighbours) {
    // Row 0: x 0, 2, 7; row 1: x 1, 7; row 2: x 0. The last pixel of a row does not touch the first of the next.
    const std::vector<std::uint32_t> failing{0, 2, 7, 9, 15, 16};
    const RenderStats all = image(failing);
    Render render("r", 8, 4);
    for (const std::uint32_t i : failing) render.g[i] = std::numeric_limits<float>::infinity();
    EXPECT_THAT(failed_groups(render, all), ElementsAre(1, 2));
    render.g[9] = 0;  // it joined the others
    EXPECT_THAT(failed_groups(render, all), ElementsAre(3, 4));
}

/// A side of `renders` renders; `counts`: pixel and in how many renders it is not finite, with one group each.
ArmStats side(std::size_t renders, const std::vector<std::pair<std::uint32_t, std::uint32_t>>& counts) {
    ArmStats out;
    out.files.resize(renders);
    out.not_finite.assign(32, 0);
    out.failed_groups.assign(renders, std::vector<std::uint32_t>(2));
    for (const auto& [pixel, count] : counts) {
        out.not_finite[pixel] = count;
        for (std::uint32_t k = 0; k < count; ++k) {
            ++out.failed_groups[k][1];
            out.failed_groups[k][0] += pixel % 8 < 4;
        }
    }
    return out;
}

TEST(NonFiniteCounts, AreComparedByFishersTest) {
    // Fisher's p of 5 of 8 against 0 of 8: 2 C(8,5) C(8,0) / C(16,5) = 0.0256; of 6 of 8: 2 C(8,6) / C(16,6) = 0.00699.
    const RenderStats all = image({5});
    const NonFinite five = compare_non_finite(all, side(8, {{5, 5}}), side(8, {}), 0.03),
                    six = compare_non_finite(all, side(8, {{5, 6}}), side(8, {}), 0.03);
    EXPECT_FALSE(five.differs());
    EXPECT_EQ(five.one_sided, 1u);
    EXPECT_EQ(five.undecided, 1u);  // half of the renders or more
    EXPECT_NEAR(five.p, 2 * 112.0 / 4368, 1e-9);
    EXPECT_THAT(six.a.pixels, ElementsAre(5));
    EXPECT_NEAR(six.p, 2 * 56.0 / 8008, 1e-9);
}

TEST(NonFiniteCounts, OfOneSideInEveryRenderDifferAtOnce) {
    const NonFinite found = compare_non_finite(image({3, 9}), side(1, {{9, 1}}), side(2, {{3, 2}, {9, 1}}), 1e-9);
    EXPECT_THAT(found.b.pixels, ElementsAre(3));
    EXPECT_THAT(found.a.pixels, IsEmpty());
    EXPECT_EQ(found.two_sided, 1u);
    EXPECT_EQ(found.p, 0);
    EXPECT_EQ(found.b.least_renders, 2u);
    EXPECT_EQ(found.b.most_other_renders, 0u);
}

TEST(NonFiniteCounts, OfGroupsShowScatteredFailures) {
    // 12 pixels, each in one of 8 renders of one side: no pixel differs, but 12 groups against 0 have p = 2^-11.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> counts;
    std::vector<std::uint32_t> pixels;
    for (std::uint32_t k = 0; k < 12; ++k) {
        counts.emplace_back(2 * k, 1);
        pixels.push_back(2 * k);
    }
    const NonFinite found = compare_non_finite(image(pixels), side(8, {}), side(8, counts), 0.01);
    EXPECT_EQ(found.groups[1].b, 12u);
    EXPECT_NEAR(found.groups[1].p, 0x1p-11, 1e-12);
    EXPECT_TRUE(found.groups[1].differs);
    EXPECT_FALSE(found.groups[0].differs);  // 6 groups: 2^-5
    EXPECT_EQ(found.b.pixels, pixels);
    EXPECT_FALSE(compare_non_finite(image({}), side(8, {}), side(8, {}), 0.01).any());
}

}  // namespace file_warnings_test
}  // namespace crescent
