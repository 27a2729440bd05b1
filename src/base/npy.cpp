// NumPy's format: a magic word, a version, and a Python dictionary of the array's type and shape.
#include "base/npy.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>

#include "base/text.h"

namespace crescent {

namespace {

constexpr std::string_view magic("\x93NUMPY", 6);

/// The header's dictionary, a Python literal, read from the start of a value.
class Dictionary {
public:
    Dictionary(const std::string& path, std::string_view text) : path_(path), text_(text) {}

    [[noreturn]] void fail(const std::string& expected) const {
        throw InputError({path_, 0, 0}, fmt::format("NPY header: expected {} in {}", expected, printable(text_, 200)));
    }
    /// Returns the text after 'key':.
    std::string_view value(std::string_view key) const {
        for (const char quote : {'\'', '"'}) {
            const std::size_t key_start = text_.find(fmt::format("{}{}{}", quote, key, quote));
            const std::size_t colon = key_start == std::string_view::npos ? key_start : text_.find(':', key_start);
            if (colon != std::string_view::npos) return without_blanks(text_.substr(colon + 1));
        }
        fail(fmt::format("'{}'", key));
    }
    static std::string_view without_blanks(std::string_view s) {
        return s.substr(std::min(s.find_first_not_of(" \t\r\n"), s.size()));
    }

private:
    const std::string& path_;
    std::string_view text_;
};

void read_type(const Dictionary& in, NpyHeader& out) {
    const std::string_view type = in.value("descr");
    const bool quoted = type.size() >= 5 && (type[0] == '\'' || type[0] == '"') && type[4] == type[0];
    const char order = quoted ? type[1] : ' ';
    if (!quoted || type[2] != 'f' || std::string_view("<>=").find(order) == std::string_view::npos ||
        std::string_view("248").find(type[3]) == std::string_view::npos)
        in.fail("a 'descr' of floats ('<f2', '<f4' or '<f8')");
    out.bytes = static_cast<std::size_t>(type[3] - '0');
    out.swapped = order != '=' && (order == '>') == (std::endian::native == std::endian::little);
}

void read_shape(const Dictionary& in, NpyHeader& out) {
    std::string_view remainder = in.value("shape");
    const auto fail = [&] { in.fail("a 'shape' of whole numbers such as (540, 960, 3)"); };
    if (!remainder.starts_with('(')) fail();
    remainder = Dictionary::without_blanks(remainder.substr(1));
    while (!remainder.starts_with(')')) {
        std::uint64_t n = 0;
        const auto [end, error] = std::from_chars(remainder.data(), remainder.data() + remainder.size(), n);
        if (error != std::errc{} || out.shape.size() == 32) fail();
        out.shape.push_back(n);
        remainder = Dictionary::without_blanks(remainder.substr(static_cast<std::size_t>(end - remainder.data())));
        if (remainder.starts_with(',')) remainder = Dictionary::without_blanks(remainder.substr(1));
        else if (!remainder.starts_with(')')) fail();
    }
}

/// IEEE 754 binary16.
double from_half(std::uint16_t bits) {
    const int exponent = bits >> 10 & 31, fraction = bits & 1023;
    const double sign = bits & 0x8000 ? -1 : 1;
    if (exponent == 31) return fraction ? std::nan("") : sign * HUGE_VAL;
    return sign * (exponent ? std::ldexp(1024 + fraction, exponent - 25) : std::ldexp(fraction, -24));
}

template <class T> T as(const NpyHeader& header, const char* bytes_of_number) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, bytes_of_number, sizeof(T));
    if (header.swapped) std::reverse(bytes, bytes + sizeof(T));
    T out;
    std::memcpy(&out, bytes, sizeof out);
    return out;
}

}  // namespace

NpyHeader read_npy_header(const std::string& path, std::string_view first_bytes) {
    const auto fail = [&](const std::string& message) { throw InputError({path, 0, 0}, message); };
    const auto byte = [&](std::size_t offset) { return std::size_t{static_cast<unsigned char>(first_bytes[offset])}; };
    if (first_bytes.size() < 12 || !first_bytes.starts_with(magic)) fail("expected an NPY file");
    const std::size_t version = byte(6);
    if (version < 1 || version > 3) fail(fmt::format("byte 7: expected an NPY format of 1 to 3, found {}", version));
    NpyHeader out;
    const std::size_t begin = version == 1 ? 10 : 12;
    std::size_t length = byte(8) | byte(9) << 8;
    if (version > 1) length |= byte(10) << 16 | byte(11) << 24;
    if (length > longest_npy_header - 12)
        fail(fmt::format(
            "byte 9: expected an NPY header of at most {} bytes, found {}", longest_npy_header - 12, length));
    if (first_bytes.size() < begin + length)
        fail(fmt::format("byte 9: expected an NPY header of {} bytes, found {}", length, first_bytes.size() - begin));
    const Dictionary in(path, first_bytes.substr(begin, length));
    read_type(in, out);
    read_shape(in, out);
    out.by_column = in.value("fortran_order").starts_with("True");
    out.end = begin + length;
    return out;
}

double npy_number(const NpyHeader& header, const char* bytes) {
    if (header.bytes == 2) return from_half(as<std::uint16_t>(header, bytes));
    return header.bytes == 4 ? static_cast<double>(as<float>(header, bytes)) : as<double>(header, bytes);
}

}  // namespace crescent
