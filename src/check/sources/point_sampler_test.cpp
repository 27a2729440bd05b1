// Samplers of points in C++.
#include "check/sources/point_sampler.h"

#include <cmath>
#include <gtest/gtest.h>

#include "check/gtest.h"
#include "check/user.h"

namespace crescent {

namespace {
namespace point_sampler_test {

PointSampler distance_sampler(double rate) {
    return {.domain = "line:0,inf",
        .numbers = 1,
        .sample =
            [rate](std::span<const double> u, std::span<double> x) {
                x[0] = -std::log1p(-u[0]) / 2;
                return rate * std::exp(-rate * x[0]);
            },
        .pdf = [rate](std::span<const double> x) { return rate * std::exp(-rate * x[0]); },
        .parallel = true};
}

TEST(PointSampler, IsChecked) {
    EXPECT_THAT(distance_sampler(2), IsARightSampler());
    EXPECT_EQ(check_sampler("rate", distance_sampler(2.2)).state, State::wrong);
}

TEST(PointSampler, IsRefusedWithAReason) {
    PointSampler disc = distance_sampler(2);
    disc.domain = "disc";
    EXPECT_THROW(check_sampler("lens", disc), InputError);
    PointSampler many = distance_sampler(2);
    many.numbers = 8;
    EXPECT_THROW(check_sampler("many", many), InputError);
}

}  // namespace point_sampler_test
}  // namespace

}  // namespace crescent
