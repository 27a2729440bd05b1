// The table is a full grid in cos theta and phi: cells where nine of ten samples carry their cell's very value, else
// points with straight lines between, whose error is told by how much p bends.
#include "subjects/samples.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/text.h"
#include "math/functions.h"
#include "math/spherical.h"
#include "simd/scalar.h"
#include "subjects/table_file.h"

namespace crescent::inline subjects {

namespace {

std::vector<double> edges_of(const std::vector<double>& centres, double first, double last) {
    std::vector<double> out = {first};
    for (std::size_t i = 0; i + 1 < centres.size(); ++i) out.push_back(0.5 * (centres[i] + centres[i + 1]));
    out.push_back(last);
    return out;
}

/// The values that differ by more than `tolerance`, ascending.
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
    if (t.rows() < 1000)
        in.add(0, 0, fmt::format("{} samples are too few to judge; expected 1000 at least", t.rows())),
            in.throw_if_any();
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
        Draw d{{at("wix"), at("wiy"), at("wiz")}, at("pdf"), {}, {}};
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
    if (rows_.size() < 2 || columns_.size() < 2 || rows_.size() * columns_.size() != p.size())
        in.add(0, 0,
            fmt::format("expected a full grid: {} heights of cos theta and {} angles phi are not {} entries",
                rows_.size(), columns_.size(), p.size())),
            in.throw_if_any();
    row_edges_ = edges_of(rows_, rows_.front() < -1e-6 ? -1 : 0, 1);
    column_edges_ = edges_of(columns_, 0, 2 * pi);
    values_.assign(p.size(), std::nan(""));
    for (std::size_t i = 0; i < p.size(); ++i)
        values_[nearest_of(rows_, cos[i]) * columns_.size() + nearest_of(columns_, phi[i])] = p[i];
    for (double v : values_)
        if (std::isnan(v))
            in.add(0, 0, "expected a full grid: a cell is missing and another stands twice"), in.throw_if_any();
}

/// Nine of ten samples carry the very value of their cell.
bool SampleFile::agrees_as_cells() const {
    std::size_t drawn = 0, alike = 0;
    for (const Draw& d : draws_) {
        if (!(d.pdf > 0)) continue;
        ++drawn;
        alike += std::fabs(of_cell(d.wi) - d.pdf) <= 1e-4 * d.pdf;
    }
    return 10 * alike >= 9 * drawn;
}

/// A straight line from point to point is off by a quarter of what p bends by where p is smooth, and by all of it at a
/// kink. At the first and the last row the line is prolonged: twice what it bends by next to it, and where a pole lies
/// beyond, what p differs by around it.
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

}  // namespace crescent::inline subjects
