// Functions that are reciprocal.
#include "check/estimate/both_ways.h"

#include <cmath>
#include <gtest/gtest.h>

#include "tests/support/function_sampler.h"

namespace crescent::check {
namespace both_ways_test {

TEST(BothWaysOfF, TellBrdfsFromPhaseFunctions) {
    const StreamKey key{1, 0, 0, 1, Purpose::pairs};
    FunctionSampler phase, same, lossy;
    for (FunctionSampler* s : {&phase, &same, &lossy}) s->of.wo = Traits::WoDomain::both;
    phase.f_value = [](Vec3d, Vec3d w) { return 0.1 / std::fabs(w.z); };
    same.f_value = [](Vec3d o, Vec3d w) { return 0.1 + 0.05 * dot(o, w); };
    lossy.f_value = [](Vec3d o, Vec3d) { return 0.1 + 0.1 * o.z * o.z; };
    EXPECT_EQ(both_ways(phase, key), BothWays::phase_function);
    EXPECT_EQ(both_ways(same, key), BothWays::same_f);
    EXPECT_EQ(both_ways(lossy, key), BothWays::not_known);
    same.of.eta = Index(1.5);  // a stated index needs no guess
    EXPECT_EQ(both_ways(same, key), BothWays::not_known);
}

}  // namespace both_ways_test
}  // namespace crescent::check
