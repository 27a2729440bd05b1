// Slices point into the film's planes, with a negative stride from the last row to the first, so nothing is copied.
// Nothing is compressed. OpenEXR's number of threads is global to the process and is set under a lock while a file is
// written.
#include "render/exr.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>
#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>

#include "base/errors.h"
#include "base/files.h"
#include "base/parallel.h"
#include "images/exr_file.h"
#include "images/exr_layers.h"
#include "images/open_file.h"
#include "images/primaries.h"
#include "images/stored_image.h"
#include "scene/texture.h"

namespace crescent {

namespace {

struct Channel {
    const char* name;
    Imf::PixelType type;
    const void* plane;
};

std::vector<Channel> channels_of(const Film& f) {
    return {{"R", Imf::FLOAT, f.r.data()}, {"G", Imf::FLOAT, f.g.data()}, {"B", Imf::FLOAT, f.b.data()},
        {"luminance.Y", Imf::FLOAT, f.y.data()}, {"second_moment.Y", Imf::FLOAT, f.second_moment.data()},
        {"variance.Y", Imf::FLOAT, f.var.data()}, {"largest.Y", Imf::FLOAT, f.largest.data()},
        {"horizon.Y", Imf::UINT, f.horizon.data()}, {"hits.Y", Imf::UINT, f.light_hits.data()}};
}

std::vector<Channel> channels_of(const ReferenceFilm& f) {
    return {{"R", Imf::FLOAT, f.r.data()}, {"G", Imf::FLOAT, f.g.data()}, {"B", Imf::FLOAT, f.b.data()},
        {"luminance.Y", Imf::FLOAT, f.y.data()}, {"error.Y", Imf::FLOAT, f.error.data()}};
}

template <class AnyFilm>
Imf::Header header_of(const std::string& name, const AnyFilm& film, const Attributes& attributes) {
    Imf::Header header(film.width, film.height);
    header.compression() = Imf::NO_COMPRESSION;  // noise is hardly compressible
    header.setName(name);
    header.setType(Imf::SCANLINEIMAGE);
    for (const Channel& c : channels_of(film)) header.channels().insert(c.name, Imf::Channel(c.type));
    for (const auto& [key, text] : attributes) header.insert(key, Imf::StringAttribute(text));
    return header;
}

/// Films are stored bottom-up and the file top-down, so the last row comes first and strides are negative.
template <class AnyFilm> Imf::FrameBuffer frame_buffer(const AnyFilm& film) {
    Imf::FrameBuffer buffer;
    const auto row = static_cast<std::ptrdiff_t>(film.width) * 4;
    for (const Channel& c : channels_of(film)) {
        char* top = static_cast<char*>(const_cast<void*>(c.plane)) + row * (film.height - 1);
        buffer.insert(c.name, Imf::Slice(c.type, top, 4, static_cast<std::size_t>(-row)));
    }
    return buffer;
}

/// OpenEXR reads and writes on its own threads, one set per process. Sets their number to that of on_threads() while
/// one file is written, then restores it.
class ExrThreads {
public:
    ExrThreads() : guard_(lock()), old_count_(Imf::globalThreadCount()) {
        Imf::setGlobalThreadCount(threads_here() > 1 ? threads_here() : 0);  // 0: this thread alone
    }
    ~ExrThreads() { Imf::setGlobalThreadCount(old_count_); }
    ExrThreads(const ExrThreads&) = delete;
    ExrThreads& operator=(const ExrThreads&) = delete;

private:
    static Mutex& lock() {
        static Mutex mutex;
        return mutex;
    }
    Guard guard_;
    int old_count_;
};

template <class AnyFilm> void write_parts(const std::string& path,
    const std::vector<std::pair<std::string, const AnyFilm*>>& parts, const Attributes& attributes) {
    const ExrThreads threads;
    std::vector<Imf::Header> headers;
    for (const auto& [name, film] : parts) headers.push_back(header_of(name, *film, attributes));
    try {
        Imf::MultiPartOutputFile file(path.c_str(), headers.data(), static_cast<int>(headers.size()));
        for (std::size_t k = 0; k < parts.size(); ++k) {
            Imf::OutputPart part(file, static_cast<int>(k));
            part.setFrameBuffer(frame_buffer(*parts[k].second));
            part.writePixels(parts[k].second->height);
        }
    } catch (const std::exception& error) { throw OutputError("cannot write " + path + ": " + error.what()); }
}

}  // namespace

void write_exr(const std::string& path, const std::vector<std::pair<std::string, const Film*>>& parts,
    const Attributes& attributes) {
    write_parts(path, parts, attributes);
}

void write_exr(const std::string& path, const std::vector<std::pair<std::string, const ReferenceFilm*>>& parts,
    const Attributes& attributes) {
    write_parts(path, parts, attributes);
}

void write_texture(const std::string& path, const RgbImage& image) {
    std::vector<half> texels(image.size());
    bool is_grey = true;
    for (std::size_t k = 0; k < texels.size(); ++k) {
        texels[k] = half(image[k]);
        is_grey = is_grey && image[k] == image[k - k % 3];
    }
    const ExrThreads threads;
    Imf::Header header(image.width, image.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    constexpr std::size_t pixel = 3 * sizeof(half);
    Imf::FrameBuffer buffer;
    const std::vector<const char*> names = is_grey ? std::vector{"Y"} : std::vector{"R", "G", "B"};
    for (std::size_t c = 0; c < names.size(); ++c) {
        header.channels().insert(names[c], Imf::Channel(Imf::HALF));
        buffer.insert(names[c],
            Imf::Slice(Imf::HALF, reinterpret_cast<char*>(texels.data() + c), pixel,
                pixel * static_cast<std::size_t>(image.width)));
    }
    try {
        Imf::OutputFile file(path.c_str(), header);
        file.setFrameBuffer(buffer);
        file.writePixels(image.height);
    } catch (const std::exception& error) { throw OutputError("cannot write " + path + ": " + error.what()); }
}

// ---- Blocks of rows are read into one interleaved array that grows with them, converted to float by OpenEXR, on this
// thread: a header that states more pixels than its file has takes no memory for them.

namespace {

/// Where the pixels of an image are in a file: a part, and the channels that become r, g and b.
struct ImageChannels {
    int part = 0;
    std::array<std::string, 3> names;
    bool half = false;  // all of them
};

ImageChannels channels_in(const ExrPart& part, const std::string& path, const std::array<std::string, 3>& names) {
    bool half = true;
    for (const std::string& name : names) {
        const ExrChannel* channel = part.channel(name);
        if (!channel) throw InputError({path, 0, 0}, fmt::format("expected a channel '{}', found none", name));
        if (channel->x_sampling != 1 || channel->y_sampling != 1)
            throw InputError({path, 0, 0}, fmt::format("expected a sample of '{}' for every pixel", name));
        half = half && channel->half;
    }
    return {part.index, names, half};
}

/// The channels of a layer, or, if none is named, R, G and B or Y of the first part.
ImageChannels channels_of(const std::string& path, const std::string& layer) {
    const OpenFile file(path);
    const ExrFile exr(file);
    if (!layer.empty()) {
        const ExrLayer match = chosen_layer(exr, path, layer);
        const ExrPart& part = exr.parts()[static_cast<std::size_t>(match.part)];
        const std::vector<std::string>& names = match.channels;
        if (match.kind == ExrLayer::Kind::grey) return channels_in(part, path, {names[0], names[0], names[0]});
        if (match.kind == ExrLayer::Kind::rgb) return channels_in(part, path, {names[0], names[1], names[2]});
        throw LayerError({path, 0, 0},
            fmt::format(
                "expected a layer of R, G and B, or Y, found '{}' of {}", layer, fmt::join(match.channels, ", ")));
    }
    const ExrPart& part = exr.parts().front();
    if (!part.channel("R") && part.channel("Y")) return channels_in(part, path, {"Y", "Y", "Y"});
    for (const char* name : {"R", "G", "B"}) {
        if (part.channel(name)) continue;
        const std::string layers = layers_found(exr);
        throw InputError({path, 0, 0},
            fmt::format("expected channels R, G and B, or Y, found no '{}' in the first part{}", name,
                layers.empty() ? "" : "; a layer can be named: " + layers));
    }
    return channels_in(part, path, {"R", "G", "B"});
}

/// Returns what an image of this size is not; "" if it may be read.
using WhyNot = std::string (*)(std::int64_t width, std::int64_t height);

/// The size from the header, before anything else is read.
std::array<int, 2> size_of(const Imath::Box2i& window, const std::string& path, WhyNot why_not) {
    const auto side = [](int low, int high) { return std::int64_t{high} - low + 1; };
    const std::int64_t width = side(window.min.x, window.max.x), height = side(window.min.y, window.max.y);
    if (const std::string why = why_not(width, height); !why.empty()) throw InputError({path, 0, 0}, why);
    return {static_cast<int>(width), static_cast<int>(height)};
}

/// Reads all rows as numbers of this type.
template <class Number> void read_rows(Imf::InputPart& part, const Imath::Box2i& window,
    const std::array<std::string, 3>& names, Imf::PixelType type, std::vector<Number>& rgb) {
    constexpr int rows = 256;  // the largest block of an OpenEXR file: DWAB
    constexpr std::size_t pixel = 3 * sizeof(Number);
    const auto width = static_cast<std::size_t>(window.max.x - window.min.x + 1);
    const std::size_t row = pixel * width;
    const bool grey = names[0] == names[1];
    for (int first = window.min.y; first <= window.max.y; first += rows) {
        const int last = std::min(first + rows - 1, window.max.y);
        rgb.resize(3 * width * static_cast<std::size_t>(last - window.min.y + 1));
        char* const origin = reinterpret_cast<char*>(rgb.data()) - static_cast<std::ptrdiff_t>(pixel) * window.min.x -
            static_cast<std::ptrdiff_t>(row) * window.min.y;
        Imf::FrameBuffer buffer;
        for (std::size_t c = 0; c < (grey ? 1 : 3); ++c)
            buffer.insert(names[c], Imf::Slice(type, origin + c * sizeof(Number), pixel, row));
        part.setFrameBuffer(buffer);
        part.readPixels(first, last);
    }
    for (std::size_t k = 0; grey && k < rgb.size(); k += 3) rgb[k + 1] = rgb[k + 2] = rgb[k];
}

/// Converts texels with other primaries, in single precision.
void to_rec709(RgbImage& image, const Imf::Chromaticities& stated, const std::string& path) {
    const auto xy = [](const Imath::V2f& v) { return std::array{double(v.x), double(v.y)}; };
    const Chromaticities from{xy(stated.red), xy(stated.green), xy(stated.blue), xy(stated.white)}, rec709;
    if (same_primaries(from, rec709)) return;
    if (!is_valid(from))
        throw InputError({path, 0, 0}, fmt::format("expected chromaticities of colours, found {}", to_string(from)));
    const Matrix3 matrix = conversion(from, rec709);
    std::vector<float> rgb(image.size());
    for (std::size_t k = 0; k < rgb.size(); k += 3) {
        const Rgb converted = transformed(matrix, {double(image[k]), double(image[k + 1]), double(image[k + 2])});
        for (std::size_t c = 0; c < 3; ++c) rgb[k + c] = static_cast<float>(converted[c]);
    }
    image.halves = {};
    image.rgb = std::move(rgb);
}

std::shared_ptr<const RgbImage> read_parts(const std::string& path, const std::string& layer, WhyNot why_not) {
    const auto [index, names, half] = channels_of(path, layer);  // checks the sizes in the headers, too
    Imf::MultiPartInputFile file(path.c_str(), 0);
    const Imf::Header& header = file.header(index);
    if (header.hasType() && header.type() != Imf::SCANLINEIMAGE && header.type() != Imf::TILEDIMAGE)
        throw InputError({path, 0, 0}, "expected a flat image, found a deep one");
    const Imath::Box2i window = header.dataWindow(), display = header.displayWindow();
    if (window != display && display.intersects(window.min) && display.intersects(window.max))
        throw InputError({path, 0, 0},
            fmt::format(
                "expected the whole picture, found a part of it: the pixels ({}, {}) to ({}, {}) of ({}, {}) to "
                "({}, {})",
                window.min.x, window.min.y, window.max.x, window.max.y, display.min.x, display.min.y, display.max.x,
                display.max.y));
    const auto [width, height] = size_of(window, path, why_not);
    Imf::InputPart part(file, index);
    auto out = std::make_shared<RgbImage>();
    out->width = width;
    out->height = height;
    if (half) read_rows(part, window, names, Imf::HALF, out->halves);
    else read_rows(part, window, names, Imf::FLOAT, out->rgb);
    if (Imf::hasChromaticities(header)) to_rec709(*out, Imf::chromaticities(header), path);
    out->hash = hash_of_texels(*out);
    return out;
}

/// Whether the primaries of a header are those of Rec.709, or Radiance's own, which its programs write for them.
bool are_near_rec709(const std::array<double, 8>& primaries) {
    constexpr std::array rec709 = {0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290};
    constexpr double distance = 0.021;  // Radiance has the white point (1/3, 1/3)
    return std::ranges::equal(primaries, rec709, [](double a, double b) { return std::fabs(a - b) < distance; });
}

std::shared_ptr<const RgbImage> read_hdr(const std::string& path, WhyNot why_not) {
    const OpenFile file(path);
    const HdrHeader header = hdr_header(file, [](const std::array<double, 8>&) { return true; });
    if (header.primaries && !are_near_rec709(*header.primaries))
        file.fail("expected colours in Rec.709, found other PRIMARIES in the header");
    if (const std::string why = why_not(header.width, header.height); !why.empty()) file.fail(why);
    const StoredImage image = decoded(file);
    const ImageHead& head = image.head;
    auto out = std::make_shared<RgbImage>();
    out->width = static_cast<int>(head.width);
    out->height = static_cast<int>(head.height);
    out->rgb.resize(3 * out->texels());
    for (std::size_t k = 0; k < out->rgb.size(); ++k) {
        const std::size_t channel = head.channels < 3 ? 0 : k % 3;
        out->rgb[k] = static_cast<float>(image.sample(k / 3 * head.channels + channel) * header.unit[k % 3]);
    }
    out->hash = hash_of_texels(*out);
    return out;
}

std::shared_ptr<const RgbImage> read_pack(const std::string& path, std::string_view head, WhyNot why_not) {
    std::error_code error;
    (void)read_image_size(head, std::filesystem::file_size(path, error), path);  // before its memory is taken
    std::shared_ptr<const RgbImage> image = read_image_file(contents_of(path), path);
    if (const std::string why = why_not(image->width, image->height); !why.empty()) throw InputError({path, 0, 0}, why);
    return image;
}

std::shared_ptr<const RgbImage> read(const std::string& path, const std::string& layer, WhyNot why_not) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
        throw InputError({path, 0, 0}, "expected a regular file");
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    if (!file)
        throw InputError(
            {path, 0, 0}, fmt::format("expected an image that can be read: {}", std::strerror(errno ? errno : ENOENT)));
    std::string head(image_header_size, '\0');
    file.read(head.data(), static_cast<std::streamsize>(head.size()));
    if (!layer.empty() && (is_image_file(head) || head.starts_with("#?")))
        throw LayerError({path, 0, 0}, fmt::format("expected an OpenEXR image, which can have a layer '{}'", layer));
    if (is_image_file(head)) return read_pack(path, head, why_not);
    if (head.starts_with("#?")) return read_hdr(path, why_not);
    try {
        return read_parts(path, layer, why_not);
    } catch (const InputError&) { throw; } catch (const std::exception& why) {
        throw InputError({path, 0, 0}, fmt::format("expected an OpenEXR image: {}", why.what()));
    }
}

}  // namespace

std::shared_ptr<const RgbImage> read_sky(const std::string& path, const std::string& layer) {
    return read(path, layer, why_no_sky_of);
}
std::shared_ptr<const RgbImage> read_texture(const std::string& path, const std::string& layer) {
    return read(path, layer, why_no_texture_of);
}

}  // namespace crescent
