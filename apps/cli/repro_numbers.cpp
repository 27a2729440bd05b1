// A number next to 1 stays as it is: rounded it would be 1, which no sampler is given.
#include "repro_numbers.h"

#include <algorithm>
#include <cmath>

namespace crescent::cli {

double uniform(RandomBits& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

PrimarySample random_numbers(RandomBits& random, int count) {
    PrimarySample out;
    for (int k = 0; k < count; ++k) out[k] = static_cast<double>(random() >> 40) * 0x1p-24;
    return out;
}

PrimarySample with_few_digits(const SamplerAdapter& sampler, Vec3d wo, const PrimarySample& u, int count,
    const std::function<bool(const Draw&)>& holds) {
    for (double scale = 10; scale < 1e8; scale *= 10) {
        PrimarySample round = u;
        for (int k = 0; k < count; ++k)
            if (u[k] < below_one) round[k] = std::min(std::round(u[k] * scale) / scale, below_one);
        Draw draw;
        sampler.sample(0, wo, {&round, 1}, {&draw, 1});
        if (holds(draw)) return round;
    }
    return u;
}

}  // namespace crescent::cli
