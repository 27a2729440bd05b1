// Radiance HDR (Ward 1991, "Real Pixels"): RGBE or XYZE, scanlines flat or run-length encoded in the old or the new
// way. Memory grows with the scanlines that are there.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "compare/render.h"
#include "compare/text_header.h"

namespace crescent::inline comparing {

namespace {

using Rgbe = std::array<unsigned char, 4>;

struct HdrHeader {
    int width = 0, height = 0;
    bool from_the_top = true, xyz = false;
    Rgb unit{1, 1, 1};  // what a stored value is multiplied with
    std::optional<Chromaticities> primaries;
    std::size_t end = 0;
};

/// Exactly so many numbers behind "KEY=".
template <std::size_t n>
std::array<double, n> numbers_of(const TextHeader& in, std::string_view text, const char* what) {
    std::array<double, n> out{};
    const std::vector<std::string_view> words = words_of(text);
    bool good = words.size() == n;
    for (std::size_t i = 0; good && i < n; ++i) good = parse_number(words[i], out[i]) && std::isfinite(out[i]);
    if (!good) in.fail(fmt::format("expected {}", what));
    return out;
}

void read_variable(TextHeader& in, std::string_view line, HdrHeader& out) {
    const std::size_t equals = line.find('=');
    const std::string_view key = line.substr(0, equals);
    const std::string_view value = equals == std::string_view::npos ? "" : line.substr(equals + 1);
    if (key == "FORMAT") {
        const std::vector<std::string_view> words = words_of(value);
        const std::string_view format = words.size() == 1 ? words[0] : "";
        out.xyz = format == "32-bit_rle_xyze";
        if (!out.xyz && format != "32-bit_rle_rgbe")
            in.fail("expected FORMAT=32-bit_rle_rgbe or FORMAT=32-bit_rle_xyze");
    } else if (key == "EXPOSURE") {
        const double by = numbers_of<1>(in, value, "EXPOSURE= and a number above 0")[0];
        if (!(by > 0)) in.fail("expected EXPOSURE= and a number above 0");
        for (double& unit : out.unit) unit /= by;
    } else if (key == "COLORCORR") {
        const auto by = numbers_of<3>(in, value, "COLORCORR= and three numbers above 0");
        for (std::size_t c = 0; c < 3; ++c) {
            if (!(by[c] > 0)) in.fail("expected COLORCORR= and three numbers above 0");
            out.unit[c] /= by[c];
        }
    } else if (key == "PRIMARIES") {
        const auto p = numbers_of<8>(in, value, "PRIMARIES= and eight numbers");
        out.primaries = Chromaticities{{p[0], p[1]}, {p[2], p[3]}, {p[4], p[5]}, {p[6], p[7]}};
        if (!is_valid(*out.primaries)) in.fail("expected PRIMARIES= of three colours and a white point");
    }
}

HdrHeader hdr_header(const OpenFile& file) {
    TextHeader in(file);
    HdrHeader out;
    for (std::string_view line = in.line(); !words_of(line).empty(); line = in.line()) read_variable(in, line, out);
    const std::vector<std::string_view> size = words_of(in.line());
    const bool known = size.size() == 4 && (size[0] == "-Y" || size[0] == "+Y") && size[2] == "+X" &&
        parse_number(size[1], out.height) && parse_number(size[3], out.width);
    if (!known) in.fail("expected a resolution such as '-Y 540 +X 960'");
    in.check_size(out.width, out.height);
    for (const double unit : out.unit)
        if (!(unit > 0 && std::isfinite(unit))) in.fail("expected an EXPOSURE and a COLORCORR that a float can hold");
    out.from_the_top = size[0] == "-Y";
    out.end = in.end();
    return out;
}

/// Pixels from the file, through a buffer.
class Scanlines {
public:
    Scanlines(const OpenFile& file, std::size_t from) : file_(file), next_(from) {}

    void read(std::vector<Rgbe>& row) {
        const Rgbe first = pixel();
        const std::size_t w = row.size();
        if (first[0] == 2 && first[1] == 2 && first[2] < 128 && w >= 8 && w < 32768) {
            if ((std::size_t{first[2]} << 8 | first[3]) != w)
                fail(fmt::format("expected a scanline of {} pixels, found one of {}", w, first[2] << 8 | first[3]));
            for (std::size_t c = 0; c < 4; ++c) read_channel(row, c);
        } else {
            read_flat(row, first);
        }
    }

private:
    /// Pixels in full; 1, 1, 1, n says the one before n times, n of the next such pixel times 256.
    void read_flat(std::vector<Rgbe>& row, Rgbe next) {
        unsigned shift = 0;
        for (std::size_t i = 0; i < row.size();) {
            if (i > 0 || shift > 0) next = pixel();
            const bool run = next[0] == 1 && next[1] == 1 && next[2] == 1;
            const std::size_t n = run ? (shift < 24 ? std::size_t{next[3]} << shift : row.size() + 1) : 1;
            if (run && i == 0) fail("expected a pixel, found a run of the pixel before the first");
            if (i + n > row.size()) fail("a run of pixels is longer than its scanline");
            const Rgbe value = run ? row[i - 1] : next;
            std::fill_n(row.begin() + static_cast<std::ptrdiff_t>(i), n, value);
            i += n, shift = run ? shift + 8 : 0;
        }
    }
    void read_channel(std::vector<Rgbe>& row, std::size_t c) {
        for (std::size_t i = 0; i < row.size();) {
            const unsigned count = byte();
            const bool run = count > 128;
            const std::size_t n = run ? count - 128 : count;
            if (n == 0 || i + n > row.size()) fail("a run of pixels is empty, or longer than its scanline");
            const unsigned char value = run ? byte() : static_cast<unsigned char>(0);
            for (std::size_t k = 0; k < n; ++k, ++i) row[i][c] = run ? value : byte();
        }
    }
    Rgbe pixel() {
        Rgbe out;
        for (unsigned char& c : out) c = byte();
        return out;
    }
    unsigned char byte() {
        if (at_ == buffer_.size()) {
            buffer_.resize(1u << 16);
            buffer_.resize(file_.read_some(next_, buffer_));
            if (buffer_.empty()) fail("the file is cut off: expected more scanlines");
            next_ += buffer_.size(), at_ = 0;
        }
        return static_cast<unsigned char>(buffer_[at_++]);
    }
    [[noreturn]] void fail(const std::string& message) const {
        file_.fail(fmt::format("byte {}: {}", next_ - buffer_.size() + at_, message));
    }

    const OpenFile& file_;
    std::uint64_t next_;
    std::vector<char> buffer_;
    std::size_t at_ = 0;
};

/// Rows from the top as rows from the bottom.
void turn_over(std::vector<float>& plane, std::size_t width) {
    for (std::size_t low = 0, high = plane.size() / width - 1; low < high; ++low, --high)
        std::swap_ranges(plane.begin() + static_cast<std::ptrdiff_t>(low * width),
            plane.begin() + static_cast<std::ptrdiff_t>((low + 1) * width),
            plane.begin() + static_cast<std::ptrdiff_t>(high * width));
}

}  // namespace

Render read_radiance_hdr(const OpenFile& file) {
    const HdrHeader h = hdr_header(file);
    file.expect_bytes(h.end, std::uint64_t{4} * static_cast<std::uint64_t>(h.height),
        fmt::format("the header promises {} scanlines", h.height));
    Render out(file.path(), h.width, h.height, Render::empty);
    out.rounding = 0x1p-8;
    Scanlines in(file, h.end);
    std::vector<Rgbe> row(static_cast<std::size_t>(h.width));
    std::vector<float>* planes[3] = {&out.r, &out.g, &out.b};
    for (int line = 0; line < h.height; ++line) {
        in.read(row);
        for (const Rgbe& pixel : row) {
            const double scale = pixel[3] ? std::ldexp(1, pixel[3] - 136) : 0;
            for (std::size_t c = 0; c < 3; ++c)
                planes[c]->push_back(static_cast<float>(pixel[c] * (h.unit[c] * scale)));
        }
    }
    if (h.from_the_top)
        for (std::vector<float>* plane : planes) turn_over(*plane, row.size());
    if (h.xyz) from_xyz(out);
    else if (h.primaries) out.primaries = *h.primaries, out.weights = luminance_weights_of(*h.primaries);
    return out;
}

}  // namespace crescent::inline comparing
