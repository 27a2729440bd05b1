// Rectangles of pixels as files have them: both ends inside, y from the top down (OpenEXR's windows).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace crescent::inline comparing {

/// More on a side is taken for a damaged header.
inline constexpr std::int64_t most_pixels_a_side = 65536;

struct PixelWindow {
    std::int64_t x0 = 0, y0 = 0, x1 = -1, y1 = -1;
    std::int64_t width() const { return x1 - x0 + 1; }
    std::int64_t height() const { return y1 - y0 + 1; }
    bool empty() const { return width() < 1 || height() < 1; }
    std::size_t pixels() const { return static_cast<std::size_t>(width()) * static_cast<std::size_t>(height()); }
    bool operator==(const PixelWindow&) const = default;
};

inline PixelWindow intersection(const PixelWindow& a, const PixelWindow& b) {
    return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

}  // namespace crescent::inline comparing
