// A cell of the adaptive cubature, shared by the rule and by the cutting of cells that a jump of the integrand crosses.
#pragma once

#include <array>
#include <vector>

#include "verdicts/cubature.h"

namespace crescent::inline verdicts {

inline constexpr int rule_size = 17;

struct Cell {
    Rect rect;
    double value = 0, error = 0;
    double low = 0, high = 0;            // of the integrand at the points tried
    std::array<double, rule_size> at{};  // of the integrand at the rule's points
    std::array<double, 8> outer{};       // of the integrand at the rule's outermost points, four sides and four corners
    bool split_a = true;
    bool rim_tried = false,
         rim_jumps = false;  // whether corners and sides differ from the outermost points beside them
    bool cut = false;        // integrated on both sides of a jump
    bool smooth = false;     // looked at for a jump, and none is there
    int suspected = 0;       // how often it was halved on the witnesses' word alone
    std::vector<Witness> inside;

    Cell(const Rect& r, int suspicion) : rect(r), suspected(suspicion) {}
    double area() const { return (rect.a1 - rect.a0) * (rect.b1 - rect.b0); }
    /// What a jump of the integrand inside can be worth.
    double step() const { return area() * (high - low); }
    /// A jump inside leaves per cents of itself as error where a smooth integrand leaves none.
    bool rough() const { return high - low > 1e-3 * high && error > 0.01 * step(); }
    /// A jump crosses it, or seems to.
    bool jumpy() const { return cut || rim_jumps || rough(); }
    /// A jump seems to cross it, and nobody looked yet.
    bool jumps() const { return !cut && !smooth && (rough() || rim_jumps); }
};

/// Tries corners and sides of cells that were not tried yet: a jump may cut a corner off unseen. Cells in which it does
/// and that weigh more than edge_mass get an error that has them halved. Returns how many evaluations that took.
std::size_t try_rims(std::vector<Cell>& cells, const Batch& g, double edge_mass, bool& found);
/// Integrates every line through cells that a jump crosses on both sides of the jump, which is found by bisection.
/// Cells without one are marked smooth. Returns how many evaluations that took.
std::size_t cut_along_jumps(std::vector<Cell>& cells, const Batch& g, double edge_mass);

/// A second estimate of every cell from points at random, whose mean is the integral whatever the integrand does.
struct Audit {
    double value = 0;                 // of all cells
    double smooth = 0, jumps = 0;     // sums of squared differences to the cells' own values, by kind of cell
    std::vector<double> bin_squares;  // the same by bin, both kinds
    std::size_t evaluations = 0;
    bool found = false;  // cells that hide more than `worth`; their errors are raised, so that they are halved
};
/// `room`: evaluations to spend on cells with jumps; 0: two a cell, whatever it holds.
Audit audit(std::vector<Cell>& cells, int bins, const Batch& g, std::uint32_t round, double worth, std::size_t room);

}  // namespace crescent::inline verdicts
