// Y'CbCr by ITU-R BT.709-6, tables 3 and 4, in 16 fractional bits; chroma is filtered 1 2 1 across and averaged over
// two rows. A oneTBB pipeline distributes chunks of ten frames to threads, each with a painter of its own.
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

// BT.709-6, table 3: E'Y = 0.2126 R + 0.7152 G + 0.0722 B; 8-bit limited range of table 4, in 16 fractional bits.
constexpr int fixed(double v) { return static_cast<int>(v * 65536 + (v < 0 ? -0.5 : 0.5)); }
constexpr double kr = 0.2126, kg = 0.7152, kb = 0.0722, luma = 219.0 / 255, chroma = 224.0 / 255;
constexpr int y_r = fixed(luma * kr), y_g = fixed(luma * kg), y_b = fixed(luma * kb);
constexpr int b_r = fixed(-chroma * kr / (2 - 2 * kb)), b_g = fixed(-chroma * kg / (2 - 2 * kb)), b_b = -b_r - b_g;
constexpr int r_g = fixed(-chroma * kg / (2 - 2 * kr)), r_b = fixed(-chroma * kb / (2 - 2 * kr)), r_r = -r_g - r_b;

void luma_row(const unsigned char* from, unsigned char* to, int width) {  // B, G, R, unused
    for (int i = 0; i < width; ++i, from += 4)
        to[i] =
            static_cast<unsigned char>((y_r * from[2] + y_g * from[1] + y_b * from[0] + (16 << 16) + (1 << 15)) >> 16);
}

/// Left-sited: across 1 2 1 around even columns, down the mean of two rows.
void chroma_row(const unsigned char* row0, const unsigned char* row1, unsigned char* cb, unsigned char* cr, int width) {
    for (int i = 0; i < width; i += 2) {
        const std::ptrdiff_t here = std::ptrdiff_t(4) * i, before = i > 0 ? here - 4 : here;
        int sum[3];
        for (int k = 0; k < 3; ++k) {
            sum[k] = row0[before + k] + 2 * row0[here + k] + row0[here + 4 + k] + row1[before + k] +
                2 * row1[here + k] + row1[here + 4 + k];
        }
        constexpr int offset = (128 << 19) + (1 << 18);
        cb[i / 2] = static_cast<unsigned char>((b_r * sum[2] + b_g * sum[1] + b_b * sum[0] + offset) >> 19);
        cr[i / 2] = static_cast<unsigned char>((r_r * sum[2] + r_g * sum[1] + r_b * sum[0] + offset) >> 19);
    }
}

/// The painter of a thread, and the last frame that it drew.
struct ThreadPainter {
    Painter painter;
    std::shared_ptr<const Raster> last;
};

using Chunk = std::vector<std::shared_ptr<const Raster>>;

}  // namespace

std::shared_ptr<const Raster> raster_of(const Canvas& canvas) {
    const auto w = static_cast<std::size_t>(canvas.width()), h = static_cast<std::size_t>(canvas.height());
    ensure(w % 2 == 0 && h % 2 == 0, "frames have even sides");
    auto raster = std::make_shared<Raster>();
    raster->bytes.resize(w * h * 3 / 2);
    unsigned char* y = raster->bytes.data();
    unsigned char *cb = y + w * h, *cr = cb + w * h / 4;
    int stride = 0;
    const unsigned char* rows = canvas.pixels(stride);
    for (std::size_t j = 0; j < h; j += 2) {
        const unsigned char *row0 = rows + std::ptrdiff_t(j) * stride, *row1 = row0 + stride;
        luma_row(row0, y + j * w, canvas.width());
        luma_row(row1, y + (j + 1) * w, canvas.width());
        chroma_row(row0, row1, cb + j / 2 * (w / 2), cr + j / 2 * (w / 2), canvas.width());
    }
    raster->hash = XXH3_64bits(raster->bytes.data(), raster->bytes.size());
    return raster;
}

void for_each_frame(const Timeline& timeline, int height, int first, int last, ProgressMonitor& monitor,
    const std::function<void(const Raster&)>& take) {
    tbb::enumerable_thread_specific<std::unique_ptr<ThreadPainter>> painters;
    int next = first;
    const auto next_chunk = [&](tbb::flow_control& control) {
        if (next >= last || monitor.stop) control.stop();
        return std::exchange(next, std::min(next + chunk, last));
    };
    const auto draw = [&](int begin) {
        std::unique_ptr<ThreadPainter>& own = painters.local();
        if (!own) own.reset(new ThreadPainter{Painter(timeline, height), nullptr});
        Chunk rasters;
        for (int frame = begin; frame < std::min(begin + chunk, last) && !monitor.stop; ++frame) {
            if (own->painter.draw(frame) || !own->last) own->last = raster_of(own->painter.canvas());
            rasters.push_back(own->last);
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
