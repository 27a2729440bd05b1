// Lights of both tables in one list, and the source of an arm in words.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiment/experiment.h"
#include "tests/support/scene_text.h"

namespace crescent {
namespace derived_values_test {

using testing::ElementsAre;

const std::string area_lights = test::view_text + test::floor_text + R"(
[disks.key]
center = [0, 2, 0]
normal = [0, -1, 0]
radius = 0.1
radiance = [9, 9, 9]
[lights.ball]
kind = "sphere"
center = [1, 2, 0]
radius = 0.25
radiance = [9, 9, 9]
[lights.window]
kind = "rectangle"
corner = [0, 1, -2]
edge_u = [1, 0, 0]
edge_v = [0, 0.5, 0]
radiance = [9, 9, 9]
[arms.cosine]
n = 4
)";

TEST(LightTables, AreThoseOfDisksAndThenThoseOfLights) {
    std::vector<std::string> paths;
    for (const LightTable& table : all_lights(parse(area_lights, "lamps.toml"))) paths.push_back(table.path);
    EXPECT_THAT(paths, ElementsAre("disks.key", "lights.ball", "lights.window"));
}

/// A surface reflects more than it receives only beyond the rounding of single precision and of seven decimal digits.
TEST(Warnings, AllowForTheRoundingOfAlbedos) {
    const auto warnings = [](double rho_d, double rho_s) {
        Experiment e = parse(area_lights, "lamps.toml");
        e.shapes.at(0).material.rho_d = {rho_d, 0, 0};
        e.shapes.at(0).material.rho_s = rho_s;
        return warnings_of(e);
    };
    for (int k = 1; k < 100; ++k) {
        const double rho = k / 100.0;
        EXPECT_THAT(
            warnings(static_cast<double>(static_cast<float>(rho)), static_cast<double>(static_cast<float>(1 - rho))),
            testing::IsEmpty())
            << rho;
    }
    EXPECT_THAT(warnings(0.3333333, 0.6666667), testing::IsEmpty());
    EXPECT_THAT(warnings(0.5, 0.50001), ElementsAre(testing::HasSubstr("rho_d + rho_s is 1.00001, above 1")));
}

}  // namespace derived_values_test
TEST(SourceOfAnArm, IsNamed) {
    ArmPlan arm;
    EXPECT_EQ(source_of(arm), "");
    arm.python = "mine.py:sampler";
    EXPECT_EQ(source_of(arm), "the Python sampler mine.py:sampler");
    ArmPlan combined;
    combined.combination = {.kind = CombinationKind::mis, .of = {"sky", "phong", "cosine"}};
    EXPECT_EQ(source_of(combined), "the balance heuristic of sky, phong and cosine");
    combined.combination.draw = MisDraw::one;
    combined.combination.heuristic = MisHeuristic::power;
    EXPECT_EQ(source_of(combined), "the power heuristic of sky, phong and cosine, one of them a sample");
    combined.combination = {.kind = CombinationKind::ris, .of = {"cosine"}, .candidates = 8};
    EXPECT_EQ(source_of(combined), "one of 8 candidates of cosine, resampled in proportion to product");
}

}  // namespace crescent
