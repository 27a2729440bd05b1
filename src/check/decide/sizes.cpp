// A fault of size e shifts a question's difference by e times its effect; it is found with the stated power if the
// shift exceeds what the level needs by the normal quantile of that power.
#include "check/decide/sizes.h"

#include <cmath>

#include "check/constants.h"
#include "check/verdicts/statistics.h"
#include "simd/frame.h"

namespace crescent::check {

namespace {

/// Of the whole sums, what each needs by the better of its two kinds of draws.
std::array<double, integrands> needed_by_sums(const Evidence& e, double level) {
    std::array<double, integrands> out{};
    const double n = e.observations.independent;
    for (std::size_t q = 0; q < integrands; ++q) {
        const double members = q >= centre_x ? 3 : 1;
        const Estimate& claimed = e.integrals.sums[q];
        const double mean = e.observations.sums[q].sum / n, square = e.observations.sums[q].square / n;
        const double floor = detection_floor * (q >= slope ? std::sqrt(square) : mean) + e.integrals.known_to[q];
        const double v = std::max(square - mean * mean, 0.0) / n + claimed.variance;
        out[q] = needed_by_bennett(floor, v, 1 / n, freedom(v, claimed.doubt), level / members);
        if (e.observations.scrambled == 0) continue;
        const ReplicateMean<Replicates> sets = replicate_mean(e, static_cast<int>(q));
        const double w = sets.variance + claimed.variance;
        const double nu =
            std::min(freedom(w, claimed.doubt + 2 * sets.variance * sets.variance / (replicate_sets - 1)), 1e6);
        const double t = stats::student_two_sided_quantile(std::max(nu, 1.0), level / members);
        out[q] = std::min(out[q], floor + (t + power_quantile) * std::sqrt(w));
    }
    return out;
}

/// The leak whose shift exceeds `needed`, where its draws vary too: their variance is in the test's own, so that the
/// shift must be as many standard errors of the sum of both. Such a test needs some 6 of them.
double leak_shown(double needed, double effect, double square, double draws) {
    constexpr double sigmas =
        8;  // t at alpha1 of 31 degrees of freedom, and the power's quantile: 5.3 + 1.3, and a floor
    const double noise = sigmas * sigmas * square / draws;  // of e = 1
    double e = needed / effect;
    for (int k = 0; k < 50; ++k) e = std::sqrt(needed * needed + e * noise) / effect;
    return e;
}

/// Total variation between p and an even density, by the leaves.
double distance_from_even(const Evidence& e) {
    double sum = 0;
    for (const Leaf& leaf : e.plan.tree.leaves()) {
        const double area = e.plan.tree.rect(leaf).area();
        if (leaf.met) sum += std::max(0.0, leaf.q * area - area / e.integrals.domain);
    }
    return std::min(sum, 1.0);
}

void take_less(std::optional<double>& to, double size) {
    if (std::isfinite(size) && (!to || size < *to)) to = size;
}

/// What each node's test by replicates needs; 0 where there is none. As many of them share the level as of nodes at
/// most.
std::vector<double> needed_by_node_sets(const Evidence& e, double level) {
    std::vector<double> out(e.plan.tree.nodes().size());
    const double t = stats::student_two_sided_quantile(replicate_sets - 1, level);
    ask_nodes(e, [&](const Answer& a) {
        if (a.family == Family::node_sets)
            out[static_cast<std::size_t>(a.member)] = a.floor + (t + power_quantile) * a.sd;
    });
    return out;
}

/// By nodes: the smallest leak that one of them shows, and the cap that shows wherever it lies but for one place in
/// ten.
void by_nodes(const Evidence& e, double level, Sizes& out) {
    const std::vector<TreeNode>& nodes = e.plan.tree.nodes();
    const std::vector<NodeSums> sums = node_sums(e);
    const double n = e.observations.independent, domain = e.integrals.domain;
    constexpr double spills = 2;  // a cap lies across cells: half of it in one
    const std::vector<double> by_sets = needed_by_node_sets(e, level);
    std::vector<double> cap(nodes.size(), 1.0);  // the mass that shows if it lies in this node
    std::vector<std::pair<double, double>> leaves;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (nodes[i].child < 0) {
            leaves.push_back({cap[i], sums[i].claimed});
            continue;
        }
        const auto first = static_cast<std::size_t>(nodes[i].child);
        cap[first] = cap[first + 1] = cap[i];
        if (std::min(sums[i].drawn, sums[i].claimed) * n < least_count) continue;
        const NodeSplit s = split_of(e, sums, i);
        const double needed =
            needed_by_bennett(s.floor, s.variance, sums[i].largest, freedom(s.variance, s.doubt), level);
        const double leaked = std::fabs(sums[first].solid_angle - s.share * sums[i].solid_angle) / domain;
        const double varies = power_quantile * (std::sqrt(s.variance + needed / n) - std::sqrt(s.variance));
        if (leaked > 0) take_less(out.leak, (needed + varies) / leaked);
        for (std::size_t half : {first, first + 1}) {
            const double share = half == first ? s.share : 1 - s.share;
            const double missing = spills * needed / ((1 - share) * s.one_draw + 1e-300);
            const double mass_here = sums[half].claimed / s.one_draw;
            if (missing <= mass_here) cap[half] = std::min(cap[half], missing);
            else if (spills * needed <= sums[half].claimed * (1 - share))
                cap[half] = std::min(cap[half], spills * mass_here);
            if (by_sets[i] > 0) {
                const double h = s.one_draw;
                const double shown = leak_shown(by_sets[i], h * (1 - share), h * h, e.observations.scrambled);
                if (shown <= mass_here) cap[half] = std::min(cap[half], spills * shown);
            }
        }
    }
    std::sort(leaves.begin(), leaves.end());
    double all = 0, below = 0;
    for (const auto& [size, mass_here] : leaves) all += mass_here;
    for (const auto& [size, mass_here] : leaves)
        if ((below += mass_here) >= stated_power * all) {
            out.cap = size;
            return;
        }
}

/// A few thousand draws on streams of their own, with p there.
struct Sample {
    std::vector<Vec3d> w;
    std::vector<double> p;
    double of = 0;
};
Sample drawn(Source& source, const StreamKey& key) {
    constexpr std::uint32_t count = 4096;
    std::vector<Numbers> u(count);
    for (std::uint32_t i = 0; i < count; ++i) u[i] = numbers_at(key, i, source.numbers(), source.single());
    std::vector<Draw> draws(count);
    source.draw(u, draws);
    Sample out;
    for (const Draw& d : draws)
        if (d.delta == 0 && d.pdf > 0 && std::isfinite(d.pdf + d.wi.x + d.wi.y + d.wi.z)) out.w.push_back(d.wi);
    out.p.resize(out.w.size());
    source.density(out.w, out.p);
    out.of = count;
    return out;
}

/// The smallest rotation about one axis that a whole sum or a node shows, from draws that are turned by `angle` and p
/// evaluated there; none where that shows nothing. Effects are taken at the low end of their intervals.
class Turned {
public:
    Turned(Source& source, const Evidence& e, const Sample& sample, Vec3d axis, double angle)
        : e_(e), angle_(angle), of_(sample.of), nodes_(e.plan.tree.nodes().size()) {
        std::vector<Vec3d> turned;
        const double c = math::cos(angle), s = math::sin(angle);
        for (Vec3d w : sample.w)
            turned.push_back(normalize(w * c + cross(axis, w) * s + axis * (dot(axis, w) * (1 - c))));
        std::vector<double> p(turned.size());
        source.density(turned, p);
        const double n = static_cast<double>(sample.w.size());
        for (std::size_t i = 0; i < turned.size(); ++i) {
            const Values change = add(turned[i], p[i], 1), before = add(sample.w[i], sample.p[i], -1);
            for (std::size_t q = 0; q < integrands; ++q) sums_[q].add(change[q] - before[q]);
            if (sample.p[i] > 0) distance += std::min(1.0, std::fabs(p[i] / sample.p[i] - 1)) / n / 2;
        }
    }

    /// Total variation between p and p turned.
    double distance = 0;

    std::optional<double> size(const std::array<double, integrands>& needed, double node_level) const {
        std::optional<double> out;
        for (std::size_t q = 0; q < integrands; ++q) take(out, sums_[q], needed[q]);
        const std::vector<NodeSums> all = node_sums(e_);
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            const TreeNode& x = e_.plan.tree.nodes()[i];
            const bool tested = x.child >= 0 && x.depth < depth &&
                std::min(all[i].drawn, all[i].claimed) * e_.observations.independent >= least_count;
            if (!tested) continue;
            const NodeSplit s = split_of(e_, all, i);
            const Sums &half = nodes_[static_cast<std::size_t>(x.child)], &whole = nodes_[i];
            const Sums d{half.sum - s.share * whole.sum, half.square + s.share * s.share * whole.square};
            take(out, d,
                needed_by_bennett(s.floor, s.variance, all[i].largest, freedom(s.variance, s.doubt), node_level));
        }
        return out;
    }

private:
    static constexpr int depth = 8;
    const Evidence& e_;
    double angle_, of_;
    std::vector<Sums> nodes_;  // by node: change of h
    std::array<Sums, integrands> sums_{};

    Values add(Vec3d w, double p, double sign) {
        if (!(p > 0)) return {};  // the estimator takes it for nothing
        const ChartPoint at = to_chart(w);
        const Values v = e_.plan.values(e_.plan.tree.leaves()[e_.plan.tree.find(at)], w, p);
        const std::vector<TreeNode>& nodes = e_.plan.tree.nodes();
        std::size_t i = 0;
        for (;;) {
            nodes_[i].add(sign * v[bridge]);
            if (nodes[i].child < 0 || nodes[i].depth == depth) return v;
            const bool along_phi = nodes[i].along_phi;
            i = static_cast<std::size_t>(nodes[i].child) +
                ((along_phi ? at.phi : at.t) >= nodes[i].rect.middle(along_phi));
        }
    }
    void take(std::optional<double>& to, const Sums& change, double needed) const {
        const double mean = change.sum / of_;
        const double se = std::sqrt(std::max(change.square / of_ - mean * mean, 0.0) / of_);
        const double effect = std::fabs(mean) - 3 * se;
        if (effect > needed || (effect > 0 && angle_ <= target_rotation)) take_less(to, angle_ * needed / effect);
    }
};

/// Of two axes across the mean direction the worse; each at a small and a large angle.
void by_turning(Source& source, const Evidence& e, const std::array<double, integrands>& needed, double node_level,
    const StreamKey& key, Sizes& out) {
    const Sample sample = drawn(source, key);
    if (sample.w.size() < 256) return;
    const Vec3d axis_of_lobe = dot(e.plan.middle, e.plan.middle) > 1e-4 ? normalize(e.plan.middle) : Vec3d{0, 0, 1};
    const Frame<double> frame = frame_about(axis_of_lobe);
    for (Vec3d axis : {frame.t, frame.b}) {
        const Turned little(source, e, sample, axis, target_rotation),
            much(source, e, sample, axis, 20 * target_rotation);
        if (little.distance < detection_floor) continue;  // it changes nothing
        std::optional<double> size = little.size(needed, node_level);
        if (const std::optional<double> other = much.size(needed, node_level)) take_less(size, *other);
        if (size && (!out.rotation || *size > *out.rotation))
            out.rotation = size, out.by_rotation = little.distance / target_rotation;
    }
}

}  // namespace

Sizes sizes_of(Source& source, const Evidence& e, double level, double node_tests, const StreamKey& key) {
    Sizes out;
    if (!e.source.has_density()) return out;
    const std::array<double, integrands> needed = needed_by_sums(e, level);
    const double n = e.observations.independent;
    for (std::size_t q : {std::size_t{mass}, std::size_t{bridge}})
        if (const double c = e.integrals.sums[q].value; c > 0) take_less(out.constant, needed[q] / c);
    for (std::size_t q = mass; q < integrands; ++q) {
        const double effect = std::fabs(e.integrals.even[q] / e.integrals.domain - e.observations.sums[q].sum / n);
        const double square = e.integrals.even_square[q] / e.integrals.domain + effect * effect;  // of one leaked draw
        if (effect > 0)
            take_less(out.leak, leak_shown(needed[q], effect, square, std::max(n, e.observations.scrambled)));
    }
    by_nodes(e, level / std::max(node_tests, 1.0), out);
    out.by_leak = distance_from_even(e);
    const Observations& o = e.observations;
    const double covariance = o.slope_log_p / n - o.sums[slope].sum / n * o.log_p.sum / n;
    const double spread = o.log_p.square / n - o.log_p.sum / n * o.log_p.sum / n;
    if (spread > 1e-4 && covariance > 0)
        out.parameter = needed[slope] / covariance, out.by_parameter = std::sqrt(spread) / 2;
    by_turning(source, e, needed, level / std::max(node_tests, 1.0), key, out);
    return out;
}

double worst_ratio(const Sizes& s) {
    double worst = 0;
    const auto look = [&](const std::optional<double>& size, double target, double changed) {
        if (size) worst = std::max(worst, std::min(*size / target, *size * changed / target_leak));
    };
    look(s.constant, target_constant, 1e300), look(s.cap, target_cap, 1e300), look(s.leak, target_leak, s.by_leak);
    look(s.rotation, target_rotation, s.by_rotation), look(s.parameter, target_parameter, s.by_parameter);
    return worst;
}

}  // namespace crescent::check
