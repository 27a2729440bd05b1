// Which draws count as steps of a threshold in u.
#include "check/decide/resolution.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "tests/support/function_sampler.h"

namespace crescent::check {
namespace resolution_test {

/// The share of the draws on a step, of a sampler that turns the cosine's draws by 180 degrees where `is_turned`.
template <class Turned> double share_of(const Turned& is_turned) {
    FunctionSampler s;
    s.draw = [&](Vec3d o, const PrimarySample& u) {
        const Vec3d w = cosine_draw(o, PrimarySample(0.5, u.y));
        return is_turned(u.x) ? Vec3d{-w.x, -w.y, w.z} : w;
    };
    const CaseLighting light{};
    Source source(s, 0, {0, 0, 1}, light);
    const Plan plan = make_plan(source, CheckBudget::limited(1e5), {});
    return resolution_effect(source, plan, {}).share;
}

// Thresholds every 64 steps of 2^-24: one draw in 64 is next to one on its side.
TEST(ResolutionOfNumbers, MovesTheDrawsNextToAThreshold) {
    constexpr double thresholds = 0x1p18;
    const double share = share_of([](double u) { return std::fmod(std::floor(u * thresholds), 2) == 1; });
    EXPECT_NEAR(share, 1.0 / 64, 5 * std::sqrt(1.0 / 64 / 4096));
}

// A rejection that is decided by a hash of u changes from one number to the next: no threshold is near.
TEST(ResolutionOfNumbers, DoesNotMoveTheDrawsOfAHash) {
    const auto hashed = [](double u) { return (static_cast<std::uint32_t>(u * 0x1p24) * 2654435761u) >> 28 == 0; };
    EXPECT_LT(share_of(hashed), 0.001);
}

}  // namespace resolution_test
}  // namespace crescent::check
