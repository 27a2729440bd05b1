// PNG, ISO/IEC 15948:2004: 8-bit RGB, sRGB chunk, provenance as tEXt (Latin-1) or iTXt (UTF-8); no time, so that equal
// pictures have equal bytes.
#include <png.h>

#include <algorithm>
#include <csetjmp>

#include "base/errors.h"
#include "report/plates/plates.h"

namespace crescent::plates {

namespace {

// zlib level and filter: noise is hardly compressible, and level 3 with one filter takes a third of the time of the
// defaults for a few per cent more bytes.
constexpr int deflate_level = 3;

void append(png_structp png, png_bytep data, png_size_t n) {
    auto* out = static_cast<std::vector<unsigned char>*>(png_get_io_ptr(png));
    out->insert(out->end(), data, data + n);
}
void keep(png_structp) {}

[[noreturn]] void fail(png_structp png, png_const_charp message) {
    *static_cast<std::string*>(png_get_error_ptr(png)) = message;
    longjmp(png_jmpbuf(png), 1);
}
void ignore(png_structp, png_const_charp) {}

bool ascii(const std::string& s) {
    return std::all_of(s.begin(), s.end(), [](unsigned char c) { return c < 128; });
}

// Everything with a destructor is owned by the caller: libpng leaves by longjmp.
bool write(png_structp png, png_infop info, const Picture& p, std::vector<png_text>& text) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_set_IHDR(png, info, png_uint_32(p.width), png_uint_32(p.height), 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
        PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_compression_level(png, deflate_level);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
    png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    if (!text.empty()) png_set_text(png, info, text.data(), int(text.size()));
    png_write_info(png, info);
    for (int y = 0; y < p.height; ++y) {
        png_write_row(png, const_cast<png_bytep>(p.rgb.data() + 3 * std::size_t(y) * std::size_t(p.width)));
    }
    png_write_end(png, nullptr);
    return true;
}

}  // namespace

std::vector<unsigned char> encode_png(
    const Picture& picture, const std::vector<std::pair<std::string, std::string>>& text) {
    ensure(picture.width > 0 && picture.height > 0 &&
            picture.rgb.size() == 3 * std::size_t(picture.width) * std::size_t(picture.height),
        "a picture has three bytes a pixel");
    std::vector<png_text> chunks;
    for (const auto& [key, value] : text) {
        ensure(!key.empty() && key.size() < 80 && ascii(key), "a PNG keyword has 1 to 79 ASCII characters");
        png_text t{};
        t.compression = ascii(value) ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
        t.key = const_cast<char*>(key.c_str());
        t.text = const_cast<char*>(value.c_str());
        (ascii(value) ? t.text_length : t.itxt_length) = value.size();
        chunks.push_back(t);
    }
    std::vector<unsigned char> out;
    std::string error;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &error, fail, ignore);
    png_infop info = png ? png_create_info_struct(png) : nullptr;
    bool done = false;
    if (info) {
        png_set_write_fn(png, &out, append, keep);
        done = write(png, info, picture, chunks);
    }
    png_destroy_write_struct(&png, &info);
    if (!done) throw OutputError("PNG: " + (error.empty() ? std::string("out of memory") : error));
    return out;
}

}  // namespace crescent::plates
