// CSV with a header by its columns' names, in any order; NPY of floats, two-dimensional, by its
// number of columns. Numbers that overflow are infinite, those that underflow are 0. Every mistake is named with line
// and column.
#include "subjects/table_file.h"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <fstream>

#include "base/npy.h"
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

NumberTable read_npy(FileDiagnostics& in, std::istream& file, const std::vector<std::vector<std::string>>& layouts) {
    std::string first(longest_npy_header, '\0');
    file.read(first.data(), static_cast<std::streamsize>(first.size()));
    first.resize(static_cast<std::size_t>(file.gcount()));
    const NpyHeader h = read_npy_header(in.path, first);
    const auto refuse = [&](const std::string& message) { in.add(0, 0, message), in.throw_if_any(); };
    if (h.shape.size() != 2)
        refuse(fmt::format("expected a two-dimensional array, not one of {} dimensions", h.shape.size()));
    const std::size_t rows = h.shape[0], columns = h.shape[1];
    NumberTable t;
    std::string expected;
    for (const auto& layout : layouts) {
        if (layout.size() == columns) t.columns = layout;
        expected += fmt::format("{}{} ({})", expected.empty() ? "" : " or ", layout.size(), fmt::join(layout, ","));
    }
    if (t.columns.empty()) refuse(fmt::format("expected {} columns, not {}", expected, columns));
    file.clear();
    file.seekg(0, std::ios::end);
    const std::size_t bytes = static_cast<std::size_t>(file.tellg()) - h.end;
    if (bytes / h.bytes / columns < rows)
        refuse(fmt::format("the file ends in row {} of {}", bytes / h.bytes / columns + 1, rows));
    file.seekg(static_cast<std::streamoff>(h.end));
    std::vector<char> raw(rows * columns * h.bytes);
    file.read(raw.data(), static_cast<std::streamsize>(raw.size()));
    t.values.resize(rows * columns);
    for (std::size_t r = 0; r < rows; ++r)
        for (std::size_t c = 0; c < columns; ++c)
            t.values[r * columns + c] = npy_number(h, &raw[h.bytes * (h.by_column ? c * rows + r : r * columns + c)]);
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
