// Pixels of OpenEXR files: chunks to planes.
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
#include "compare/exr_layers.h"
#include "compare/exr_file.h"

namespace crescent {

namespace {

using Planes = std::vector<std::vector<float>>;

/// The file as a stream of OpenEXR's C++ library.
class FileStream : public Imf::IStream {
public:
    explicit FileStream(const OpenFile& file) : Imf::IStream(file.path().c_str()), file_(file) {}
    bool read(char to[], int n) override {
        file_.read(at_, {to, static_cast<std::size_t>(std::max(0, n))});
        at_ += static_cast<std::uint64_t>(n);
        return at_ < file_.size();
    }
    std::uint64_t tellg() override { return at_; }
    void seekg(std::uint64_t to) override { at_ = to; }

private:
    const OpenFile& file_;
    std::uint64_t at_ = 0;
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

// ---- OpenEXR as renderers write it: scanlines or tiles, half or float, one part or many, layers with dotted names,
// luminance and chroma, XYZ. Deep parts and data other than radiance (Cryptomatte, normals, depth, ...) are skipped.

namespace {

void set_primaries(Render& out, const ExrPart& part) {
    if (!part.primaries) return;
    out.primaries = *part.primaries;
    out.weights = luminance_weights_of(*part.primaries);
}

/// Returns the render without pixels, with the attributes of the part.
Render render_of(const ExrPart& part, const OpenFile& file, const ExrLayer& layer) {
    Render out(file.path(), static_cast<int>(part.data.width()), static_cast<int>(part.data.height()), Render::empty);
    out.layer = layer.name;
    out.data = part.data;
    out.display = part.display;
    out.spp =
        exr_attribute(file.path(), part, "samples a pixel", {"spp", "samples", "samplesperpixel", "samplecount", "n"});
    out.seconds = exr_attribute(file.path(), part, "seconds", {"rendertime", "seconds", "time", "rendertimes"});
    const bool half = layer.kind == ExrLayer::Kind::luminance_chroma || part.channel(layer.channels[0])->half;
    if (half) out.rounding = 0x1p-11;
    return out;
}

}  // namespace

Render read_exr(const OpenFile& file, const std::string& wanted, const ReadingOptions& options) {
    const ExrFile exr(file);
    const ExrLayer layer = options.channel.empty() ? chosen_layer(exr, file.path(), wanted)
                                                   : layer_of_channel(exr, file.path(), options.channel);
    const ExrPart& part = exr.parts()[static_cast<std::size_t>(layer.part)];
    Render out = render_of(part, file, layer);
    set_primaries(out, part);
    const ExrExtra extra = options.channel.empty() ? exr_extra(part) : ExrExtra{};
    if (options.channels == TestedChannels::rgba && options.channel.empty()) {
        const std::string alpha = alpha_of(part, layer);
        if (alpha.empty()) file.fail("channels = \"rgba\": expected an alpha channel, found none");
        out.alpha = std::move(exr.read(part, {alpha})[0]);
    }
    std::vector<std::string> channels;
    if (layer.kind == ExrLayer::Kind::luminance_chroma) {
        auto rgb = exr.read_luminance_chroma(part, layer.prefix);
        out.r = std::move(rgb[0]);
        out.g = std::move(rgb[1]);
        out.b = std::move(rgb[2]);
    } else {
        channels = layer.channels;
    }
    const std::size_t colours = channels.size();
    channels.insert(channels.end(), extra.spread.begin(), extra.spread.end());
    if (!extra.samples.empty()) channels.push_back(extra.samples);
    if (channels.empty()) return out;
    std::vector<std::vector<float>> planes = exr.read(part, channels);
    std::vector<float> samples;
    if (!extra.samples.empty()) {
        samples = std::move(planes.back());
        planes.pop_back();
    }
    std::vector<float>* to[] = {&out.r, &out.g, &out.b};
    for (std::size_t c = 0; c < colours; ++c) *to[c] = std::move(planes[c]);
    planes.erase(planes.begin(), planes.begin() + static_cast<std::ptrdiff_t>(colours));
    if (colours == 1) out.g = out.b = out.r;
    if (layer.kind == ExrLayer::Kind::xyz) from_xyz(out);
    set_variance(out, extra, planes);
    if (!extra.samples.empty()) set_samples(out, extra, samples);
    return out;
}

// ---- SMPTE RP 177 (primaries to XYZ); Lindbloom, "Chromatic Adaptation" (Bradford's matrix).

namespace {

using Xy = std::array<double, 2>;

/// Returns x, y and z of a chromaticity.
Rgb xyz_of(const Xy& c) { return {c[0], c[1], 1 - c[0] - c[1]}; }

Matrix3 product(const Matrix3& a, const Matrix3& b) {
    Matrix3 out{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            for (std::size_t k = 0; k < 3; ++k) out[i][j] += a[i][k] * b[k][j];
    return out;
}

/// Inverts by cofactors.
Matrix3 inverse(const Matrix3& m) {
    Matrix3 out;
    const auto minor = [&](std::size_t i, std::size_t j) {
        const std::size_t i0 = (i + 1) % 3, i1 = (i + 2) % 3, j0 = (j + 1) % 3, j1 = (j + 2) % 3;
        return m[i0][j0] * m[i1][j1] - m[i0][j1] * m[i1][j0];
    };
    const double determinant = m[0][0] * minor(0, 0) + m[0][1] * minor(0, 1) + m[0][2] * minor(0, 2);
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) out[j][i] = minor(i, j) / determinant;
    return out;
}

/// Returns a matrix with a column per primary: its x, y and z times its amount.
Matrix3 columns(const Chromaticities& c, const Rgb& amounts) {
    const Rgb primary[3] = {xyz_of(c.red), xyz_of(c.green), xyz_of(c.blue)};
    Matrix3 out;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) out[i][j] = primary[j][i] * amounts[j];
    return out;
}

/// Returns the matrix that maps one white to the other, by scaling Bradford's cone responses.
Matrix3 adaptation(const Rgb& from, const Rgb& to) {
    constexpr Matrix3 bradford{{{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}};
    const Rgb a = transformed(bradford, from), b = transformed(bradford, to);
    Matrix3 scale{};
    for (std::size_t i = 0; i < 3; ++i) scale[i][i] = b[i] / a[i];
    return product(inverse(bradford), product(scale, bradford));
}

bool near(const Xy& a, const Xy& b) { return std::fabs(a[0] - b[0]) <= 1e-3 && std::fabs(a[1] - b[1]) <= 1e-3; }

/// The primaries of OpenEXR files with XYZ in channels R, G and B; their "white" is not the white of a scene.
constexpr Chromaticities xyz_primaries{.red = {1, 0}, .green = {0, 1}, .blue = {0, 0}, .white = {1. / 3, 1. / 3}};

}  // namespace

bool is_valid(const Chromaticities& c) {
    for (const Xy& p : {c.red, c.green, c.blue, c.white})
        if (!(std::fabs(p[0]) <= 10 && std::fabs(p[1]) <= 10)) return false;
    const double area =
        (c.green[0] - c.red[0]) * (c.blue[1] - c.red[1]) - (c.blue[0] - c.red[0]) * (c.green[1] - c.red[1]);
    return c.white[1] > 1e-3 && std::fabs(area) > 1e-4;
}

bool same_primaries(const Chromaticities& a, const Chromaticities& b) {
    return near(a.red, b.red) && near(a.green, b.green) && near(a.blue, b.blue) && near(a.white, b.white);
}

std::string to_string(const Chromaticities& c) {
    if (same_primaries(c, {})) return "Rec.709";
    return fmt::format("R {:.4g} {:.4g}, G {:.4g} {:.4g}, B {:.4g} {:.4g}, white {:.4g} {:.4g}", c.red[0], c.red[1],
        c.green[0], c.green[1], c.blue[0], c.blue[1], c.white[0], c.white[1]);
}

Rgb transformed(const Matrix3& m, const Rgb& v) {
    Rgb out{};
    for (std::size_t i = 0; i < 3; ++i) out[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
    return out;
}

Matrix3 rgb_to_xyz(const Chromaticities& c) {
    if (same_primaries(c, {}))
        return columns(
            c, {luminance_weights[0] / c.red[1], luminance_weights[1] / c.green[1], luminance_weights[2] / c.blue[1]});
    Rgb white = xyz_of(c.white);
    for (double& x : white) x /= c.white[1];
    return columns(c, transformed(inverse(columns(c, {1, 1, 1})), white));
}

Rgb luminance_weights_of(const Chromaticities& c) {
    if (same_primaries(c, {})) return {luminance_weights[0], luminance_weights[1], luminance_weights[2]};
    return rgb_to_xyz(c)[1];
}

Matrix3 xyz_to_rgb(const Chromaticities& c) { return inverse(rgb_to_xyz(c)); }

Matrix3 conversion(const Chromaticities& from, const Chromaticities& to) {
    const Matrix3 a = rgb_to_xyz(from), b = rgb_to_xyz(to);
    if (same_primaries(from, xyz_primaries) || same_primaries(to, xyz_primaries)) return product(inverse(b), a);
    const Rgb white{1, 1, 1};
    return product(inverse(b), product(adaptation(transformed(a, white), transformed(b, white)), a));
}

}  // namespace crescent
