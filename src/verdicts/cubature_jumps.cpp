// Jumps: the edge of a cone, a disk light's rim, the horizon. Inside a small cell the jump is a smooth curve a(b) or
// b(a), so five Gauss lines across it, each integrated up to the jump and beyond it, leave an error of about a
// hundredth of the cell.
#include <algorithm>
#include <array>
#include <cmath>

#include "verdicts/cell.h"

namespace crescent::inline verdicts {

namespace {

constexpr int lines = 5, sides = 2, bisections = 13;
constexpr double gauss5[lines] = {-0.906179845938664, -0.538469310105683, 0, 0.538469310105683, 0.906179845938664};
constexpr double weight5[lines] = {
    0.236926885056189, 0.478628670499366, 0.568888888888889, 0.478628670499366, 0.236926885056189};
constexpr double gauss2 = 0.577350269189626;

/// A line through a cell, along a or along b; t runs over the cell's width in [0, 1].
struct Line {
    std::size_t cell;
    bool along_a;
    double across;                          // the other coordinate
    double t0 = 0, t1 = 1, g0 = 0, g1 = 0;  // the bracket of the jump
};

Vec2d at(const Rect& r, const Line& l, double t) {
    return l.along_a ? Vec2d{r.a0 + t * (r.a1 - r.a0), l.across} : Vec2d{l.across, r.b0 + t * (r.b1 - r.b0)};
}

constexpr double inset = 1e-7;

/// Four sides and four corners, in the order of the rule's outermost points.
std::array<Vec2d, 8> rim(const Rect& r) {
    const double da = inset * (r.a1 - r.a0), db = inset * (r.b1 - r.b0), a = 0.5 * (r.a0 + r.a1),
                 b = 0.5 * (r.b0 + r.b1);
    return {{{r.a0 + da, b}, {r.a1 - da, b}, {a, r.b0 + db}, {a, r.b1 - db}, {r.a0 + da, r.b0 + db},
        {r.a0 + da, r.b1 - db}, {r.a1 - da, r.b0 + db}, {r.a1 - da, r.b1 - db}}};
}

/// Lines through every cell that a jump seems to cross, along the side that sees more of the change.
std::vector<Line> lines_through(const std::vector<Cell>& cells, double edge_mass) {
    std::vector<Line> out;
    for (std::size_t c = 0; c < cells.size(); ++c) {
        if (!cells[c].jumps() || cells[c].step() >= edge_mass) continue;
        const std::array<double, 8>& v = cells[c].outer;
        const double along_a = std::fabs(v[4] - v[6]) + std::fabs(v[5] - v[7]) + std::fabs(v[0] - v[1]);
        const double along_b = std::fabs(v[4] - v[5]) + std::fabs(v[6] - v[7]) + std::fabs(v[2] - v[3]);
        const Rect& r = cells[c].rect;
        for (double x : gauss5) {
            Line l;
            l.cell = c;
            l.along_a = along_a >= along_b;
            l.across = l.along_a ? 0.5 * (r.b0 + r.b1) + 0.5 * x * (r.b1 - r.b0)
                                 : 0.5 * (r.a0 + r.a1) + 0.5 * x * (r.a1 - r.a0);
            out.push_back(l);
        }
    }
    return out;
}

std::size_t evaluate(const Batch& g, const std::vector<Vec2d>& where, std::vector<double>& out) {
    out.resize(where.size());
    if (!where.empty()) g(where, out);
    return where.size();
}

/// Closes in on the larger change, all lines in step.
std::size_t bracket(std::vector<Line>& all, const std::vector<Cell>& cells, const Batch& g) {
    std::vector<Vec2d> where;
    std::vector<double> v;
    for (const Line& l : all)
        for (double t : {inset, 1 - inset}) where.push_back(at(cells[l.cell].rect, l, t));
    std::size_t count = evaluate(g, where, v);
    for (std::size_t i = 0; i < all.size(); ++i) {
        all[i].g0 = v[2 * i];
        all[i].g1 = v[2 * i + 1];
    }
    for (int k = 0; k < bisections; ++k) {
        where.clear();
        for (const Line& l : all) where.push_back(at(cells[l.cell].rect, l, 0.5 * (l.t0 + l.t1)));
        count += evaluate(g, where, v);
        for (std::size_t i = 0; i < all.size(); ++i) {
            Line& l = all[i];
            const double mid = 0.5 * (l.t0 + l.t1);
            if (std::fabs(v[i] - l.g0) > std::fabs(v[i] - l.g1)) l.t1 = mid, l.g1 = v[i];
            else l.t0 = mid, l.g0 = v[i];
        }
    }
    return count;
}

}  // namespace

std::size_t try_rims(std::vector<Cell>& cells, const Batch& g, double edge_mass, bool& found) {
    std::vector<Vec2d> where;
    std::vector<double> v;
    for (const Cell& c : cells)
        if (!c.rim_tried)
            for (Vec2d p : rim(c.rect)) where.push_back(p);
    const std::size_t count = evaluate(g, where, v);
    const double* at_rim = v.data();
    for (Cell& c : cells) {
        if (c.rim_tried) continue;
        c.rim_tried = true;
        for (std::size_t k = 0; k < 8; ++k) {
            const double top = std::max(c.high, at_rim[k]);
            c.rim_jumps = c.rim_jumps || std::fabs(at_rim[k] - c.outer[k]) > 0.2 * top;
            c.high = top;
        }
        std::copy(at_rim, at_rim + 8, c.outer.begin());
        at_rim += 8;
        if (!c.rim_jumps || c.step() < edge_mass) continue;
        c.error = std::max(c.error, 0.05 * c.area() * c.high);
        found = true;
    }
    return count;
}

std::size_t cut_along_jumps(std::vector<Cell>& cells, const Batch& g, double edge_mass) {
    std::vector<Line> all = lines_through(cells, edge_mass);
    std::size_t count = bracket(all, cells, g);
    std::vector<Vec2d> where;
    std::vector<double> v;
    for (const Line& l : all) {
        const double jump = 0.5 * (l.t0 + l.t1);
        for (double from : {0.0, jump}) {
            const double to = from == 0 ? jump : 1, mid = 0.5 * (from + to), half = 0.5 * (to - from);
            for (double x : {-gauss2, gauss2}) where.push_back(at(cells[l.cell].rect, l, mid + x * half));
        }
    }
    count += evaluate(g, where, v);
    for (std::size_t i = 0; i + lines <= all.size(); i += lines) {
        Cell& cell = cells[all[i].cell];
        double sum = 0;
        bool jumps = false;
        for (std::size_t k = 0; k < lines; ++k) {
            const Line& l = all[i + k];
            jumps =
                jumps || std::fabs(l.g1 - l.g0) > 0.01 * (cell.high - cell.low);  // smooth: 2^-13 of the cell's width
            const double jump = 0.5 * (l.t0 + l.t1);
            const double* p = &v[(i + k) * 2 * sides];
            sum += 0.5 * weight5[k] * 0.5 * (jump * (p[0] + p[1]) + (1 - jump) * (p[2] + p[3]));
        }
        cell.smooth = !jumps;
        if (!jumps) continue;
        cell.value = cell.area() * sum;
        cell.error = 0.02 * std::fabs(cell.value);
        cell.cut = true;
    }
    return count;
}

}  // namespace crescent::inline verdicts
