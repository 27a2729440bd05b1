// Chunk by chunk: OpenEXR's table of offsets, what each chunk must hold at least, and what it holds.
#include "compare/exr_chunks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace crescent::inline comparing {

namespace {

thread_local std::string said;

/// The most that a byte of a chunk can hold. RLE: two bytes are 128. zlib: 1032 (its authors' bound); PXR24 leaves out
/// a byte of four before it. PIZ: a run of 255 half words is no shorter than 9 bits. B44: three bytes are 32. DWA: a
/// block of 64 pixels is at least one half word, which zlib packs.
double most_per_byte(exr_compression_t compression) {
    switch (compression) {
        case EXR_COMPRESSION_NONE: return 1;
        case EXR_COMPRESSION_RLE: return 64;
        case EXR_COMPRESSION_ZIPS:
        case EXR_COMPRESSION_ZIP: return 1032;
        case EXR_COMPRESSION_PXR24: return 1376;
        case EXR_COMPRESSION_PIZ: return 512;
        case EXR_COMPRESSION_B44:
        case EXR_COMPRESSION_B44A: return 11;
        default: return 64 * 1032;
    }
}

/// A tile of so many pixels may be larger than the picture: 1024 x 1024.
constexpr std::size_t large_tile = std::size_t{1} << 20;

std::int64_t in_steps(std::int64_t size, std::int64_t step) { return (size + step - 1) / step; }

/// A decoder that is destroyed with its buffers.
struct Decoder {
    exr_const_context_t context;
    exr_decode_pipeline_t pipeline{};
    ~Decoder() { exr_decoding_destroy(context, &pipeline); }
};

}  // namespace

void keep_message(exr_const_context_t, exr_result_t, const char* message) { said = message ? message : ""; }

void forget_messages() { said.clear(); }

void expect_success(const OpenFile& file, exr_result_t result) {
    if (result == EXR_ERR_SUCCESS) return;
    if (said.empty()) said = exr_get_default_error_message(result);
    expect_silence(file);
}

void expect_silence(const OpenFile& file) {
    if (said.empty()) return;
    const std::string why = std::move(said);
    said.clear();
    file.fail("expected an OpenEXR file that can be read: " + why);
}

ExrChunks::ExrChunks(const OpenFile& file, exr_const_context_t context, const ExrPart& part)
    : file_(file), context_(context), part_(part) {
    std::uint32_t w = static_cast<std::uint32_t>(part.data.width()), h = 0;
    std::int32_t rows = 0;
    exr_tile_level_mode_t levels{};
    exr_tile_round_mode_t rounding{};
    if (part.tiled) expect_success(file, exr_get_tile_descriptor(context, part.index, &w, &h, &levels, &rounding));
    else
        expect_success(file, exr_get_scanlines_per_chunk(context, part.index, &rows)),
            h = static_cast<std::uint32_t>(std::max(0, rows));
    const PixelWindow chunk{0, 0, std::int64_t{w} - 1, std::int64_t{h} - 1};
    const bool side = !chunk.empty() && w <= most_pixels_a_side && h <= most_pixels_a_side;
    if (!side || (part.tiled && chunk.pixels() > std::max(large_tile, 4 * part.data.pixels())))
        file.fail(fmt::format("attribute 'tiles': expected tiles that fit {} x {} pixels, found {} x {}",
            part.data.width(), part.data.height(), w, h));
    width_ = w, height_ = h;
    across_ = in_steps(part.data.width(), w), count_ = across_ * in_steps(part.data.height(), h);
}

exr_chunk_info_t ExrChunks::info(std::int64_t chunk) const {
    exr_chunk_info_t out{};
    expect_success(file_,
        part_.tiled ? exr_read_tile_chunk_info(context_, part_.index, static_cast<int>(chunk % across_),
                          static_cast<int>(chunk / across_), 0, 0, &out)
                    : exr_read_scanline_chunk_info(
                          context_, part_.index, static_cast<int>(part_.data.y0 + chunk * height_), &out));
    return out;
}

PixelWindow ExrChunks::window(std::int64_t chunk) const {
    const std::int64_t x = part_.data.x0 + chunk % across_ * width_, y = part_.data.y0 + chunk / across_ * height_;
    return intersection(part_.data, {x, y, x + width_ - 1, y + height_ - 1});
}

std::size_t ExrChunks::samples(int sampling, std::int64_t first, std::int64_t pixels) {
    const auto below = [&](std::int64_t x) {
        return static_cast<std::int64_t>(std::ceil(static_cast<double>(x) / sampling));
    };
    return static_cast<std::size_t>(below(first + pixels) - below(first));
}

std::uint64_t ExrChunks::unpacked_size(const PixelWindow& w) const {
    std::uint64_t bytes = 0;
    for (const ExrChannel& c : part_.channels)
        bytes += samples(c.x_sampling, w.x0, w.width()) * samples(c.y_sampling, w.y0, w.height()) * c.bytes();
    return bytes;
}

void ExrChunks::check() const {
    std::uint64_t packed = 0;
    const double most = most_per_byte(part_.compression);
    for (std::int64_t k = 0; k < count_; ++k) {
        const exr_chunk_info_t chunk = info(k);
        const PixelWindow w = window(k);
        const std::uint64_t unpacked = unpacked_size(w);
        packed += chunk.packed_size;
        const bool flat = part_.compression == EXR_COMPRESSION_NONE;
        if (flat ? chunk.packed_size != unpacked
                 : static_cast<double>(chunk.packed_size) * most < static_cast<double>(unpacked))
            file_.fail(
                fmt::format("block {} of {} at byte {}: expected {}{} bytes for {} x {} pixels of {} channels, "
                            "found {}",
                    k + 1, count_, chunk.data_offset, flat ? "" : "at least ",
                    flat ? unpacked : static_cast<std::uint64_t>(std::ceil(static_cast<double>(unpacked) / most)),
                    w.width(), w.height(), part_.channels.size(), chunk.packed_size));
    }
    if (packed > file_.size())
        file_.fail(fmt::format("blocks overlap: they have {} bytes, the file {}", packed, file_.size()));
}

void ExrChunks::each(const std::function<void(const PixelWindow&, std::span<const char>)>& use) const {
    parallel_for(std::int64_t{0}, count_, [&](std::int64_t k) {
        const exr_chunk_info_t chunk = info(k);
        const std::uint64_t size = unpacked_size(window(k));
        if (chunk.packed_size == size) {  // as it is: what its compression would not have made smaller
            std::vector<char> bytes(size);
            expect_success(file_, exr_read_chunk(context_, part_.index, &chunk, bytes.data()));
            return use(window(k), bytes);
        }
        if (size != chunk.unpacked_size)
            file_.fail(fmt::format(
                "block {} of {}: expected {} bytes of pixels, found {}", k + 1, count_, size, chunk.unpacked_size));
        Decoder decoder{context_};
        exr_decode_pipeline_t& p = decoder.pipeline;
        expect_success(file_, exr_decoding_initialize(context_, part_.index, &chunk, &p));
        expect_success(file_, exr_decoding_choose_default_routines(context_, part_.index, &p));
        p.unpack_and_convert_fn = nullptr;  // 3.1's writes through the null pointers of channels that are not wanted
        expect_success(file_, exr_decoding_run(context_, part_.index, &p));
        use(window(k), {static_cast<const char*>(p.unpacked_buffer), static_cast<std::size_t>(size)});
    });
}

}  // namespace crescent::inline comparing
