// Each operator of an assertion below, at and above its bound.
#include "experiment/assertion.h"

#include <gtest/gtest.h>

#include <cmath>

namespace crescent {
namespace assertion_test {

TEST(Comparisons, HoldBelowAtOrAboveTheirBound) {
    const auto text = [](std::string_view op) {
        std::string out;
        for (const double left : {1.0, 2.0, 3.0}) out += holds(left, op, 2) ? 'y' : 'n';
        return out;
    };
    EXPECT_EQ(text("<"), "ynn");
    EXPECT_EQ(text("<="), "yyn");
    EXPECT_EQ(text(">"), "nny");
    EXPECT_EQ(text(">="), "nyy");
    EXPECT_EQ(text("=="), "nyn");
    EXPECT_EQ(text("!="), "nnn") << "no operator of the language";
}

TEST(Comparisons, WithNoNumberNeverHold) {
    for (const char* op : {"<", "<=", ">", ">=", "=="}) {
        EXPECT_FALSE(holds(std::nan(""), op, 1)) << op;
        EXPECT_FALSE(holds(1, op, std::nan(""))) << op;
        EXPECT_FALSE(holds(std::nan(""), op, std::nan(""))) << op;
    }
}

}  // namespace assertion_test
}  // namespace crescent
