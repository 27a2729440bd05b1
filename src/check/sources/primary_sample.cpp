// Random numbers in pairs from the stream of the pixel; even covers by Roberts' additive recurrence, whose steps are
// powers of the generalised golden ratio. All numbers are at most 1 - 2^-24.
#include "check/sources/primary_sample.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "math/functions.h"
#include "math/simd/random.h"

namespace crescent::inline sources {

namespace {

/// Roberts' generalised golden ratios: powers of 1/g, g^(d+1) = g + 1.
std::array<double, PrimarySample::most> steps_of(int count) {
    if (count <= 2) return {0.7548776662466927, 0.5698402909980532};
    double g = 1.2;
    for (int k = 0; k < 64; ++k) g = math::pow(1 + g, 1.0 / (count + 1));
    std::array<double, PrimarySample::most> out{};
    for (int k = 0; k < count; ++k) out[static_cast<std::size_t>(k)] = math::pow(g, -(k + 1.0));
    return out;
}

}  // namespace

PrimarySample drawn_numbers(
    std::uint32_t seed, std::uint32_t pixel, std::uint64_t i, std::uint32_t technique, int count) {
    PrimarySample out;
    for (int k = 0; k < count; k += 2) {
        const Vec2<float> u = draw(seed, pixel, i, technique + 16 * static_cast<std::uint32_t>(k) / 2);
        out[k] = u.x;
        if (k + 1 < PrimarySample::most) out[k + 1] = u.y;
    }
    return out;
}

PrimarySample even_cover(std::uint64_t i, const PrimarySample& shift, int count) {
    static const auto table = [] {
        std::array<std::array<double, PrimarySample::most>, PrimarySample::most + 1> all{};
        for (int n = 0; n <= PrimarySample::most; ++n) all[static_cast<std::size_t>(n)] = steps_of(n);
        return all;
    }();
    constexpr double top = 1 - 0x1p-24;
    PrimarySample out;
    for (int k = 0; k < std::max(count, 2); ++k) {
        const double x =
            shift[k] + table[static_cast<std::size_t>(count)][static_cast<std::size_t>(k)] * static_cast<double>(i + 1);
        out[k] = std::min(x - std::floor(x), top);
    }
    return out;
}

std::string describe(const PrimarySample& u, int count, int digits) {
    std::string out = "u = (";
    for (int k = 0; k < count; ++k) out += fmt::format("{}{:.{}g}", k ? ", " : "", u[k], digits);
    return out + ")";
}

}  // namespace crescent::inline sources
