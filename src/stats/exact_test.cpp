// Values by integer arithmetic.
#include "stats/exact.h"

#include <gtest/gtest.h>

#include <cmath>

namespace crescent::inline stats {
namespace {

TEST(ExactTests, FisherIsTheHypergeometricProbabilityOfNoLikelierSplits) {
    EXPECT_NEAR(fisher_exact(4, 4, 0, 4), 2.0 / 70, 1e-15);
    EXPECT_NEAR(fisher_exact(3, 4, 1, 4), 0.48571428571428565, 1e-12);
    EXPECT_NEAR(fisher_exact(1, 24, 0, 24), 1, 1e-12);
    EXPECT_NEAR(fisher_exact(10, 24, 0, 24) / (2 * 1961256.0 / 6540715896.0), 1, 1e-12);
    EXPECT_NEAR(fisher_exact(1, 1, 1, 24), 2.0 / 25, 1e-12);
    EXPECT_NEAR(fisher_exact(0, 5, 0, 9), 1, 1e-15);
    EXPECT_GT(fisher_exact(500, 500, 0, 500), 0);
    EXPECT_LT(fisher_exact(500, 500, 0, 500), 1e-290);
}

TEST(ExactTests, BinomialIsTwiceTheSmallerTail) {
    EXPECT_NEAR(binomial_exact(12, 12, 0.5) / std::ldexp(1, -11), 1, 1e-12);
    EXPECT_NEAR(binomial_exact(0, 12, 0.5) / std::ldexp(1, -11), 1, 1e-12);
    EXPECT_NEAR(binomial_exact(6, 12, 0.5), 1, 1e-15);
    EXPECT_NEAR(binomial_exact(3, 4, 0.2), 2 * (4 * 0.008 * 0.8 + 0.0016), 1e-12);
    EXPECT_EQ(binomial_exact(0, 0, 0.5), 1);
}

}  // namespace
}  // namespace crescent::inline stats
