// encode_png() read back by libpng: size, pixels, provenance in Latin-1 and other text, no date.
#include <gtest/gtest.h>
#include <png.h>

#include <cstring>
#include <map>

#include "report/plates/plates.h"

namespace crescent::plates {
namespace {

struct Decoded {
    int width = 0, height = 0;
    std::map<std::string, std::string> text;
    std::vector<unsigned char> rgb;
    bool dated = false;
};

Decoded decode(const std::vector<unsigned char>& bytes) {
    struct Source {
        const unsigned char* at;
    } source{bytes.data()};
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_set_read_fn(png, &source, [](png_structp p, png_bytep out, png_size_t n) {
        auto* s = static_cast<Source*>(png_get_io_ptr(p));
        std::memcpy(out, s->at, n);
        s->at += n;
    });
    png_read_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
    Decoded d;
    d.width = int(png_get_image_width(png, info)), d.height = int(png_get_image_height(png, info));
    png_bytepp rows = png_get_rows(png, info);
    for (int y = 0; y < d.height; ++y) d.rgb.insert(d.rgb.end(), rows[y], rows[y] + 3 * d.width);
    png_textp text = nullptr;
    int count = 0;
    png_get_text(png, info, &text, &count);
    for (int i = 0; i < count; ++i) d.text[text[i].key] = text[i].text;
    d.dated = png_get_valid(png, info, PNG_INFO_tIME) != 0;
    png_destroy_read_struct(&png, &info, nullptr);
    return d;
}

TEST(Png, HasPixelsAndProvenanceButNoDate) {
    Picture p{3, 2, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 255}};
    Decoded d = decode(encode_png(p, {{"experiment", "gallery.toml"}, {"title", "ω and ρ"}}));
    EXPECT_EQ(d.width, 3);
    EXPECT_EQ(d.height, 2);
    EXPECT_EQ(d.rgb, p.rgb);
    EXPECT_EQ(d.text["experiment"], "gallery.toml");
    EXPECT_EQ(d.text["title"], "ω and ρ");
    EXPECT_FALSE(d.dated);
}

}  // namespace
}  // namespace crescent::plates
