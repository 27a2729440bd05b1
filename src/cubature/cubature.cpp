// Genz & Malik 1980 in two dimensions, degrees 7 and 5, 17 points a cell, over 1 - cos and turns. Cells are halved
// worst first, also where draws fall more often than the integral says; those at a jump are cut along it
// (jump_lines.h); points at random (audit) look for what the rule is blind to.

#include <algorithm>
#include <array>
#include <cmath>

#include "cubature/cell.h"
#include "math/functions.h"
#include "math/spherical.h"
#include "simd/scalar.h"

namespace crescent::inline cubature {

namespace {

constexpr int points = rule_size;

/// The rule's points in [-1, 1]^2: centre, +-l2 and +-l3 on the axes, +-l4 and +-l5 on the diagonals.
std::array<Vec2d, points> rule_points() {
    const double l2 = std::sqrt(9.0 / 70), l3 = std::sqrt(0.9), l5 = std::sqrt(9.0 / 19);
    std::array<Vec2d, points> p{};
    int i = 1;
    for (double l : {l2, l3}) {
        for (double sign : {-l, l}) p[i++] = {sign, 0};
        for (double sign : {-l, l}) p[i++] = {0, sign};
    }
    for (double l : {l3, l5})
        for (double x : {-l, l})
            for (double y : {-l, l}) p[i++] = {x, y};
    return p;
}

double sum(std::span<const double> g, int first, int count) {
    double s = 0;
    for (int i = first; i < first + count; ++i) s += g[i];
    return s;
}

void apply_rule(Cell& cell, std::span<const double> g) {
    const Rect& r = cell.rect;
    const double area = (r.a1 - r.a0) * (r.b1 - r.b0);
    const double s2 = sum(g, 1, 4), s3 = sum(g, 5, 4), s4 = sum(g, 9, 4), s5 = sum(g, 13, 4);
    const double w1 = (12824 - 9120 * 2 + 400 * 4) / 19683.0, w3 = (1820 - 400 * 2) / 19683.0;
    const double seven = w1 * g[0] + 980.0 / 6561 * s2 + w3 * s3 + 200.0 / 19683 * s4 + 6859.0 / 19683 / 4 * s5;
    const double five =
        (729 - 950 * 2 + 50 * 4) / 729.0 * g[0] + 245.0 / 486 * s2 + (265 - 100 * 2) / 1458.0 * s3 + 25.0 / 729 * s4;
    cell.value = area * seven;
    cell.error = cell.rule_error = area * std::fabs(seven - five);
    const auto [low, high] = std::minmax_element(g.begin(), g.end());
    std::copy(g.begin() + 5, g.begin() + 13, cell.outer.begin());
    std::copy(g.begin(), g.end(), cell.at.begin());
    cell.low = *low;
    cell.high = *high;
    const double ratio = (9.0 / 70) / 0.9;  // fourth differences along either axis choose the side to halve
    const double along_a = std::fabs(g[1] + g[2] - 2 * g[0] - ratio * (g[5] + g[6] - 2 * g[0]));
    const double along_b = std::fabs(g[3] + g[4] - 2 * g[0] - ratio * (g[7] + g[8] - 2 * g[0]));
    cell.split_a = along_a > along_b || (along_a == along_b && (r.a1 - r.a0) > 2 * (r.b1 - r.b0));
}

void evaluate(std::span<Cell> cells, const Batch& g) {
    static const std::array<Vec2d, points> rule = rule_points();
    std::vector<Vec2d> at(cells.size() * points);
    std::vector<double> values(at.size());
    for (std::size_t c = 0; c < cells.size(); ++c) {
        const Rect& r = cells[c].rect;
        for (int i = 0; i < points; ++i)
            at[c * points + i] = {0.5 * (r.a0 + r.a1) + 0.5 * (r.a1 - r.a0) * rule[i].x,
                0.5 * (r.b0 + r.b1) + 0.5 * (r.b1 - r.b0) * rule[i].y};
    }
    g(at, values);
    for (std::size_t c = 0; c < cells.size(); ++c) apply_rule(cells[c], std::span(values).subspan(c * points, points));
}

/// What the draws say of a cell, where it differs from its integral by more than chance allows: six standard
/// deviations; or where they fell higher than the rule has seen.
double disagreement(Cell& cell, double total) {
    constexpr int patience = 14;  // halvings; a density that is wrong never comes to agree
    if (total <= 0 || cell.suspected > patience) return 0;
    const double seen = static_cast<double>(cell.inside.size()), due = cell.value * total;
    // Draws at which the integrand is more than the rule knows of: a sliver behind a jump. The cell keeps their number.
    if (cell.higher_than != cell.high) cell.higher = 0, cell.higher_than = cell.high, cell.compared = 0;
    for (; cell.compared < cell.inside.size(); ++cell.compared)
        cell.higher += cell.inside[cell.compared].g > 1.3 * cell.high;
    const bool off = std::fabs(seen - due) > 6 * std::sqrt(std::max(due, 0.0)) + 2;
    return std::max(off ? std::fabs(seen - due) : 0.0, cell.higher) / total;
}

std::array<Cell, 2> halve(Cell& cell, double total) {
    Rect lower = cell.rect, upper = cell.rect;
    if (cell.split_a) lower.a1 = upper.a0 = 0.5 * (cell.rect.a0 + cell.rect.a1);
    else lower.b1 = upper.b0 = 0.5 * (cell.rect.b0 + cell.rect.b1);
    const int suspected = cell.suspected + (disagreement(cell, total) > 0);
    std::array<Cell, 2> out = {Cell(lower, suspected), Cell(upper, suspected)};
    for (Cell& half : out) half.beside_jump = cell.jumpy();
    for (const SampleValue& w : cell.inside)
        out[(cell.split_a ? w.at.x < lower.a1 : w.at.y < lower.b1) ? 0 : 1].inside.push_back(w);
    return out;
}

std::vector<Cell> start_cells(const std::vector<Rect>& start, int bins, const SamplesPerBin* samples) {
    std::vector<Cell> cells;
    std::vector<std::vector<std::size_t>> of_bin(static_cast<std::size_t>(bins));
    for (const Rect& r : start) {
        of_bin[static_cast<std::size_t>(r.bin)].push_back(cells.size());
        cells.emplace_back(r, 0);
    }
    for (std::size_t b = 0; samples && b < of_bin.size(); ++b)
        for (const SampleValue& w : samples->bins[b])
            for (std::size_t c : of_bin[b]) {
                const Rect& r = cells[c].rect;
                if (w.at.x < r.a0 || w.at.x > r.a1 || w.at.y < r.b0 || w.at.y > r.b1) continue;
                cells[c].inside.push_back(w);
                break;
            }
    return cells;
}

}  // namespace

namespace {

/// Halves cells, the worst first, until the errors left are small; true where cells at a jump were left for cutting.
bool refine(std::vector<Cell>& cells, const Batch& g, const Effort& effort, double total, Integral& out) {
    bool edges = false;
    for (;;) {
        double all = 0;
        std::vector<std::pair<double, std::size_t>> order;
        edges = false;
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const bool at_edge =
                !cells[i].bent && (cells[i].cut || (cells[i].jumps() && cells[i].step() < effort.edge_mass));
            const double urge = std::max(at_edge ? 0 : cells[i].error, disagreement(cells[i], total));
            edges = edges || (at_edge && !cells[i].cut);
            all += urge;
            order.emplace_back(urge, i);
        }
        out.settled = !(all > effort.tolerance);
        if (out.settled || out.evaluations >= effort.most_evaluations) return edges;
        std::sort(order.begin(), order.end(), std::greater<>());
        const std::size_t room = (effort.most_evaluations - out.evaluations) / (2 * points) + 1;
        double covered = 0;  // the largest errors, to nine tenths of the whole
        std::vector<Cell> fresh;
        std::size_t count = 0;
        for (; count < order.size() && count < room && covered < 0.9 * all; ++count) {
            covered += order[count].first;
            for (Cell& half : halve(cells[order[count].second], total)) fresh.push_back(std::move(half));
        }
        evaluate(fresh, g);
        out.evaluations += fresh.size() * points;
        bool found = false;  // beside a jump a corner may be cut off
        out.evaluations +=
            try_rims(fresh, g, effort.edge_mass, found, [](const Cell& c) { return c.beside_jump && !c.rough(); });
        for (std::size_t k = 0; k < count; ++k) {
            Cell& parent = cells[order[k].second];
            // Both halves answer for what they differ by from the whole: a rule may be blind to a spike, two seldom
            // are.
            const double surprise = std::fabs(parent.value - fresh[2 * k].value - fresh[2 * k + 1].value) / 16;
            const bool neither = !fresh[2 * k].rough() && !fresh[2 * k + 1].rough();
            for (Cell* half : {&fresh[2 * k], &fresh[2 * k + 1]})
                if (neither || half->rough()) half->error = std::max(half->error, surprise);
            parent = std::move(fresh[2 * k]);
            cells.push_back(std::move(fresh[2 * k + 1]));
        }
    }
}

}  // namespace

namespace {

/// The sum, and what it is known to: where the integrand is smooth by the rule's own estimate; along jumps, where
/// errors have either sign, by the audit's differences; and never less than the audit's difference from the whole.
void add_up(const std::vector<Cell>& cells, int bins, const Audit& look, Integral& out) {
    const std::size_t n = static_cast<std::size_t>(bins);
    out.evaluations += look.evaluations;
    out.bins.assign(n, 0.0);
    out.bin_errors.assign(n, 0.0);
    for (const Cell& c : cells) {
        out.bins[static_cast<std::size_t>(c.rect.bin)] += c.value;
        if (c.jumps() && !c.bent) out.settled = false;  // nothing was left to look for the jump with
        if (c.jumpy()) continue;
        out.error += c.error;
        out.bin_errors[static_cast<std::size_t>(c.rect.bin)] += c.error;
    }
    for (double v : out.bins) out.value += v;
    for (std::size_t i = 0; i < n; ++i) out.bin_errors[i] += std::sqrt(look.bin_squares[i]);
    out.second = look.value;
    out.second_se = std::sqrt(look.smooth + look.jumps);
    const double off = std::fabs(out.second - out.value);
    out.error = std::max(out.error + 2 * std::sqrt(look.jumps), off > 2 * out.second_se ? off : 0.0);
}

}  // namespace

Integral integrate(
    std::vector<Rect> start, int bins, const Batch& g, const Effort& effort, const SamplesPerBin* samples) {
    const double total = samples ? samples->total : 0;
    std::vector<Cell> cells = start_cells(start, bins, samples);
    evaluate(cells, g);
    Integral out;
    out.evaluations = cells.size() * points;
    bool edges = refine(cells, g, effort, total, out);
    Effort rest = effort;
    rest.most_evaluations *= 2;  // as many again for what is cut along jumps, and for what the audit comes upon
    const auto room = [&] { return rest.most_evaluations - std::min(rest.most_evaluations, out.evaluations); };
    for (std::uint32_t round = 0; round < 12 && room() > 0; ++round) {
        bool found = false;  // what the rule did not see: corners cut off, and whatever points at random come upon
        if (edges) out.evaluations += try_rims(cells, g, effort.edge_mass, found, [](const Cell&) { return true; });
        if (edges)
            out.evaluations += cut_along_jumps(cells, g, effort.edge_mass, room());  // what has none is halved on
        out.evaluations += look_around(cells, g, effort.edge_mass, found);
        const Audit look = audit(cells, bins, g, round, 0.02 * effort.edge_mass, 0);
        out.evaluations += look.evaluations;
        if (!edges && !found && !look.found) break;
        edges = refine(cells, g, rest, total, out);
    }
    for (std::uint32_t round = 99;; ++round) {  // the last look is the widest: what it comes upon is halved too
        if (edges) out.evaluations += cut_along_jumps(cells, g, effort.edge_mass, room());
        const Audit look = audit(cells, bins, g, round, 0.02 * effort.edge_mass, effort.most_evaluations / 4);
        if (!look.found || round == 103 || 2 * look.evaluations >= room()) {
            add_up(cells, bins, look, out);
            return out;
        }
        out.evaluations += look.evaluations;
        edges = refine(cells, g, rest, total, out);
    }
}

Vec3d SphereMap::direction(Vec2d at) const {
    return frame.to_world(math::spherical(std::sqrt(std::max(at.x * (2 - at.x), 0.0)), 1 - at.x, 2 * pi * at.y));
}

double SphereMap::height(Vec3d w) const {
    const Vec3d off = w - frame.n;
    const double near = 0.5 * dot(off, off);  // 1 - cos for unit w, without cancellation near the axis
    return near < 0.5 ? near : 1 - dot(w, frame.n);
}

Vec2d SphereMap::coordinates(Vec3d w) const {
    const double turns = math::atan2(dot(w, frame.b), dot(w, frame.t)) / (2 * pi);
    return {height(w), turns < 0 ? turns + 1 : turns};
}

std::vector<Rect> graded_cells(double a_end) {
    const double edges[] = {0, 1e-6, 1e-4, 1e-2, 0.1, 0.4, 1, 1.6, 2};
    std::vector<Rect> out;
    for (std::size_t i = 0; i + 1 < std::size(edges) && edges[i] < a_end; ++i)
        for (int k = 0; k < 6; ++k) out.push_back({edges[i], std::min(edges[i + 1], a_end), k / 6.0, (k + 1) / 6.0, 0});
    return out;
}

namespace {

struct Node {
    Rect rect;
    std::vector<Vec2d> inside;
    int depth = 0;
};

void split(const Node& n, std::vector<Node>& stack) {
    const Rect& r = n.rect;
    const double mid = 0.5 * (r.a0 + r.a1), sin = std::sqrt(std::max(mid * (2 - mid), 1e-12));
    const bool along_a = (r.a1 - r.a0) / sin > 2 * pi * (r.b1 - r.b0) * sin;  // the longer side, in radians
    Node lower{r, {}, n.depth + 1}, upper{r, {}, n.depth + 1};
    if (along_a) lower.rect.a1 = upper.rect.a0 = mid;
    else lower.rect.b1 = upper.rect.b0 = 0.5 * (r.b0 + r.b1);
    for (Vec2d at : n.inside)
        ((along_a ? at.x < lower.rect.a1 : at.y < lower.rect.b1) ? lower : upper).inside.push_back(at);
    stack.push_back(std::move(lower));
    stack.push_back(std::move(upper));
}

}  // namespace

std::vector<Rect> refined_at_pilots(
    std::vector<Rect> cells, const SphereMap& map, std::span<const Vec3d> pilot_directions) {
    std::vector<Node> stack;
    for (const Rect& r : cells) stack.push_back({r, {}, 0});
    for (Vec3d w : pilot_directions) {
        const Vec2d at = map.coordinates(w);
        const auto holds = [&](const Node& n) {  // one of them at most: cells do not overlap
            return at.x >= n.rect.a0 && at.x < n.rect.a1 && at.y >= n.rect.b0 && at.y < n.rect.b1;
        };
        if (const auto n = std::find_if(stack.begin(), stack.end(), holds); n != stack.end()) n->inside.push_back(at);
    }
    const std::size_t crowd = std::max<std::size_t>(pilot_directions.size() / 500, 3);
    std::vector<Rect> out;
    while (!stack.empty()) {
        const Node n = std::move(stack.back());
        stack.pop_back();
        if (n.inside.size() <= crowd || n.depth > 60) out.push_back(n.rect);
        else split(n, stack);
    }
    return out;
}

}  // namespace crescent::inline cubature
