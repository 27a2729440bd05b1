// Frames as the encoder takes them: rows of R, G, B, 8 bits each.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "painter.h"

namespace crescent::explainer {

struct Raster {
    std::vector<unsigned char> bytes;  // R, G, B
    std::uint64_t hash = 0;            // XXH3-64 of the bytes
};

/// Returns the picture on a canvas, whose width and height must be even.
std::shared_ptr<const Raster> raster_of(const Canvas& canvas);

/// Draws frames first .. last - 1 on all cores and passes them on one by one in order. A frame that equals the one
/// before it is passed on again without being drawn.
void for_each_frame(const Timeline& timeline, int height, int first, int last, ProgressMonitor& monitor,
    const std::function<void(const Raster&)>& take);

}  // namespace crescent::explainer
