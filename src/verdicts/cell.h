// A cell of the adaptive cubature, shared by the rule and by the cutting of cells that a jump of the integrand crosses.
#pragma once

#include <array>
#include <vector>

#include "verdicts/cubature.h"

namespace crescent {

inline constexpr int rule_size = 17;

struct Cell {
    Rect rect;
    double value = 0, error = 0;
    double low = 0, high = 0;       // of the integrand at the points tried
    std::array<double, 8> outer{};  // of the integrand at the rule's outermost points, four sides and four corners
    bool split_a = true;
    bool rim_tried = false, rim_jumps = false;  // whether corners and sides differ from the outermost points beside them
    bool cut = false;               // integrated on both sides of a jump
    int suspected = 0;              // how often it was halved on the witnesses' word alone
    std::vector<Vec2d> inside;      // witnesses

    Cell(const Rect& r, int suspicion) : rect(r), suspected(suspicion) {}
    double area() const { return (rect.a1 - rect.a0) * (rect.b1 - rect.b0); }
    /// A jump inside leaves per cents of error where a smooth integrand leaves none.
    bool rough() const { return high - low > 0.3 * high && error > 0.01 * area() * high; }
};

/// Tries corners and sides of cells that were not tried yet: a jump may cut a corner off unseen. Cells in which it does and
/// that weigh more than edge_mass get an error that has them halved. Returns how many evaluations that took.
std::size_t try_rims(std::vector<Cell>& cells, const Batch& g, double edge_mass, bool& found);
/// Integrates every line through cells that a jump crosses on both sides of the jump, which is found by bisection.
/// Returns how many evaluations that took.
std::size_t cut_along_jumps(std::vector<Cell>& cells, const Batch& g);

}  // namespace crescent
