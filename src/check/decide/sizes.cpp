// A fault of size e shifts a question's difference by e times its effect; it is found with the stated power if the
// shift exceeds what the level needs by the normal quantile of that power.
#include "check/decide/sizes.h"

#include <cmath>

#include "check/constants.h"
#include "check/verdicts/statistics.h"
#include "simd/frame.h"

namespace crescent::check {

namespace {

constexpr double power_quantile = 1.2816;  // P(Z < 1.2816) = 0.9

/// The difference that Bennett's test finds with the stated power.
double needed_by_bennett(double floor, double v, double b, double nu, double level) {
    const double z2 = -2 * math::log(level / 2);
    double low = 0, high = 1;
    while (bennett_z2(high, v, b, nu) < z2 && high < 1e6) high *= 2;
    for (int k = 0; k < 60; ++k) {
        const double middle = (low + high) / 2;
        (bennett_z2(middle, v, b, nu) < z2 ? low : high) = middle;
    }
    return floor + high + power_quantile * std::sqrt(v);
}

/// Of the whole sums, what each needs by the better of its two kinds of draws.
std::array<double, integrands> needed_by_sums(const Evidence& e, double level) {
    std::array<double, integrands> out{};
    const double n = e.observations.independent;
    for (std::size_t q = 0; q < integrands; ++q) {
        const double members = q >= centre_x ? 3 : 1;
        const Estimate& claimed = e.integrals.sums[q];
        const double mean = e.observations.sums[q].sum / n, square = e.observations.sums[q].square / n;
        const double floor = detection_floor * (q >= slope ? std::sqrt(square) : mean);
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

/// By nodes: the smallest leak that one of them shows, and the cap that shows wherever it lies but for one place in
/// ten.
void by_nodes(const Evidence& e, double level, Sizes& out) {
    const std::vector<TreeNode>& nodes = e.plan.tree.nodes();
    const std::vector<NodeSums> sums = node_sums(e);
    const double n = e.observations.independent, domain = e.integrals.domain;
    constexpr double spills = 2;                 // a cap lies across cells: half of it in one
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
        if (leaked > 0) take_less(out.leak, needed / leaked);
        for (std::size_t half : {first, first + 1}) {
            const double share = half == first ? s.share : 1 - s.share;
            const double missing = spills * needed / ((1 - share) * s.one_draw + 1e-300);
            const double mass_here = sums[half].claimed / s.one_draw;
            if (missing <= mass_here) cap[half] = std::min(cap[half], missing);
            else if (spills * needed <= sums[half].claimed * (1 - share))
                cap[half] = std::min(cap[half], spills * mass_here);
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

/// What turning the draws about an axis does to the whole sums: p is evaluated at turned draws. Of two axes the worse.
void by_turning(
    Source& source, const Evidence& e, const std::array<double, integrands>& needed, const StreamKey& key, Sizes& out) {
    const Sample sample = drawn(source, key);
    const double n = static_cast<double>(sample.w.size());
    if (n < 256) return;
    const Vec3d axis_of_lobe = dot(e.plan.middle, e.plan.middle) > 1e-4 ? normalize(e.plan.middle) : Vec3d{0, 0, 1};
    const Frame<double> frame = frame_about(axis_of_lobe);
    constexpr double angle = target_rotation;
    std::optional<double> worst;
    for (Vec3d axis : {frame.t, frame.b}) {
        std::vector<Vec3d> turned;
        for (Vec3d w : sample.w) turned.push_back(normalize(w + cross(axis, w) * angle));
        std::vector<double> p(turned.size());
        source.density(turned, p);
        std::array<Sums, integrands> change;
        double distance = 0;
        for (std::size_t i = 0; i < turned.size(); ++i) {
            const auto values = [&](Vec3d w, double at) {
                return e.plan.values(e.plan.tree.leaves()[e.plan.tree.find(to_chart(w))], w, at);
            };
            const Values before = values(sample.w[i], sample.p[i]), after = values(turned[i], p[i]);
            for (std::size_t q = 0; q < integrands; ++q) change[q].add(after[q] - before[q]);
            if (sample.p[i] > 0) distance += std::min(1.0, std::fabs(p[i] / sample.p[i] - 1)) / n / 2;
        }
        if (distance < detection_floor) continue;  // it changes nothing
        std::optional<double> size;
        for (std::size_t q = 0; q < integrands; ++q) {
            const double mean = change[q].sum / n;
            const double se = std::sqrt(std::max(change[q].square / n - mean * mean, 0.0) / n);
            const double effect = (std::fabs(mean) - power_quantile * se) * n / sample.of;
            if (effect > 0) take_less(size, angle * needed[q] / effect);
        }
        if (size && (!worst || *size > *worst)) worst = size, out.by_rotation = distance / angle;
    }
    out.rotation = worst;
}

}  // namespace

Sizes sizes_of(Source& source, const Evidence& e, double level, double node_tests, const StreamKey& key) {
    Sizes out;
    if (!e.source.has_density()) return out;
    const std::array<double, integrands> needed = needed_by_sums(e, level);
    const double n = e.observations.independent;
    for (std::size_t q : {std::size_t{mass}, std::size_t{bridge}})
        if (const double c = e.integrals.sums[q].value; c > 0) take_less(out.constant, needed[q] / c);
    for (std::size_t q = bridge; q < integrands; ++q) {
        const double effect = std::fabs(e.integrals.even[q] / e.integrals.domain - e.observations.sums[q].sum / n);
        if (effect > 0) take_less(out.leak, needed[q] / effect);
    }
    by_nodes(e, level / std::max(node_tests, 1.0), out);
    out.by_leak = distance_from_even(e);
    const Observations& o = e.observations;
    const double covariance = o.slope_log_p / n - o.sums[slope].sum / n * o.log_p.sum / n;
    const double spread = o.log_p.square / n - o.log_p.sum / n * o.log_p.sum / n;
    if (spread > 1e-4 && covariance > 0)
        out.parameter = needed[slope] / covariance, out.by_parameter = std::sqrt(spread) / 2;
    by_turning(source, e, needed, key, out);
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
