// A chart of a domain on the unit sphere: the measure of the domain becomes solid angle times a known factor, so that
// every test of a density over directions is one of a density over the domain.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "base/vec.h"
#include "samplers/domains/domain.h"
#include "samplers/domains/sphere_chart.h"

namespace crescent {

/// The parts of a domain are mapped to a unit cube, and the cube to the sphere: one or two dimensions to the polar and
/// the azimuthal coordinate of sphere_chart.h; three or four by dealing the bits of their coordinates to these two in
/// turn, which keeps measures and maps dyadic boxes to dyadic boxes.
class DomainChart {
public:
    explicit DomainChart(Domain domain);

    const Domain& domain() const { return domain_; }
    /// Random numbers that a point needs besides its own: an entry of a set is spread over a cell, and a single
    /// dimension over the azimuth.
    std::size_t spreads() const;
    /// Fits the charts of infinite lines to these points, rows of coordinates.
    void fit(std::span<const double> rows);
    /// The direction of a point of the domain. spread: as many numbers in [0, 1) as spreads().
    Vec3d direction(std::span<const double> point, std::span<const double> spread) const;
    /// The point of a direction. Returns the factor from a density over the domain to one over solid angle: 0 where the
    /// direction belongs to no point.
    double point(Vec3d w, std::span<double> out) const;

    /// The density over the domain of one over solid angle.
    double density(Vec3d w, double per_sr) const;
    /// Whether all of its parts are sets.
    bool is_discrete() const;
    /// Whether one of them is a set.
    bool has_set() const;
    /// The direction that the point of `w` has in another chart of the same domain.
    Vec3d in_chart(const DomainChart& other, Vec3d w) const;
    /// Whether a direction belongs to a point: not beyond the last entry of a set.
    bool has_point(Vec3d w) const;

    /// The direction whose point is shifted along every second dimension, from number `axis` (0 or 1) on, by this share
    /// of its range, or of its mass on an infinite line. A point that would leave at the end is reflected.
    Vec3d shifted(Vec3d w, std::size_t axis, double distance) const;

    /// Remembers the first point that does not belong to the domain, for messages.
    void note_outside(std::span<const double> point) const;
    /// "x = 1.5, which is outside [0, 1]"; "" if there was none.
    std::string first_outside() const;

    /// The point of a direction in words.
    std::string text(Vec3d w) const;
    /// The smallest box that contains a rectangle of the sphere's chart, in words: "at x from 0.2 to 0.3", "at entries
    /// 4 to 7".
    std::string text(const check::ChartRect& rect) const;
    /// The entry of a set that a rectangle of the sphere's chart is a part of; none if it has several, or no set.
    std::optional<std::uint32_t> entry(const check::ChartRect& rect) const;
    /// The value of coordinate 0 of a line, or the entry of a set, at t of the sphere's chart.
    double value_at(double t) const;
    /// The name of a dimension, and its value at a share of its range: "radius", "0.5".
    std::string axis(std::size_t dimension) const;
    std::string label(std::size_t dimension, double share) const;
    /// Whether a dimension alone is spread over the azimuth.
    bool is_line() const { return domain_.dimensions() == 1; }

private:
    /// Piecewise linear from [0, 1] to the part, with knots at dyadic y.
    struct Knots {
        std::vector<double> y, x;
        static Knots fitted(std::vector<double> values, double from, double to);
        double to_unit(double value) const;
        /// Sets the value at `unit`, and returns its derivative.
        double from_unit(double unit, double& value) const;
    };
    /// Shared by copies of a chart.
    struct Outside {
        Mutex lock;
        std::string first;
    };
    Domain domain_;
    std::shared_ptr<Outside> outside_point_ = std::make_shared<Outside>();
    std::vector<Knots> knots_;                                 // by part; empty where the line is finite
    using Cube = std::array<double, Domain::most_dimensions>;  // of which the first dimensions() are used
    Cube cube_of(Vec3d w) const;
    Vec3d from_cube_to_direction(std::span<const double> y, double azimuth) const;
    void to_cube(std::span<const double> point, std::span<const double> spread, std::span<double> y) const;
    double from_cube(std::span<const double> y, std::span<double> point) const;
};

}  // namespace crescent
