// PFM (Debevec), Radiance HDR (Ward 1991, "Real Pixels"; RGBE, run-length encoded scanlines) and NPY (NumPy format
// 1-3).
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "base/errors.h"
#include "compare/render.h"

namespace crescent::inline comparing {

namespace {

constexpr int most_pixels_a_side = 65536;

/// A file's bytes, taken from the front.
class Reader {
public:
    Reader(const std::string& path, std::span<const char> bytes) : path_(path), rest_(bytes) {}

    [[noreturn]] void fail(const std::string& say) const { throw InputError({path_, 0, 0}, say); }

    std::string_view line() {
        const std::string_view all(rest_.data(), rest_.size());
        const std::size_t end = all.find('\n');
        if (end == std::string_view::npos || end > 4096) fail("expected a line of the header, found none");
        rest_ = rest_.subspan(end + 1);
        return all.substr(0, end);
    }
    std::span<const char> take(std::size_t count) {
        if (rest_.size() < count)
            fail(fmt::format("the file is cut off: expected {} more bytes, found {}", count, rest_.size()));
        const auto taken = rest_.first(count);
        rest_ = rest_.subspan(count);
        return taken;
    }
    unsigned byte() { return static_cast<unsigned char>(take(1)[0]); }
    bool empty() const { return rest_.empty(); }

    /// Width and height, both from 1 to 65536, whose pixels fit the memory that a file of this size can speak for.
    void check_size(long long w, long long h) const {
        if (w < 1 || h < 1 || w > most_pixels_a_side || h > most_pixels_a_side)
            fail(fmt::format("expected 1 to {} pixels a side, found {} x {}", most_pixels_a_side, w, h));
    }

private:
    const std::string& path_;
    std::span<const char> rest_;
};

template <class T> T swapped(T x) {
    auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(x);
    std::reverse(bytes.begin(), bytes.end());
    return std::bit_cast<T>(bytes);
}

template <class T> T read_as(const char* at, bool swap) {
    T x;
    std::memcpy(&x, at, sizeof x);
    return swap ? swapped(x) : x;
}

std::vector<std::string_view> words_of(std::string_view line) {
    std::vector<std::string_view> words;
    for (std::size_t at = 0; at < line.size();) {
        const std::size_t end = std::min(line.find_first_of(" \t\r", at), line.size());
        if (end > at) words.push_back(line.substr(at, end - at));
        at = end + 1;
    }
    return words;
}

template <class T> bool parse(std::string_view text, T& to) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), to);
    return error == std::errc{} && end == text.data() + text.size();
}

}  // namespace

Render read_pfm(const std::string& path, std::span<const char> bytes) {
    Reader in(path, bytes);
    const std::string_view kind = in.line();
    const int channels = kind.starts_with("PF") ? 3 : 1;
    std::vector<std::string_view> words = words_of(in.line());
    if (words.size() == 1) words.push_back(words_of(in.line()).at(0));  // width and height on two lines
    int w = 0, h = 0;
    double scale = 0;
    const bool sized = words.size() == 2 && parse(words[0], w) && parse(words[1], h);
    const std::vector<std::string_view> last = words_of(in.line());
    if (!sized || last.size() != 1 || !parse(last[0], scale) || scale == 0 || !std::isfinite(scale))
        in.fail("expected a PFM header: PF or Pf, width and height, a scale that is not 0");
    in.check_size(w, h);
    Render out(path, w, h);
    const bool swap = (scale > 0) == (std::endian::native == std::endian::little);  // positive: big-endian
    const auto pixels = in.take(out.size() * static_cast<std::size_t>(channels) * 4);
    for (std::size_t i = 0; i < out.size(); ++i) {
        const char* at = pixels.data() + i * static_cast<std::size_t>(channels) * 4;
        float* planes[3] = {&out.r[i], &out.g[i], &out.b[i]};
        for (int c = 0; c < 3; ++c) *planes[c] = read_as<float>(at + (channels == 3 ? 4 * c : 0), swap);
    }
    return out;
}

namespace {

using Rgbe = std::array<unsigned char, 4>;

/// One scanline, run-length encoded a channel (Ward 1991) or flat.
void read_scanline(Reader& in, std::vector<Rgbe>& row) {
    Rgbe first{};
    for (auto& c : first) c = static_cast<unsigned char>(in.byte());
    const std::size_t w = row.size();
    const bool encoded = first[0] == 2 && first[1] == 2 && first[2] < 128 && w >= 8 && w < 32768;
    if (!encoded) {
        row[0] = first;
        for (std::size_t i = 1; i < w; ++i)
            for (auto& c : row[i]) c = static_cast<unsigned char>(in.byte());
        return;
    }
    if ((std::size_t{first[2]} << 8 | first[3]) != w) in.fail("a scanline of another width than the header says");
    for (int c = 0; c < 4; ++c) {
        for (std::size_t i = 0; i < w;) {
            const unsigned count = in.byte();
            const bool run = count > 128;
            const std::size_t n = run ? count - 128 : count;
            if (n == 0 || i + n > w) in.fail("a run of pixels longer than its scanline");
            const unsigned value = run ? in.byte() : 0;
            for (std::size_t k = 0; k < n; ++k, ++i)
                row[i][static_cast<std::size_t>(c)] = static_cast<unsigned char>(run ? value : in.byte());
        }
    }
}

}  // namespace

Render read_radiance_hdr(const std::string& path, std::span<const char> bytes) {
    Reader in(path, bytes);
    double exposure = 1;
    for (std::string_view line = in.line(); !words_of(line).empty(); line = in.line()) {
        if (line == "FORMAT=32-bit_rle_xyze") in.fail("expected RGBE pixels, found XYZE");
        double by = 0;
        if (line.starts_with("EXPOSURE=") && parse(words_of(line.substr(9)).at(0), by) && by > 0) exposure *= by;
    }
    const std::vector<std::string_view> size = words_of(in.line());
    int w = 0, h = 0;
    const bool known = size.size() == 4 && (size[0] == "-Y" || size[0] == "+Y") && size[2] == "+X" &&
        parse(size[1], h) && parse(size[3], w);
    if (!known) in.fail("expected a resolution such as '-Y 540 +X 960'");
    in.check_size(w, h);
    Render out(path, w, h);
    out.rounding = 0x1p-8;
    std::vector<Rgbe> row(static_cast<std::size_t>(w));
    for (int line = 0; line < h; ++line) {
        read_scanline(in, row);
        const int j = size[0] == "-Y" ? h - 1 - line : line;
        for (std::size_t i = 0; i < row.size(); ++i) {
            const std::size_t at = static_cast<std::size_t>(j) * row.size() + i;
            const double unit = row[i][3] ? std::ldexp(1 / exposure, row[i][3] - 136) : 0;
            out.r[at] = static_cast<float>(row[i][0] * unit);
            out.g[at] = static_cast<float>(row[i][1] * unit);
            out.b[at] = static_cast<float>(row[i][2] * unit);
        }
    }
    return out;
}

namespace {

struct NpyHeader {
    char kind = 0;  // f
    int bytes = 0;
    bool swap = false, fortran = false;
    std::vector<long long> shape;
};

/// What stands after 'key': in the header's Python dictionary, up to the end of the value.
std::string_view value_of(const Reader& in, std::string_view header, std::string_view key) {
    const std::size_t at = header.find(fmt::format("'{}'", key));
    const std::size_t colon = at == std::string_view::npos ? at : header.find(':', at);
    if (colon == std::string_view::npos) in.fail(fmt::format("expected '{}' in the NPY header", key));
    std::string_view rest = header.substr(colon + 1);
    rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
    return rest;
}

NpyHeader npy_header(const Reader& in, std::string_view text) {
    NpyHeader out;
    const std::string_view type = value_of(in, text, "descr");
    if (type.size() < 5 || type[0] != '\'' || type[2] != 'f' || !(type[3] == '2' || type[3] == '4' || type[3] == '8') ||
        type[4] != '\'')
        in.fail("expected floats ('<f2', '<f4' or '<f8') in the NPY header");
    out.kind = 'f', out.bytes = type[3] - '0';
    out.swap = (type[1] == '>') == (std::endian::native == std::endian::little);
    out.fortran = value_of(in, text, "fortran_order").starts_with("True");
    std::string_view shape = value_of(in, text, "shape");
    const std::size_t end = shape.find(')');
    if (!shape.starts_with('(') || end == std::string_view::npos)
        in.fail("expected a shape such as (540, 960, 3) in the NPY header");
    std::string numbers(shape.substr(1, end - 1));
    for (char& c : numbers) c = c == ',' ? ' ' : c;
    for (const std::string_view word : words_of(numbers)) {
        long long n = 0;
        if (!parse(word, n)) in.fail("expected whole numbers in the shape of the NPY header");
        out.shape.push_back(n);
    }
    return out;
}

/// IEEE 754 binary16.
double from_half(std::uint16_t bits) {
    const int exponent = bits >> 10 & 31, fraction = bits & 1023;
    const double sign = bits & 0x8000 ? -1 : 1;
    if (exponent == 31) return fraction ? std::nan("") : sign * HUGE_VAL;
    return sign * (exponent ? std::ldexp(1024 + fraction, exponent - 25) : std::ldexp(fraction, -24));
}

double npy_number(const char* at, const NpyHeader& h) {
    if (h.bytes == 2) return from_half(read_as<std::uint16_t>(at, h.swap));
    return h.bytes == 4 ? static_cast<double>(read_as<float>(at, h.swap)) : read_as<double>(at, h.swap);
}

}  // namespace

Render read_npy(const std::string& path, std::span<const char> bytes) {
    Reader in(path, bytes);
    in.take(6);
    const unsigned version = in.byte();
    in.byte();
    std::size_t length = in.byte();
    length |= std::size_t{in.byte()} << 8;
    if (version >= 2) length |= std::size_t{in.byte()} << 16, length |= std::size_t{in.byte()} << 24;
    const auto header = in.take(length);
    const NpyHeader h = npy_header(in, {header.data(), header.size()});
    const bool colour = h.shape.size() == 3;
    if (!(colour || h.shape.size() == 2) || (colour && h.shape[2] != 1 && h.shape[2] != 3 && h.shape[2] != 4))
        in.fail("expected an array of height x width, or height x width x 1, 3 or 4, rows from the top");
    in.check_size(h.shape[1], h.shape[0]);
    const auto rows = static_cast<std::size_t>(h.shape[0]), columns = static_cast<std::size_t>(h.shape[1]);
    const std::size_t channels = colour ? static_cast<std::size_t>(h.shape[2]) : 1;
    Render out(path, static_cast<int>(columns), static_cast<int>(rows));
    if (h.bytes == 2) out.rounding = 0x1p-11;
    const auto width = static_cast<std::size_t>(h.bytes);
    const auto data = in.take(rows * columns * channels * width);
    for (std::size_t row = 0; row < rows; ++row) {
        for (std::size_t i = 0; i < columns; ++i) {
            const std::size_t to = (rows - 1 - row) * columns + i;
            float* planes[3] = {&out.r[to], &out.g[to], &out.b[to]};
            for (std::size_t c = 0; c < 3; ++c) {
                const std::size_t k = channels >= 3 ? c : 0;
                const std::size_t at = h.fortran ? (k * columns + i) * rows + row : (row * columns + i) * channels + k;
                *planes[c] = static_cast<float>(npy_number(data.data() + at * width, h));
            }
        }
    }
    return out;
}

}  // namespace crescent::inline comparing
