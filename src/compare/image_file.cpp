// PNG by libpng, the other formats by stb_image in a child process, see images/stored_image.h.
#include "compare/image_file.h"

#include <png.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <csetjmp>
#include <cstdint>
#include <cstring>
#include <fmt/format.h>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "base/errors.h"
#include "base/text.h"
#include "images/stored_image.h"
#include "compare/renders.h"
#include "math/functions.h"
#include "output/tone_map.h"

namespace crescent {

namespace {

// ---- PNG.

/// One reading of a PNG file. libpng reports errors by longjmp(), so what it fills is kept here, outside of the calls
/// between setjmp() and longjmp().
class PngReader {
public:
    explicit PngReader(const OpenFile& file) : file_(file) {
        png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, fail, ignore);
        if (png_) info_ = png_create_info_struct(png_);
        if (!info_) throw std::bad_alloc();
    }
    ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;

    StoredImage read() {
        if (!begin()) refuse();
        ImageHead& head = image_.head;
        head.width = png_get_image_width(png_, info_);
        head.height = png_get_image_height(png_, info_);
        head.channels = png_get_channels(png_, info_);
        head.bytes = png_get_bit_depth(png_, info_) == 16 ? 2 : 1;
        const std::size_t row = std::size_t{head.width} * head.channels * head.bytes;
        // Deflate writes at least 1 byte for 1032 (zlib's documentation, "Maximum Compression Factor"), 1 to 8 bits of
        // a pixel may be one byte here.
        constexpr std::uint64_t most_over_file = 1032 * 8 * 4;
        if (row * head.height / most_over_file > file_.size())
            file_.fail(fmt::format("the file is cut off: the header promises {} x {} pixels", head.width, head.height));
        image_.samples.resize(row * head.height);
        for (std::size_t j = 0; j < head.height; ++j) rows_.push_back(image_.samples.data() + j * row);
        if (!finish()) refuse();
        if (head.bytes == 2 && std::endian::native == std::endian::little)
            for (std::size_t k = 0; k + 1 < image_.samples.size(); k += 2)
                std::swap(image_.samples[k], image_.samples[k + 1]);
        return std::move(image_);
    }

private:
    /// Reads the header and selects 8 or 16 bits of grey or colour, with alpha if the file has any.
    bool begin() {
        if (setjmp(jump_)) return false;
        png_set_user_limits(png_, most_pixels_a_side, most_pixels_a_side);
        png_set_read_fn(png_, this, take);
        png_read_info(png_, info_);
        png_fixed_point gamma = 0;
        int intent = 0;
        if (png_get_sRGB(png_, info_, &intent)) image_.srgb = true;
        else if (png_get_gAMA_fixed(png_, info_, &gamma) && gamma > 0) image_.srgb = gamma < linear_gamma;
        png_set_expand(png_);
        png_set_interlace_handling(png_);
        png_read_update_info(png_, info_);
        return true;
    }
    bool finish() {
        if (setjmp(jump_)) return false;
        png_read_image(png_, rows_.data());
        png_read_end(png_, nullptr);
        return true;
    }
    [[noreturn]] void refuse() const {
        if (error_) std::rethrow_exception(error_);
        file_.fail("expected a PNG file that can be read: " + message_);
    }

    static void take(png_structp png, png_bytep to, std::size_t bytes) {
        auto* self = static_cast<PngReader*>(png_get_io_ptr(png));
        try {
            self->file_.read(self->next_, {reinterpret_cast<char*>(to), bytes});
        } catch (...) {  // no exception passes through libpng
            self->error_ = std::current_exception();
        }
        if (self->error_) png_error(png, "the file cannot be read");
        self->next_ += bytes;
    }
    [[noreturn]] static void fail(png_structp png, png_const_charp message) {
        auto* self = static_cast<PngReader*>(png_get_error_ptr(png));
        self->message_ = message;
        std::longjmp(self->jump_, 1);
    }
    static void ignore(png_structp, png_const_charp) {}

    /// gAMA is 100000 over the exponent of the decoding: 45455 for sRGB, 100000 for linear; between them in the middle.
    static constexpr png_fixed_point linear_gamma = 70000;

    const OpenFile& file_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
    std::jmp_buf jump_{};
    std::uint64_t next_ = 0;
    StoredImage image_;
    std::vector<png_bytep> rows_;
    std::string message_;
    std::exception_ptr error_;
};

// ---- Stored numbers as values.

/// The values of all numbers of a file.
std::vector<float> value_table(const Quantisation& steps) {
    std::vector<float> out(static_cast<std::size_t>(steps.levels));
    for (std::size_t k = 0; k < out.size(); ++k) {
        const double share = static_cast<double>(k) / (steps.levels - 1);
        out[k] = static_cast<float>(steps.srgb ? srgb_decode(share) : share);
    }
    return out;
}

/// Fills planes from the channels of an image; rows are from the top there and from the bottom in a render.
Render render_of(const OpenFile& file, const StoredImage& image, const ReadingOptions& options) {
    const ImageHead& head = image.head;
    Render out(file.path(), static_cast<int>(head.width), static_cast<int>(head.height), Render::empty);
    if (image.levels() > 0) {
        const bool srgb = options.encoding == ImageEncoding::automatic ? image.srgb.value_or(true)
                                                                       : options.encoding == ImageEncoding::srgb;
        out.display_referred = true;
        out.displayed = options.space == ImageSpace::display && srgb;
        out.steps = {.levels = image.levels(), .srgb = srgb && options.space == ImageSpace::radiance};
        out.rounding = 0;
    }
    const Quantisation plain{.levels = image.levels(), .srgb = false};
    const std::vector<float> values = value_table(out.steps), shares = value_table(plain);
    const auto fill = [&](std::vector<float>& plane, std::size_t channel, const std::vector<float>& table) {
        plane.resize(out.data.pixels());
        for (std::size_t row = 0; row < head.height; ++row)
            for (std::size_t x = 0; x < head.width; ++x) {
                const double number = image.sample((row * head.width + x) * head.channels + channel);
                plane[(head.height - 1 - row) * head.width + x] =
                    table.empty() ? static_cast<float>(number) : table[static_cast<std::size_t>(number)];
            }
    };
    const bool is_grey = head.channels < 3, has_alpha = head.channels % 2 == 0;
    fill(out.r, 0, values);
    fill(out.g, is_grey ? 0 : 1, values);
    fill(out.b, is_grey ? 0 : 2, values);
    if (has_alpha) fill(out.alpha, head.channels - 1, shares);
    return out;
}

// ---- Radiance HDR.

Render read_radiance_hdr(const OpenFile& file, const ReadingOptions& options) {
    const auto primaries_of = [](const std::array<double, 8>& p) {
        return Chromaticities{{p[0], p[1]}, {p[2], p[3]}, {p[4], p[5]}, {p[6], p[7]}};
    };
    const HdrHeader header =
        hdr_header(file, [&](const std::array<double, 8>& p) { return is_valid(primaries_of(p)); });
    Render out = render_of(file, decoded(file), options);
    out.rounding = 0x1p-8;
    std::vector<float>* planes[3] = {&out.r, &out.g, &out.b};
    for (std::size_t c = 0; c < 3; ++c)
        for (float& value : *planes[c]) value = static_cast<float>(static_cast<double>(value) * header.unit[c]);
    if (header.primaries) {
        out.primaries = primaries_of(*header.primaries);
        out.weights = luminance_weights_of(out.primaries);
    }
    return out;
}

// ---- PNM: stb_image does not scale by the largest number of the header.

/// Refuses what stb_image would read wrongly: text, bitmaps, and numbers that do not end at 255 or 65535.
void check_pnm(const OpenFile& file, std::string_view first) {
    if (std::string_view("1234").find(first[1]) != std::string_view::npos)
        file.fail(fmt::format("expected binary PGM or PPM (P5, P6), found P{}: {} is not read", first[1],
            first[1] == '4' ? "a bitmap" : "PNM as text"));
    std::string header(4096, '\0');
    header.resize(file.read_some(0, header));
    std::vector<std::string> words;
    for (std::size_t i = 0; i < header.size() && words.size() < 4;) {
        if (header[i] == '#') i = std::min(header.find('\n', i), header.size());
        else if (std::isspace(static_cast<unsigned char>(header[i]))) ++i;
        else {
            const std::size_t begin = i;
            while (i < header.size() && !std::isspace(static_cast<unsigned char>(header[i]))) ++i;
            words.push_back(header.substr(begin, i - begin));
        }
    }
    if (words.size() < 4 || (words[3] != "255" && words[3] != "65535"))
        file.fail(fmt::format("expected PNM with the largest number 255 or 65535, found {}",
            words.size() < 4 ? "no such number" : printable(words[3], 20)));
}

bool is_tga(const std::string& path) {
    std::string end = path.size() < 4 ? "" : path.substr(path.size() - 4);
    std::transform(end.begin(), end.end(), end.begin(), [](unsigned char c) { return std::tolower(c); });
    return end == ".tga";
}

bool is_png(std::string_view first) { return first.starts_with("\x89PNG"); }
bool is_pnm(std::string_view first) {
    return first.size() > 2 && first[0] == 'P' && first[1] >= '1' && first[1] <= '6' &&
        std::isspace(static_cast<unsigned char>(first[2]));
}

}  // namespace

double Quantisation::half_step(double value) const {
    if (levels < 2) return 0;
    const double half = 0.5 / (levels - 1);
    if (!srgb) return half;
    // The derivative of srgb_decode(): 1 / 12.92 up to 0.04045, and 2.4 / 1.055 ((s + 0.055) / 1.055)^1.4 above.
    constexpr double knee = 0.0031308, slope = 1 / 12.92, power = 1.4 / 2.4;
    return half * (value <= knee ? slope : 2.4 / 1.055 * math::pow(std::min(value, 1.0), power));
}

double Quantisation::number_of(double value) const {
    return std::round((srgb ? srgb_encode(value) : value) * (levels - 1));
}

bool is_image(const OpenFile& file, std::string_view first) {
    for (const auto& [bytes, name] : {std::pair{"GIF8", "GIF"}, std::pair{"RIFF", "WebP"}, std::pair{"II*", "TIFF"},
             std::pair{"MM", "TIFF"}, std::pair{"8BPS", "PSD"}})
        if (first.starts_with(bytes)) file.fail(fmt::format("expected {}, found a {}", readable_formats, name));
    return is_png(first) || first.starts_with("\xff\xd8\xff") || first.starts_with("BM") || first.starts_with("#?") ||
        is_pnm(first) || is_tga(file.path());
}

Render read_image(const OpenFile& file, const ReadingOptions& options) {
    std::array<char, 16> head{};
    const std::string_view first(head.data(), file.read_some(0, head));
    if (first.starts_with("#?")) return read_radiance_hdr(file, options);
    if (is_png(first)) return render_of(file, PngReader(file).read(), options);
    if (is_pnm(first)) check_pnm(file, first);
    return render_of(file, decoded(file), options);
}

}  // namespace crescent
