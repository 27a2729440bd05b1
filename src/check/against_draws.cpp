// Given the number of draws of both in a node, the draws of A in its first half have a hypergeometric distribution if
// both samplers have the same distribution. It is the distribution of a sum of independent indicators (Vatutin and
// Mikhailov 1982), so Bennett's inequality holds with its variance at every count.
#include "check/against_draws.h"

#include <algorithm>
#include <cmath>

#include "check/constants.h"
#include "check/estimate/observations.h"
#include "check/verdicts/questions.h"

namespace crescent::check {

namespace {

constexpr std::size_t kinds_before_deltas = 2;  // no sample, a direction
constexpr double same_delta_direction = 1e-4;   // distance of unit vectors
constexpr std::size_t drawn_kept = 256;

/// Decides which draws are usable, and which of them are directions of the density.
class DrawClassifier {
public:
    DrawClassifier(const AgainstSide& side, int technique)
        : source_(*side.check_case.adapter, technique, side.check_case.wo, side.check_case.light),
          other_(side.other, 0, side.check_case.wo, side.check_case.light) {}
    Source& source() { return source_; }

    static bool usable(const Draw& d) {
        return std::isfinite(d.pdf) && d.pdf >= 0 && (!(d.pdf > 0) || std::isfinite(d.wi.x + d.wi.y + d.wi.z)) &&
            (!(d.pdf > 0) || dot(d.wi, d.wi) > 0) && d.delta >= 0 && d.delta <= 1;
    }
    bool is_drawn(const Draw& d) {
        if (!usable(d) || d.delta != 0 || !(d.pdf > 0)) return false;
        if (d.wi.z > 0) return true;
        return (source_.has_density() || !other_.has_density() ? source_ : other_).density(d.wi) > 0;
    }

private:
    Source source_, other_;
};

Vec3d weight_of(const Draw& d, int channels) {
    const double w = d.weight.value_or(0);
    return channels == 3 ? d.weights : Vec3d{w, w, w};
}

std::size_t nearest_delta(std::span<const Vec3d> delta_directions, Vec3d w) {
    const auto distance = [w](Vec3d direction) { return length(w - direction); };
    return static_cast<std::size_t>(
        std::ranges::min_element(delta_directions, {}, distance) - delta_directions.begin());
}

/// Pilot draws of all techniques.
std::uint32_t draw_pilots(
    const AgainstSide& side, const CheckBudget& budget, std::vector<Vec3d>& out, std::vector<DeltaPart>& parts) {
    std::uint32_t pilot_draws = 0;
    DeltaParts delta;
    for (int t = 0; t < side.check_case.adapter->techniques(); ++t) {
        DrawClassifier classifier(side, t);
        StreamKey key = side.key;
        key.purpose = Purpose::pilot;
        key.technique = static_cast<std::uint8_t>(t);
        const std::uint32_t count = classifier.source().available(key, budget.pilot());
        std::vector<PrimarySample> u;
        std::vector<Draw> draws;
        for (std::uint32_t from = 0; from < count; from += batch_size) {
            u.resize(std::min(batch_size, count - from));
            draws.assign(u.size(), {});
            classifier.source().draw(key, from, u, draws);
            for (const Draw& d : draws)
                if (classifier.is_drawn(d)) out.push_back(normalize(d.wi));
                else if (d.delta > 0 && d.delta <= 1) delta.add(d, weight_of(d, classifier.source().channels()));
        }
        pilot_draws += count;
    }
    parts = delta.parts(pilot_draws);
    return pilot_draws;
}

}  // namespace

CommonTree common_tree(const AgainstSide& a, const AgainstSide& b, const CheckBudget& budget) {
    std::vector<Vec3d> of_a, of_b, drawn, delta_directions;
    std::vector<DeltaPart> delta_a, delta_b;
    const std::uint32_t pilot_draws = draw_pilots(a, budget, of_a, delta_a) + draw_pilots(b, budget, of_b, delta_b);
    for (const auto* parts : {&delta_a, &delta_b})
        for (const DeltaPart& p : *parts)
            if (std::ranges::none_of(
                    delta_directions, [&](Vec3d w) { return length(w - p.wi) < same_delta_direction; }))
                delta_directions.push_back(p.wi);
    const double step = std::max(step_of_directions(of_a), step_of_directions(of_b));
    std::vector<DensityPoint> pilots;
    Vec3d middle{};
    for (const auto* directions : {&of_a, &of_b}) {
        for (std::size_t i = 0; i < directions->size(); ++i) {
            const Vec3d w = (*directions)[i];
            pilots.push_back({to_chart(w), 1});
            middle = middle + w * (1.0 / static_cast<double>(of_a.size() + of_b.size()));
            if (i < drawn_kept) drawn.push_back(w);
        }
    }
    Source source(*a.check_case.adapter, 0, a.check_case.wo, a.check_case.light);
    source.by_draws = true;
    StreamKey key = a.key;
    key.purpose = Purpose::tree;
    CommonTree out{.tree = Tree(source, std::move(pilots), pilot_draws, {}, step, budget, key),
        .step = step,
        .middle = middle,
        .log_q = 0,
        .delta_directions = std::move(delta_directions),
        .delta_a = std::move(delta_a),
        .delta_b = std::move(delta_b),
        .drawn = std::move(drawn)};
    double total = 0;
    for (const Leaf& leaf : out.tree.leaves()) {
        const double m = leaf.q * out.tree.rect(leaf).area();
        out.log_q += m * math::log(leaf.q);
        total += m;
    }
    out.log_q /= total;
    return out;
}

namespace {

/// Draws of one technique of one sampler.
class AgainstTechnique {
public:
    AgainstTechnique(const AgainstSide& side, const CommonTree& common, int technique, AgainstDraws& to)
        : common_(common), classifier_(side, technique), source_(classifier_.source()), to_(to) {}

    void independent(StreamKey key, std::uint32_t from, std::uint32_t last, std::uint32_t of_f) {
        key.purpose = Purpose::draws;
        key.technique = static_cast<std::uint8_t>(source_.technique);
        last = source_.available(key, last);
        for (; from < last; from += batch_size) {
            u_.resize(std::min(batch_size, last - from));
            draws_.assign(u_.size(), {});
            source_.draw(key, from, u_, draws_);
            to_.independent += static_cast<double>(u_.size());
            for (const Draw& d : draws_) take(d, -1);
            if (from < of_f) add_weights(from);
        }
    }
    void scrambled(StreamKey key, std::uint32_t first, std::uint32_t last) {
        if (source_.traits.own_random || !source_.declaration.can_draw) return;
        key.purpose = Purpose::scrambles;
        key.technique = static_cast<std::uint8_t>(source_.technique);
        for (int set = 0; set < replicate_sets; ++set) {
            key.part = static_cast<std::uint16_t>(set);
            const ScrambledSobol points(key, source_.numbers(), source_.resolution());
            for (std::uint32_t from = first; from < last; from += static_cast<std::uint32_t>(u_.size())) {
                u_.resize(std::min(source_.batch_rows(), last - from));
                draws_.assign(u_.size(), {});
                points.points(from, u_);
                source_.draw(u_, draws_);
                for (const Draw& d : draws_) take(d, set);
            }
        }
        to_.scrambled += static_cast<double>(last - first) * replicate_sets;
    }

private:
    const CommonTree& common_;
    DrawClassifier classifier_;
    Source& source_;
    AgainstDraws& to_;
    std::vector<PrimarySample> u_;
    std::vector<Draw> draws_;

    void take(const Draw& d, int set) {
        to_.invalid += !DrawClassifier::usable(d);
        const bool drawn = classifier_.is_drawn(d);
        if (set < 0) {
            const bool direction = d.delta > 0 && !common_.delta_directions.empty();
            ++to_.kinds[drawn   ? 1
                    : direction ? kinds_before_deltas + nearest_delta(common_.delta_directions, d.wi)
                                : 0];
        }
        if (!drawn) return;
        const Vec3d w = normalize(d.wi);
        const std::size_t l = common_.tree.find(to_chart(w));
        const Leaf& leaf = common_.tree.leaves()[l];
        const std::array<double, against_sums> h = {
            math::log(leaf.q) - common_.log_q, w.x - common_.middle.x, w.y - common_.middle.y, w.z - common_.middle.z};
        if (set < 0) {
            ++to_.leaves[l];
            for (std::size_t q = 0; q < h.size(); ++q) to_.sums[q].add(h[q]);
            return;
        }
        for (std::size_t q = 0; q < h.size(); ++q) to_.by_set[q][static_cast<std::size_t>(set)] += h[q];
        ++to_.node_by_set[static_cast<std::size_t>(leaf.coarse)][static_cast<std::size_t>(set)];
    }

    /// f L cos / p of the buffered draws, or the weight returned with them, summed over the techniques.
    void add_weights(std::uint32_t from) {
        std::vector<std::size_t> indices;
        std::vector<Vec3d> w;
        for (std::size_t i = 0; i < draws_.size(); ++i) {
            const Draw& d = draws_[i];
            if (!classifier_.is_drawn(d)) continue;
            indices.push_back(i);
            w.push_back(d.wi);
            to_.has_weights = to_.has_weights && (d.weight || (source_.has_density() && (source_.has_f() || d.f)));
        }
        std::vector<Vec3d> f(source_.has_f() ? w.size() : 0);
        if (source_.has_f()) source_.f_cos(w, f);
        const std::vector<double> drawn(w.size(), 1.0);
        std::vector<double> x;
        append_weights(source_, draws_, {.at = indices, .wi = w, .p = drawn, .f_cos = f}, x);
        if (to_.x.size() < from + x.size()) to_.x.resize(from + x.size());
        for (std::size_t i = 0; i < x.size(); ++i) to_.x[from + i] += x[i];
    }
};

}  // namespace

void draw_on(const AgainstSide& side, const CommonTree& common, const Look& to, std::uint32_t of_f, AgainstDraws& d) {
    const auto techniques = static_cast<std::uint32_t>(side.check_case.adapter->techniques());
    const auto before = static_cast<std::uint32_t>(d.independent) / techniques,
               set_before = static_cast<std::uint32_t>(d.scrambled) / replicate_sets / techniques;
    d.leaves.resize(common.tree.leaves().size());
    d.node_by_set.resize(common.tree.rows());
    d.kinds.resize(kinds_before_deltas + common.delta_directions.size());
    for (std::uint32_t t = 0; t < techniques; ++t) {
        AgainstTechnique one(side, common, static_cast<int>(t), d);
        one.independent(side.key, before, to.independent, of_f);
        one.scrambled(side.key, set_before, to.scrambled / replicate_sets);
    }
}

std::string_view name_of(AgainstAnswer::Family family) {
    static constexpr std::array<std::string_view, AgainstAnswer::families> names = {
        "kinds", "sums", "sums, replicates", "node", "node, replicates"};
    return names[family];
}

namespace {

/// Counts of one node by sampler: in its first half, and in the whole node.
struct NodeCounts {
    double a = 0, b = 0;
};

std::vector<NodeCounts> counts_of(const Tree& tree, const AgainstDraws& a, const AgainstDraws& b) {
    std::vector<NodeCounts> out(tree.nodes().size());
    for (std::size_t i = out.size(); i-- > 0;) {
        const TreeNode& x = tree.nodes()[i];
        if (x.child < 0) {
            out[i] = {a.leaves[static_cast<std::size_t>(x.leaf)], b.leaves[static_cast<std::size_t>(x.leaf)]};
            continue;
        }
        const auto c = static_cast<std::size_t>(x.child);
        out[i] = {out[c].a + out[c + 1].a, out[c].b + out[c + 1].b};
    }
    return out;
}

/// Two counts, each with its total: the difference of their shares, in draws of A given the sum of both.
struct TwoShares {
    double difference = 0, variance = 0;  // of k_a
    double per_share = 0;                 // change of the share for each unit of difference
    double share = 0;                     // of both together
    TwoShares(double ka, double na, double kb, double nb) {
        const double n = na + nb, k = ka + kb;
        share = k / n;
        difference = ka - na * share;
        variance = na * nb / n * share * (1 - share) * n / std::max(n - 1, 1.0);
        per_share = n / (na * nb);
    }
};

AgainstAnswer answer_of(AgainstAnswer::Family family, int member, const TwoShares& s, double floor) {
    AgainstAnswer out{.family = family,
        .member = member,
        .difference = s.difference * s.per_share,
        .sd = std::sqrt(s.variance) * s.per_share,
        .floor = floor};
    out.p = bennett_p(bennett_z2(std::fabs(s.difference) - floor / s.per_share, s.variance, 1, 1e12));
    return out;
}

/// Compares means of replicates of both samplers by Welch's t-test.
AgainstAnswer by_sets(AgainstAnswer::Family family, int member, const ReplicateMean<Replicates>& a,
    const ReplicateMean<Replicates>& b, double floor) {
    const double v = a.variance + b.variance;
    const double nu = (replicate_sets - 1) * v * v / (a.variance * a.variance + b.variance * b.variance + 1e-300);
    AgainstAnswer out{
        .family = family, .member = member, .difference = a.mean - b.mean, .sd = std::sqrt(v), .floor = floor};
    out.p = student_p_of(std::fabs(out.difference) - floor, v, nu);
    return out;
}

void test_kinds(const AgainstDraws& a, const AgainstDraws& b, const std::function<void(const AgainstAnswer&)>& visit) {
    for (std::size_t k = 0; k < a.kinds.size(); ++k) {
        if (a.kinds[k] + b.kinds[k] == 0) continue;
        const TwoShares s(a.kinds[k], a.independent, b.kinds[k], b.independent);
        visit(
            answer_of(AgainstAnswer::kinds, static_cast<int>(k), s, detection_floor * std::min(s.share, 1 - s.share)));
    }
}

void test_sums_against(const CommonTree& g, const AgainstDraws& a, const AgainstDraws& b,
    const std::function<void(const AgainstAnswer&)>& visit) {
    double low = 1e300, high = -1e300;  // of ln q
    for (const Leaf& leaf : g.tree.leaves()) {
        low = std::min(low, leaf.q);
        high = std::max(high, leaf.q);
    }
    const double ranges[against_sums] = {math::log(high / low), 2, 2, 2};
    for (int q = 0; q < against_sums; ++q) {
        const auto index = static_cast<std::size_t>(q);
        const auto mean = [&](const AgainstDraws& d) { return d.sums[index].sum / d.independent; };
        const auto square = [&](const AgainstDraws& d) { return d.sums[index].square / d.independent; };
        const double floor = detection_floor * std::sqrt((square(a) + square(b)) / 2) + g.step;
        const double v = std::max(square(a) - sqr(mean(a)), 0.0) / a.independent +
            std::max(square(b) - sqr(mean(b)), 0.0) / b.independent;
        AgainstAnswer out{.family = AgainstAnswer::sums,
            .member = q,
            .difference = mean(a) - mean(b),
            .sd = std::sqrt(v),
            .floor = floor};
        out.p = bennett_p(
            bennett_z2(std::fabs(out.difference) - floor, v, ranges[q] / std::min(a.independent, b.independent), 1e12));
        visit(out);
        if (a.scrambled == 0 || b.scrambled == 0) continue;
        const auto sets = [&](const AgainstDraws& d) {
            Replicates y = d.by_set[index];
            for (double& e : y) e *= replicate_sets / d.scrambled;
            return ReplicateMean<Replicates>(y, std::sqrt(square(d)) * replicate_sets / d.scrambled);
        };
        visit(by_sets(AgainstAnswer::sums_by_sets, q, sets(a), sets(b), floor));
    }
}

}  // namespace

void test_against(const CommonTree& g, const AgainstDraws& a, const AgainstDraws& b,
    const std::function<void(const AgainstAnswer&)>& visit) {
    test_kinds(a, b, visit);
    test_sums_against(g, a, b, visit);
    const std::vector<NodeCounts> counts = counts_of(g.tree, a, b);
    const bool both = a.scrambled > 0 && b.scrambled > 0;
    const std::vector<Replicates> sets_a = both ? replicates_by_row(g.tree, a.node_by_set) : std::vector<Replicates>(),
                                  sets_b = both ? replicates_by_row(g.tree, b.node_by_set) : std::vector<Replicates>();
    for (std::size_t i = 0; i < counts.size(); ++i) {
        const TreeNode& x = g.tree.nodes()[i];
        const NodeCounts& node = counts[i];
        if (x.child < 0 || std::min(node.a, node.b) < least_count) continue;
        const NodeCounts& half = counts[static_cast<std::size_t>(x.child)];
        const TwoShares s(half.a, node.a, half.b, node.b);
        const double floor = floor_of_cut(x, s.share);
        visit(answer_of(AgainstAnswer::nodes, static_cast<int>(i), s, floor));
        const auto in_each = [&](const AgainstDraws& d, double n) {
            return std::min(s.share, 1 - s.share) * n * d.scrambled / d.independent / replicate_sets;
        };
        // As for one sampler, the mean of a replicate must be nearly normal.
        if (!both || x.depth >= replicated_depth || std::min(in_each(a, node.a), in_each(b, node.b)) < least_count)
            continue;
        const auto row = static_cast<std::size_t>(x.row),
                   first = static_cast<std::size_t>(g.tree.nodes()[static_cast<std::size_t>(x.child)].row);
        const auto mean = [&](const std::vector<Replicates>& sets, const AgainstDraws& d) {
            const double draw = replicate_sets / d.scrambled;
            Replicates y;
            for (std::size_t k = 0; k < y.size(); ++k) y[k] = (sets[first][k] - s.share * sets[row][k]) * draw;
            return ReplicateMean<Replicates>(y, draw);
        };
        visit(by_sets(AgainstAnswer::nodes_by_sets, static_cast<int>(i), mean(sets_a, a), mean(sets_b, b),
            floor * (node.a / a.independent + node.b / b.independent) / 2));
    }
}

AgainstSizes sizes_against(const CommonTree& g, const AgainstDraws& a, const AgainstDraws& b, double level) {
    AgainstSizes out;
    double tests = 0;
    test_against(g, a, b, [&](const AgainstAnswer& r) {
        tests += r.family == AgainstAnswer::nodes;
        if (r.family == AgainstAnswer::sums_by_sets ||
            (b.scrambled * a.scrambled == 0 && r.family == AgainstAnswer::sums)) {
            constexpr double sums = against_sums;
            const double z = std::sqrt(-2 * math::log(level / sums / 2)) + power_quantile;
            const double needed = r.floor + z * r.sd;
            if (r.member >= mean_x && !(out.distance > needed)) out.distance = needed;
        }
    });
    const std::vector<NodeCounts> counts = counts_of(g.tree, a, b);
    std::vector<double> part(counts.size(), 1.0);  // detectable missing part if it lies in this node
    std::vector<std::pair<double, double>> leaves;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        const TreeNode& x = g.tree.nodes()[i];
        const NodeCounts& node = counts[i];
        if (x.child < 0) {
            leaves.push_back({part[i], node.a / a.independent + node.b / b.independent});
            continue;
        }
        const auto first = static_cast<std::size_t>(x.child);
        part[first] = part[first + 1] = part[i];
        if (std::min(node.a, node.b) < least_count) continue;
        const TwoShares s(counts[first].a, node.a, counts[first].b, node.b);
        const double needed =
            needed_by_bennett(floor_of_cut(x, s.share) / s.per_share, s.variance, 1, 1e12, level / tests) * s.per_share;
        for (std::size_t half : {first, first + 1}) {
            const double share = half == first ? s.share : 1 - s.share;
            // Relative to the draws of the node; the missing part may overlap several cells, with half of it in one.
            const double missing = needed / (1 - share + 1e-300);
            const double of_all = std::max(node.a / a.independent, node.b / b.independent);
            if (missing <= share) part[half] = std::min(part[half], 2 * missing * of_all);
        }
    }
    std::sort(leaves.begin(), leaves.end());
    double total = 0, below = 0;
    for (const auto& [size, m] : leaves) total += m;
    for (const auto& [size, m] : leaves)
        if ((below += m) >= stated_power * total) {
            if (total > 0) out.part = size;
            break;
        }
    return out;
}

}  // namespace crescent::check
