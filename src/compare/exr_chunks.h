// The chunks of a part: blocks of rows, or the tiles of its full resolution.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "compare/exr_file.h"

namespace crescent::inline comparing {

/// OpenEXR's handler of errors: keeps what was said for expect_success() of the same thread.
void keep_message(exr_const_context_t, exr_result_t, const char* message);
/// Throws InputError, with what OpenEXR said, where it is no success.
void expect_success(const OpenFile& file, exr_result_t result);
/// Drops what was said before, of another file.
void forget_messages();
/// Throws it too where something was said all the same: of a broken attribute OpenEXR skips some bytes and reads on.
void expect_silence(const OpenFile& file);

class ExrChunks {
public:
    ExrChunks(const OpenFile& file, exr_const_context_t context, const ExrPart& part);

    /// Throws InputError where the file cannot hold all pixels: a chunk that is missing, lies beyond the end or in
    /// another, or is smaller than its compression can make it. Takes no memory to speak of.
    void check() const;
    /// Calls use(window, bytes) for each chunk, decompressed, rows from the top and channels one after another in a
    /// row; at the same time on many threads. Not for DWA.
    void each(const std::function<void(const PixelWindow&, std::span<const char>)>& use) const;
    /// How many of so many pixels, from the first on, have a value where every `sampling`th has one.
    static std::size_t samples(int sampling, std::int64_t first, std::int64_t pixels);

private:
    exr_chunk_info_t info(std::int64_t chunk) const;
    PixelWindow window(std::int64_t chunk) const;
    std::uint64_t unpacked_size(const PixelWindow& w) const;

    const OpenFile& file_;
    exr_const_context_t context_;
    const ExrPart& part_;
    std::int64_t width_ = 0, height_ = 0;  // of a chunk that is not cut off by the data window
    std::int64_t across_ = 1, count_ = 0;
};

}  // namespace crescent::inline comparing
