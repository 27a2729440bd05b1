// The jobs of a plan against lists written out by hand: every arm at the experiment's own exponent, then the runs of
// the exponent control that no arm has already.
#include "run/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/film.h"
#include "render/tiles.h"
#include "tests/support/test_scene.h"

namespace crescent {
namespace plan_test {

std::vector<std::string> describe(const Experiment& e) {
    std::vector<std::string> out;
    for (const Job& job : jobs_of(e, 9)) {
        EXPECT_EQ(job.seed, 9u);
        for (const std::uint64_t n : job.n) out.push_back(to_string(RunKey{job.arm, n, job.s, job.seed}));
    }
    return out;
}

TEST(Jobs, AreEachArmAtTheExperimentsOwnExponent) {
    EXPECT_EQ(describe(test::small_scene()),
        (std::vector<std::string>{
            "uniform n=64 s=24", "cosine n=4 s=24", "cosine n=64 s=24", "phong n=4 s=24", "phong n=64 s=24"}));
}

TEST(Jobs, AddOnlyMissingExponentControlRuns) {
    Experiment e = test::small_scene();
    e.exponent.emplace();
    e.exponent->arm = "phong";
    e.exponent->shape = "ball";
    e.exponent->n = 64;
    e.exponent->s = {8, 24, 128};
    std::vector<std::string> all = describe(e);
    ASSERT_EQ(all.size(), 7u);
    EXPECT_EQ(all[5], "phong n=64 s=8");
    EXPECT_EQ(all[6], "phong n=64 s=128");
    e.exponent->n = 16;  // a sample count that the arm does not have
    all = describe(e);
    ASSERT_EQ(all.size(), 8u);
    EXPECT_EQ(all[6], "phong n=16 s=24");
}

// ---- A run that exceeds the machine's memory is rejected before it begins, with a size that would fit.

Experiment tiny(int width, int height) {
    return load(std::string(CRESCENT_SOURCE_DIR) + "/tests/system/tiny.toml",
        {"image.width=" + std::to_string(width), "image.height=" + std::to_string(height),
            "reference.monte_carlo=true"});
}

/// An experiment of the repository with these settings, and the peak of `crescent run --threads 2` in MB.
struct MeasuredRun {
    const char* file;
    std::vector<std::string> settings;
    double megabytes;
};

TEST(Needs, AreWithinAQuarterOfWhatRunsTook) {
    const MeasuredRun runs[] = {
        {"tests/system/tiny.toml", {"seeds=1"}, 32},
        {"tests/system/tiny.toml", {"image.width=960", "image.height=540", "seeds=1"}, 218},
        {"tests/system/tiny.toml", {"image.width=2048", "image.height=2048", "seeds=1"}, 1637},
        {"experiments/two-lamps.toml", {"seeds=1"}, 40},
        {"experiments/two-lamps.toml", {"image.width=1920", "image.height=1080", "n=4", "seeds=1"}, 1155},
        {"experiments/three-glosses.toml", {"seeds=1"}, 42},
        {"experiments/three-glosses.toml", {"image.width=1600", "image.height=600", "seeds=1"}, 420},
        {"experiments/empty-room.toml", {"seeds=1"}, 46},
        {"experiments/empty-room.toml", {"image.width=1280", "image.height=720", "seeds=1"}, 360},
        {"experiments/gallery.toml", {"seeds=1"}, 381},
        {"experiments/gallery.toml", {"image.width=1920", "image.height=1080", "seeds=1"}, 1453},
        {"experiments/cousins.toml", {"seeds=1"}, 739},
    };
    for (const MeasuredRun& run : runs) {
        SCOPED_TRACE(run.file + testing::PrintToString(run.settings));
        const RunPlan all = plan(load(std::string(CRESCENT_SOURCE_DIR) + "/" + run.file, run.settings));
        const Scene scene(all.experiment);
        EXPECT_TRUE(can_keep_points(all, scene, 100'000'000'000));
        const double needed = static_cast<double>(memory_needed(all.experiment, bytes_of_points(scene))) / 1e6;
        EXPECT_GT(needed, 0.85 * run.megabytes);
        EXPECT_LT(needed, 1.25 * run.megabytes);
    }
}

TEST(Needs, GrowWithThePixelsAndTheRungs) {
    const double large = static_cast<double>(memory_needed(tiny(16384, 16384)));
    EXPECT_GT(large, 250.0 * 16384 * 16384) << "260 bytes a pixel were measured";
    EXPECT_LT(large, 290.0 * 16384 * 16384);
    Experiment e = tiny(2048, 2048);
    const std::uint64_t before = memory_needed(e);
    e.arms[0].n = {1, 2, 3, 4, 5};
    EXPECT_GT(memory_needed(e), before + std::uint64_t{3} * 30 * 2048 * 2048);
    const std::uint64_t now = memory_needed(e);
    EXPECT_EQ(memory_needed(e, 1'000'000'000), now + 1'000'000'000);
}

TEST(Needs, OfASmallImageHaveWholeHitsWithTheFilmsIfPointsAreNotKept) {
    const Experiment small = tiny(1024, 1024), large = tiny(1025, 1024);
    EXPECT_GT(memory_needed(small), memory_needed(large) + std::uint64_t{100} * 1024 * 1024);
    EXPECT_LT(memory_needed(small, 1), memory_needed(large, 1));
}

TEST(Needs, PointsAreNotKeptIfMemoryIsShort) {
    const RunPlan small = plan(tiny(96, 54)), large = plan(tiny(8192, 8192));
    EXPECT_TRUE(can_keep_points(small, Scene(small.experiment), 1'000'000'000));
    EXPECT_FALSE(can_keep_points(large, Scene(large.experiment), 20'000'000'000));
    const std::uint64_t with_points = memory_needed(large.experiment, bytes_of_points(Scene(large.experiment)));
    EXPECT_TRUE(can_keep_points(large, Scene(large.experiment), 2 * with_points));
    EXPECT_FALSE(can_keep_points(large, Scene(large.experiment), 2 * with_points - 2));
    EXPECT_EQ(large.exponents.size(), 1u);
}

TEST(Needs, ThatAreNotThereAreToldWithWhatWouldFit) {
    EXPECT_EQ(why_too_large(tiny(96, 54), 2'000'000'000), "");
    const std::string message = why_too_large(tiny(16384, 16384), 8'000'000'000);
    EXPECT_THAT(message, testing::HasSubstr("and 8 GB are available"));
    const std::size_t at = message.find("image.width=");
    ASSERT_NE(at, std::string::npos) << message;
    const int width = std::stoi(message.substr(at + 12));
    EXPECT_GT(width, 2048);
    EXPECT_EQ(why_too_large(tiny(width, width), 8'000'000'000), "") << "what it proposes fits";
}

}  // namespace plan_test
}  // namespace crescent
