// A cell of the adaptive cubature, shared by the rule and by the cutting of cells that a jump of the integrand crosses.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "cubature/cubature.h"

namespace crescent::inline cubature {

inline constexpr int rule_size = 17;

/// How a cell is integrated that a jump crosses: along lines of one coordinate, three in each piece of the other.
struct CutLines {
    static constexpr std::size_t lines = 3, most_pieces = 3;
    bool along_a = true;
    int pieces = 0;
    std::array<double, most_pieces + 1> ends{};  // of the pieces, ascending in [0, 1]
    std::array<std::array<double, lines>, most_pieces> means{};

    double mean() const;  // of the integrand over the cell
    /// The mean along the line at x in [0, 1] of a piece, by the quadratic polynomial through its three.
    double mean_at(std::size_t piece, double x) const;
};

struct Cell {
    Rect rect;
    double value = 0, error = 0;
    double rule_error = 0;               // by the rule alone; `error` is raised by what else is known
    double low = 0, high = 0;            // of the integrand at the points tried
    std::array<double, rule_size> at{};  // of the integrand at the rule's points
    std::array<double, 8> outer{};       // at the rule's outermost points: four sides, four corners; or at the corners
    bool split_a = true;
    bool rim_tried = false,
         rim_jumps = false;        // whether corners, or what a cell beside it knows, differ from what the rule saw
    bool cut = false;              // integrated on both sides of a jump,
    CutLines lines;                // along these
    std::optional<double> second;  // the audit's estimate of its value, where it is cut and was looked at,
    double unsure = 0;             // and what single lines differ by
    bool looked_around = false;    // the cells beside it were asked for the jump
    bool bent = false;             // more than one curve crosses it: to be halved before it is cut again
    bool beside_jump = false;      // half of a cell that a jump crosses, or seems to
    bool smooth = false;           // looked at for a jump, and none is there
    int suspected = 0;             // how often it was halved because of the draws in it alone
    std::vector<SampleValue> inside;
    double higher = 0;  // how many of the first `compared` of them lie at more than 1.3 times `higher_than`
    double higher_than = -1;
    std::size_t compared = 0;

    Cell(const Rect& r, int suspicion) : rect(r), suspected(suspicion) {}
    double area() const { return (rect.a1 - rect.a0) * (rect.b1 - rect.b0); }
    /// What a jump of the integrand inside can be worth.
    double step() const { return area() * (high - low); }
    /// A jump inside leaves per cents of itself as error where a smooth integrand leaves none.
    bool rough() const { return high - low > 1e-3 * high && rule_error > 0.01 * step(); }
    /// A jump crosses it, or seems to.
    bool jumpy() const { return cut || rim_jumps || rough(); }
    /// A jump seems to cross it, and was not looked at yet.
    bool jumps() const { return !cut && !smooth && (rough() || rim_jumps); }
};

/// The integrand at some points, which may be none.
std::vector<double> values_at(const Batch& g, const std::vector<Vec2d>& where);

inline constexpr double inset = 1e-7;  // of a cell's width: so far inside of its rim it is asked
/// The corners, as far inside, in the order of the rule's outermost points: a0 b0, a0 b1, a1 b0, a1 b1.
std::array<Vec2d, 4> corners(const Rect& r);

/// Tries the corners of cells that were not tried yet and are `asked`: a jump may cut a corner off unseen. Cells
/// in which it does and that weigh more than edge_mass get an error that has them halved. Returns how many evaluations
/// that took.
std::size_t try_rims(std::vector<Cell>& cells, const Batch& g, double edge_mass, bool& found,
    const std::function<bool(const Cell&)>& asked);
/// Integrates lines through cells that a jump crosses on both sides of the jump, which is found by bisection. Cells
/// without one are marked smooth. Returns how many evaluations that took, `room` at most.
std::size_t cut_along_jumps(std::vector<Cell>& cells, const Batch& g, double edge_mass, std::size_t room);

/// Has cells beside those that were cut last halved or cut where the jump goes on in them, unseen. Returns how many
/// evaluations that took.
std::size_t look_around(std::vector<Cell>& cells, const Batch& g, double edge_mass, bool& found);

/// A second estimate of every cell from points at random, whose mean is the integral whatever the integrand does.
struct Audit {
    double value = 0;                 // of all cells
    double smooth = 0, jumps = 0;     // sums of squared differences to the cells' own values, by kind of cell
    std::vector<double> bin_squares;  // the same by bin, both kinds
    std::size_t evaluations = 0;
    bool found = false;  // cells that hide more than `worth`; their errors are raised, so that they are halved
};
/// `room`: evaluations to spend on cells with jumps; 0: two a cell, whatever it holds, and cut cells are looked at
/// once.
Audit audit(std::vector<Cell>& cells, int bins, const Batch& g, std::uint32_t round, double worth, std::size_t room);

}  // namespace crescent::inline cubature
