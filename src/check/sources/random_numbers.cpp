// Random numbers in pairs from the stream of the pixel, at most 1 - 2^-24.
#include "check/sources/random_numbers.h"

#include "check/estimate/stream.h"
#include "math/simd/random.h"
#include "math/simd/scalar.h"

namespace crescent {

PrimarySample drawn_numbers(
    std::uint32_t seed, std::uint32_t pixel, std::uint64_t i, std::uint32_t technique, int count) {
    PrimarySample out;
    for (int k = 0; k < count; k += 2) {
        const Vec2<float> u = draw(seed, pixel, i, technique + 16 * static_cast<std::uint32_t>(k) / 2);
        out[k] = u.x;
        if (k + 1 < PrimarySample::most_numbers) out[k + 1] = u.y;
    }
    return out;
}

std::vector<PrimarySample> numbers_of_chart(int count) {
    constexpr check::StreamKey key{.seed = 0x6c696e65, .purpose = check::Purpose::pilot};
    std::vector<PrimarySample> out(draws_of_chart);
    for (std::uint32_t i = 0; i < draws_of_chart; ++i)
        out[i] = check::numbers_at(key, i, count, check::Resolution::standard);
    return out;
}

}  // namespace crescent
