// Values are sorted and merged into the entries of each axis; the coarsest difference that still gives a full grid
// counts as rounding.
#include "check/sources/density_grid.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace crescent {

namespace {

/// The values that differ by more than `tolerance`, in ascending order.
std::vector<double> distinct(std::vector<double> v, double tolerance) {
    std::sort(v.begin(), v.end());
    std::vector<double> out;
    for (double x : v)
        if (out.empty() || x - out.back() > tolerance) out.push_back(x);
    return out;
}

std::vector<double> edges_of(const std::vector<double>& centres, const GridAxis& axis) {
    const double first_step = centres.size() > 1 ? centres[1] - centres[0] : axis.scale,
                 last_step = centres.size() > 1 ? centres.back() - centres[centres.size() - 2] : axis.scale;
    std::vector<double> out = {std::isfinite(axis.from) ? axis.from : centres.front() - 0.5 * first_step};
    for (std::size_t i = 0; i + 1 < centres.size(); ++i) out.push_back(0.5 * (centres[i] + centres[i + 1]));
    out.push_back(std::isfinite(axis.to) ? axis.to : centres.back() + 0.5 * last_step);
    return out;
}

std::size_t cell_of(const std::vector<double>& edges, double v) {
    const auto cell = std::upper_bound(edges.begin(), edges.end(), v) - edges.begin() - 1;
    return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(cell, 0, static_cast<std::ptrdiff_t>(edges.size()) - 2));
}

std::size_t nearest_of(const std::vector<double>& values, double v) {
    const auto upper = std::lower_bound(values.begin(), values.end(), v);
    if (upper == values.end() || (upper != values.begin() && v - upper[-1] < *upper - v))
        return static_cast<std::size_t>(upper - values.begin()) - 1;
    return static_cast<std::size_t>(upper - values.begin());
}

std::size_t product_of_sizes(const std::vector<std::vector<double>>& entries) {
    std::size_t out = 1;
    for (const std::vector<double>& axis_entries : entries) out *= axis_entries.size();
    return out;
}

}  // namespace

DensityGrid::DensityGrid(std::vector<GridAxis> axes, std::span<const double> rows) : axes_(std::move(axes)) {
    const std::size_t columns = axes_.size() + 1, count = rows.size() / columns;
    entries_.resize(axes_.size());
    for (double tolerance = 1e-7; product_of_sizes(entries_) != count && tolerance < 1e-2; tolerance *= 10)
        for (std::size_t a = 0; a < axes_.size(); ++a) {
            std::vector<double> values;
            for (std::size_t i = 0; i < count; ++i) values.push_back(rows[i * columns + a]);
            entries_[a] = distinct(std::move(values), tolerance * axes_[a].scale);
        }
    std::string sizes;
    bool is_full = count > 0 && product_of_sizes(entries_) == count;
    for (std::size_t a = 0; a < axes_.size(); ++a) {
        is_full = is_full && entries_[a].size() >= axes_[a].fewest_values;
        sizes += fmt::format("{}{} values of {}", sizes.empty() ? "" : " and ", entries_[a].size(), axes_[a].name);
    }
    if (!is_full) throw std::invalid_argument(fmt::format("expected a full grid: {} are not {} entries", sizes, count));
    for (std::size_t a = 0; a < axes_.size(); ++a) {
        const GridAxis& axis = axes_[a];
        const auto expected_count = static_cast<std::size_t>(axis.is_integral ? axis.to - axis.from + 1 : 0);
        if (axis.is_integral && entries_[a].size() != expected_count)
            throw std::invalid_argument(
                fmt::format("expected all {} values of {}, not {}", expected_count, axis.name, entries_[a].size()));
        edges_.push_back(edges_of(entries_[a], axis));
    }
    values_.assign(count, std::nan(""));
    for (std::size_t i = 0; i < count; ++i) {
        std::size_t index = 0;
        for (std::size_t a = 0; a < axes_.size(); ++a)
            index = index * entries_[a].size() + nearest_of(entries_[a], rows[i * columns + a]);
        values_[index] = rows[i * columns + axes_.size()];
    }
    if (std::ranges::any_of(values_, [](double v) { return std::isnan(v); }))
        throw std::invalid_argument("expected a full grid: a cell is missing and another occurs twice");
    spreads_.assign(count, 0);
    find_bends();
}

std::size_t DensityGrid::stride(std::size_t axis) const {
    std::size_t out = 1;
    for (std::size_t a = axis + 1; a < axes_.size(); ++a) out *= entries_[a].size();
    return out;
}

/// How far p at an entry, or next to it at an end, is from a straight line along one axis.
double DensityGrid::bend_along(std::size_t axis, std::size_t index) const {
    const std::vector<double>& x = entries_[axis];
    const std::size_t n = x.size(), step = stride(axis), i = index / step % n;
    const auto p = [&](std::size_t k) { return values_[index - i * step + k * step]; };
    if (axes_[axis].is_integral) return 0;
    if (axes_[axis].is_periodic) return std::fabs(p(i) - 0.5 * (p((i + n - 1) % n) + p((i + 1) % n)));
    if (n < 3) return 0;
    const std::size_t c = std::clamp<std::size_t>(i, 1, n - 2);
    const double t = (x[c] - x[c - 1]) / (x[c + 1] - x[c - 1]);
    return std::fabs(p(c) - (1 - t) * p(c - 1) - t * p(c + 1)) * (i == 0 || i + 1 == n ? 2 : 1);
}

void DensityGrid::find_bends() {
    bends_.assign(values_.size(), 0);
    for (std::size_t i = 0; i < values_.size(); ++i)
        for (std::size_t a = 0; a < axes_.size(); ++a) bends_[i] += bend_along(a, i);
    for (std::size_t i = 0; i < values_.size(); ++i) bends_[i] = std::max(bends_[i], spreads_[i]);
    for (std::size_t a = 0; a + 1 < axes_.size(); ++a) {
        const std::size_t n = entries_[a].size(), ring_size = entries_[a + 1].size(), step = stride(a + 1);
        for (std::size_t i = 0; i < values_.size(); ++i) {
            const std::size_t row = i / stride(a) % n;
            const bool is_last = row + 1 == n;
            if ((row > 0 && !is_last) || !axes_[a].poles[is_last] || i / step % ring_size > 0) continue;
            double least_value = values_[i], largest_value = values_[i];
            for (std::size_t k = 1; k < ring_size; ++k) {
                least_value = std::min(least_value, values_[i + k * step]);
                largest_value = std::max(largest_value, values_[i + k * step]);
            }
            double& variation = variation_at_pole_[a][is_last];
            variation = std::max(variation, largest_value - least_value);
        }
    }
}

bool DensityGrid::contains(std::span<const double> x) const {
    for (std::size_t a = 0; a < axes_.size(); ++a)
        if (!(x[a] >= edges_[a].front() && x[a] <= edges_[a].back())) return false;
    return true;
}

std::size_t DensityGrid::cell_index(std::span<const double> x) const {
    std::size_t index = 0;
    for (std::size_t a = 0; a < axes_.size(); ++a)
        index = index * entries_[a].size() +
            (axes_[a].is_integral ? nearest_of(entries_[a], x[a]) : cell_of(edges_[a], x[a]));
    return index;
}

double DensityGrid::cell_value(std::span<const double> x) const { return values_[cell_index(x)]; }

GridCell DensityGrid::cell(std::size_t index) const {
    GridCell out{.value = values_[index]};
    for (std::size_t a = 0; a < axes_.size(); ++a) {
        const std::size_t i = position(a, index);
        out.entry[a] = entries_[a][i];
        out.low[a] = edges_[a][i];
        out.high[a] = edges_[a][i + 1];
    }
    return out;
}

template <class Each> void DensityGrid::for_each_near(std::size_t index, std::size_t steps, Each&& each) const {
    std::array<std::size_t, most_axes> first{}, sizes{};
    std::size_t count = 1;
    for (std::size_t a = 0; a < axes_.size(); ++a) {
        const std::size_t i = position(a, index), n = entries_[a].size();
        first[a] = i - std::min(i, steps);
        sizes[a] = std::min(i + steps, n - 1) - first[a] + 1;
        count *= sizes[a];
    }
    for (std::size_t k = 0; k < count; ++k) {
        std::size_t remainder = k, neighbour = 0;
        for (std::size_t a = 0; a < axes_.size(); ++a) {
            neighbour += (first[a] + remainder % sizes[a]) * stride(a);
            remainder /= sizes[a];
        }
        each(neighbour);
    }
}

void DensityGrid::replace(std::vector<double> values) {
    values_ = std::move(values);
    spreads_.assign(values_.size(), 0);
    std::vector<std::size_t> unknown_cells;
    for (std::size_t i = 0; i < values_.size(); ++i)
        if (std::isnan(values_[i])) unknown_cells.push_back(i);
    while (!unknown_cells.empty() && unknown_cells.size() < values_.size()) {
        std::vector<std::size_t> later_cells;
        std::vector<std::pair<std::size_t, double>> means;
        for (std::size_t i : unknown_cells) {
            double sum = 0, least_value = INFINITY, largest_value = -INFINITY, error = 0;
            std::size_t neighbour_count = 0;
            for_each_near(i, 1, [&](std::size_t neighbour) {
                if (std::isnan(values_[neighbour])) return;
                sum += values_[neighbour];
                ++neighbour_count;
            });
            if (neighbour_count == 0) {
                later_cells.push_back(i);
                continue;
            }
            for_each_near(i, 2, [&](std::size_t neighbour) {
                if (std::isnan(values_[neighbour])) return;
                least_value = std::min(least_value, values_[neighbour]);
                largest_value = std::max(largest_value, values_[neighbour]);
                error = std::max(error, spreads_[neighbour]);
            });
            spreads_[i] = largest_value - least_value + error;
            means.emplace_back(i, sum / static_cast<double>(neighbour_count));
        }
        if (means.empty()) break;
        for (const auto& [i, value] : means) values_[i] = value;
        unknown_cells = std::move(later_cells);
    }
    for (double& value : values_)
        if (std::isnan(value)) value = 0;
    find_bends();
}

DensityGrid::Interval DensityGrid::interval_at(std::size_t axis, double x) const {
    const std::vector<double>& entries = entries_[axis];
    const std::size_t n = entries.size();
    if (n == 1) return {0, 0, 0};
    const auto upper = std::upper_bound(entries.begin(), entries.end(), x) - entries.begin();
    if (!axes_[axis].is_periodic) {
        const auto low =
            static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(upper - 1, 0, static_cast<std::ptrdiff_t>(n) - 2));
        return {low, low + 1, (x - entries[low]) / (entries[low + 1] - entries[low])};
    }
    const double period = axes_[axis].to - axes_[axis].from;
    const auto next = static_cast<std::size_t>(upper);
    Interval out{(next + n - 1) % n, next % n, 0};
    const double from = entries[out.low] - (next == 0 ? period : 0), to = entries[out.high] + (next == n ? period : 0);
    if (to > from) out.share = (x - from) / (to - from);
    return out;
}

DensityGrid::Intervals DensityGrid::intervals_at(std::span<const double> x) const {
    Intervals out{};
    for (std::size_t a = 0; a < axes_.size(); ++a) out[a] = interval_at(a, x[a]);
    return out;
}

template <class Each> void DensityGrid::for_each_corner(const Intervals& intervals, Each&& each) const {
    const std::size_t corners = std::size_t{1} << axes_.size();
    for (std::size_t corner = 0; corner < corners; ++corner) {
        std::size_t index = 0;
        for (std::size_t a = 0; a < axes_.size(); ++a) {
            const bool is_high = corner >> (axes_.size() - 1 - a) & 1;
            index = index * entries_[a].size() + (is_high ? intervals[a].high : intervals[a].low);
        }
        each(index);
    }
}

double DensityGrid::value_between(std::span<const double> x) const {
    const Intervals intervals = intervals_at(x);
    std::array<double, 1 << most_axes> values{};
    std::size_t count = 0;
    for_each_corner(intervals, [&](std::size_t index) { values[count++] = values_[index]; });
    for (std::size_t a = axes_.size(); a-- > 0; count /= 2)
        for (std::size_t i = 0; i < count / 2; ++i) {
            const double low = values[2 * i], high = values[2 * i + 1];
            values[i] =
                std::max((1 - intervals[a].share) * low + intervals[a].share * high, std::min({low, high, 0.0}));
        }
    return values[0];
}

double DensityGrid::error_between(std::span<const double> x) const {
    const Intervals intervals = intervals_at(x);
    double out = 0;
    for_each_corner(intervals, [&](std::size_t index) { out = std::max(out, bends_[index]); });
    for (std::size_t a = 0; a < axes_.size(); ++a)
        out += intervals[a].share > 1 ? variation_at_pole_[a][1]
            : intervals[a].share < 0  ? variation_at_pole_[a][0]
                                      : 0;
    return out;
}

}  // namespace crescent
