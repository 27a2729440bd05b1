// Spectra of synthetic noise, and of a wave.
#include "compare/noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "compare/synthetic.h"

namespace crescent::inline comparison {
namespace {

TEST(Spectrum, DistinguishesFilteredFromWhiteNoise) {
    std::vector<double> white, filtered;
    const auto noise = [](int x, int y) {
        return synthetic_pixel({SyntheticNoise::Kind::normal, 1, 0}, 9, static_cast<std::uint32_t>(y * 65 + x), 65) - 1;
    };
    const Box box{0, 0, 63, 63};
    add_spectrum(white, box, noise);
    add_spectrum(filtered, box,
        [&](int x, int y) { return noise(x, y) + noise(x + 1, y) + noise(x, y + 1) + noise(x + 1, y + 1); });
    EXPECT_EQ(noise_colour(white), NoiseColour::white);
    EXPECT_EQ(noise_colour(filtered), NoiseColour::correlated);
}

TEST(Spectrum, ContainsThePowerOfAWave) {
    std::vector<double> power;
    add_spectrum(power, {0, 0, 31, 31}, [](int x, int) { return std::cos(2 * 3.141592653589793 * 5 * x / 32); });
    for (std::size_t k = 0; k < power.size(); ++k)
        if (k != 4) EXPECT_NEAR(power[k], 0, 1e-9) << k;
    EXPECT_GT(power[4], 1);
}

}  // namespace
}  // namespace crescent::inline comparison
