// Jumps: the edge of a cone, a light's rim, the horizon. Inside a small cell the jump is a smooth curve, which lines
// across it meet once. Where the curve leaves the cell on the way, the lines' means have a kink: the lines stand at
// Gauss points between such places.
#include <algorithm>
#include <array>
#include <cmath>

#include "cubature/jump_lines.h"

namespace crescent::inline cubature {

namespace {

constexpr std::array<double, CutLines::lines> gauss3 = {0.5 - 0.3872983346207417, 0.5, 0.5 + 0.3872983346207417};
constexpr std::array<double, CutLines::lines> weight3 = {5.0 / 18, 8.0 / 18, 5.0 / 18};
constexpr double a_jump = 0.01;  // of the cell's range: a smooth integrand changes by less over 2^-12 of its width

/// The cells to cut: small ones that a jump seems to cross, as many as `room` evaluations are enough for.
std::vector<std::size_t> due(const std::vector<Cell>& cells, double edge_mass, std::size_t room) {
    constexpr std::size_t a_cell = 200;  // of two sides, three lines in up to three pieces, and the audit's lines
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < cells.size() && out.size() < room / a_cell; ++i)
        if (cells[i].jumps() && cells[i].step() < edge_mass) out.push_back(i);
    return out;
}

/// Along the side that sees more of the change.
bool along_a(const Cell& c) {
    const std::array<double, 8>& v = c.outer;
    return std::fabs(v[4] - v[6]) + std::fabs(v[5] - v[7]) + std::fabs(v[0] - v[1]) >=
        std::fabs(v[4] - v[5]) + std::fabs(v[6] - v[7]) + std::fabs(v[2] - v[3]);
}

bool crosses(const Cell& c, const JumpLine& l) { return l.change() > a_jump * (c.high - c.low); }

/// Whether the corners of the side at which the lines start (end) tell of a jump between them, or are not known.
bool may_cross(const Cell& c, int end) {
    const std::size_t one = c.lines.along_a ? 4 + 2 * static_cast<std::size_t>(end) : 4 + static_cast<std::size_t>(end);
    const std::size_t two = one + (c.lines.along_a ? 1 : 2);
    return !c.rim_tried || std::fabs(c.outer[one] - c.outer[two]) > a_jump * (c.high - c.low);
}

/// Where the jump leaves these cells through the sides at which their lines end.
std::size_t find_pieces(std::vector<Cell>& cells, const std::vector<std::size_t>& which, const Batch& g) {
    std::vector<JumpLine> sides;
    for (std::size_t c : which) {
        CutLines& cut = cells[c].lines;
        cut = CutLines{along_a(cells[c])};
        for (int end : {0, 1})
            if (may_cross(cells[c], end)) sides.push_back({c, !cut.along_a, end ? 1 - inset : inset});
    }
    const std::size_t count = bracket_jumps(sides, cells, g);
    for (const JumpLine& l : sides) {
        CutLines& cut = cells[l.cell].lines;
        if (crosses(cells[l.cell], l)) cut.ends[static_cast<std::size_t>(++cut.pieces)] = l.jump();
    }
    for (std::size_t c : which) {
        CutLines& cut = cells[c].lines;
        cut.ends[static_cast<std::size_t>(++cut.pieces)] = 1;
        std::sort(cut.ends.begin(), cut.ends.begin() + cut.pieces + 1);
    }
    return count;
}

}  // namespace

std::vector<double> values_at(const Batch& g, const std::vector<Vec2d>& where) {
    std::vector<double> out(where.size());
    if (!where.empty()) g(where, out);
    return out;
}

std::array<Vec2d, 4> corners(const Rect& r) {
    const double da = inset * (r.a1 - r.a0), db = inset * (r.b1 - r.b0);
    return {{{r.a0 + da, r.b0 + db}, {r.a0 + da, r.b1 - db}, {r.a1 - da, r.b0 + db}, {r.a1 - da, r.b1 - db}}};
}

double CutLines::mean() const {
    double sum = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(pieces); ++i)
        for (std::size_t k = 0; k < lines; ++k) sum += (ends[i + 1] - ends[i]) * weight3[k] * means[i][k];
    return sum;
}

double CutLines::mean_at(std::size_t piece, double x) const {
    double sum = 0;
    for (std::size_t k = 0; k < lines; ++k) {
        double term = means[piece][k];
        for (std::size_t j = 0; j < lines; ++j)
            if (j != k) term *= (x - gauss3[j]) / (gauss3[k] - gauss3[j]);
        sum += term;
    }
    return sum;
}

std::size_t try_rims(std::vector<Cell>& cells, const Batch& g, double edge_mass, bool& found,
    const std::function<bool(const Cell&)>& asked) {
    std::vector<Vec2d> where;
    for (Cell& c : cells)
        if (!c.rim_tried && asked(c))
            for (Vec2d p : corners(c.rect)) where.push_back(p);
    const std::vector<double> v = values_at(g, where);
    const double* at_rim = v.data();
    for (Cell& c : cells) {
        if (c.rim_tried || !asked(c)) continue;
        for (std::size_t k = 0; k < 4; ++k) {
            const double top = std::max(c.high, at_rim[k]);
            c.rim_jumps = c.rim_jumps || std::fabs(at_rim[k] - c.outer[4 + k]) > 0.2 * top;
            c.high = top;
        }
        c.rim_tried = true;
        std::copy(at_rim, at_rim + 4, c.outer.begin() + 4);
        at_rim += 4;
        if (!c.rim_jumps || c.step() < edge_mass) continue;
        c.error = std::max(c.error, 0.05 * c.area() * c.high);
        found = true;
    }
    return where.size();
}

std::size_t cut_along_jumps(std::vector<Cell>& cells, const Batch& g, double edge_mass, std::size_t room) {
    const std::vector<std::size_t> which = due(cells, edge_mass, room);
    std::size_t count = find_pieces(cells, which, g);
    std::vector<JumpLine> all;
    for (std::size_t c : which) {
        const CutLines& cut = cells[c].lines;
        for (std::size_t i = 0; i < static_cast<std::size_t>(cut.pieces); ++i)
            for (double x : gauss3) all.push_back({c, cut.along_a, cut.ends[i] + x * (cut.ends[i + 1] - cut.ends[i])});
    }
    count += bracket_jumps(all, cells, g);
    const std::vector<double> means = means_along(all, cells, g, nullptr, count);
    for (std::size_t i = 0; i < all.size();) {
        Cell& cell = cells[all[i].cell];
        bool jumps = false;
        for (std::size_t piece = 0; piece < static_cast<std::size_t>(cell.lines.pieces); ++piece)
            for (double& mean : cell.lines.means[piece]) {
                jumps = jumps || crosses(cell, all[i]);
                mean = means[i++];
            }
        cell.smooth = !jumps;
        if (!jumps) continue;
        cell.value = cell.area() * cell.lines.mean();
        cell.error = 0.02 * std::fabs(cell.value);
        cell.cut = true;
    }
    return count;
}

}  // namespace crescent::inline cubature
