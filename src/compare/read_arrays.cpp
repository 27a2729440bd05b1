// PFM (Debevec) and NPY: floats one after another behind a header, read a row at a time.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "base/npy.h"
#include "compare/render.h"
#include "compare/text_header.h"

namespace crescent::inline comparing {

namespace {

float float_at(const char* at, bool swap) {
    char bytes[sizeof(float)];
    std::memcpy(bytes, at, sizeof bytes);
    if (swap) std::reverse(bytes, bytes + sizeof bytes);
    float out;
    std::memcpy(&out, bytes, sizeof out);
    return out;
}

struct PfmHeader {
    int width = 0, height = 0;
    std::size_t channels = 1, end = 0;
    bool swap = false;
};

PfmHeader pfm_header(const OpenFile& file) {
    TextHeader in(file);
    PfmHeader out;
    const std::vector<std::string_view> kind = words_of(in.line());
    if (kind.size() != 1 || (kind[0] != "PF" && kind[0] != "Pf")) in.fail("expected 'PF' (colour) or 'Pf' (grey)");
    out.channels = kind[0] == "PF" ? 3 : 1;
    std::vector<std::string_view> size = words_of(in.line());
    if (size.size() == 1)  // width and height on two lines
        for (const std::string_view word : words_of(in.line())) size.push_back(word);
    if (size.size() != 2 || !parse_number(size[0], out.width) || !parse_number(size[1], out.height))
        in.fail("expected a width and a height in pixels, such as '960 540'");
    in.check_size(out.width, out.height);
    const std::vector<std::string_view> last = words_of(in.line());
    double scale = 0;
    if (last.size() != 1 || !parse_number(last[0], scale) || scale == 0 || !std::isfinite(scale))
        in.fail("expected a scale that is not 0, such as '-1.0'");
    out.swap = (scale > 0) == (std::endian::native == std::endian::little);  // positive: big-endian
    out.end = in.end();
    return out;
}

}  // namespace

Render read_pfm(const OpenFile& file) {
    const PfmHeader h = pfm_header(file);
    const std::size_t row = static_cast<std::size_t>(h.width) * h.channels * sizeof(float);
    file.expect_bytes(h.end, row * static_cast<std::size_t>(h.height),
        fmt::format("the header promises {} x {} pixels of {} floats", h.width, h.height, h.channels));
    Render out(file.path(), h.width, h.height);
    std::vector<char> bytes(row);
    for (std::size_t j = 0, i = 0; j < static_cast<std::size_t>(h.height); ++j) {
        file.read(h.end + j * row, bytes);
        for (std::size_t x = 0; x < static_cast<std::size_t>(h.width); ++x, ++i) {
            const char* at = bytes.data() + x * h.channels * sizeof(float);
            float* planes[3] = {&out.r[i], &out.g[i], &out.b[i]};
            for (std::size_t c = 0; c < 3; ++c)
                *planes[c] = float_at(at + (h.channels == 3 ? sizeof(float) * c : 0), h.swap);
        }
    }
    return out;
}

Render read_npy(const OpenFile& file) {
    std::string first(longest_npy_header, '\0');
    first.resize(file.read_some(0, first));
    const NpyHeader h = read_npy_header(file.path(), first);
    const bool colour = h.shape.size() == 3;
    const std::uint64_t channels = colour ? h.shape[2] : 1;
    if (!(colour || h.shape.size() == 2) || !(channels == 1 || channels == 3 || channels == 4))
        file.fail(
            fmt::format("NPY header: expected a shape of height x width, or height x width x 1, 3 or 4, rows from "
                        "the top, found ({})",
                fmt::join(h.shape, ", ")));
    for (const std::uint64_t side : {h.shape[0], h.shape[1]})
        if (side < 1 || side > static_cast<std::uint64_t>(most_pixels_a_side))
            file.fail(fmt::format("NPY header: expected 1 to {} pixels a side, found {} x {}", most_pixels_a_side,
                h.shape[1], h.shape[0]));
    const std::size_t rows = h.shape[0], columns = h.shape[1], total = rows * columns * channels;
    file.expect_bytes(h.end, total * h.bytes,
        fmt::format("the header promises {} x {} x {} floats of {} bytes", rows, columns, channels, h.bytes));
    Render out(file.path(), static_cast<int>(columns), static_cast<int>(rows));
    if (h.bytes == 2) out.rounding = 0x1p-11;
    std::vector<float>* planes[3] = {&out.r, &out.g, &out.b};
    const std::size_t block = std::min<std::size_t>(total, 1u << 16);
    std::vector<char> bytes(block * h.bytes);
    for (std::size_t begin = 0; begin < total; begin += block) {
        const std::size_t n = std::min(block, total - begin);
        file.read(h.end + begin * h.bytes, std::span(bytes).first(n * h.bytes));
        for (std::size_t k = 0; k < n; ++k) {
            const std::size_t at = begin + k;  // by rows: (row, column, channel); by columns: the other way round
            const std::size_t row = h.by_column ? at % rows : at / channels / columns;
            const std::size_t column = h.by_column ? at / rows % columns : at / channels % columns;
            const std::size_t channel = h.by_column ? at / rows / columns : at % channels;
            if (channel < 3)
                (*planes[channel])[(rows - 1 - row) * columns + column] =
                    static_cast<float>(npy_number(h, bytes.data() + k * h.bytes));
        }
    }
    if (channels == 1) out.g = out.b = out.r;
    return out;
}

}  // namespace crescent::inline comparing
