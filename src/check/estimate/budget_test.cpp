// The shares of a budget: no look costs more than it may, and Sobol sets have a power of two points.
#include "check/estimate/budget.h"

#include <gtest/gtest.h>

namespace crescent::check {
namespace budget_test {

TEST(CheckBudgets, ALookCostsNoMoreThanItMay) {
    for (const double evaluations : {-5.0, 0.0, 100.0, 5e3, 2e5, 1.2e6, 6.4e6}) {
        const Look look = look_of(evaluations);
        EXPECT_LE(look.cost(), std::max(evaluations, 0.0));
        EXPECT_GE(look.cost(), 0.99 * evaluations - 4) << evaluations;
        if (look.scrambled > 0) EXPECT_TRUE(std::has_single_bit(look.scrambled / replicate_sets));
        if (evaluations < 1e4) continue;
        EXPECT_GE(look.scrambled, 0.18 * evaluations);
        EXPECT_LE(look.scrambled, 0.36 * evaluations);
        EXPECT_NEAR(look.points, 2.0 * look.independent, 4);
    }
}

TEST(CheckBudgets, EachLookHasEightTimesTheOneBefore) {
    const CheckBudget thorough = CheckBudget::thorough();
    for (int i = 1; i < thorough.looks; ++i) {
        EXPECT_EQ(thorough.look(i - 1).independent, thorough.look(i).independent / 8);
        EXPECT_EQ(thorough.look(i - 1).scrambled, thorough.look(i).scrambled / 8);
    }
    EXPECT_LE(thorough.look(thorough.looks - 1).cost(), 0.75 * thorough.evaluations);
}

TEST(CheckBudgets, PartsAreFixedShares) {
    const CheckBudget quick = CheckBudget::quick();
    EXPECT_NEAR(quick.pilot(), 0x1p14, 100);
    EXPECT_NEAR(quick.leaves(), 4096, 10);
    EXPECT_NEAR(quick.f_draws(), 0x1p16, 100);
    EXPECT_EQ(CheckBudget::limited(1e4).size_draws(), 1024u);
    EXPECT_EQ(CheckBudget::limited(12e5).points(), 250000u);
}

}  // namespace budget_test
}  // namespace crescent::check
