// A GoogleTest suite as users write theirs, whose samplers share one alpha: tests/system/suite.sh runs it in one
// process and in one process per test, as gtest_discover_tests does.
#include <array>
#include <cmath>

#include "check/gtest.h"

namespace {

using crescent::IsARightSampler;

struct Cosine {
    struct Drawn {
        std::array<float, 3> wi;
        float pdf;
    };
    float too_much = 1;
    Drawn sample(std::array<float, 3>, std::array<float, 2> u) const {
        const float r = std::sqrt(u[0]), phi = 6.2831853f * u[1], z = std::sqrt(1 - u[0]);
        return {{r * std::cos(phi), r * std::sin(phi), z}, too_much * z / 3.14159265f};
    }
    float pdf(std::array<float, 3>, std::array<float, 3> wi) const {
        return wi[2] > 0 ? too_much * wi[2] / 3.14159265f : 0;
    }
};

TEST(Suite, OneSampler) { EXPECT_THAT(Cosine{}, IsARightSampler()); }

TEST(Suite, TwoSamplers) {
    EXPECT_THAT(Cosine{}, IsARightSampler());
    EXPECT_THAT(Cosine{}, IsARightSampler());
}

TEST(Suite, WrongSampler) { EXPECT_THAT(Cosine{1.01f}, IsARightSampler()); }

}  // namespace

int main(int argc, char** argv) {
    testing::InitGoogleTest(&argc, argv);
    crescent::share_alpha(1e-3);
    return RUN_ALL_TESTS();
}
