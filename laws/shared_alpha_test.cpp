// The sharing of one alpha over the tests of a GoogleTest program.
#include <gtest/gtest.h>

#include "verdicts/gtest_alpha.h"

namespace crescent {
namespace {

TEST(SharedAlpha, TheSharesOfAllTestsComeToAlphaAtMost) {
    SharedAlpha shared(0.01);
    double sum = 0;
    for (int test = 0; test < 40; ++test)
        for (int call = 0; call < 25; ++call) sum += shared.next(std::to_string(test), 40);
    EXPECT_LE(sum, 0.01);
    EXPECT_GT(sum, 0.009);
    EXPECT_DOUBLE_EQ(sum, shared.spent());
}

TEST(SharedAlpha, WithoutItAMatcherHasItsAlphaForItself) {
    EXPECT_EQ(shared_alpha(), nullptr);
    EXPECT_EQ(shared_settings().alpha, TestSettings::quick().alpha);
}

}  // namespace
}  // namespace crescent
