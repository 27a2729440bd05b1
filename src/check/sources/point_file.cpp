// The grid is read as cells, with constant p and the entries at their centres, if the pdf of the draws agrees with
// that; otherwise p is linear between its points, and the tests allow for the error of that.
#include "check/sources/point_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "base/text.h"
#include "check/estimate/stream.h"
#include "check/sources/density_grid.h"
#include "check/sources/sample_file.h"
#include "math/functions.h"

namespace crescent {

namespace {

using Point = std::array<double, Domain::most_coordinates>;
using GridPoint = std::array<double, DensityGrid::most_axes>;
constexpr double edge_slack = 1e-6;  // of a coordinate, by single precision

bool is_direction(const DomainPart& part) {
    return part.kind == DomainPart::Kind::sphere || part.kind == DomainPart::Kind::hemisphere;
}

/// Whether the boundary of a part cuts cells of a grid of its coordinates.
bool cuts_cells(const DomainPart& part) {
    return part.kind == DomainPart::Kind::disk || part.kind == DomainPart::Kind::triangle;
}

/// The share of a cell that is inside a disk or a triangle.
double share_inside(const DomainPart& part, std::span<const double> low, std::span<const double> high) {
    constexpr int steps = 4096;  // an error below 1e-5 of the cell, from the vertical tangent of the disk
    const bool is_disk = part.kind == DomainPart::Kind::disk;
    const double from = std::max(low[0], is_disk ? -1.0 : 0.0), to = std::min(high[0], 1.0);
    double sum = 0;
    for (int i = 0; i < steps && to > from; ++i) {
        const double x = from + (to - from) * (i + 0.5) / steps;
        const double top = is_disk ? std::sqrt(1 - x * x) : 1 - x, bottom = is_disk ? -top : 0;
        sum += std::max(0.0, std::min(top, high[1]) - std::max(bottom, low[1]));
    }
    return std::max(0.0, to - from) * sum / steps / ((high[0] - low[0]) * (high[1] - low[1]));
}

/// The columns of the table but the last, and what they may contain.
std::vector<GridAxis> axes_of(const Domain& domain) {
    std::vector<GridAxis> out;
    std::size_t coordinate = 1, directions = 0;
    for (const DomainPart& part : domain.parts()) {
        const bool is_sphere = part.kind == DomainPart::Kind::sphere;
        if (is_direction(part)) {
            for (GridAxis& axis : direction_axes(is_sphere, ++directions > 1 ? std::to_string(directions) : ""))
                out.push_back(std::move(axis));
        } else
            for (std::size_t k = 0; k < part.coordinates(); ++k) {
                GridAxis axis{.name = fmt::format("x{}", coordinate + k)};
                if (part.kind == DomainPart::Kind::disk) axis.from = -1;
                if (part.kind == DomainPart::Kind::line) {
                    axis.from = part.from;
                    axis.to = part.to;
                }
                if (part.kind == DomainPart::Kind::set) {
                    axis.to = part.count - 1.0;
                    axis.is_integral = true;
                }
                out.push_back(std::move(axis));
            }
        coordinate += part.coordinates();
    }
    return out;
}

class PointFile : public RecordedSampler {
public:
    PointFile(const Domain& domain, const std::string& samples, const std::string& table)
        : name_(printable(samples)), chart_(std::make_shared<DomainChart>(domain)) {
        const NumberTable draws = read_rows(samples);
        read_table(table);
        take_draws(samples, draws);
        correct_boundary();
        has_cells_ = agrees_as_cells();
    }
    std::string name() const override { return name_; }
    Traits traits() const override {
        Traits out;
        out.numbers = numbers_ + static_cast<int>(chart_->spreads());
        out.wo = Traits::WoDomain::none;
        out.u_bits = 53;
        out.domain = chart_;
        return out;
    }
    bool has_drawn_f() const override { return has_drawn_f_; }
    void pdf(int, std::span<const Pair> pairs, std::span<double> out) const override {
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            double factor = 0;
            const GridPoint x = grid_point(pairs[i].wi, factor);
            out[i] = !(factor > 0) || !grid_.contains(x)
                ? 0
                : factor * (has_cells_ ? grid_.cell_value(x) : grid_.value_between(x));
        }
    }
    double tabulation_error(Vec3d w) const override {
        double factor = 0;
        const GridPoint x = grid_point(w, factor);
        if (!(factor > 0) || !grid_.contains(x)) return 0;
        return factor * (has_cells_ ? grid_.error_of_cell(x) : grid_.error_between(x));
    }
    std::string place(std::size_t row) const override { return place_of_row(name_, lines_, row); }

private:
    std::string name_;
    std::shared_ptr<DomainChart> chart_;
    int numbers_ = 0;  // random numbers of a row
    bool has_drawn_f_ = false, has_cells_ = true;
    std::vector<unsigned> lines_;
    std::vector<double> points_, densities_;  // of the draws, by row
    DensityGrid grid_;

    const Domain& domain() const { return chart_->domain(); }
    std::size_t coordinates() const { return domain().coordinates(); }
    std::span<const double> point_of_row(std::size_t row) const {
        return std::span(points_).subspan(row * coordinates(), coordinates());
    }

    GridPoint grid_point(std::span<const double> point) const {
        GridPoint out{};
        std::size_t axis = 0;
        for (const DomainPart& part : domain().parts()) {
            if (is_direction(part)) {
                const double phi = math::atan2(point[1], point[0]);
                out[axis] = point[2];
                out[axis + 1] = phi < 0 ? phi + 2 * pi : phi;
            } else std::copy_n(point.begin(), part.coordinates(), out.begin() + static_cast<std::ptrdiff_t>(axis));
            axis += part.dimensions();
            point = point.subspan(part.coordinates());
        }
        return out;
    }
    GridPoint grid_point(Vec3d w, double& factor) const {
        Point x{};
        const std::span<double> point = std::span(x).first(coordinates());
        factor = chart_->point(w, point);
        return grid_point(point);
    }

    NumberTable read_rows(const std::string& path) const {
        FileDiagnostics in{path, {}};
        std::vector<std::string> columns;
        for (std::size_t k = 0; k < coordinates(); ++k) columns.push_back(fmt::format("x{}", k + 1));
        columns.emplace_back("pdf");
        std::vector<std::vector<std::string>> layouts = {columns, columns};
        layouts[1].insert(layouts[1].begin(), {"u1", "u2"});
        for (std::size_t k = 0; k < 2; ++k) {
            layouts.push_back(layouts[k]);
            layouts.back().emplace_back("f");
        }
        return read_draws(in, layouts);
    }

    void take_draws(const std::string& path, const NumberTable& t) {
        FileDiagnostics in{path, {}};
        has_drawn_f_ = t.column("f") >= 0;
        numbers_ = t.column("u1") >= 0 ? 2 : 0;
        lines_ = t.lines;
        std::vector<std::size_t> columns;
        for (std::size_t k = 0; k < coordinates(); ++k)
            columns.push_back(static_cast<std::size_t>(t.column(fmt::format("x{}", k + 1))));
        for (std::size_t r = 0; r < t.rows(); ++r) {
            for (std::size_t column : columns) points_.push_back(t.at(r, column));
            densities_.push_back(t.value(r, "pdf"));
            check_row(in, t, r);
        }
        in.throw_if_any();
        chart_->fit(pilot_points());
        const std::vector<PrimarySample> spreads = spreading_numbers(t.rows());
        for (std::size_t r = 0; r < t.rows(); ++r) {
            PrimarySample u = spreads[r];
            if (numbers_ > 0) {
                u.x = t.value(r, "u1");
                u.y = t.value(r, "u2");
            }
            u_.push_back(u);
            draws_.push_back(draw_of_point(*chart_, point_of_row(r), densities_[r], u, numbers_));
            if (has_drawn_f_) draws_.back().f = t.value(r, "f") * factor_of(draws_.back());
        }
    }

    /// The rows that test nothing, see check::Source::draw(): one of eight.
    std::vector<double> pilot_points() const {
        std::vector<double> out;
        for (std::size_t r = 0; r < densities_.size(); r += 8)
            if (densities_[r] > 0) out.insert(out.end(), point_of_row(r).begin(), point_of_row(r).end());
        return out;
    }

    /// Random numbers of a row, and that an infinite line's table reaches as far as the draws.
    void check_row(FileDiagnostics& in, const NumberTable& t, std::size_t r) const {
        check_numbers(in, t, r);
        if (!domain().is_infinite() || !(densities_[r] > 0) || !domain().fault(point_of_row(r)).empty()) return;
        const GridPoint x = grid_point(point_of_row(r));
        std::size_t axis = 0;
        for (const DomainPart& part : domain().parts()) {
            if (part.is_infinite() && !(x[axis] >= grid_.first_edge(axis) && x[axis] <= grid_.last_edge(axis)))
                in.add(t.line(r), 1,
                    fmt::format("{} is outside the table of the density, which is from {:g} to {:g}",
                        domain().text(point_of_row(r)), grid_.first_edge(axis), grid_.last_edge(axis)));
            axis += part.dimensions();
        }
    }

    /// Those that spread a point, after the random numbers of its row.
    std::vector<PrimarySample> spreading_numbers(std::size_t rows) const {
        constexpr check::StreamKey key{.seed = 0x66696c65, .purpose = check::Purpose::pilot};
        const int count = numbers_ + static_cast<int>(chart_->spreads());
        std::vector<PrimarySample> out(rows);
        for (std::size_t r = 0; r < rows; ++r)
            out[r] =
                check::numbers_at(key, static_cast<std::uint32_t>(r), std::max(count, 1), check::Resolution::standard);
        return out;
    }

    /// From a density over the domain to one over solid angle, at a draw.
    double factor_of(const Draw& d) const {
        Point x{};
        return d.pdf > 0 && std::isfinite(d.wi.x) ? chart_->point(d.wi, std::span(x).first(coordinates())) : 1;
    }

    void read_table(const std::string& path) {
        FileDiagnostics in{path, {}};
        std::vector<GridAxis> axes = axes_of(domain());
        std::vector<std::string> columns;
        for (const GridAxis& axis : axes) columns.push_back(axis.name);
        columns.emplace_back("pdf");
        const NumberTable t = read_table_file(in, {columns});
        std::vector<double> rows;
        for (std::size_t r = 0; r < t.rows(); ++r) {
            for (std::size_t k = 0; k < columns.size(); ++k) {
                const auto column = static_cast<std::size_t>(t.column(columns[k]));
                const bool is_axis = k < axes.size();
                double x = t.at(r, column);
                if (is_axis && axes[k].is_periodic && x < 0) x += axes[k].to;
                const double slack = is_axis && std::isfinite(axes[k].to - axes[k].from) ? edge_slack * axes[k].to : 0;
                if (is_axis && !(std::isfinite(x) && x >= axes[k].from - slack && x <= axes[k].to + slack))
                    in.add(t.line(r), static_cast<unsigned>(column) + 1,
                        fmt::format("{} is {:g}; expected a number from {:g} to {:g}", columns[k], x, axes[k].from,
                            axes[k].to));
                if (is_axis && axes[k].is_integral && x != std::floor(x))
                    in.add(t.line(r), static_cast<unsigned>(column) + 1,
                        fmt::format("{} is {:g}; expected an integer, an entry of the set", columns[k], x));
                if (!is_axis && !std::isfinite(x) && !is_beyond(std::span(rows).last(axes.size()))) {
                    in.add(
                        t.line(r), static_cast<unsigned>(column) + 1, fmt::format("pdf is {:g}; expected a number", x));
                }
                rows.push_back(is_axis || std::isfinite(x) ? x : 0);
            }
        }
        in.throw_if_any();
        set_scales(axes, rows);
        grid_ = grid_of(in, axes, rows);
        check_coverage(in, t, axes, grid_, rows);
    }

    /// Whether an entry is on or beyond the curved or slanted boundary of a part, where its value states no p.
    bool is_beyond(std::span<const double> entry) const {
        std::size_t axis = 0;
        for (const DomainPart& part : domain().parts()) {
            const std::span<const double> x = entry.subspan(axis, part.dimensions());
            if (part.kind == DomainPart::Kind::disk && x[0] * x[0] + x[1] * x[1] > 1 - edge_slack) return true;
            if (part.kind == DomainPart::Kind::triangle && x[0] + x[1] > 1 - edge_slack) return true;
            axis += part.dimensions();
        }
        return false;
    }

    double share_inside_cell(const GridCell& cell) const {
        double out = 1;
        std::size_t axis = 0;
        for (const DomainPart& part : domain().parts()) {
            if (cuts_cells(part))
                out *= share_inside(part, std::span(cell.low).subspan(axis, 2), std::span(cell.high).subspan(axis, 2));
            axis += part.dimensions();
        }
        return out;
    }

    /// Cells that the boundary cuts hold p of the part inside. A table may have the average over the whole cell there,
    /// as a histogram has: the pdf of the draws tells. An entry of 0 beyond the boundary is unknown.
    void correct_boundary() {
        if (std::ranges::none_of(domain().parts(), cuts_cells)) return;
        constexpr double least_share = 0.01;  // below, the share itself has an error of 0.1 %
        std::vector<double> written_values(grid_.size()), average_values(grid_.size()), shares(grid_.size());
        for (std::size_t i = 0; i < grid_.size(); ++i) {
            const GridCell cell = grid_.cell(i);
            shares[i] = share_inside_cell(cell);
            const bool is_unknown = cell.value == 0 && is_beyond(cell.entry);
            written_values[i] = is_unknown ? std::nan("") : cell.value;
            average_values[i] = shares[i] > least_share ? cell.value / shares[i] : std::nan("");
        }
        double written_error = 0, average_error = 0;
        for (std::size_t r = 0; r < densities_.size(); ++r) {
            if (!(densities_[r] > 0) || !domain().fault(point_of_row(r)).empty()) continue;
            const std::size_t i = grid_.cell_index(grid_point(point_of_row(r)));
            if (!(shares[i] < 1 - 1e-4) || std::isnan(written_values[i])) continue;
            written_error += std::fabs(written_values[i] - densities_[r]);
            average_error += std::fabs(average_values[i] - densities_[r]);
        }
        grid_.replace(average_error < written_error ? average_values : written_values);
    }

    /// Values of a line have any size.
    void set_scales(std::vector<GridAxis>& axes, const std::vector<double>& rows) const {
        std::size_t axis = 0;
        for (const DomainPart& part : domain().parts()) {
            if (part.kind == DomainPart::Kind::line) {
                double low = rows[axis], high = rows[axis];
                for (std::size_t i = axis; i < rows.size(); i += axes.size() + 1) {
                    low = std::min(low, rows[i]);
                    high = std::max(high, rows[i]);
                }
                axes[axis].scale = high > low ? high - low : std::max(std::fabs(low), 1e-300);
            }
            axis += part.dimensions();
        }
    }

    bool agrees_as_cells() const {
        CellAgreement out;
        for (std::size_t r = 0; r < densities_.size(); ++r)
            if (densities_[r] > 0 && domain().fault(point_of_row(r)).empty())
                out.add(grid_.cell_value(grid_point(point_of_row(r))), densities_[r]);
        return out.holds();
    }
};

}  // namespace

std::shared_ptr<const SamplerAdapter> read_point_file(
    const Domain& domain, const std::string& samples, const std::string& table) {
    return std::make_shared<PointFile>(domain, samples, table);
}

}  // namespace crescent
