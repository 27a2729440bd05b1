// Along a line across a cell the jump is bracketed by 12 bisections. On either side t = jump +- width x^2, so that a
// root at the jump is smooth, with two Gauss points; two points at random, mirrored, take out what those leave.
#include "cubature/jump_lines.h"

#include <array>

#include "simd/random.h"

namespace crescent::inline cubature {

namespace {

constexpr int bisections = 12;
constexpr std::array<double, 2> gauss2 = {0.5 - 0.28867513459481287, 0.5 + 0.28867513459481287};  // over [0, 1]

Vec2d at(const Rect& r, const JumpLine& l, double t) {
    const double a = l.along_a ? t : l.across, b = l.along_a ? l.across : t;
    return {r.a0 + a * (r.a1 - r.a0), r.b0 + b * (r.b1 - r.b0)};
}

/// One side of a line's jump: from it to an end of the cell.
struct Side {
    double jump, width;  // width < 0: towards t = 0
    double t(double x) const { return jump + width * x * x; }
    double density(double x) const { return 2 * x * std::fabs(width); }  // |dt / dx|
};

std::array<Side, 2> sides_of(const JumpLine& l) { return {{{l.jump(), -l.jump()}, {l.jump(), 1 - l.jump()}}}; }

/// A place in (0, 1) of one side of a line.
double place(std::size_t line, std::uint32_t side, std::uint32_t round) {
    return (pcg4d<std::uint32_t>({static_cast<std::uint32_t>(line), side, round, 0x11e5u}).x + 0.5) * 0x1p-32;
}

}  // namespace

std::size_t bracket_jumps(std::vector<JumpLine>& lines, const std::vector<Cell>& cells, const Batch& g) {
    std::vector<Vec2d> where;
    for (const JumpLine& l : lines)
        for (double t : {inset, 1 - inset}) where.push_back(at(cells[l.cell].rect, l, t));
    std::vector<double> v = values_at(g, where);
    std::size_t count = where.size();
    for (std::size_t i = 0; i < lines.size(); ++i) lines[i].g0 = v[2 * i], lines[i].g1 = v[2 * i + 1];
    for (int k = 0; k < bisections; ++k) {
        where.clear();
        for (const JumpLine& l : lines) where.push_back(at(cells[l.cell].rect, l, l.jump()));
        v = values_at(g, where);
        count += where.size();
        for (std::size_t i = 0; i < lines.size(); ++i) {
            JumpLine& l = lines[i];
            if (std::fabs(v[i] - l.g0) > std::fabs(v[i] - l.g1)) l.t1 = l.jump(), l.g1 = v[i];
            else l.t0 = l.jump(), l.g0 = v[i];
        }
    }
    return count;
}

std::vector<double> means_along(const std::vector<JumpLine>& lines, const std::vector<Cell>& cells, const Batch& g,
    const std::uint32_t* round, std::size_t& count) {
    std::vector<Vec2d> where;
    std::vector<double> x;
    for (std::size_t i = 0; i < lines.size(); ++i)
        for (std::uint32_t k = 0; k < 2; ++k) {
            const std::size_t from = x.size();
            x.insert(x.end(), gauss2.begin(), gauss2.end());
            if (round) {  // and its mirror image: what is odd about the middle leaves no variance
                const double p = place(i, k, *round);
                x.insert(x.end(), {p, 1 - p});
            }
            const Side side = sides_of(lines[i])[k];
            for (std::size_t n = from; n < x.size(); ++n)
                where.push_back(at(cells[lines[i].cell].rect, lines[i], side.t(x[n])));
        }
    const std::vector<double> v = values_at(g, where);
    count += where.size();
    std::vector<double> out(lines.size(), 0.0);
    std::size_t n = 0;
    for (std::size_t i = 0; i < lines.size(); ++i)
        for (const Side& side : sides_of(lines[i])) {
            const double low = side.density(x[n]) * v[n], high = side.density(x[n + 1]) * v[n + 1];
            n += 2;
            out[i] += 0.5 * (low + high);
            if (!round) continue;
            double beyond = 0;  // what the straight line through the Gauss points leaves
            for (int k = 0; k < 2; ++k, ++n)
                beyond +=
                    side.density(x[n]) * v[n] - (low + (high - low) * (x[n] - gauss2[0]) / (gauss2[1] - gauss2[0]));
            out[i] += 0.5 * beyond;
        }
    return out;
}

}  // namespace crescent::inline cubature
