// Integrals over the sphere and over disks by adaptive cubature: Genz & Malik 1980, "Remarks on algorithm 006: An
// adaptive algorithm for numerical integration over an N-dimensional rectangular region", degree 7 with an embedded
// degree 5, 17 points a cell. Cells are halved in waves, so that a wave is one batch of questions.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "base/vec2d.h"
#include "simd/frame.h"

namespace crescent::inline cubature {

/// A rectangle in the two coordinates, and the bin its integral counts for.
struct Rect {
    double a0, a1, b0, b1;
    int bin = 0;
};

/// Values of the integrand at points (a, b), many at once.
using Batch = std::function<void(std::span<const Vec2d> at, std::span<double> out)>;

/// Of a table whose cells are summed by their values, over what is drawn: ln p, or where p sin theta is what each cell
/// holds the same, about the bins' axis, ln of that.
struct LogHeights {
    bool times_sin = false;
    double mean = 0, variance = 0;
};

struct Integral {
    std::vector<double> bins;          // one a bin
    double value = 0, error = 0;       // sum over bins and its estimated error, no less than `second` differs from it
    double second = 0, second_se = 0;  // by points at random in the same cells: unbiased, with its standard error
    std::vector<double> bin_errors;    // what each bin is known to
    std::size_t evaluations = 0;
    bool sampled = false;  // a table of too many cells to sum, known from points at random alone
    bool settled = true;   // the tolerance was reached
    std::optional<LogHeights> heights{};
};

struct Effort {
    double tolerance = 5e-6;  // absolute, of the sum
    std::size_t most_evaluations = 400000;
    double edge_mass = 1e-4;  // cells cut by a jump of the integrand are halved down to this, then cut along it
};

/// Where draws of a density fell, and the integrand there: a cell that 17 points find empty, or lower than draws do, is
/// halved until both agree.
struct SampleValue {
    Vec2d at;
    double g = 0;
};
struct SamplesPerBin {
    std::vector<std::vector<SampleValue>> bins;  // by bin
    double total = 0;                            // draws, those in no bin included
};

/// The integral over cells, by Genz-Malik rules on the worst cell first, with the error it is known to.
Integral integrate(
    std::vector<Rect> cells, int bins, const Batch& g, const Effort& effort, const SamplesPerBin* samples = nullptr);

/// Sphere coordinates about an axis: a = 1 - cos of the angle to it, b = turns about it. dw = 2 pi da db.
struct SphereMap {
    Frame<double> frame;
    explicit SphereMap(Vec3d axis) : frame(frame_about(axis)) {}
    Vec3d direction(Vec2d at) const;
    Vec2d coordinates(Vec3d w) const;
    double height(Vec3d w) const;  // their a alone, for less
};

/// Rings that narrow towards the axis, six sectors each, up to a = a_end.
std::vector<Rect> graded_cells(double a_end = 2);
/// The same cells halved wherever `pilot_directions` crowd, so that no sharp lobe is overlooked; bins are kept.
std::vector<Rect> refined_at_pilots(
    std::vector<Rect> cells, const SphereMap& map, std::span<const Vec3d> pilot_directions);

}  // namespace crescent::inline cubature
