// A cell of the adaptive cubature, shared by the rule and by the cutting of cells that a jump of the integrand crosses.
#pragma once

#include <vector>

#include "verdicts/cubature.h"

namespace crescent {

inline constexpr int rule_size = 17;

struct Cell {
    Rect rect;
    double value = 0, error = 0;
    double low = 0, high = 0;       // of the integrand at the points tried
    bool split_a = true;
    bool cut = false;               // integrated on both sides of a jump
    int suspected = 0;              // how often it was halved on the witnesses' word alone
    std::vector<Vec2d> inside;      // witnesses

    Cell(const Rect& r, int suspicion) : rect(r), suspected(suspicion) {}
    double area() const { return (rect.a1 - rect.a0) * (rect.b1 - rect.b0); }
    bool rough() const { return high - low > 0.3 * high; }
};

/// Finds cells that a jump crosses, by their corners and sides too, and integrates each line through them on both sides of
/// the jump, which is found by bisection. Returns how many evaluations that took.
std::size_t cut_along_jumps(std::vector<Cell>& cells, const Batch& g);

}  // namespace crescent
