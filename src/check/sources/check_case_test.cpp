// The text of a case.
#include "check/sources/check_case.h"

#include <gtest/gtest.h>

#include "tests/support/function_sampler.h"

namespace crescent {
namespace check_case_test {

TEST(CheckCases, AreDescribedByTheirDirectionAndParameters) {
    CheckCase t;
    t.theta_deg = 60;
    t.azimuth_deg = 250;
    t.parameters = {{"s", 32}};
    t.brdf = "Lambert";
    t.lighting = "fill";
    EXPECT_EQ(t.text(), "w_o 60 deg az 250, s=32, Lambert, fill");
    auto sky = std::make_shared<check::FunctionSampler>();
    sky->of.wo = Traits::WoDomain::none;
    CheckCase of_sky;
    of_sky.adapter = sky;
    EXPECT_EQ(of_sky.text(), without_wo);
    EXPECT_NEAR(tilt(30, 90).y, 0.5, 1e-12);
    EXPECT_NEAR(tilt(120).z, -0.5, 1e-12);
}

}  // namespace check_case_test
}  // namespace crescent
