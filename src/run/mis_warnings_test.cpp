// Weights of MIS that lose light are reported before a run.
#include "run/mis_warnings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "run/external_samplers.h"
#include "tests/support/test_scene.h"

namespace crescent {
namespace mis_warnings_test {

using ::testing::HasSubstr;

Experiment with_weights(std::vector<std::string> weights) {
    Experiment e = test::small_scene({"image.width=32", "image.height=24", "regions.all.box=[0,0,31,23]"});
    ArmPlan both;
    both.name = "both";
    both.combination.kind = CombinationKind::mis;
    both.combination.of = {"light-area", "cosine"};
    both.combination.weights = std::move(weights);
    e.arms = {both};
    return e;
}

std::vector<std::string> warnings_of(std::vector<std::string> weights) {
    const Experiment e = with_weights(std::move(weights));
    return mis_warnings(e, open_external(e));
}

TEST(MisWarnings, NameTheSamplerThatHasWeightWithoutADensity) {
    const auto warnings = warnings_of({"0.5", "0.5"});
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_THAT(warnings[0], HasSubstr("'light-area' has MIS weight where its density is 0"));
    EXPECT_THAT(warnings[0], HasSubstr("down to 0.5"));
}

TEST(MisWarnings, AreNotGivenForWeightsThatVanishWithTheDensity) {
    EXPECT_TRUE(warnings_of({"p1 / (p1 + p2)", "rest"}).empty());
    EXPECT_TRUE(warnings_of({}).empty());
}

}  // namespace mis_warnings_test
}  // namespace crescent
