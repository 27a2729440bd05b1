// The columns that describe a surface point and its lights to a program.
#include "samplers/surface_context.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace crescent {
namespace external_sampler_test {

using ::testing::ElementsAre;
using Names = std::vector<std::string>;

TEST(ContextColumns, AreInTheOrderOfTheNames) {
    const SurfaceRun point{{0, 0, 1}, {20, 0.3, 0.5, 0.25}, 1, {0.1, 0.2, 0.4}};
    const auto columns = [&](const Names& uses) {
        std::vector<double> out;
        add_context(uses, point, {}, {}, out);
        EXPECT_EQ(out.size(), context_columns(uses, 0));
        return out;
    };
    EXPECT_THAT(columns({"alpha", "s"}), ElementsAre(0.3, 20));
    EXPECT_THAT(columns({"rho_s", "rho_d"}), ElementsAre(0.25, 0.1, 0.2, 0.4));
    EXPECT_THAT(columns({"side", "eta", "lights"}), ElementsAre(1, 1, 0));
}

TEST(ContextColumns, OfALightAreItsKindRadianceAndPlace) {
    const SceneLight light{"sphere", {3, 4, 5}, 0.5};
    const LightAtPoint at{{1, 2, 3}, {0, 0, -1}, {6, 0, 0}, {0, 7, 0}, true};
    std::vector<double> out;
    add_context(Names{"lights"}, {}, {&light, 1}, {&at, 1}, out);
    EXPECT_THAT(out, ElementsAre(1, 1, 0.5, 3, 4, 5, 1, 2, 3, 0, 0, -1, 6, 0, 0, 0, 7, 0, 1));
    EXPECT_EQ(out.size(), context_columns(Names{"lights"}, 1));
    EXPECT_EQ(context_columns(Names{"lights", "rho_d"}, 3), 1 + 3 * 18 + 3u);
}

TEST(ContextColumns, NamesAreKnownAndDifferent) {
    Names out;
    EXPECT_TRUE(take_context_names("lights,s,rho_d", out));
    EXPECT_EQ(out, (Names{"lights", "s", "rho_d"}));
    for (const char* bad : {"", "s,", "s,s", "s,roughness", " s"}) EXPECT_FALSE(take_context_names(bad, out)) << bad;
    EXPECT_EQ(context_names().size(), 7u);
}

TEST(ContextColumns, OfTheExampleShineOnThePoint) {
    const ExampleLight example = example_light();
    EXPECT_TRUE(example.at.shines);
    EXPECT_LT(dot(example.at.normal, example.at.center), 0);
    EXPECT_EQ(example_context(Names{"s", "lights"}).size(), context_columns(Names{"s", "lights"}, 1));
}

}  // namespace external_sampler_test
}  // namespace crescent
