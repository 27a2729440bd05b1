// Primaries: published matrices, white stays white, XYZ keeps its luminance.
#include <gtest/gtest.h>

#include <cmath>

#include "compare/primaries.h"

namespace crescent::inline comparison {
namespace {

constexpr Chromaticities ap1{{0.713, 0.293}, {0.165, 0.83}, {0.128, 0.044}, {0.32168, 0.33767}};  // ACEScg
constexpr Chromaticities rec2020{{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, {0.3127, 0.3290}};

void expect_near(const Rgb& a, const Rgb& b, double within) {
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], within) << c;
}

TEST(Primaries, LuminanceWeightsAreThosePublished) {
    expect_near(luminance_weights_of(ap1), {0.2722287, 0.6740818, 0.0536895}, 1e-6);  // Academy S-2014-004
    expect_near(luminance_weights_of(rec2020), {0.2627, 0.6780, 0.0593}, 1e-4);       // ITU-R BT.2020
    expect_near(luminance_weights_of({}), {0.2126, 0.7152, 0.0722}, 0);
}

TEST(Primaries, ConversionsAreThosePublished) {
    // ITU-R BT.2087: linear Rec.709 in Rec.2020.
    const Matrix3 m = conversion({}, rec2020);
    expect_near(m[0], {0.6274, 0.3293, 0.0433}, 2e-4);
    expect_near(m[1], {0.0691, 0.9195, 0.0114}, 2e-4);
    expect_near(m[2], {0.0164, 0.0880, 0.8956}, 2e-4);
    // ACEScg to linear sRGB with Bradford's adaptation, as OpenColorIO's ACES configurations have it.
    const Matrix3 a = conversion(ap1, {});
    expect_near(a[0], {1.70505, -0.62179, -0.08326}, 3e-4);
    expect_near(a[1], {-0.13026, 1.14080, -0.01055}, 3e-4);
    expect_near(a[2], {-0.02400, -0.12897, 1.15297}, 3e-4);
}

TEST(Primaries, WhiteStaysWhiteAndThereAndBackIsTheSame) {
    expect_near(transformed(conversion(ap1, {}), {1, 1, 1}), {1, 1, 1}, 1e-12);
    const Rgb colour{0.2, 0.7, 0.4};
    expect_near(transformed(conversion({}, ap1), transformed(conversion(ap1, {}), colour)), colour, 1e-12);
}

TEST(Primaries, XyzKeepsItsLuminance) {
    const Rgb rgb = transformed(xyz_to_rgb({}), {0.3, 0.5, 0.9});
    EXPECT_NEAR(luminance(rgb), 0.5, 1e-12);
    expect_near(transformed(rgb_to_xyz({}), rgb), {0.3, 0.5, 0.9}, 1e-12);
    constexpr Chromaticities itself{{1, 0}, {0, 1}, {0, 0}, {1. / 3, 1. / 3}};
    EXPECT_TRUE(is_valid(itself));
    expect_near(luminance_weights_of(itself), {0, 1, 0}, 1e-12);
    expect_near(transformed(conversion(itself, {}), {0.3, 0.5, 0.9}), rgb, 1e-12);
}

TEST(Primaries, WhatDescribesNoColoursIsNotValid) {
    EXPECT_TRUE(is_valid({}) && is_valid(ap1));
    EXPECT_FALSE(is_valid({{0.64, 0.33}, {0.64, 0.33}, {0.15, 0.06}, {0.3127, 0.3290}}));
    EXPECT_FALSE(is_valid({{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {0.3127, 0}}));
    EXPECT_FALSE(is_valid({{0.64, std::nan("")}, {0.30, 0.60}, {0.15, 0.06}, {0.3127, 0.3290}}));
    EXPECT_FALSE(is_valid({{0, 0}, {0, 0}, {0, 0}, {0, 0}}));
}

}  // namespace
}  // namespace crescent::inline comparison
