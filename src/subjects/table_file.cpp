// CSV with a header by its columns' names, in any order; NPY (format 1 to 3) of <f4 or <f8, two-dimensional, by its
// number of columns. Numbers that overflow are infinite, those that underflow are 0. Every mistake is named with line
// and column.
#include "subjects/table_file.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <fmt/format.h>
#include <fstream>

#include "base/text.h"
#include "subjects/pipe_text.h"

namespace crescent::inline subjects {

namespace {

std::string_view trimmed(std::string_view s) {
    const auto from = s.find_first_not_of(" \t\r");
    return from == std::string_view::npos ? std::string_view() : s.substr(from, s.find_last_not_of(" \t\r") - from + 1);
}

/// Calls each(cell, column from 1) for every cell of a line.
template <class Each> void cells_of(std::string_view line, Each&& each) {
    for (std::size_t from = 0;;) {
        const std::size_t comma = line.find(',', from);
        each(trimmed(line.substr(from, comma - from)), static_cast<unsigned>(from + 1));
        if (comma == std::string_view::npos) return;
        from = comma + 1;
    }
}

double number(FileDiagnostics& in, std::string_view word, unsigned line, unsigned column) {
    double v = 0;
    const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), v);
    if (error == std::errc::result_out_of_range && end == digits.data() + digits.size())
        return (digits.starts_with('-') ? -1 : 1) * out_of_range(digits.substr(digits.starts_with('-')), false);
    if (error != std::errc{} || end != digits.data() + digits.size())
        in.add(line, column, fmt::format("expected a number, not '{}'", printable(word, 40)));
    return v;
}

NumberTable read_csv(FileDiagnostics& in, std::istream& file) {
    NumberTable t;
    std::string text;
    for (unsigned line = 1; std::getline(file, text); ++line) {
        if (line == 1 && text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);  // a byte order mark
        if (trimmed(text).empty()) continue;
        if (t.columns.empty()) {
            cells_of(text, [&](std::string_view cell, unsigned) { t.columns.emplace_back(cell); });
            continue;
        }
        const std::size_t before = t.values.size();
        cells_of(
            text, [&](std::string_view cell, unsigned column) { t.values.push_back(number(in, cell, line, column)); });
        const std::size_t got = t.values.size() - before;
        if (got != t.columns.size()) {
            in.add(line, 1, fmt::format("expected {} values, as the header has, not {}", t.columns.size(), got));
            t.values.resize(before);
        } else {
            t.lines.push_back(line);
        }
    }
    if (t.columns.empty()) in.add(1, 1, "the file is empty; expected a header line");
    in.throw_if_any();
    return t;
}

void name_columns(FileDiagnostics& in, const NumberTable& t, const std::vector<std::vector<std::string>>& layouts) {
    const auto has_all = [&](const std::vector<std::string>& layout) {
        return std::all_of(layout.begin(), layout.end(), [&](const std::string& n) { return t.column(n) >= 0; });
    };
    const auto fits = [&](const std::vector<std::string>& layout) {
        return has_all(layout) && layout.size() == t.columns.size();
    };
    if (std::any_of(layouts.begin(), layouts.end(), fits)) return;
    std::string expected;
    for (const auto& layout : layouts)
        expected += fmt::format("{}{}", expected.empty() ? "" : " or ", fmt::join(layout, ","));
    in.add(1, 1,
        fmt::format(
            "expected the header {}, not {}", expected, printable(fmt::format("{}", fmt::join(t.columns, ",")), 100)));
    in.throw_if_any();
}

struct NpyHeader {
    std::size_t rows = 0, columns = 0, size = 0;
    bool by_column = false;
};

std::string_view without_blanks(std::string_view s) {
    return s.substr(std::min(s.find_first_not_of(" \t\r\n"), s.size()));
}

/// What stands after a key of the header, which is a Python dictionary.
std::string_view value_of(std::string_view header, std::string_view key) {
    const std::size_t at = header.find(key);
    return at == std::string_view::npos ? std::string_view() : without_blanks(header.substr(at + key.size()));
}

bool take(std::string_view& s, char c) {
    if (!s.starts_with(c)) return false;
    s = without_blanks(s.substr(1));
    return true;
}

/// A count of at most fifteen digits.
bool take_count(std::string_view& s, std::size_t& out) {
    const auto [end, error] = std::from_chars(s.data(), s.data() + s.size(), out);
    if (error != std::errc{} || end - s.data() > 15) return false;
    s = without_blanks(s.substr(static_cast<std::size_t>(end - s.data())));
    return true;
}

NpyHeader npy_header(FileDiagnostics& in, std::istream& file) {
    char magic[10];
    if (!file.read(magic, 10) || std::memcmp(magic, "\x93NUMPY", 6) != 0)
        in.add(0, 0, "not an NPY file"), in.throw_if_any();
    const auto byte = [](char c) { return static_cast<std::uint32_t>(static_cast<unsigned char>(c)); };
    std::uint32_t length = byte(magic[8]) | byte(magic[9]) << 8;
    if (magic[6] > 1) {
        char more[2] = {};
        file.read(more, 2);
        length |= byte(more[0]) << 16 | byte(more[1]) << 24;
    }
    if (length > 65536) in.add(0, 0, "the NPY header is too long"), in.throw_if_any();
    std::string header(length, ' ');
    file.read(header.data(), static_cast<std::streamsize>(length));
    NpyHeader out;
    std::string_view type = value_of(header, "'descr':"), shape = value_of(header, "'shape':");
    if (type.starts_with("'<f4'")) out.size = 4;
    if (type.starts_with("'<f8'")) out.size = 8;
    const bool known = out.size > 0 && take(shape, '(') && take_count(shape, out.rows) && take(shape, ',') &&
        take_count(shape, out.columns) && (take(shape, ','), take(shape, ')'));
    if (!known)
        in.add(0, 0,
            fmt::format("expected a two-dimensional array of <f4 or <f8, not {}", printable(trimmed(header), 100))),
            in.throw_if_any();
    out.by_column = value_of(header, "'fortran_order':").starts_with("True");
    return out;
}

NumberTable read_npy(FileDiagnostics& in, std::istream& file, const std::vector<std::vector<std::string>>& layouts) {
    const NpyHeader h = npy_header(in, file);
    NumberTable t;
    std::string expected;
    for (const auto& layout : layouts) {
        if (layout.size() == h.columns) t.columns = layout;
        expected += fmt::format("{}{} ({})", expected.empty() ? "" : " or ", layout.size(), fmt::join(layout, ","));
    }
    if (t.columns.empty())
        in.add(0, 0, fmt::format("expected {} columns, not {}", expected, h.columns)), in.throw_if_any();
    const auto start = file.tellg();
    file.seekg(0, std::ios::end);
    const std::size_t bytes = static_cast<std::size_t>(file.tellg() - start);
    if (bytes / h.size / h.columns < h.rows)
        in.add(0, 0, fmt::format("the file ends in row {} of {}", bytes / h.size / h.columns + 1, h.rows)),
            in.throw_if_any();
    file.seekg(start);
    std::vector<char> raw(h.rows * h.columns * h.size);
    file.read(raw.data(), static_cast<std::streamsize>(raw.size()));
    t.values.resize(h.rows * h.columns);
    for (std::size_t r = 0; r < h.rows; ++r)
        for (std::size_t c = 0; c < h.columns; ++c) {
            const char* at = &raw[h.size * (h.by_column ? c * h.rows + r : r * h.columns + c)];
            float single = 0;
            double& v = t.values[r * h.columns + c];
            if (h.size == 4) std::memcpy(&single, at, 4), v = static_cast<double>(single);
            else std::memcpy(&v, at, 8);
        }
    return t;
}

}  // namespace

int NumberTable::column(std::string_view name) const {
    const auto at = std::find(columns.begin(), columns.end(), name);
    return at == columns.end() ? -1 : static_cast<int>(at - columns.begin());
}

NumberTable read_table_file(FileDiagnostics& in, const std::vector<std::vector<std::string>>& layouts) {
    std::ifstream file(in.path, std::ios::binary);
    if (!file || file.peek() == std::ifstream::traits_type::eof())
        in.add(0, 0, file ? "is empty" : "cannot be read"), in.throw_if_any();
    if (in.path.ends_with(".npy")) return read_npy(in, file, layouts);
    NumberTable t = read_csv(in, file);
    name_columns(in, t, layouts);
    return t;
}

}  // namespace crescent::inline subjects
