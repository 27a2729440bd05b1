// The pixels of an area of the image: those of its box, or those of them in which the camera sees one surface.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "render/film.h"
#include "scene/scene_data.h"

namespace crescent {

/// The map must outlive it; it is read only for an area of one surface.
class AreaPixels {
public:
    AreaPixels(const Area& area, const ShapeMap& shapes) : area_(area), shapes_(shapes) {}

    /// Calls f(index) for each pixel, row by row from the bottom-left; index = i + j * width.
    template <class F> void for_each(F&& f) const {
        const auto width = static_cast<std::size_t>(shapes_.width);
        for (int j = area_.box.y0; j <= area_.box.y1; ++j)
            for (int i = area_.box.x0; i <= area_.box.x1; ++i) {
                const std::size_t index = static_cast<std::size_t>(j) * width + static_cast<std::size_t>(i);
                if (area_.surface == any_surface || shapes_.shape[index] == area_.surface) f(index);
            }
    }
    std::uint64_t count() const {
        const Box& box = area_.box;
        if (area_.surface == any_surface)
            return static_cast<std::uint64_t>(box.width()) * static_cast<std::uint64_t>(box.height());
        std::uint64_t pixels = 0;
        for_each([&](std::size_t) { ++pixels; });
        return pixels;
    }
    /// Returns the smallest box that has all of them; the area's own if there are none.
    Box bounds() const {
        if (area_.surface == any_surface) return area_.box;
        const auto width = static_cast<std::size_t>(shapes_.width);
        Box out{.x0 = area_.box.x1, .y0 = area_.box.y1, .x1 = -1, .y1 = -1};
        for_each([&](std::size_t index) {
            const int i = static_cast<int>(index % width), j = static_cast<int>(index / width);
            out = {std::min(out.x0, i), std::min(out.y0, j), std::max(out.x1, i), std::max(out.y1, j)};
        });
        return out.x1 < 0 ? area_.box : out;
    }
    /// Returns the same area with these bounds as its box.
    Area tight() const { return {bounds(), area_.surface}; }
    /// Returns the mean of f(index) over the pixels, summed in double in their order.
    template <class F> double mean(F&& f) const {
        double sum = 0;
        for_each([&](std::size_t index) { sum += f(index); });
        return sum / static_cast<double>(count());
    }

private:
    Area area_;
    const ShapeMap& shapes_;
};

}  // namespace crescent
