// Random numbers in pairs from the stream of the pixel, all of them at most 1 - 2^-24.
#include "check/sources/primary_sample.h"

#include <fmt/format.h>

#include "math/simd/random.h"

namespace crescent::inline sources {

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

std::string describe(const PrimarySample& u, int count, int digits) {
    std::string out = "u = (";
    for (int k = 0; k < count; ++k) out += fmt::format("{}{:.{}g}", k ? ", " : "", u[k], digits);
    return out + ")";
}

}  // namespace crescent::inline sources
