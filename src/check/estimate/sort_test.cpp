// Sorting by keys, compared with the standard library's.
#include "check/estimate/sort.h"

#include <gtest/gtest.h>

#include <limits>

#include "check/estimate/stream.h"

namespace crescent::check {
namespace sort_test {

TEST(SortByKey, OrdersNumbersOfEitherSign) {
    Stream stream(StreamKey{3});
    std::vector<double> numbers = {0, -1, 1, std::numeric_limits<double>::infinity(), -1e-310, 1e300};
    for (int i = 0; i < 5000; ++i) numbers.push_back((stream.number() - 0.5) * std::ldexp(1, i % 40 - 20));
    std::vector<double> sorted = numbers;
    std::ranges::sort(sorted);
    sort_by_key(numbers, sort_key);
    EXPECT_EQ(numbers, sorted);
}

TEST(SortByKey, KeepsTheOrderOfEqualElements) {
    std::vector<std::pair<std::uint64_t, int>> v;
    for (int i = 0; i < 1000; ++i) v.emplace_back(std::uint64_t{static_cast<unsigned>(i % 7)} << 60, i);
    auto sorted = v;
    std::ranges::sort(sorted);
    sort_by_key(v, [](const auto& x) { return x.first; });
    EXPECT_EQ(v, sorted);
}

TEST(SortByKey, OfNothingOrOneElementChangesNothing) {
    std::vector<double> none, one = {2.5};
    sort_by_key(none, sort_key);
    sort_by_key(one, sort_key);
    EXPECT_TRUE(none.empty());
    EXPECT_EQ(one, std::vector{2.5});
}

}  // namespace sort_test
}  // namespace crescent::check
