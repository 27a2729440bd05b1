// 24 runs of two arms, two n, two s and three seeds, in no order.
#include <gtest/gtest.h>

#include "metrics/metrics.h"

namespace crescent::inline metrics {

namespace {

std::vector<RunMetrics> runs_of_three_seeds() {
    std::vector<RunMetrics> runs;
    for (const std::uint32_t seed : {9u, 2u, 7u})
        for (const char* arm : {"cosine", "phong"})
            for (const std::uint64_t n : {4u, 16u})
                for (const double s : {0.0, 32.0}) runs.emplace_back().key = {arm, n, s, seed};
    return runs;
}

}  // namespace

TEST(RunIndex, FindsEveryRunByItsKeyAndNoOther) {
    const std::vector<RunMetrics> runs = runs_of_three_seeds();
    const RunIndex index(runs);
    for (const RunMetrics& run : runs) EXPECT_EQ(index.find(run.key), &run);
    EXPECT_EQ(index.find({"phong", 4, -0.0, 7}), index.find({"phong", 4, 0.0, 7}));
    EXPECT_EQ(index.find({"phong", 4, 32, 3}), nullptr);
    EXPECT_EQ(index.find({"phong", 8, 32, 7}), nullptr);
    EXPECT_EQ(index.find({"uniform", 4, 32, 7}), nullptr);
}

TEST(RunIndex, TellsSeedsInTheOrderOfTheRuns) {
    EXPECT_EQ(RunIndex(runs_of_three_seeds()).seeds(), (std::vector<std::uint32_t>{9, 2, 7}));
    EXPECT_TRUE(RunIndex({}).seeds().empty());
}

}  // namespace crescent::inline metrics
