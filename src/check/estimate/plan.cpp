// The tree grows in rounds, so that p is evaluated in batches: all nodes to `even_depth`, then in each round the eighth
// of the leaves with the highest score. The pilot draws shape the tree and have no other use, so that the choice of the
// tree causes no bias.
#include "check/estimate/plan.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "check/estimate/sampling_map.h"
#include "check/estimate/sort.h"
#include "check/constants.h"
#include "check/estimate/source.h"

namespace crescent::check {

namespace {

constexpr std::size_t round_share = 8;  // one leaf in eight is cut in a round
constexpr double least_score = 1e-7;    // a score too small for a cut: 1/2000 of the detection floor
constexpr int fewest_steps = 4;         // measured steps in a leaf that has its own mean
constexpr double fewest_pilots = 8;     // draws of a leaf that is cut without a density, so that its halves have some

}  // namespace

class TreeGrowth {
    /// The state of a leaf while the tree grows.
    struct Growing {
        std::vector<DensityPoint> points;
        std::size_t first = 0, last = 0;  // its pilot draws
        double spread = 0, score = 0, q = 0;
        bool has_mass = false;
    };

public:
    TreeGrowth(Tree& tree, Source& source, std::vector<DensityPoint> pilots, std::uint32_t draws, double step,
        const CheckBudget& budget, const StreamKey& key)
        : tree_(tree),
          source_(source),
          pilots_(std::move(pilots)),
          draw_count_(draws),
          step_(step),
          budget_(budget),
          stream_(key) {}

    void grow(std::vector<DensityPoint> hints) {
        tree_.nodes_.push_back({});
        tree_.nodes_[0].step = step_;
        growing_.push_back({});
        growing_[0].points = std::move(hints);
        for (DensityPoint& e : growing_[0].points) e.hint = true;
        growing_[0].last = pilots_.size();
        rate({0});
        std::vector<int> front = {0};
        for (int depth = 0; depth < even_depth; ++depth) front = cut(front);
        std::vector<int> open;
        for (std::size_t i = 0; i < tree_.nodes_.size(); ++i)
            if (tree_.nodes_[i].child < 0) open.push_back(static_cast<int>(i));
        while (grow_round(open)) {}
        tree_.number_leaves();
        for (Leaf& leaf : tree_.leaves_) {
            const Growing& g = growing_[static_cast<std::size_t>(leaf.node)];
            leaf.q = g.q;
            leaf.spread = g.spread;
            leaf.score = g.score;
            leaf.has_mass = g.has_mass;
        }
    }

private:
    Tree& tree_;
    Source& source_;
    std::vector<DensityPoint> pilots_;
    std::uint32_t draw_count_;
    double step_;
    const CheckBudget& budget_;
    Stream stream_;
    std::vector<Growing> growing_;  // by node

    /// One round of best-first growth; false at the end.
    bool grow_round(std::vector<int>& open) {
        double spread = 0;
        for (int i : open) spread += growth_of(i).spread;
        const auto limit = static_cast<std::size_t>(
            spread / std::sqrt(static_cast<double>(budget_.points())) > detection_floor / 4 ? budget_.most_leaves()
                                                                                            : budget_.leaves());
        if (open.size() >= limit) return false;
        std::size_t count = std::min(std::max(open.size() / round_share, std::size_t{16}), limit - open.size());
        count = std::min(count, open.size());
        const auto chosen_end = open.begin() + static_cast<std::ptrdiff_t>(count);
        const auto precedes = [&](int a, int b) {
            return growth_of(a).score != growth_of(b).score ? growth_of(a).score > growth_of(b).score : a < b;
        };
        std::nth_element(open.begin(), chosen_end, open.end(), precedes);
        std::sort(open.begin(), chosen_end, precedes);
        std::vector<int> chosen(open.begin(), chosen_end);
        std::erase_if(chosen, [&](int i) { return growth_of(i).score <= least_score; });
        if (chosen.empty()) return false;
        const std::vector<int> fresh = cut(chosen);
        for (int i : chosen)
            if (tree_.nodes_[static_cast<std::size_t>(i)].child < 0) growth_of(i).score = 0;  // too narrow
        std::erase_if(open, [&](int i) { return tree_.nodes_[static_cast<std::size_t>(i)].child >= 0; });
        open.insert(open.end(), fresh.begin(), fresh.end());
        return true;
    }

    Growing& growth_of(int node) { return growing_[static_cast<std::size_t>(node)]; }

    /// The side to cut, by the difference of the halves; none if both sides are too narrow.
    std::optional<bool> side_to_cut(const TreeNode& node, const Growing& g) const {
        const ChartRect& rect = node.rect;
        const double limit = std::max(least_width, 4 * node.step);
        double gain[2] = {};
        for (bool along_phi : {false, true}) {
            if (along_phi && source_.is_line()) continue;
            const double middle = rect.middle(along_phi);
            const auto is_below = [&](ChartPoint point) { return (along_phi ? point.phi : point.t) < middle; };
            double sum[2] = {}, count[2] = {}, draws_below = 0;
            for (const DensityPoint& e : g.points) {
                sum[!is_below(e.place)] += e.p;
                ++count[!is_below(e.place)];
            }
            for (std::size_t k = g.first; k < g.last; ++k) draws_below += is_below(pilots_[k].place);
            double& to = gain[along_phi];
            to = std::fabs(2 * draws_below - static_cast<double>(g.last - g.first)) / draw_count_ + 1e-12;
            if (count[0] > 0 && count[1] > 0) to += rect.area() * std::fabs(sum[0] / count[0] - sum[1] / count[1]) / 2;
            if (rect.width(along_phi) > rect.width(!along_phi)) to *= wider_side;
            if (rect.width(along_phi) < limit) to = 0;
        }
        if (gain[0] == 0 && gain[1] == 0) return {};
        return gain[1] > gain[0];
    }

    /// Cuts these leaves in two if possible, and rates the halves.
    std::vector<int> cut(const std::vector<int>& nodes) {
        std::vector<int> fresh;
        for (int i : nodes) {
            const std::optional<bool> side = side_to_cut(tree_.nodes_[static_cast<std::size_t>(i)], growth_of(i));
            if (!side) continue;
            TreeNode& parent = tree_.nodes_[static_cast<std::size_t>(i)];
            const double middle = parent.rect.middle(*side), step = parent.step;
            parent.along_phi = *side;
            parent.child = static_cast<int>(tree_.nodes_.size());
            TreeNode halves[2] = {{parent.rect, -1, parent.depth + 1}, {parent.rect, -1, parent.depth + 1}};
            (*side ? halves[0].rect.phi1 : halves[0].rect.t1) = middle;
            (*side ? halves[1].rect.phi0 : halves[1].rect.t0) = middle;
            const auto is_below = [&](const DensityPoint& e) { return (*side ? e.place.phi : e.place.t) < middle; };
            Growing parts[2];
            const Growing state = std::move(growth_of(i));
            for (Growing& part : parts) part.points.reserve(state.points.size() + points_per_leaf);
            for (const DensityPoint& e : state.points) parts[!is_below(e)].points.push_back(e);
            const auto begin = pilots_.begin() + static_cast<std::ptrdiff_t>(state.first);
            const auto end = pilots_.begin() + static_cast<std::ptrdiff_t>(state.last);
            const auto split = static_cast<std::size_t>(std::partition(begin, end, is_below) - pilots_.begin());
            parts[0].first = state.first;
            parts[0].last = parts[1].first = split;
            parts[1].last = state.last;
            for (int k : {0, 1}) {
                fresh.push_back(static_cast<int>(tree_.nodes_.size()));
                halves[k].step = step_in(parts[k], step);
                tree_.nodes_.push_back(halves[k]);
                growing_.push_back(std::move(parts[k]));
            }
            tree_.depth_ = std::max(tree_.depth_, halves[0].depth);
        }
        rate(fresh);
        return fresh;
    }

    /// The mean step over the draws with a measured step; that of the parent if they are too few.
    double step_in(const Growing& g, double parent_step) const {
        double sum = 0;
        int count = 0;
        for (std::size_t k = g.first; k < g.last; ++k)
            if (pilots_[k].step >= 0) {
                sum += pilots_[k].step;
                ++count;
            }
        return count < fewest_steps ? parent_step : std::max(step_, sum / count);
    }

    static int sampled(const Growing& g) {
        return static_cast<int>(std::ranges::count_if(g.points, [](const DensityPoint& e) { return !e.hint; }));
    }

    /// Evaluates p until each leaf has its points, in one batch, and scores them.
    void rate(const std::vector<int>& nodes) {
        std::vector<ChartPoint> places;
        std::vector<Vec3d> w;
        for (int i : nodes)
            for (int k = sampled(growth_of(i)); k < points_per_leaf; ++k) {
                const double x = stream_.number(), y = stream_.number();
                places.push_back(tree_.nodes_[static_cast<std::size_t>(i)].rect.at(x, (k + y) / points_per_leaf));
                w.push_back(from_chart(places.back()));
            }
        std::vector<double> p(w.size());
        source_.density(w, p);
        std::size_t next = 0;
        for (int i : nodes) {
            Growing& g = growth_of(i);
            for (int k = sampled(g); k < points_per_leaf; ++k, ++next) g.points.push_back({places[next], p[next]});
            score(tree_.nodes_[static_cast<std::size_t>(i)].rect.area(), g);
        }
    }

    /// Without a density only the draws decide where leaves are needed.
    void score_by_draws(double area, Growing& g) const {
        const double draws = static_cast<double>(g.last - g.first);
        g.score = draws < fewest_pilots ? 0 : draws / draw_count_;
        g.has_mass = draws > 0;
        g.q = std::max(draws, 0.5) / draw_count_ / area;
    }

    void score(double area, Growing& g) const {
        if (!source_.has_density()) return score_by_draws(area, g);
        const double n = sampled(g);
        double mean = 0, square = 0, top = 0, peak = 0;
        for (const DensityPoint& e : g.points) {
            if (e.hint) {
                peak = std::max(peak, e.p);
                continue;
            }
            mean += e.p / n;
            square += e.p * e.p / n;
            top = std::max(top, e.p);
        }
        for (std::size_t k = g.first; k < g.last; ++k) peak = std::max(peak, pilots_[k].p);
        const double draw_share = static_cast<double>(g.last - g.first) / draw_count_, claim = area * mean;
        const bool is_missed = peak > alike * top;
        const double hidden = is_missed ? std::max(draw_share, area * std::min(peak, 1 / area) / n) : 0;
        g.spread = area * std::sqrt(std::max(0.0, square - mean * mean));
        g.score = g.spread + std::fabs(draw_share - claim) + worth_of_mass * std::max(draw_share, claim) + hidden;
        // Not from the draws alone: their noise would make h vary from leaf to leaf, and replicates would gain nothing.
        g.q = is_missed ? (mean + draw_share / area) / 2 : mean;
        g.has_mass = g.q > 0;
        if (!g.has_mass) g.q = std::max(draw_share, 0.5 / draw_count_) / area;
    }
};

void Tree::number_leaves() {
    std::vector<int> ancestor_rows(nodes_.size());
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        TreeNode& x = nodes_[i];
        if (x.depth <= replicated_depth) ancestor_rows[i] = x.row = static_cast<int>(rows_++);
        if (x.child >= 0) {
            const TreeNode& c = nodes_[static_cast<std::size_t>(x.child)];
            ancestor_rows[static_cast<std::size_t>(x.child)] = ancestor_rows[static_cast<std::size_t>(x.child) + 1] =
                ancestor_rows[i];
            cuts_.push_back(
                {x.along_phi ? c.rect.phi1 : c.rect.t1, static_cast<std::uint32_t>(x.child), x.along_phi, 0});
            continue;
        }
        x.leaf = static_cast<int>(leaves_.size());
        cuts_.push_back({NAN, static_cast<std::uint32_t>(i), false, static_cast<std::uint32_t>(x.leaf)});
        Leaf leaf;
        leaf.node = static_cast<int>(i);
        leaf.coarse = ancestor_rows[i];
        leaf.step = x.step;
        leaves_.push_back(leaf);
    }
}

/// Makes the grids of the search.
class StartGrids {
public:
    explicit StartGrids(Tree& tree) : tree_(tree), leaves_below_(tree.nodes_.size(), 1) {
        for (std::size_t i = tree.nodes_.size(); i-- > 0;)
            if (const int child = tree.nodes_[i].child; child >= 0) {
                const auto c = static_cast<std::size_t>(child);
                leaves_below_[i] = leaves_below_[c] + leaves_below_[c + 1];
            }
        add_grid(0);
    }

private:
    static constexpr std::uint32_t cells = Tree::cells;
    static constexpr int many_leaves = 128;  // below a node with a grid of its own: one leaf for each eighth cell
    Tree& tree_;
    std::vector<int> leaves_below_;

    struct Cells {
        std::uint32_t t0 = 0, t1 = cells, phi0 = 0, phi1 = cells;
    };
    std::uint32_t add_grid(std::size_t node) {
        const ChartRect& r = tree_.nodes_[node].rect;
        const auto first = static_cast<std::uint32_t>(tree_.starts_.size());
        const auto grid = static_cast<std::uint32_t>(tree_.grids_.size());
        tree_.grids_.push_back({r.t0, r.phi0, cells / (r.t1 - r.t0), cells / (r.phi1 - r.phi0), first});
        tree_.starts_.resize(first + cells * cells);
        fill(first, node, {});
        return Tree::is_grid | grid;
    }
    /// Sets the entries of these cells, which are the rectangle of the node.
    void fill(std::uint32_t first, std::size_t node, const Cells& block) {
        const TreeNode& x = tree_.nodes_[node];
        const std::uint32_t from = x.along_phi ? block.phi0 : block.t0, to = x.along_phi ? block.phi1 : block.t1;
        if (x.child < 0 || to - from == 1) {
            const std::uint32_t start =
                leaves_below_[node] >= many_leaves ? add_grid(node) : static_cast<std::uint32_t>(node);
            for (std::uint32_t t = block.t0; t < block.t1; ++t)
                std::fill_n(tree_.starts_.begin() + first + t * cells + block.phi0, block.phi1 - block.phi0, start);
            return;
        }
        Cells low = block, high = block;
        (x.along_phi ? low.phi1 : low.t1) = (x.along_phi ? high.phi0 : high.t0) = (from + to) / 2;
        fill(first, static_cast<std::size_t>(x.child), low);
        fill(first, static_cast<std::size_t>(x.child) + 1, high);
    }
};

Tree::Tree(Source& source, std::vector<DensityPoint> pilots, std::uint32_t draws, std::vector<DensityPoint> hints,
    double step, const CheckBudget& budget, const StreamKey& key) {
    const double direction_share = static_cast<double>(pilots.size()) / std::max(draws, 1u);
    TreeGrowth(*this, source, std::move(pilots), draws, step, budget, key).grow(std::move(hints));
    StartGrids{*this};
    find_edges();
    set_resolvable_p(direction_share, budget.points());
}

std::vector<double> Tree::shares_of_points() const {
    std::vector<double> out;
    for (const Leaf& leaf : leaves_)
        out.push_back(leaf.spread + worth_of_score * leaf.score + (leaf.edge ? rect(leaf).area() * leaf.q / 4 : 0));
    const double sum = std::accumulate(out.begin(), out.end(), 1e-300);
    for (double& x : out) x = even_points / static_cast<double>(out.size()) + (1 - even_points) * x / sum;
    return out;
}

void Tree::set_resolvable_p(double direction_share, double points) {
    double leaf_mass = 0;
    for (const Leaf& leaf : leaves_) leaf_mass += leaf.q * rect(leaf).area();
    const double integral = std::max(direction_share, leaf_mass);  // of a p that is too large, what the leaves hold
    const std::vector<double> shares = shares_of_points();
    for (std::size_t l = 0; l < leaves_.size(); ++l) {
        Leaf& leaf = leaves_[l];
        const double point = heaviest_point * integral * (points * shares[l] + 2) / rect(leaf).area();
        leaf.resolvable_p = std::max(point, far_above * leaf.q);
    }
}

void Tree::find(std::span<const ChartPoint> points, std::span<std::uint32_t> leaves) const {
    constexpr std::size_t block_size = 16;
    for (std::size_t first = 0; first < points.size(); first += block_size) {
        const std::size_t n = std::min(block_size, points.size() - first);
        std::array<ChartPoint, block_size> block;
        std::array<std::uint32_t, block_size> node{};
        for (std::size_t k = 0; k < block_size; ++k) {
            block[k] = points[first + std::min(k, n - 1)];
            node[k] = start_in(0, block[k]);
        }
        // Without a branch for each point: few of them could be predicted.
        for (bool goes_deeper = true; goes_deeper;) {
            goes_deeper = false;
            for (std::size_t k = 0; k < block_size; ++k) {
                const bool is_in_grid = (node[k] & is_grid) != 0;
                const std::uint32_t next = start_in(is_in_grid ? node[k] & ~is_grid : 0, block[k]);
                node[k] = is_in_grid ? next : node[k];
                goes_deeper |= (node[k] & is_grid) != 0;
            }
        }
        for (bool has_moved = true; has_moved;) {
            has_moved = false;
            for (std::size_t k = 0; k < block_size; ++k) {
                const std::uint32_t next = cuts_[node[k]].next(block[k]);
                has_moved |= next != node[k];
                node[k] = next;
            }
        }
        for (std::size_t k = 0; k < n; ++k) leaves[first + k] = cuts_[node[k]].leaf;
    }
}

/// A leaf is at an edge if a neighbouring leaf has another density: it may then contain a strip of it without any
/// point. The neighbours are those at two places beyond each side.
void Tree::find_edges() {
    constexpr double margin = 1e-12, places[2] = {0.25, 0.75};
    constexpr std::size_t sides = 4, leaves_per_block = 512;
    std::vector<ChartPoint> outer_points;
    std::vector<std::size_t> leaf_of;  // the leaf of each of these points
    std::vector<std::uint32_t> neighbours;
    for (std::size_t first = 0; first < leaves_.size(); first += leaves_per_block) {
        outer_points.clear();
        leaf_of.clear();
        for (std::size_t l = first; l < std::min(first + leaves_per_block, leaves_.size()); ++l) {
            if (!leaves_[l].has_mass) continue;
            const ChartRect& r = rect(leaves_[l]);
            for (std::size_t side = 0; side < sides; ++side)
                for (double x : places) {
                    ChartPoint point = r.at(x, x);
                    if (side == 0) point.t = r.t0 - margin;
                    if (side == 1) point.t = r.t1 + margin;
                    if (side == 2) point.phi = r.phi0 - margin < 0 ? r.phi0 - margin + two_pi : r.phi0 - margin;
                    if (side == 3) point.phi = r.phi1 + margin >= two_pi ? r.phi1 + margin - two_pi : r.phi1 + margin;
                    if (point.t < 0 || point.t > 2) continue;
                    outer_points.push_back(point);
                    leaf_of.push_back(l);
                }
        }
        neighbours.resize(outer_points.size());
        find(outer_points, neighbours);
        for (std::size_t k = 0; k < leaf_of.size(); ++k) {
            const Leaf& neighbour = leaves_[neighbours[k]];
            Leaf& leaf = leaves_[leaf_of[k]];
            const double q = neighbour.has_mass ? neighbour.q : 0;
            if (std::max(q, leaf.q) > alike * std::min(q, leaf.q)) leaf.edge = true;
        }
    }
}

// ---- The pilot draws and the step of the arithmetic.

double step_of(std::vector<double> v) {
    if (v.size() < 64) return 0;
    sort_by_key(v, sort_key);
    for (std::size_t k = 0; k + 1 < v.size(); ++k) v[k] = v[k + 1] - v[k];
    v.pop_back();
    sort_by_key(v, sort_key);
    const auto equal_pairs = static_cast<std::size_t>(std::upper_bound(v.begin(), v.end(), 0.0) - v.begin());
    const std::size_t n = v.size(), close_pairs = std::min(n - 1, 2 * equal_pairs + n / 16);
    if (equal_pairs < 3 || equal_pairs == n) return 0;
    return std::min(2 * v[close_pairs] * static_cast<double>(equal_pairs) / static_cast<double>(close_pairs),
        v[(equal_pairs + n) / 2]);
}

double step_of_directions(std::span<const Vec3d> directions) {
    std::vector<double> xyz[3];
    for (Vec3d w : directions) {
        xyz[0].push_back(w.x);
        xyz[1].push_back(w.y);
        xyz[2].push_back(w.z);
    }
    double step = 0;
    for (auto& v : xyz) step = std::max(step, step_of(std::move(v)));
    return angle_per_step * std::min(step, coarsest_step);
}

namespace {

struct Pilot {
    std::vector<DensityPoint> points;
    std::vector<Vec3d> directions;
    std::vector<PrimarySample> u;    // of the first of them
    std::array<double, 3> weight{};  // mean
    std::uint32_t draw_count = 0;
};

/// The mean weight f cos / pdf by channel of draws that come without one, from the directions among the first draws.
/// pdf: that of each draw.
std::array<double, 3> weights_from_f(
    Source& source, std::span<const Vec3d> wi, std::span<const double> pdf, std::uint32_t draws) {
    std::array<double, 3> out{};
    std::vector<Vec3d> f(wi.size());
    source.f_cos(wi, f);
    for (std::size_t i = 0; i < wi.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const double x = channel_of(f[i], c) / pdf[i];
            if (std::isfinite(x)) out[static_cast<std::size_t>(c)] += x / draws;
        }
    return out;
}

Pilot draw_pilot(Source& source, const CheckBudget& budget, const StreamKey& key) {
    Pilot out;
    std::vector<PrimarySample> u;
    std::vector<Draw> draws;
    std::vector<double> unweighted_pdf;
    std::vector<Vec3d> unweighted;  // directions without a weight, among the first batch
    out.draw_count = source.available(key, budget.pilot());
    for (std::uint32_t from = 0; from < out.draw_count; from += batch_size) {
        const std::uint32_t n = std::min(batch_size, out.draw_count - from);
        u.resize(n);
        draws.assign(n, {});
        source.draw(key, from, u, draws);
        const auto [rows, w, p] = usable_draws(source, draws);
        for (std::size_t i = 0; i < w.size(); ++i) {
            const Draw& d = draws[rows[i]];
            out.points.push_back({to_chart(w[i]), p[i]});
            out.directions.push_back(w[i]);
            if (out.u.size() < budget.step_draws()) out.u.push_back(u[rows[i]]);
            if (!d.weight) {
                if (from == 0) {
                    unweighted.push_back(w[i]);
                    unweighted_pdf.push_back(d.pdf);
                }
                continue;
            }
            const Vec3d x = weight_by_channel(d, source.channels());
            for (int c = 0; c < 3; ++c)
                if (std::isfinite(channel_of(x, c)))
                    out.weight[static_cast<std::size_t>(c)] += channel_of(x, c) / out.draw_count;
        }
    }
    if (source.has_f() && source.has_density() && !unweighted.empty()) {
        const std::array<double, 3> x =
            weights_from_f(source, unweighted, unweighted_pdf, std::min(batch_size, out.draw_count));
        for (std::size_t c = 0; c < 3; ++c) out.weight[c] += x[c];
    }
    return out;
}

Values change_per_step(Source& source, const Plan& plan, const Pilot& pilot, const std::vector<LocalStep>& steps) {
    std::vector<std::size_t> rows;
    std::vector<Vec3d> next;
    for (std::size_t i = 0; i < steps.size(); ++i)
        if (steps[i].jump > 0) {
            rows.push_back(i);
            next.push_back(steps[i].next);
        }
    std::vector<double> p(next.size());
    source.density(next, p);
    Values out{};
    for (std::size_t k = 0; k < rows.size(); ++k) {
        if (!(p[k] > 0)) continue;
        const auto values_at = [&](Vec3d w, double density) {
            return plan.values(plan.tree.leaves()[plan.tree.find(to_chart(w))], w, density);
        };
        const std::size_t i = rows[k];
        const Values values = values_at(pilot.directions[i], pilot.points[i].p), next_values = values_at(next[k], p[k]);
        for (std::size_t q = 0; q < integrands; ++q)
            out[q] += std::fabs(next_values[q] - values[q]) / static_cast<double>(steps.size());
    }
    return out;
}

}  // namespace

Plan make_plan(Source& source, const CheckBudget& budget, StreamKey key, std::vector<DensityPoint> hints) {
    key.purpose = Purpose::pilot;
    Pilot pilot = draw_pilot(source, budget, key);
    std::vector<double> log_p;
    for (const DensityPoint& e : pilot.points)
        if (e.p > 0) log_p.push_back(e.p);
    const auto direction_count = static_cast<std::uint32_t>(pilot.points.size());
    Vec3d middle{};
    for (Vec3d w : pilot.directions) middle = middle + w * (1.0 / direction_count);
    const double step = step_of_directions(pilot.directions);
    const std::vector<LocalStep> steps =
        local_steps(source, pilot.u, {pilot.directions.begin(), pilot.directions.begin() + std::ssize(pilot.u)});
    for (std::size_t i = 0; i < steps.size(); ++i) pilot.points[i].step = steps[i].jump;
    double median = 0;
    if (!log_p.empty()) {
        const auto median_place = log_p.begin() + static_cast<std::ptrdiff_t>(log_p.size() / 2);
        std::nth_element(log_p.begin(), median_place, log_p.end());
        median = math::log(*median_place);
    }
    key.purpose = Purpose::tree;
    Plan plan{.tree = Tree(source, pilot.points, pilot.draw_count, std::move(hints), step, budget, key),
        .step = step,
        .median_log_p = median,
        .middle = middle,
        .mean_weight = pilot.weight,
        .per_step = {},
        .estimates = source.estimates || !source.has_density(),
        .direction_count = direction_count,
        .draw_count = pilot.draw_count};
    if (!plan.estimates) plan.per_step = change_per_step(source, plan, pilot, steps);
    return plan;
}

}  // namespace crescent::check
