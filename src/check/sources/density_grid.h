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
    bool periodic = false;        // `to` is the same place as `from`
    std::array<bool, 2> poles{};  // whether the next axis goes around the first and the last end
    bool integral = false;        // has all integers from `from` to `to`
    std::size_t fewest = 1;       // distinct values
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
    double of_cell(std::span<const double> x) const;
    /// p between the entries.
    double between(std::span<const double> x) const;
    /// The error of between().
    double error_between(std::span<const double> x) const;
    /// Whether x belongs to a cell.
    bool contains(std::span<const double> x) const;
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
    std::vector<double> values_, bends_;                // the last axis first
    std::array<std::array<double, 2>, most_axes> variation_at_pole_{};

    std::size_t stride(std::size_t axis) const;
    Interval interval_at(std::size_t axis, double x) const;
    Intervals intervals_at(std::span<const double> x) const;
    /// Calls each(index) for the corners of a cell; the last axis varies first.
    template <class Each> void for_each_corner(const Intervals& intervals, Each&& each) const;
    double bend_along(std::size_t axis, std::size_t index) const;
    void find_bends();
};

}  // namespace crescent
