// An OpenEXR file as plain data: its parts with their windows, channels and attributes, and pixels as planes of floats.
// Read through OpenEXR's C library, which holds every size in the file against the file's own, and every chunk against
// the size that its header promises. What that library does not decode (DWA, subsampled channels) its C++ library does,
// after the same checks.
#pragma once

#include <OpenEXR/openexr.h>

#include <optional>
#include <string>
#include <vector>

#include "compare/open_file.h"
#include "compare/pixel_window.h"
#include "compare/primaries.h"

namespace crescent::inline comparing {

struct ExrChannel {
    std::string name;
    bool half = false, whole = false;  // else float
    int x_sampling = 1, y_sampling = 1;
    std::size_t bytes() const { return half ? 2 : 4; }
};

struct ExrAttribute {
    std::string name;
    std::optional<double> number;
    std::string text;  // of a string
};

struct ExrPart {
    int index = 0;
    std::string name;  // "": none
    bool deep = false, tiled = false;
    exr_compression_t compression = EXR_COMPRESSION_NONE;
    PixelWindow data, display;
    std::vector<ExrChannel> channels;  // in the order of the file
    std::vector<ExrAttribute> attributes;
    std::optional<Chromaticities> primaries;

    const ExrChannel* channel(const std::string& wanted) const;
    bool subsampled() const;
};

class ExrFile {
public:
    /// Reads the headers. Throws InputError where they cannot be those of this file.
    explicit ExrFile(const OpenFile& file);
    ~ExrFile();
    ExrFile(const ExrFile&) = delete;
    ExrFile& operator=(const ExrFile&) = delete;

    const std::vector<ExrPart>& parts() const { return parts_; }
    /// The named channels of a part in its data window, bottom row first. Throws InputError, before it takes memory for
    /// them, where the file is too short to hold them, and where a chunk holds less than the header says.
    std::vector<std::vector<float>> read(const ExrPart& part, const std::vector<std::string>& channels) const;
    /// R, G and B of channels PREFIX + Y, RY and BY (luminance and chroma), by OpenEXR's own reconstruction.
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

}  // namespace crescent::inline comparing
