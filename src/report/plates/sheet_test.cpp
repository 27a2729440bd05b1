// Labels, numbers and formulas of plates against markup written out by hand, on a synthetic experiment.
#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "report/plates/sheet.h"
#include "tests/support/test_world.h"

namespace crescent::plates {
namespace sheet_test {

TEST(Words, ALabelSaysOnceWhatTheRunsShare) {
    World world(8, 8);
    EXPECT_EQ(runs_label({{"phong", 256, 32, 7}}, world.e), "phong N=256 s=32");
    EXPECT_EQ(runs_label({{"uniform", 64, 32, 7}, {"cosine", 64, 32, 7}}, world.e), "uniform | cosine N=64")
        << "neither aims by s";
    EXPECT_EQ(runs_label({{"cosine", 4, 32, 7}, {"cosine", 16, 32, 7}}, world.e), "cosine N=4 | 16");
    EXPECT_EQ(runs_label({{"cosine", 4, 8, 7}}, world.e), "cosine N=4 s=8") << "not the experiment's own s";
    world.add_arm("mis-balance", "mis-balance");
    EXPECT_THAT(runs_label({{"mis-balance", 64, 32, 7}}, world.e), testing::HasSubstr("N=64 pairs"));
}

TEST(Words, NumbersAreSetWithTrueMinusAndPowers) {
    EXPECT_EQ(number(-0.25), "−0.25");
    EXPECT_EQ(number(1.5e-9), "1.5·10<sup>−9</sup>");
    EXPECT_EQ(figure(2, 4), "2.000");
    EXPECT_EQ(figure(889.708, 3), "890");
    EXPECT_EQ(figure(99.97, 3), "100");
    EXPECT_EQ(figure(99.94, 3), "99.9");
    EXPECT_EQ(figure(1234.4, 4), "1234");
    EXPECT_EQ(figure(14402, 4).find('.'), std::string::npos);
    EXPECT_EQ(number(std::nan("")), "not a number");
}

TEST(Words, RenamedArmKeepsItsNameAndFormula) {
    World world(8, 8);
    world.add_arm("sharp", "phong");
    EXPECT_EQ(arm_name("phong", world.e), "phong");
    EXPECT_EQ(arm_name("sharp", world.e), "sharp");
    EXPECT_EQ(density_formula_at("sharp", 8, world.e), "p(ω) = 9/(2π) (ω·R)<sup>8</sup>");
    EXPECT_EQ(density_formula("uniform", world.e), "p(ω) = 1/(2π)");
}

}  // namespace sheet_test
}  // namespace crescent::plates
