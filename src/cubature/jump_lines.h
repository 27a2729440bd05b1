// Lines through cells that a jump of the integrand crosses. Each is integrated up to its jump and from it on, at the
// distance x^2 from the jump for x in [0, 1], which takes a pole of 1/sqrt(distance), as grazed surfaces have it, out
// of the integrand.
#pragma once

#include <cmath>
#include <cstdint>

#include "cubature/cell.h"

namespace crescent::inline cubature {

/// Along a or along b through a cell; t runs over the cell's width in [0, 1], `across` is the other coordinate there.
struct JumpLine {
    std::size_t cell;
    bool along_a;
    double across;
    double t0 = 0, t1 = 1, g0 = 0, g1 = 0;  // the bracket of the jump

    double jump() const { return 0.5 * (t0 + t1); }
    double change() const { return std::fabs(g1 - g0); }
};

/// Closes in on the largest change along each line, to 2^-12 of the cell's width. Returns how many evaluations that
/// took.
std::size_t bracket_jumps(std::vector<JumpLine>& lines, const std::vector<Cell>& cells, const Batch& g);
/// The mean of the integrand along each line whose jump is bracketed: two Gauss points a side, and with `round` two
/// more at random, whose mean is right whatever the integrand does between. Adds to `count` how many evaluations that
/// took.
std::vector<double> means_along(const std::vector<JumpLine>& lines, const std::vector<Cell>& cells, const Batch& g,
    const std::uint32_t* round, std::size_t& count);

}  // namespace crescent::inline cubature
