// The audit of a cubature: points at random in every cell. Against the biquadratic polynomial through nine of the
// rule's points where the integrand is smooth, which leaves next to no variance; jittered over up to 8 x 8 parts where
// a jump is. Either way its mean is the integral, whatever the integrand does between the rule's points.
#include <algorithm>
#include <array>
#include <cmath>

#include "cubature/jump_lines.h"
#include "simd/random.h"

namespace crescent::inline cubature {

namespace {

constexpr double far2 = 0.9;  // the square of the rule's outermost coordinate
constexpr int looks = 2, most_parts = 8;

/// The three quadratic polynomials of Lagrange over -l, 0, l.
std::array<double, 3> quadratics(double x) {
    const double l = std::sqrt(far2);
    return {x * (x - l) / (2 * far2), 1 - x * x / far2, x * (x + l) / (2 * far2)};
}

/// The rule's points on that grid, rows of x, columns of y.
constexpr int node[3][3] = {{9, 5, 10}, {7, 0, 8}, {11, 6, 12}};

double polynomial(const Cell& c, const std::array<double, 3>& x, const std::array<double, 3>& y) {
    double sum = 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) sum += x[i] * y[j] * c.at[static_cast<std::size_t>(node[i][j])];
    return sum;
}

/// Its mean over the cell: of x^2 it is 1/3.
double polynomial_mean(const Cell& c) {
    constexpr double side = 1 / (6 * far2);
    const std::array<double, 3> w = {side, 1 - 2 * side, side};
    return polynomial(c, w, w);
}

/// Random points of one cell in [0, 1)^2: two anywhere, or one in each of n x n parts.
void add_points(int n, std::uint32_t index, std::uint32_t round, std::vector<Vec2d>& out) {
    for (int k = 0; k < (n > 1 ? n * n : looks); ++k) {
        const auto h = pcg4d<std::uint32_t>({index, static_cast<std::uint32_t>(k), round, 0xa0d17u});
        const double x = (h.x + 0.5) * 0x1p-32, y = (h.y + 0.5) * 0x1p-32;
        out.push_back({(k / n * (n > 1) + x) / n, (k % n + y) / n});
    }
}

int parts_for(const std::vector<Cell>& cells, std::size_t room) {
    std::size_t jumpy = 0;
    for (const Cell& c : cells) jumpy += c.jumpy() && !c.cut;
    if (room == 0 || jumpy == 0) return 1;
    return std::clamp(
        static_cast<int>(std::sqrt(static_cast<double>(room) / static_cast<double>(jumpy))), 2, most_parts);
}

/// Of each cut cell that has none a second value, by two lines at random in each piece, against the polynomial through
/// the piece's lines; `unsure` is what the lines differ by from that, the more of the two.
std::size_t look_at_cuts(std::vector<Cell>& cells, const Batch& g, std::uint32_t round) {
    std::vector<JumpLine> all;
    std::vector<double> place;
    for (std::size_t c = 0; c < cells.size(); ++c)
        for (std::size_t i = 0; i < static_cast<std::size_t>(cells[c].lines.pieces); ++i) {
            if (!cells[c].cut || cells[c].second) break;
            const CutLines& cut = cells[c].lines;
            const auto h =
                pcg4d<std::uint32_t>({static_cast<std::uint32_t>(c), static_cast<std::uint32_t>(i), round, 0xc07e5u});
            for (std::uint32_t half : {0u, 0x80000000u}) {
                place.push_back((h.x + half + 0.5) * 0x1p-32);
                all.push_back({c, cut.along_a, cut.ends[i] + place.back() * (cut.ends[i + 1] - cut.ends[i])});
            }
        }
    std::size_t count = bracket_jumps(all, cells, g);
    const std::vector<double> means = means_along(all, cells, g, &round, count);
    for (std::size_t n = 0; n < all.size();) {
        Cell& c = cells[all[n].cell];
        std::array<double, 2> off{};
        for (std::size_t i = 0; i < static_cast<std::size_t>(c.lines.pieces); ++i)
            for (double& side : off) {
                side += c.area() * (c.lines.ends[i + 1] - c.lines.ends[i]) * (means[n] - c.lines.mean_at(i, place[n]));
                ++n;
            }
        c.second = c.value + 0.5 * (off[0] + off[1]);
        c.unsure = std::max(std::fabs(off[0]), std::fabs(off[1]));
    }
    return count;
}

bool jittered(const Cell& c, int parts) { return parts > 1 && c.jumpy(); }

/// Where the integrand is asked, in the cells that are not cut; `points` are the same in each cell's own coordinates.
std::vector<Vec2d> points_at_random(
    const std::vector<Cell>& cells, int parts, std::uint32_t round, std::vector<Vec2d>& points) {
    std::vector<Vec2d> where;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (cells[i].cut) continue;
        const std::size_t from = points.size();
        add_points(jittered(cells[i], parts) ? parts : 1, static_cast<std::uint32_t>(i), round, points);
        const Rect& r = cells[i].rect;
        for (std::size_t k = from; k < points.size(); ++k)
            where.push_back({r.a0 + points[k].x * (r.a1 - r.a0), r.b0 + points[k].y * (r.b1 - r.b0)});
    }
    return where;
}

/// What the lines at random say of a cell that is cut; one that they differ in is to be halved.
void add_cut(Cell& c, double worth, Audit& out) {
    out.value += *c.second;
    out.jumps += sqr(*c.second - c.value);
    out.bin_squares[static_cast<std::size_t>(c.rect.bin)] += sqr(*c.second - c.value);
    if (!(c.unsure > worth)) return;
    c.bent = true;
    c.cut = false;
    c.error = std::max(c.error, c.unsure);
    out.found = true;
}

/// Where a jump turns a corner, its tip may stand in a cell whose points and lines all miss it: so much is granted to
/// the whole, and to each bin in which cells are cut.
void grant_tips(const std::vector<Cell>& cells, double mass, Audit& out) {
    std::vector<bool> granted(out.bin_squares.size());
    for (const Cell& c : cells)
        if (c.cut) granted[static_cast<std::size_t>(c.rect.bin)] = true;
    for (std::size_t i = 0; i < granted.size(); ++i) out.bin_squares[i] += granted[i] ? sqr(mass) : 0;
    out.jumps += std::find(granted.begin(), granted.end(), true) != granted.end() ? sqr(mass) : 0;
}

}  // namespace

Audit audit(std::vector<Cell>& cells, int bins, const Batch& g, std::uint32_t round, double worth, std::size_t room) {
    const int parts = parts_for(cells, room);
    Audit out;
    out.bin_squares.assign(static_cast<std::size_t>(bins), 0.0);
    out.evaluations += look_at_cuts(cells, g, round);
    std::vector<Vec2d> points;
    const std::vector<Vec2d> where = points_at_random(cells, parts, round, points);
    const std::vector<double> v = values_at(g, where);
    out.evaluations += where.size();
    std::size_t next = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        Cell& c = cells[i];
        if (c.cut) {
            add_cut(c, worth, out);
            continue;
        }
        const bool plain = jittered(c, parts);
        const int count = plain ? parts * parts : looks;
        double sum = 0, most = 0;
        for (int k = 0; k < count; ++k, ++next) {
            const double of =
                plain ? 0 : polynomial(c, quadratics(2 * points[next].x - 1), quadratics(2 * points[next].y - 1));
            sum += v[next] - of;
            most = std::max(most, std::fabs(v[next] - of));
        }
        const double mean = sum / count + (plain ? 0 : polynomial_mean(c)), value = c.area() * mean;
        out.value += value;
        (c.jumpy() ? out.jumps : out.smooth) += sqr(value - c.value);
        out.bin_squares[static_cast<std::size_t>(c.rect.bin)] += sqr(value - c.value);
        if (!(most * c.area() > worth) || !(most > 0.02 * (c.high - c.low))) continue;
        c.error = std::max(c.error, 0.5 * most * c.area());
        out.found = true;
    }
    grant_tips(cells, 2.5 * worth, out);
    return out;
}

}  // namespace crescent::inline cubature
