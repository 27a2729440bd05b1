// Quantiles of sets whose answer is seen at once.
#include "stats/quantiles.h"

#include <gtest/gtest.h>

#include <cmath>

namespace crescent::inline stats {
namespace {

TEST(Quantiles, InterpolateBetweenOrderStatistics) {
    EXPECT_DOUBLE_EQ(quantile({4, 1, 3, 2}, 0.5), 2.5);
    EXPECT_DOUBLE_EQ(quantile({5}, 0.95), 5);
    EXPECT_TRUE(std::isnan(quantile({1, std::nan("")}, 0.5)));
}

TEST(Quantiles, OfTwoMiddlesTheMedianIsTheUpper) {
    EXPECT_EQ(median_of({4, 1, 3, 2}), 3);
    EXPECT_EQ(median_of({2, 1, 3}), 2);
    EXPECT_EQ(median_of({}), 0);
}

TEST(Quantiles, AnOrderStatisticCountsFromTheSmallest) {
    EXPECT_EQ(order_statistic({4, 1, 3, 2}, 0), 1);
    EXPECT_EQ(order_statistic({4, 1, 3, 2}, 2), 3);
}

}  // namespace
}  // namespace crescent::inline stats
