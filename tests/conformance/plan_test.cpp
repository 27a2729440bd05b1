// The jobs of a plan against lists written out by hand: every arm at the experiment's own exponent, then the runs of
// the exponent control that no arm has already.
#include "run/plan.h"

#include <gtest/gtest.h>

#include "render/film.h"
#include "tests/support/test_scene.h"

namespace crescent {
namespace {

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
    e.exponent->arm = "phong", e.exponent->shape = "ball", e.exponent->n = 64, e.exponent->s = {8, 24, 128};
    std::vector<std::string> all = describe(e);
    ASSERT_EQ(all.size(), 7u);
    EXPECT_EQ(all[5], "phong n=64 s=8");
    EXPECT_EQ(all[6], "phong n=64 s=128");
    e.exponent->n = 16;  // a sample count that the arm does not have
    all = describe(e);
    ASSERT_EQ(all.size(), 8u);
    EXPECT_EQ(all[6], "phong n=16 s=24");
}

}  // namespace
}  // namespace crescent
