// Pixels of OpenEXR files: chunks to planes.
#include "images/exr_file.h"

#include <Imath/half.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfRgbaFile.h>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fmt/format.h>

#include "base/errors.h"

namespace crescent {

namespace {

using Planes = std::vector<std::vector<float>>;

/// The file as a stream of OpenEXR's C++ library.
class FileStream : public Imf::IStream {
public:
    explicit FileStream(const OpenFile& file) : Imf::IStream(file.path().c_str()), file_(file) {}
    bool read(char to[], int n) override {
        file_.read(position_, {to, static_cast<std::size_t>(std::max(0, n))});
        position_ += static_cast<std::uint64_t>(n);
        return position_ < file_.size();
    }
    std::uint64_t tellg() override { return position_; }
    void seekg(std::uint64_t to) override { position_ = to; }

private:
    const OpenFile& file_;
    std::uint64_t position_ = 0;
};

/// Reads a little-endian number.
template <class T> T number_at(const char* bytes_in) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, bytes_in, sizeof(T));
    if constexpr (std::endian::native == std::endian::big) std::reverse(bytes, bytes + sizeof(T));
    T out;
    std::memcpy(&out, bytes, sizeof out);
    return out;
}

void convert_row(const ExrChannel& channel, const char* from, std::span<float> to) {
    for (std::size_t i = 0; i < to.size(); ++i)
        to[i] = channel.half ? imath_half_to_float(number_at<std::uint16_t>(from + 2 * i))
            : channel.whole  ? static_cast<float>(number_at<std::uint32_t>(from + 4 * i))
                             : number_at<float>(from + 4 * i);
}

/// Copies the rows of one chunk to the planes (null: the channel is not read).
void place_chunk(
    const ExrPart& part, const PixelWindow& w, std::span<const char> bytes, const std::vector<float*>& planes) {
    const char* source = bytes.data();
    for (std::int64_t y = w.y0; y <= w.y1; ++y) {
        const std::int64_t begin = (part.data.y1 - y) * part.data.width() + (w.x0 - part.data.x0);
        for (std::size_t c = 0; c < part.channels.size(); ++c) {
            const ExrChannel& channel = part.channels[c];
            if (y % channel.y_sampling != 0) continue;
            const std::size_t n = ExrChunks::samples(channel.x_sampling, w.x0, w.width());
            if (planes[c]) convert_row(channel, source, {planes[c] + begin, n});
            source += n * channel.bytes();
        }
    }
}

Planes zeros(const ExrPart& part, std::size_t planes) { return Planes(planes, std::vector<float>(part.data.pixels())); }

/// Returns the slice with which OpenEXR's C++ library writes a plane that begins with its bottom row.
Imf::Slice slice_of(const ExrPart& part, std::vector<float>& plane) {
    const auto row = static_cast<std::ptrdiff_t>(sizeof(float)) * static_cast<std::ptrdiff_t>(part.data.width());
    char* base = reinterpret_cast<char*>(plane.data()) + row * static_cast<std::ptrdiff_t>(part.data.y1) -
        static_cast<std::ptrdiff_t>(sizeof(float)) * static_cast<std::ptrdiff_t>(part.data.x0);
    return {Imf::FLOAT, base, sizeof(float), static_cast<std::size_t>(-row)};
}

bool is_dwa(const ExrPart& part) {
    return part.compression == EXR_COMPRESSION_DWAA || part.compression == EXR_COMPRESSION_DWAB;
}

/// Converts exceptions of OpenEXR's C++ library to InputErrors of the file.
template <class Read> void of_file(const OpenFile& file, const Read& read) {
    try {
        read();
    } catch (const InputError&) { throw; } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& e) {
        file.fail(std::string("expected an OpenEXR file that can be read: ") + e.what());
    }
}

}  // namespace

void ExrFile::check(const ExrPart& part) const {
    if (part.deep) file_.fail("expected an image of one colour a pixel: deep images are not supported");
    const ExrChunks chunks(file_, context_, part);
    chunks.check();
}

void ExrFile::read_dwa(const ExrPart& part, const std::vector<std::string>& channels, Planes& out) const {
    of_file(file_, [&] {
        FileStream stream(file_);
        Imf::MultiPartInputFile file(stream, 0, false);
        Imf::InputPart in(file, part.index);
        Imf::FrameBuffer buffer;
        for (std::size_t c = channels.size(); c-- > 0;) buffer.insert(channels[c], slice_of(part, out[c]));
        in.setFrameBuffer(buffer);
        in.readPixels(static_cast<int>(part.data.y0), static_cast<int>(part.data.y1));
    });
}

void ExrFile::read_chunks(const ExrPart& part, const std::vector<std::string>& channels, Planes& out) const {
    std::vector<float*> planes(part.channels.size(), nullptr);
    for (std::size_t k = 0; k < planes.size(); ++k)
        for (std::size_t c = channels.size(); c-- > 0;)
            if (part.channels[k].name == channels[c]) planes[k] = out[c].data();
    ExrChunks(file_, context_, part).each([&](const PixelWindow& w, std::span<const char> bytes) {
        place_chunk(part, w, bytes, planes);
    });
}

Planes ExrFile::read(const ExrPart& part, const std::vector<std::string>& channels) const {
    for (const std::string& name : channels) {
        const ExrChannel* channel = part.channel(name);
        if (channel && (channel->x_sampling != 1 || channel->y_sampling != 1))
            file_.fail(fmt::format("channel '{}': expected one value a pixel, found one in {} x {}", name,
                channel->x_sampling, channel->y_sampling));
    }
    check(part);
    Planes out = zeros(part, channels.size());
    std::vector<std::size_t> first(channels.size());  // a channel that is requested twice is read once and copied
    for (std::size_t c = 0; c < channels.size(); ++c)
        first[c] =
            static_cast<std::size_t>(std::find(channels.begin(), channels.end(), channels[c]) - channels.begin());
    if (is_dwa(part)) read_dwa(part, channels, out);
    else read_chunks(part, channels, out);
    for (std::size_t c = 0; c < channels.size(); ++c)
        if (first[c] != c) out[c] = out[first[c]];
    return out;
}

Planes ExrFile::read_luminance_chroma(const ExrPart& part, const std::string& layer) const {
    for (const char* channel : {"Y", "RY", "BY"})
        if (!part.channel(layer.empty() ? channel : layer + "." + channel))
            file_.fail(fmt::format("expected luminance and chroma in channels Y, RY and BY, found none called '{}{}{}'",
                layer, layer.empty() ? "" : ".", channel));
    if (part.index > 0) file_.fail("luminance and chroma (Y, RY, BY) are read from the first part of a file alone");
    check(part);
    if (!is_dwa(part))  // OpenEXR's C++ library reads missing bytes of a chunk as 0
        ExrChunks(file_, context_, part).each([](const PixelWindow&, std::span<const char>) {});
    Planes out = zeros(part, 3);
    of_file(file_, [&] {
        FileStream stream(file_);
        Imf::RgbaInputFile in(stream, layer, 0);
        const auto width = static_cast<std::size_t>(part.data.width());
        std::vector<Imf::Rgba> row(width);
        in.setFrameBuffer(row.data() - part.data.x0, 1, 0);
        for (std::int64_t y = part.data.y0; y <= part.data.y1; ++y) {
            in.readPixels(static_cast<int>(y));
            const std::size_t to = static_cast<std::size_t>(part.data.y1 - y) * width;
            for (std::size_t i = 0; i < width; ++i) {
                out[0][to + i] = row[i].r;
                out[1][to + i] = row[i].g;
                out[2][to + i] = row[i].b;
            }
        }
    });
    return out;
}

}  // namespace crescent
