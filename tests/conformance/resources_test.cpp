// A run that exceeds the machine's memory is rejected before it begins, with a size that would fit.
#include "run/resources.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/tiles.h"

namespace crescent {
namespace {

Experiment tiny(int width, int height) {
    return load(std::string(CRESCENT_SOURCE_DIR) + "/tests/system/tiny.toml",
        {"image.width=" + std::to_string(width), "image.height=" + std::to_string(height),
            "reference.monte_carlo=true"});
}

TEST(Needs, GrowWithThePixelsAndTheRungs) {
    const double large = static_cast<double>(memory_needed(tiny(16384, 16384)));
    EXPECT_GT(large, 250.0 * 16384 * 16384) << "260 bytes a pixel were measured";
    EXPECT_LT(large, 350.0 * 16384 * 16384);
    Experiment e = tiny(2048, 2048);
    const std::uint64_t before = memory_needed(e);
    e.arms[0].n = {1, 2, 3, 4, 5};
    EXPECT_GT(memory_needed(e), before + std::uint64_t{3} * 30 * 2048 * 2048);
}

TEST(Needs, PointsAreNotKeptIfMemoryIsShort) {
    const RunPlan small = plan(tiny(96, 54)), large = plan(tiny(8192, 8192));
    EXPECT_TRUE(can_keep_points(small, Scene(small.experiment), 1'000'000'000));
    EXPECT_FALSE(can_keep_points(large, Scene(large.experiment), 20'000'000'000));
    const std::uint64_t all = memory_needed(large.experiment) + bytes_of_points(Scene(large.experiment));
    EXPECT_TRUE(can_keep_points(large, Scene(large.experiment), 2 * all));
    EXPECT_EQ(large.exponents.size(), 1u);
}

TEST(Needs, ThatAreNotThereAreToldWithWhatWouldFit) {
    EXPECT_EQ(why_too_large(tiny(96, 54), 2'000'000'000), "");
    const std::string message = why_too_large(tiny(16384, 16384), 8'000'000'000);
    EXPECT_THAT(message, testing::HasSubstr("and 8 GB are to be had"));
    const std::size_t at = message.find("image.width=");
    ASSERT_NE(at, std::string::npos) << message;
    const int width = std::stoi(message.substr(at + 12));
    EXPECT_GT(width, 2048);
    EXPECT_EQ(why_too_large(tiny(width, width), 8'000'000'000), "") << "what it proposes fits";
}

}  // namespace
}  // namespace crescent
