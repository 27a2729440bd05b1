// Numbers in sentences, with as many digits as are known.
#pragma once

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <string>

#include "base/vec.h"

namespace crescent::check {

/// "0.9754 +- 0.0002": the half width of the interval with one digit, or two if the first is 1, and the value to the
/// same place.
inline std::string with_error(double value, double half) {
    if (!(half > 0) || !std::isfinite(half)) return fmt::format("{:.5g}", value);
    const double exponent = std::floor(math::log10(half) + 1e-9);
    const int digits = -static_cast<int>(exponent) + (half < 1.95 * math::pow(10, exponent) ? 1 : 0);
    if (digits > 12 || digits < -3) return fmt::format("{:.5g} +- {:.1g}", value, half);
    return fmt::format("{:.{}f} +- {:.{}f}", value, std::max(digits, 0), half, std::max(digits, 0));
}
/// "12.3 % +- 0.4 %" for shares.
inline std::string percent(double share, double half) {
    const std::string both = with_error(100 * share, 100 * half);
    const std::size_t at = both.find(" +-");
    return at == std::string::npos ? both + " %" : both.substr(0, at) + " %" + both.substr(at) + " %";
}

inline std::string direction_text(Vec3d w) { return fmt::format("({:.4g}, {:.4g}, {:.4g})", w.x, w.y, w.z); }

}  // namespace crescent::check
