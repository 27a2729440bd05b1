// The same in one line of a GoogleTest suite.
#include <cmath>

#include <crescent/gtest.h>
#include <gtest/gtest.h>

namespace {

struct UpperHemisphere {
    struct Direction {
        float x, y, z;
    };
    struct Drawn {
        Direction wi;
        float pdf;
    };
    Drawn sample(crescent::Vec3<float> /*wo*/, crescent::Vec2<float> u) const {
        const float sin = std::sqrt(1 - u.x * u.x), phi = 6.2831853f * u.y;
        return {{sin * std::cos(phi), sin * std::sin(phi), u.x}, 0.15915494f};
    }
    float pdf(crescent::Vec3<float> /*wo*/, crescent::Vec3<float> wi) const { return wi.z > 0 ? 0.15915494f : 0; }
};

TEST(MySampler, IsJudgedInOneLine) { EXPECT_THAT(UpperHemisphere{}, crescent::IsARightSampler()); }

}  // namespace
