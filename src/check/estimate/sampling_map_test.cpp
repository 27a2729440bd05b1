// Steps of single precision.
#include "check/estimate/sampling_map.h"

#include <cmath>
#include <gtest/gtest.h>

#include "tests/support/function_sampler.h"

namespace crescent::check {
namespace sampling_map_test {

const CaseLighting uniform_light;

TEST(LocalSteps, AreThoseOfSinglePrecision) {
    // A cosine next to 1 has a step of 2^-24: the angle jumps between sqrt(2 k 2^-24).
    const auto steps = [](bool single) {
        FunctionSampler s;
        s.draw = [single](Vec3d, const PrimarySample& u) {
            double z = 1 - 1e-6 * u[0];
            if (single) z = static_cast<double>(static_cast<float>(z));
            const double r = std::sqrt(1 - z * z);
            return Vec3d{r * std::cos(two_pi * u[1]), r * std::sin(two_pi * u[1]), z};
        };
        s.p = [](Vec3d, Vec3d) { return 1.0; };
        Source source(s, 0, {0, 0, 1}, uniform_light);
        std::vector<PrimarySample> u;
        for (std::uint32_t i = 0; i < 64; ++i) u.push_back(numbers_at({1}, i, 2, Resolution::single));
        std::vector<Vec3d> w;
        for (const Draw& d : source.draw(u)) w.push_back(d.wi);
        double sum = 0;
        for (const LocalStep& step : local_steps(source, u, w)) sum += step.jump / 64;
        return sum;
    };
    EXPECT_EQ(steps(false), 0);
    const double typical = 0x1p-24 / std::sqrt(1e-6);  // dz = theta dtheta, at a typical theta of 1e-3
    EXPECT_GT(steps(true), typical / 3);
    EXPECT_LT(steps(true), typical * 3);
}

}  // namespace sampling_map_test
}  // namespace crescent::check
