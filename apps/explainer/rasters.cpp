// A oneTBB pipeline distributes chunks of ten frames to threads, each with a painter of its own.
#include "rasters.h"

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_arena.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <thread>

namespace crescent::explainer {

namespace {

constexpr int chunk = 10;  // consecutive frames drawn by one thread

/// The painter of a thread, and the last frame that it drew.
struct ThreadPainter {
    Painter painter;
    std::shared_ptr<const Raster> last;
};

using Chunk = std::vector<std::shared_ptr<const Raster>>;

}  // namespace

std::shared_ptr<const Raster> raster_of(const Canvas& canvas) {
    const auto w = static_cast<std::size_t>(canvas.width()), h = static_cast<std::size_t>(canvas.height());
    ensure(w % 2 == 0 && h % 2 == 0, "frames of 4:2:0 have even sides");
    auto raster = std::make_shared<Raster>();
    raster->bytes.reserve(w * h * 3);
    int stride = 0;
    const unsigned char* row = canvas.pixels(stride);
    for (std::size_t j = 0; j < h; ++j, row += stride)
        for (std::size_t i = 0; i < w; ++i)  // of B, G, R, unused
            for (const int channel : {2, 1, 0}) raster->bytes.push_back(row[4 * i + static_cast<std::size_t>(channel)]);
    raster->hash = XXH3_64bits(raster->bytes.data(), raster->bytes.size());
    return raster;
}

void for_each_frame(const Timeline& timeline, int height, int first, int last, ProgressMonitor& monitor,
    const std::function<void(const Raster&)>& take) {
    tbb::enumerable_thread_specific<std::unique_ptr<ThreadPainter>> painters;
    int next_frame = first;
    const auto next_chunk = [&](tbb::flow_control& control) {
        if (next_frame >= last || monitor.stop) control.stop();
        return std::exchange(next_frame, std::min(next_frame + chunk, last));
    };
    const auto draw = [&](int begin) {
        std::unique_ptr<ThreadPainter>& thread_painter = painters.local();
        if (!thread_painter) thread_painter.reset(new ThreadPainter{Painter(timeline, height), nullptr});
        Chunk rasters;
        for (int frame = begin; frame < std::min(begin + chunk, last) && !monitor.stop; ++frame) {
            if (thread_painter->painter.draw(frame) || !thread_painter->last)
                thread_painter->last = raster_of(thread_painter->painter.canvas());
            rasters.push_back(thread_painter->last);
        }
        return rasters;
    };
    const auto pass_on = [&](const Chunk& rasters) {
        for (const auto& raster : rasters) {
            if (monitor.stop) return;
            take(*raster);
            monitor.advance(1);
        }
    };
    const std::size_t tokens = 2 * static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()) + 1;
    tbb::parallel_pipeline(tokens,
        tbb::make_filter<void, int>(tbb::filter_mode::serial_in_order, next_chunk) &
            tbb::make_filter<int, Chunk>(tbb::filter_mode::parallel, draw) &
            tbb::make_filter<Chunk, void>(tbb::filter_mode::serial_in_order, pass_on));
    monitor.check();
}

}  // namespace crescent::explainer
