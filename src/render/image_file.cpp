// Rows are read into one interleaved array, converted to float by OpenEXR, on this thread.
#include "render/image_file.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "base/errors.h"
#include "base/files.h"
#include "scene/image_pack.h"

namespace crescent::inline render {

namespace {

/// Returns the names of the channels that become r, g and b.
std::array<std::string, 3> channels_of(const Imf::Header& header, const std::string& path) {
    const Imf::ChannelList& channels = header.channels();
    std::array<std::string, 3> names = {"R", "G", "B"};
    if (!channels.findChannel("R") && channels.findChannel("Y")) names = {"Y", "Y", "Y"};
    for (const std::string& name : names) {
        const Imf::Channel* channel = channels.findChannel(name);
        if (!channel)
            throw InputError(
                {path, 0, 0}, fmt::format("expected channels R, G and B, or Y, found no '{}' in the first part", name));
        if (channel->xSampling != 1 || channel->ySampling != 1)
            throw InputError({path, 0, 0}, fmt::format("expected a sample of '{}' for every pixel", name));
    }
    return names;
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

std::shared_ptr<const RgbImage> read_parts(const std::string& path, WhyNot why_not) {
    Imf::MultiPartInputFile file(path.c_str(), 0);
    const Imf::Header& header = file.header(0);
    if (header.hasType() && header.type() != Imf::SCANLINEIMAGE && header.type() != Imf::TILEDIMAGE)
        throw InputError({path, 0, 0}, "expected a flat image, found a deep one");
    const Imath::Box2i window = header.dataWindow();
    const auto [width, height] = size_of(window, path, why_not);
    const std::array<std::string, 3> names = channels_of(header, path);
    std::vector<float> rgb(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    Imf::InputPart part(file, 0);
    constexpr std::size_t pixel = 3 * sizeof(float);
    const std::size_t row = pixel * static_cast<std::size_t>(width);
    char* const origin = reinterpret_cast<char*>(rgb.data()) - static_cast<std::ptrdiff_t>(pixel) * window.min.x -
        static_cast<std::ptrdiff_t>(row) * window.min.y;
    Imf::FrameBuffer buffer;
    const bool grey = names[0] == names[1];
    for (std::size_t c = 0; c < (grey ? 1 : 3); ++c)
        buffer.insert(names[c], Imf::Slice(Imf::FLOAT, origin + c * sizeof(float), pixel, row));
    part.setFrameBuffer(buffer);
    part.readPixels(window.min.y, window.max.y);
    for (std::size_t k = 0; grey && k < rgb.size(); k += 3) rgb[k + 1] = rgb[k + 2] = rgb[k];
    auto out = std::make_shared<RgbImage>();
    out->hash = hash_of(width, height, rgb);
    out->width = width, out->height = height, out->rgb = std::move(rgb);
    return out;
}

std::shared_ptr<const RgbImage> read_pack(const std::string& path, WhyNot why_not) {
    std::shared_ptr<const RgbImage> image = read_image_file(contents_of(path), path);
    if (const std::string why = why_not(image->width, image->height); !why.empty()) throw InputError({path, 0, 0}, why);
    return image;
}

std::shared_ptr<const RgbImage> read(const std::string& path, WhyNot why_not) {
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    if (!file)
        throw InputError(
            {path, 0, 0}, fmt::format("expected an image that can be read: {}", std::strerror(errno ? errno : ENOENT)));
    std::string head(image_header_size, '\0');
    file.read(head.data(), static_cast<std::streamsize>(head.size()));
    if (is_image_file(head)) return read_pack(path, why_not);
    try {
        return read_parts(path, why_not);
    } catch (const InputError&) { throw; } catch (const std::exception& error) {
        throw InputError({path, 0, 0}, fmt::format("expected an OpenEXR image: {}", error.what()));
    }
}

}  // namespace

std::shared_ptr<const RgbImage> read_sky(const std::string& path) { return read(path, why_no_sky_of); }
std::shared_ptr<const RgbImage> read_texture(const std::string& path) { return read(path, why_no_texture_of); }

}  // namespace crescent::inline render
