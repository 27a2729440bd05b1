// A density that is known at the entries of a full grid: constant in the cells around them, or linear between them.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

namespace crescent {

/// One coordinate of a grid.
struct GridAxis {
    std::string name;             // of its column
    double from = 0, to = 1;      // the ends of the domain; either may be infinite: then the outer cells are symmetric
    double scale = 1;             // of its values, for what counts as equal
    bool is_periodic = false;     // `to` is the same place as `from`
    std::array<bool, 2> poles{};  // whether the next axis goes around the first and the last end
    bool is_integral = false;     // has all integers from `from` to `to`
    std::size_t fewest_values = 1;  // distinct values
};

/// An entry of a grid with the cell around it.
struct GridCell {
    std::array<double, 4> entry{}, low{}, high{};  // by axis
    double value = 0;
};

/// Linear interpolation has an error of a quarter of the bend of p where p is smooth, and of all of it at a kink. At
/// the first and the last entry the line is extrapolated: the error is twice the bend of the next entry, and towards a
/// pole the variation of p around it.
class DensityGrid {
public:
    static constexpr std::size_t most_axes = 4;

    DensityGrid() = default;
    /// rows: a coordinate for each axis, then p. Throws std::invalid_argument if they are no full grid.
    DensityGrid(std::vector<GridAxis> axes, std::span<const double> rows);

    /// p of the cell; 0 outside the grid.
    double cell_value(std::span<const double> x) const;
    /// p between the entries.
    double value_between(std::span<const double> x) const;
    /// The error of value_between().
    double error_between(std::span<const double> x) const;
    /// The error of cell_value(): 0 but for the values that replace() found from others.
    double error_of_cell(std::span<const double> x) const { return spreads_[cell_index(x)]; }
    /// Whether x belongs to a cell.
    bool contains(std::span<const double> x) const;
    std::size_t size() const { return values_.size(); }
    /// An entry by its index.
    GridCell cell(std::size_t index) const;
    /// The index of the cell that contains x.
    std::size_t cell_index(std::span<const double> x) const;
    /// Sets the values by index. One that is NaN becomes the mean of the known ones next to it, with the range of those
    /// within two steps as its error.
    void replace(std::vector<double> values);
    /// The entries of an axis in ascending order.
    std::span<const double> entries(std::size_t axis) const { return entries_[axis]; }
    /// The ends of an axis' outer cells.
    double first_edge(std::size_t axis) const { return edges_[axis].front(); }
    double last_edge(std::size_t axis) const { return edges_[axis].back(); }

private:
    /// The entries on both sides of a place along one axis, and its share of the way.
    struct Interval {
        std::size_t low, high;
        double share;
    };
    using Intervals = std::array<Interval, most_axes>;
    std::vector<GridAxis> axes_;
    std::vector<std::vector<double>> entries_, edges_;  // by axis
    std::vector<double> values_, bends_, spreads_;      // the last axis first; spreads_: errors of replaced values
    std::array<std::array<double, 2>, most_axes> variation_at_pole_{};

    std::size_t stride(std::size_t axis) const;
    Interval interval_at(std::size_t axis, double x) const;
    Intervals intervals_at(std::span<const double> x) const;
    /// Calls each(index) for the corners of a cell; the last axis varies first.
    template <class Each> void for_each_corner(const Intervals& intervals, Each&& each) const;
    double bend_along(std::size_t axis, std::size_t index) const;
    void find_bends();
    std::size_t position(std::size_t axis, std::size_t index) const {
        return index / stride(axis) % entries_[axis].size();
    }
    /// Calls each(index) for the entries up to `steps` away along every axis, the own one too.
    template <class Each> void for_each_near(std::size_t index, std::size_t steps, Each&& each) const;
};

}  // namespace crescent
