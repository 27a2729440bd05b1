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
    std::string first(longest_npy_header, '\0');
    file.read(first.data(), static_cast<std::streamsize>(first.size()));
    first.resize(static_cast<std::size_t>(file.gcount()));
    const NpyHeader h = read_npy_header(in.path, first);
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
    const auto at = std::find(columns.begin(), columns.end(), name);
    return at == columns.end() ? -1 : static_cast<int>(at - columns.begin());
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

// ---- The table is a full grid in cos theta and phi: cells if nine of ten samples have exactly the value of their
// cell, otherwise points with linear interpolation, whose error is estimated from the curvature of p.

namespace {

std::vector<double> edges_of(const std::vector<double>& centres, double first, double last) {
    std::vector<double> out = {first};
    for (std::size_t i = 0; i + 1 < centres.size(); ++i) out.push_back(0.5 * (centres[i] + centres[i + 1]));
    out.push_back(last);
    return out;
}

/// The values that differ by more than `tolerance`, in ascending order.
std::vector<double> distinct(std::vector<double> v, double tolerance) {
    std::sort(v.begin(), v.end());
    std::vector<double> out;
    for (double x : v)
        if (out.empty() || x - out.back() > tolerance) out.push_back(x);
    return out;
}

std::size_t cell_of(const std::vector<double>& edges, double v) {
    const auto at = std::upper_bound(edges.begin(), edges.end(), v) - edges.begin() - 1;
    return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(at, 0, static_cast<std::ptrdiff_t>(edges.size()) - 2));
}

std::size_t nearest_of(const std::vector<double>& sorted, double v) {
    const auto at = std::lower_bound(sorted.begin(), sorted.end(), v);
    if (at == sorted.end() || (at != sorted.begin() && v - at[-1] < *at - v))
        return static_cast<std::size_t>(at - sorted.begin()) - 1;
    return static_cast<std::size_t>(at - sorted.begin());
}

double turned(double phi) { return phi < 0 ? phi + 2 * pi : phi; }
double turned(Vec3d w) { return turned(math::atan2(w.y, w.x)); }

}  // namespace

SampleFile::SampleFile(const std::string& samples, const std::string& table) : name_(printable(samples)) {
    read_samples(samples);
    read_table(table);
    cells_ = agrees_as_cells();
    find_bends();
}

void SampleFile::read_samples(const std::string& path) {
    FileDiagnostics in{path, {}};
    const std::vector<std::string> without = {"u1", "u2", "wix", "wiy", "wiz", "pdf"};
    std::vector<std::string> with = without;
    with.emplace_back("f");
    const NumberTable t = read_table_file(in, {without, with});
    if (t.rows() < 1000) {
        in.add(0, 0, fmt::format("{} samples are too few for a check; expected at least 1000", t.rows()));
        in.throw_if_any();
    }
    const int f = t.column("f");
    has_drawn_f_ = f >= 0;
    lines_ = t.lines;
    for (std::size_t r = 0; r < t.rows(); ++r) {
        const auto at = [&](const char* name) { return t.at(r, static_cast<std::size_t>(t.column(name))); };
        u_.push_back({at("u1"), at("u2")});
        for (const char* name : {"u1", "u2"})
            if (!(at(name) >= 0 && at(name) <= 1))
                in.add(t.lines.empty() ? 0 : t.lines[r], static_cast<unsigned>(t.column(name)) + 1,
                    fmt::format("{} is {:g}; expected a number from 0 to 1", name, at(name)));
        Draw d{.wi = {at("wix"), at("wiy"), at("wiz")}, .pdf = at("pdf"), .weight = {}, .f = {}};
        if (f >= 0) d.f = t.at(r, static_cast<std::size_t>(f));
        draws_.push_back(d);
    }
    in.throw_if_any();
}

void SampleFile::read_table(const std::string& path) {
    FileDiagnostics in{path, {}};
    const NumberTable t = read_table_file(in, {{"cos_theta", "phi", "pdf"}, {"wix", "wiy", "wiz", "pdf"}});
    const bool polar = t.column("cos_theta") >= 0;
    std::vector<double> cos, phi, p;
    for (std::size_t r = 0; r < t.rows(); ++r) {
        const auto at = [&](const char* name) { return t.at(r, static_cast<std::size_t>(t.column(name))); };
        cos.push_back(polar ? at("cos_theta") : at("wiz"));
        phi.push_back(polar ? turned(at("phi")) : turned(Vec3d{at("wix"), at("wiy"), 0}));
        p.push_back(at("pdf"));
        if (!(std::fabs(cos.back()) <= 1 + 1e-6) || !(phi.back() >= 0 && phi.back() <= 2 * pi + 1e-6) ||
            !std::isfinite(p.back()))
            in.add(t.lines.empty() ? 0 : t.lines[r], 1, "no direction of the sphere with a finite pdf");
    }
    in.throw_if_any();
    for (double tolerance = 1e-7; rows_.size() * columns_.size() != p.size() && tolerance < 1e-2; tolerance *= 10) {
        rows_ = distinct(cos, tolerance);
        columns_ = distinct(phi, tolerance);
    }
    if (rows_.size() < 2 || columns_.size() < 2 || rows_.size() * columns_.size() != p.size()) {
        in.add(0, 0,
            fmt::format("expected a full grid: {} heights of cos theta and {} angles phi are not {} entries",
                rows_.size(), columns_.size(), p.size()));
        in.throw_if_any();
    }
    row_edges_ = edges_of(rows_, rows_.front() < -1e-6 ? -1 : 0, 1);
    column_edges_ = edges_of(columns_, 0, 2 * pi);
    values_.assign(p.size(), std::nan(""));
    for (std::size_t i = 0; i < p.size(); ++i)
        values_[nearest_of(rows_, cos[i]) * columns_.size() + nearest_of(columns_, phi[i])] = p[i];
    for (double v : values_)
        if (std::isnan(v)) {
            in.add(0, 0, "expected a full grid: a cell is missing and another occurs twice");
            in.throw_if_any();
        }
}

/// Whether nine of ten samples have exactly the value of their cell.
bool SampleFile::agrees_as_cells() const {
    std::size_t drawn = 0, alike = 0;
    for (const Draw& d : draws_) {
        if (!(d.pdf > 0)) continue;
        ++drawn;
        alike += std::fabs(of_cell(d.wi) - d.pdf) <= 1e-4 * d.pdf;
    }
    return 10 * alike >= 9 * drawn;
}

/// Linear interpolation has an error of a quarter of the bend of p where p is smooth, and of all of it at a kink. At
/// the first and the last row the line is extrapolated: the error is twice the bend of the next row, and towards a pole
/// the variation of p around it.
void SampleFile::find_bends() {
    const std::size_t m = rows_.size(), n = columns_.size();
    bent_.assign(values_.size(), 0);
    if (cells_) return;
    const auto p = [&](std::size_t i, std::size_t j) { return values_[i * n + j]; };
    const auto around = [&](std::size_t i) {
        const auto [least, most] = std::minmax_element(&values_[i * n], &values_[i * n] + n);
        return *most - *least;
    };
    cap_below_ = row_edges_.front() == -1 ? around(0) : 0;
    cap_above_ = around(m - 1);
    for (std::size_t i = 0; i < m; ++i)
        for (std::size_t j = 0; j < n; ++j) {
            const std::size_t c = std::clamp<std::size_t>(i, 1, std::max<std::size_t>(m, 3) - 2),
                              west = (j + n - 1) % n, east = (j + 1) % n;
            double along = 0;
            if (m > 2) {
                const double t = (rows_[c] - rows_[c - 1]) / (rows_[c + 1] - rows_[c - 1]);
                along = std::fabs(p(c, j) - (1 - t) * p(c - 1, j) - t * p(c + 1, j));
            }
            bent_[i * n + j] =
                along * (i == 0 || i + 1 == m ? 2 : 1) + std::fabs(p(i, j) - 0.5 * (p(i, west) + p(i, east)));
        }
}

double SampleFile::of_cell(Vec3d w) const {
    return w.z < row_edges_.front()
        ? 0
        : values_[cell_of(row_edges_, w.z) * columns_.size() + cell_of(column_edges_, turned(w))];
}

SampleFile::GridCell SampleFile::cell_at(Vec3d w) const {
    const auto row = std::upper_bound(rows_.begin(), rows_.end(), w.z) - rows_.begin();
    GridCell at{};
    at.i0 =
        static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(row - 1, 0, static_cast<std::ptrdiff_t>(rows_.size()) - 2));
    at.i1 = at.i0 + 1;
    at.s = (w.z - rows_[at.i0]) / (rows_[at.i1] - rows_[at.i0]);
    const double phi = turned(w);
    const auto column =
        static_cast<std::size_t>(std::upper_bound(columns_.begin(), columns_.end(), phi) - columns_.begin());
    at.j1 = column % columns_.size();
    at.j0 = (column + columns_.size() - 1) % columns_.size();
    const double from = columns_[at.j0] - (column == 0 ? 2 * pi : 0),
                 to = columns_[at.j1] + (column == columns_.size() ? 2 * pi : 0);
    at.t = to > from ? (phi - from) / (to - from) : 0;
    return at;
}

double SampleFile::between(const GridCell& at) const {
    const std::size_t n = columns_.size();
    const double low = (1 - at.t) * values_[at.i0 * n + at.j0] + at.t * values_[at.i0 * n + at.j1];
    const double high = (1 - at.t) * values_[at.i1 * n + at.j0] + at.t * values_[at.i1 * n + at.j1];
    return std::max((1 - at.s) * low + at.s * high, std::min({low, high, 0.0}));
}

void SampleFile::pdf(int, std::span<const Pair> at, std::span<double> out) const {
    for (std::size_t i = 0; i < at.size(); ++i) {
        const Vec3d w = at[i].wi;
        out[i] = w.z < row_edges_.front() ? 0 : cells_ ? of_cell(w) : between(cell_at(w));
    }
}

double SampleFile::tabulation_error(Vec3d w) const {
    if (cells_ || w.z < row_edges_.front()) return 0;
    const GridCell at = cell_at(w);
    const std::size_t n = columns_.size();
    const double cap = at.s > 1 ? cap_above_ : at.s < 0 ? cap_below_ : 0;
    return cap +
        std::max(
            {bent_[at.i0 * n + at.j0], bent_[at.i0 * n + at.j1], bent_[at.i1 * n + at.j0], bent_[at.i1 * n + at.j1]});
}

std::string SampleFile::place(std::size_t row) const {
    return row < lines_.size() ? fmt::format("{}:{}", name_, lines_[row]) : fmt::format("{}, row {}", name_, row);
}

}  // namespace crescent
