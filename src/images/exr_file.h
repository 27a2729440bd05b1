// An OpenEXR file as plain data: its parts with their windows, channels and attributes, and pixels as planes of floats.
// OpenEXR's C library reads it and checks each size in the file against the file's own size, and each chunk against the
// size that its header states. What that library does not decode (DWA, subsampled channels) is read by OpenEXR's C++
// library, after the same checks.
#pragma once

#include <OpenEXR/openexr.h>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "images/open_file.h"
#include "images/primaries.h"

namespace crescent {

struct ExrChannel {
    std::string name;
    bool half = false, whole = false;  // neither: float
    int x_sampling = 1, y_sampling = 1;
    std::size_t bytes() const { return half ? 2 : 4; }
};

struct ExrAttribute {
    std::string name;
    std::optional<double> number;
    std::string text;            // the value of a string
    std::vector<float> numbers;  // the values of a vector of floats
};

struct ExrPart {
    int index = 0;
    std::string name;  // "": none
    bool deep = false, tiled = false;
    exr_compression_t compression = EXR_COMPRESSION_NONE;
    PixelWindow data, display;
    std::vector<ExrChannel> channels;  // in file order
    std::vector<ExrAttribute> attributes;
    std::optional<Chromaticities> primaries;

    const ExrChannel* channel(const std::string& channel_name) const;
};

class ExrFile {
public:
    /// Reads the headers. Throws InputError if they are damaged or contradict the file.
    explicit ExrFile(const OpenFile& file);
    ~ExrFile();
    ExrFile(const ExrFile&) = delete;
    ExrFile& operator=(const ExrFile&) = delete;

    const std::vector<ExrPart>& parts() const { return parts_; }
    /// Returns the named channels of a part in its data window, bottom row first. Throws InputError if the file is too
    /// short to contain them, before it allocates memory, and if a chunk has fewer bytes than the header states.
    std::vector<std::vector<float>> read(const ExrPart& part, const std::vector<std::string>& channels) const;
    /// Returns R, G and B of channels PREFIX + Y, RY and BY (luminance and chroma), by OpenEXR's own reconstruction.
    std::vector<std::vector<float>> read_luminance_chroma(const ExrPart& part, const std::string& layer) const;

private:
    void check(const ExrPart& part) const;
    void read_dwa(
        const ExrPart& part, const std::vector<std::string>& channels, std::vector<std::vector<float>>& out) const;
    void read_chunks(
        const ExrPart& part, const std::vector<std::string>& channels, std::vector<std::vector<float>>& out) const;

    const OpenFile& file_;
    exr_context_t context_ = nullptr;
    std::vector<ExrPart> parts_;
};

// ---- The chunks of a part: blocks of rows, or the tiles of its full resolution.

/// OpenEXR's error handler: stores the message for expect_success() of the same thread.
void keep_message(exr_const_context_t, exr_result_t, const char* message);
/// Throws InputError with OpenEXR's message if the call failed.
void expect_success(const OpenFile& file, exr_result_t result);
/// Removes a stored message of another file.
void clear_message();
/// Throws InputError if a message is stored although the call succeeded: OpenEXR skips some bytes of a broken attribute
/// and continues.
void expect_no_message(const OpenFile& file);

class ExrChunks {
public:
    ExrChunks(const OpenFile& file, exr_const_context_t context, const ExrPart& part);

    /// Throws InputError if the file cannot contain all pixels: a chunk is missing, is beyond the end, overlaps
    /// another, or is smaller than its compression allows. Allocates almost no memory.
    void check() const;
    /// Calls use(window, bytes) for each chunk, decompressed, rows from the top, and in a row the channels one after
    /// another; from many threads at once. Not for DWA.
    void each(const std::function<void(const PixelWindow&, std::span<const char>)>& use) const;
    /// Returns how many of `pixels` pixels from `first` on have a value if every `sampling`th one has.
    static std::size_t samples(int sampling, std::int64_t first, std::int64_t pixels);

private:
    exr_chunk_info_t info(std::int64_t chunk) const;
    PixelWindow window(std::int64_t chunk) const;
    std::uint64_t unpacked_size(const PixelWindow& w) const;

    const OpenFile& file_;
    exr_const_context_t context_;
    const ExrPart& part_;
    std::int64_t width_ = 0, height_ = 0;  // of a chunk that the data window does not cut off
    std::int64_t columns_ = 1, count_ = 0;
};

}  // namespace crescent
