// Reads CSV with a header of column names in any order, and two-dimensional NPY arrays of floats by their number of
// columns. Numbers that overflow become infinite, those that underflow become 0. Every mistake is reported with line
// and column.
#include "check/sources/sample_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <fstream>

#include "base/input.h"
#include "base/npy.h"
#include "base/text.h"
#include "check/sources/pipe_io.h"
#include "math/functions.h"
#include "math/simd/scalar.h"

namespace crescent {

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
    constexpr std::size_t longest_line = 65536;
    for (unsigned line = 1; read_line(file, text, longest_line); ++line) {
        if (line == 1 && text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);  // a byte order mark
        if (trimmed(text).empty()) continue;
        if (t.columns.empty()) {
            cells_of(text, [&](std::string_view cell, unsigned) { t.columns.emplace_back(cell); });
            continue;
        }
        const std::size_t old_size = t.values.size();
        cells_of(
            text, [&](std::string_view cell, unsigned column) { t.values.push_back(number(in, cell, line, column)); });
        const std::size_t count = t.values.size() - old_size;
        if (count != t.columns.size()) {
            in.add(line, 1, fmt::format("expected {} values, as the header has, not {}", t.columns.size(), count));
            t.values.resize(old_size);
        } else {
            t.lines.push_back(line);
        }
    }
    if (text.size() > longest_line)
        in.add(static_cast<unsigned>(t.lines.size()) + 2, 1,
            fmt::format("expected lines of at most {} bytes, found a longer one", longest_line));
    else if (t.columns.empty()) in.add(1, 1, "the file is empty; expected a header line");
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
    std::string header_text(longest_npy_header, '\0');
    file.read(header_text.data(), static_cast<std::streamsize>(header_text.size()));
    header_text.resize(static_cast<std::size_t>(file.gcount()));
    const NpyHeader h = read_npy_header(in.path, header_text);
    const auto reject = [&](const std::string& message) {
        in.add(0, 0, message);
        in.throw_if_any();
    };
    if (h.shape.size() != 2)
        reject(fmt::format("expected a two-dimensional array, not one of {} dimensions", h.shape.size()));
    const std::size_t rows = h.shape[0], columns = h.shape[1];
    NumberTable t;
    std::string expected;
    for (const auto& layout : layouts) {
        if (layout.size() == columns) t.columns = layout;
        expected += fmt::format("{}{} ({})", expected.empty() ? "" : " or ", layout.size(), fmt::join(layout, ","));
    }
    if (t.columns.empty()) reject(fmt::format("expected {} columns, not {}", expected, columns));
    file.clear();
    file.seekg(0, std::ios::end);
    const std::size_t bytes = static_cast<std::size_t>(file.tellg()) - h.end;
    if (bytes / h.bytes / columns < rows)
        reject(fmt::format("the file ends in row {} of {}", bytes / h.bytes / columns + 1, rows));
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
    const auto match = std::find(columns.begin(), columns.end(), name);
    return match == columns.end() ? -1 : static_cast<int>(match - columns.begin());
}

NumberTable read_table_file(FileDiagnostics& in, const std::vector<std::vector<std::string>>& layouts) {
    if (is_named_pipe(in.path)) {
        in.add(0, 0, "is a named pipe; expected a regular file");
        in.throw_if_any();
    }
    std::ifstream file(in.path, std::ios::binary);
    if (!file || file.peek() == std::ifstream::traits_type::eof()) {
        in.add(0, 0, file ? "is empty" : "cannot be read");
        in.throw_if_any();
    }
    if (in.path.ends_with(".npy")) return read_npy(in, file, layouts);
    NumberTable t = read_csv(in, file);
    name_columns(in, t, layouts);
    return t;
}

NumberTable read_draws(FileDiagnostics& in, const std::vector<std::vector<std::string>>& layouts) {
    constexpr std::size_t fewest_rows = 1000;
    NumberTable out = read_table_file(in, layouts);
    if (out.rows() < fewest_rows) {
        in.add(0, 0, fmt::format("{} samples are too few for a check; expected at least {}", out.rows(), fewest_rows));
        in.throw_if_any();
    }
    return out;
}

void check_numbers(FileDiagnostics& in, const NumberTable& draws, std::size_t row) {
    for (const char* name : {"u1", "u2"}) {
        const int column = draws.column(name);
        if (column < 0) continue;
        const double u = draws.at(row, static_cast<std::size_t>(column));
        if (!(u >= 0 && u <= 1))
            in.add(draws.line(row), static_cast<unsigned>(column) + 1,
                fmt::format("{} is {:g}; expected a number from 0 to 1", name, u));
    }
}

DensityGrid grid_of(FileDiagnostics& in, std::vector<GridAxis> axes, std::span<const double> rows) {
    try {
        return {std::move(axes), rows};
    } catch (const std::invalid_argument& e) {
        in.add(0, 0, e.what());
        throw InputError(in.diagnostics);
    }
}

void check_coverage(FileDiagnostics& in, const NumberTable& table, std::span<const GridAxis> axes,
    const DensityGrid& grid, std::span<const double> rows) {
    constexpr double slack = 1 + 1e-6;  // of a step, by single precision
    for (std::size_t a = 0; a < axes.size(); ++a) {
        const GridAxis& axis = axes[a];
        const std::span<const double> x = grid.entries(a);
        if (axis.is_integral || x.size() < 2) continue;  // one entry: p does not depend on this coordinate
        const auto line = [&](double value) {            // of the first row of that entry
            for (std::size_t r = 0; r < table.rows(); ++r)
                if (std::fabs(rows[r * (axes.size() + 1) + a] - value) <= 1e-6 * axis.scale) return table.line(r);
            return 0U;
        };
        const auto refuse = [&](double value, const std::string& end) {
            in.add(line(value), 1,
                fmt::format("the entries of {0} are from {1:.6g} to {2:.6g}; expected a table over all of "
                            "[{3:.6g}, {4:.6g}]: p {5} is not known. Where nothing is drawn, write entries of 0",
                    axis.name, x.front(), x.back(), axis.from, axis.to, end));
        };
        if (axis.is_periodic) {
            double step = 0;
            for (std::size_t i = 1; i < x.size(); ++i) step = std::max(step, x[i] - x[i - 1]);
            if (x.front() + (axis.to - axis.from) - x.back() > 2 * step * slack)
                refuse(x.back(), fmt::format("between {:.6g} and {:.6g}", x.back(), x.front() + axis.to - axis.from));
            continue;
        }
        if (x.front() - axis.from > (x[1] - x[0]) * slack && std::isfinite(axis.from))
            refuse(x.front(), fmt::format("below {:.6g}", x.front()));
        if (axis.to - x.back() > (x[x.size() - 1] - x[x.size() - 2]) * slack && std::isfinite(axis.to))
            refuse(x.back(), fmt::format("above {:.6g}", x.back()));
    }
    in.throw_if_any();
}

std::array<GridAxis, 2> direction_axes(bool is_sphere, const std::string& number) {
    return {
        {{.name = "cos_theta" + number, .from = is_sphere ? -1.0 : 0.0, .poles = {is_sphere, true}, .fewest_values = 2},
            {.name = "phi" + number, .to = 2 * pi, .is_periodic = true, .fewest_values = 2}}};
}

std::string place_of_row(const std::string& name, std::span<const unsigned> lines, std::size_t row) {
    return row < lines.size() ? fmt::format("{}:{}", name, lines[row]) : fmt::format("{}, row {}", name, row);
}

// ---- The table is a full grid in cos theta and phi: cells if nine of ten samples have exactly the value of their
// cell, otherwise points with linear interpolation.

namespace {

double azimuth_of(double phi) { return phi < 0 ? phi + 2 * pi : phi; }
double azimuth_of(Vec3d w) { return azimuth_of(math::atan2(w.y, w.x)); }

}  // namespace

SampleFile::SampleFile(const std::string& samples, const std::string& table) : name_(printable(samples)) {
    read_samples(samples);
    read_table(table);
    has_cells_ = agrees_as_cells();
}

void SampleFile::read_samples(const std::string& path) {
    FileDiagnostics in{path, {}};
    const std::vector<std::string> columns = {"u1", "u2", "wix", "wiy", "wiz", "pdf"};
    std::vector<std::string> f_columns = columns;
    f_columns.emplace_back("f");
    const NumberTable t = read_draws(in, {columns, f_columns});
    has_drawn_f_ = t.column("f") >= 0;
    lines_ = t.lines;
    for (std::size_t r = 0; r < t.rows(); ++r) {
        u_.push_back({t.value(r, "u1"), t.value(r, "u2")});
        check_numbers(in, t, r);
        Draw d{.wi = {t.value(r, "wix"), t.value(r, "wiy"), t.value(r, "wiz")}, .pdf = t.value(r, "pdf")};
        if (has_drawn_f_) d.f = t.value(r, "f");
        draws_.push_back(d);
    }
    in.throw_if_any();
}

void SampleFile::read_table(const std::string& path) {
    FileDiagnostics in{path, {}};
    const NumberTable t = read_table_file(in, {{"cos_theta", "phi", "pdf"}, {"wix", "wiy", "wiz", "pdf"}});
    const bool is_polar = t.column("cos_theta") >= 0;
    std::vector<double> rows;
    double lowest = 1;
    for (std::size_t r = 0; r < t.rows(); ++r) {
        const auto value_of = [&](const char* name) { return t.value(r, name); };
        const double cos = is_polar ? value_of("cos_theta") : value_of("wiz"), p = value_of("pdf");
        const double phi =
            is_polar ? azimuth_of(value_of("phi")) : azimuth_of(Vec3d{value_of("wix"), value_of("wiy"), 0});
        rows.insert(rows.end(), {cos, phi, p});
        lowest = std::min(lowest, cos);
        if (!(std::fabs(cos) <= 1 + 1e-6) || !(phi >= 0 && phi <= 2 * pi + 1e-6) || !std::isfinite(p))
            in.add(t.line(r), 1, "no direction of the sphere with a finite pdf");
    }
    in.throw_if_any();
    const bool is_sphere = lowest < -1e-6;
    floor_ = is_sphere ? -1 : 0;
    const std::array<GridAxis, 2> axes = direction_axes(is_sphere);
    grid_ = grid_of(in, {axes.begin(), axes.end()}, rows);
    check_coverage(in, t, axes, grid_, rows);
}

bool SampleFile::agrees_as_cells() const {
    CellAgreement out;
    for (const Draw& d : draws_)
        if (d.pdf > 0) out.add(cell_value(d.wi), d.pdf);
    return out.holds();
}

double SampleFile::cell_value(Vec3d w) const {
    return w.z < floor_ ? 0 : grid_.cell_value(std::array{w.z, azimuth_of(w)});
}

void SampleFile::pdf(int, std::span<const Pair> pairs, std::span<double> out) const {
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const Vec3d w = pairs[i].wi;
        const std::array<double, 2> place = {w.z, azimuth_of(w)};
        out[i] = w.z < floor_ ? 0 : has_cells_ ? grid_.cell_value(place) : grid_.value_between(place);
    }
}

double SampleFile::tabulation_error(Vec3d w) const {
    const std::array<double, 2> place = {w.z, azimuth_of(w)};
    return has_cells_ || w.z < floor_ ? 0 : grid_.error_between(place);
}

std::string SampleFile::place(std::size_t row) const { return place_of_row(name_, lines_, row); }

}  // namespace crescent
