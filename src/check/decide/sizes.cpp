// A fault of size e shifts the difference of a test by e times its effect, and adds e times the variance of its draws.
// It is found if the difference passes both stages. The second stage has as many draws and points as the first and a
// less extreme level for one member, so nearly all differences that pass the first stage pass it too.
#include "check/decide/sizes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "check/constants.h"
#include "check/verdicts/density.h"
#include "check/verdicts/statistics.h"
#include "check/verdicts/sums.h"
#include "math/functions.h"
#include "math/simd/frame.h"
#include "math/statistics.h"

namespace crescent::check {

namespace {

/// The difference d for which Bennett's exponent is z2: Newton's method from Bernstein's bound, which is above it.
double bennett_difference(double z2, double v, double b) {
    v = std::max(v, 1e-30);
    const double linear = b * z2 / 6, c = z2 * b * b / (2 * v);
    double x = b / v * (linear + std::sqrt(linear * linear + v * z2));
    if (x < 1e-4) return std::sqrt(v * z2);
    for (int k = 0; k < 3; ++k) x -= ((1 + x) * math::log1p(x) - x - c) / math::log1p(x);
    return x * v / b;
}

/// The difference that one test needs to detect a fault.
class Requirement {
public:
    /// largest: largest single term, for Bennett's inequality.
    static Requirement by_bennett(double floor, double variance, double largest, double freedom, double level) {
        const double z2 = -2 * math::log(level / 2) / freedom;
        return {floor, variance, largest, z2 < 500 ? freedom * (math::exp(z2) - 1) : 1e300, 0};
    }
    /// The quantile of Student's t, shared by many tests with the same degrees of freedom.
    static double quantile(double freedom, double level) {
        return student_two_sided_quantile(std::clamp(freedom, 1.0, 1e6), level);
    }
    static Requirement by_student(double floor, double variance, double quantile, double freedom) {
        return {floor, variance, 0, quantile, 1 / (2 * std::clamp(freedom, 1.0, 1e6))};
    }

    /// `tested_variance`: variance that the fault adds and that the test estimates from its draws; `untested_variance`:
    /// variance that the test does not include.
    double difference(double tested_variance = 0, double untested_variance = 0, double errors = power_of_each) const {
        const double v = variance_ + tested_variance;
        // A single draw is never significant, for any small expectation: it may be in a region that the points have
        // missed.
        const double critical = largest_ > 0 ? std::max(bennett_difference(critical_, v, largest_), 2 * largest_)
                                             : critical_ * std::sqrt(v);
        // A standard deviation with nu degrees of freedom has a relative error of 1 / sqrt(2 nu). It enters through the
        // critical value, t times, and through the stated size, t + the quantile times.
        const double inflation = largest_ > 0 ? 0 : unknown_ * (sqr(critical_) + sqr(critical_ + errors));
        return floor_ + critical + errors * std::sqrt(v * (1 + inflation) + untested_variance);
    }
    /// The size of a detectable fault from its effect and its added variances, both per unit of size.
    double size(double effect, double tested_variance = 0, double untested_variance = 0) const {
        if (!(effect > 0)) return 1e300;
        double e = difference() / effect;
        for (int k = 0; k < 12 && e < 1; ++k) e = difference(e * tested_variance, e * untested_variance) / effect;
        return e;
    }

private:
    double floor_, variance_, largest_, critical_;
    double unknown_;  // relative variance of the standard deviation
    Requirement(double floor, double variance, double largest, double critical, double unknown)
        : floor_(floor), variance_(variance), largest_(largest), critical_(critical), unknown_(unknown) {}
};

struct SumTest {
    std::size_t sum;  // index of the sum
    Requirement requirement;
    double draws;
    double visible;  // part of a fault of one of two samplers that the difference shows; 1 for one sampler
};

/// The tests of whole sums, with both kinds of draws.
std::vector<SumTest> whole_sums(const Evidence& e, double family_level) {
    std::vector<SumTest> out;
    const std::array<WholeSum, integrands> sums = compare_sums(e);
    for (std::size_t q = 0; q < integrands; ++q) {
        const auto add = [&](const SumComparison& s, double draws) {
            const double level = family_level / (q >= centre_x ? 3 : 1);
            out.push_back({q,
                s.largest > 0 ? Requirement::by_bennett(s.floor, s.variance(), s.largest, s.freedom, level)
                              : Requirement::by_student(
                                    s.floor, s.variance(), Requirement::quantile(s.freedom, level), s.freedom),
                draws, s.visible});
        };
        add(sums[q].by_draws, e.observations.independent);
        if (sums[q].by_sets) add(*sums[q].by_sets, e.observations.scrambled);
    }
    return out;
}

struct NodeTest {
    std::size_t node;
    double share;  // of h p in the first half
    double h;      // weight of one draw
    Requirement requirement;
    double draws;    // 0: the variance is predicted from the claimed density, not estimated from draws
    double visible;  // as for a sum
};

/// The nodes that are tested, with both kinds of draws.
std::vector<NodeTest> node_tests(const Evidence& e, const std::vector<NodeSums>& sums, double level) {
    std::vector<Answer> answers;
    test_nodes(e, [&](const Answer& a) {
        if (a.family == Family::node || a.family == Family::node_sets) answers.push_back(a);
    });
    const auto set_count = static_cast<double>(
        std::ranges::count_if(answers, [](const Answer& a) { return a.family == Family::node_sets; }));
    const double node_level = level / std::max(static_cast<double>(answers.size()) - set_count, 1.0);
    const double t = Requirement::quantile(replicate_sets - 1, level / std::max(set_count, 1.0));
    std::vector<NodeTest> out;
    out.reserve(answers.size());
    for (const Answer& a : answers) {
        const auto i = static_cast<std::size_t>(a.member);
        const NodeSplit s = split_of(e, sums, i);
        if (a.family == Family::node)
            out.push_back({i, s.share, s.one_draw,
                Requirement::by_bennett(s.floor, s.variance, sums[i].largest, freedom(s.variance, s.doubt), node_level),
                0, s.visible});
        else
            out.push_back({i, s.share, s.one_draw, Requirement::by_student(a.floor, a.sd * a.sd, t, replicate_sets - 1),
                e.observations.scrambled, 1});
    }
    return out;
}

void take_less(std::optional<double>& to, double size) {
    if (!to || size < *to) to = std::min(size, 1.0);
}

/// A few thousand draws from separate streams, and p at them.
struct Sample {
    std::vector<Vec3d> w;
    std::vector<double> p;
    double draw_count = 0;
};
Sample draw_sample(Source& source, std::uint32_t count, const StreamKey& key) {
    UsableDraws usable = usable_draws(source, source.draw(first_numbers(key, count, source.traits)));
    return {std::move(usable.w), std::move(usable.p), static_cast<double>(count)};
}

}  // namespace

/// What a size is computed from. Without a density there are no tests of it.
struct SizeTests {
    Source& source;
    const Evidence& e;
    double level;  // of a family at stage 1
    std::vector<SumTest> whole;
    std::vector<NodeSums> sums;
    std::vector<NodeTest> nodes;
    Sample sample;

    SizeTests(Source& size_source, const Evidence& evidence, double family_level)
        : source(size_source), e(evidence), level(family_level) {
        if (!e.source.has_density()) return;
        whole = whole_sums(e, level);
        sums = node_sums(e);
        nodes = node_tests(e, sums, level);
    }
    /// No density is uniform over an infinite line, and powers of p per length are not those of p over the chart.
    bool is_infinite() const { return source.traits.domain && source.traits.domain->domain().is_infinite(); }
};

namespace {

// ---- Faults of size e that draw by p (1 + e g) for some g: what g changes in each test.

/// Per unit of size: the change of the mean of h, and the mean square of the draws that are exchanged.
struct FaultChange {
    double mean = 0, square = 0;
};

/// Takes the least size that one of these tests detects. n: number of independent draws.
template <class Test, class ChangeOf>
void take_detected(const std::vector<Test>& tests, double n, const ChangeOf& change_of, std::optional<double>& size) {
    for (const Test& t : tests) {
        const FaultChange change = change_of(t);
        const double added_variance = change.square / (t.draws > 0 ? t.draws : n);
        const bool is_estimated = t.draws > 0;
        take_less(size,
            t.requirement.size(
                change.mean * t.visible, is_estimated ? added_variance : 0, is_estimated ? 0 : added_variance));
    }
}

/// p is (1 + e) times the density of the draws.
FaultSize constant_of(const SizeTests& tests) {
    FaultSize out;
    const auto change_of_sum = [&](const SumTest& t) {
        const bool grows = t.sum == mass || t.sum == bridge;
        return FaultChange{grows ? tests.e.integrals.sums[t.sum].value : 0};
    };
    take_detected(tests.whole, tests.e.observations.independent, change_of_sum, out.size);
    return out;
}

/// Total variation between p and a uniform density, from the leaves.
double distance_from_uniform(const Evidence& e) {
    double sum = 0;
    for (const Leaf& leaf : e.plan.tree.leaves()) {
        const double area = e.plan.tree.rect(leaf).area();
        if (leaf.has_mass) sum += std::max(0.0, leaf.q * area - area / e.integrals.domain);
    }
    return std::min(sum, 1.0);
}

/// A share e of the draws is uniform.
FaultSize leak_of(const SizeTests& tests) {
    FaultSize out;
    if (tests.whole.empty() || tests.is_infinite()) return out;
    const Evidence& e = tests.e;
    out.change = distance_from_uniform(e);
    const double domain = e.integrals.domain, n = e.observations.independent;
    const auto change_of_sum = [&](const SumTest& t) {
        const double mean = std::fabs(e.integrals.uniform_sums[t.sum] / domain - e.observations.sums[t.sum].sum / n);
        return FaultChange{mean, e.integrals.uniform_squares[t.sum] / domain + mean * mean};
    };
    const auto change_of_node = [&](const NodeTest& t) {
        const auto first = static_cast<std::size_t>(e.plan.tree.nodes()[t.node].child);
        const double a = tests.sums[first].solid_angle / domain, b = tests.sums[first + 1].solid_angle / domain;
        return FaultChange{std::fabs((1 - t.share) * a - t.share * b),
            t.h * ((1 - t.share) * (1 - t.share) * a + t.share * t.share * b)};
    };
    take_detected(tests.whole, n, change_of_sum, out.size);
    take_detected(tests.nodes, n, change_of_node, out.size);
    return out;
}

/// The noncentrality at which chi^2 with these degrees of freedom exceeds this level half of the time.
double noncentrality(double degrees, double level) {
    double low = 0, high = degrees + 1000;
    for (int k = 0; k < 50; ++k) {
        const double middle = (low + high) / 2;
        (chi_squared_tail(degrees, middle) > level ? low : high) = middle;
    }
    return high - degrees;
}

/// Caps about draws: removes leaves in order of their distance from the centre until a node, or all nodes of one depth
/// together, detect it.
class Caps {
public:
    Caps(const Evidence& e, const std::vector<NodeSums>& sums, const std::vector<NodeTest>& tests, double level)
        : e_(e),
          sums_(sums),
          parent_(sums.size(), -1),
          removed_mass_(sums.size()),
          least_difference_(sums.size(), 1e300),
          variance_(sums.size()),
          shift_(static_cast<std::size_t>(e.plan.tree.depth()) + 1),
          least_shift_(shift_.size(), 1e300) {
        const std::vector<TreeNode>& nodes = e.plan.tree.nodes();
        std::vector<double> degrees(shift_.size());
        for (std::size_t i = 0; i < nodes.size(); ++i)
            if (nodes[i].child >= 0)
                for (int half : {0, 1}) parent_[static_cast<std::size_t>(nodes[i].child + half)] = static_cast<int>(i);
        for (const NodeTest& t : tests) {
            least_difference_[t.node] =
                std::min(least_difference_[t.node], t.requirement.difference(0, 0, 0) / t.visible);
            const NodeSplit split = split_of(e, sums, t.node);
            if (t.draws > 0 || split.smaller_half < e.fewest_draws) continue;
            variance_[t.node] = split.variance / sqr(t.visible);
            ++degrees[static_cast<std::size_t>(nodes[t.node].depth)];
        }
        const auto depths = static_cast<double>(std::ranges::count_if(degrees, [](double d) { return d > 0; }));
        for (std::size_t d = 0; d < degrees.size(); ++d)
            if (degrees[d] > 0) least_shift_[d] = noncentrality(degrees[d], level / depths);
        for (const Leaf& leaf : e.plan.tree.leaves()) {
            const NodeSums& s = sums[static_cast<std::size_t>(leaf.node)];
            if (!(s.claim > 0)) continue;
            leaves_.push_back({leaf.node, s.claim, s.claim * s.claim / std::max(s.second, 1e-300)});
            const Vec3d middle = without_azimuth(from_chart(e.plan.tree.rect(leaf).at(0.5, 0.5)));
            x_.push_back(middle.x);
            y_.push_back(middle.y);
            z_.push_back(middle.z);
        }
        cosine_.resize(leaves_.size());
    }
    /// p: the density at the centre. It sets the width of the first ring to about that of a detectable cap.
    double mass_about(Vec3d cap_centre, double p) {
        const Vec3d centre = without_azimuth(cap_centre);
        constexpr double first = 2e-3;
        for (std::size_t l = 0; l < leaves_.size(); ++l)
            cosine_[l] = centre.x * x_[l] + centre.y * y_[l] + centre.z * z_[l];
        std::vector<std::pair<double, std::size_t>> ring;
        std::vector<int> touched_nodes;
        double mass = 0, inner = 2, width = first / (two_pi * std::max(p, 1e-3));
        bool is_found = false;
        for (; !is_found && inner > -1; width *= 4) {
            const double outer = 1 - width;
            ring.clear();
            for (std::size_t l = 0; l < leaves_.size(); ++l)
                if (cosine_[l] < inner && cosine_[l] >= outer) ring.push_back({cosine_[l], l});
            std::sort(ring.begin(), ring.end(), std::greater<>());
            for (std::size_t k = 0; k < ring.size() && !is_found; ++k) {
                const Piece& leaf = leaves_[ring[k].second];
                mass += leaf.mass;
                for (int node = leaf.node; node >= 0; node = parent_[static_cast<std::size_t>(node)]) {
                    const auto i = static_cast<std::size_t>(node);
                    const double last_square = variance_[i] > 0 ? sqr(difference(i)) : 0;
                    removed_mass_[i] += leaf.claim;
                    touched_nodes.push_back(node);
                    is_found = is_found || shows(i, last_square);
                }
            }
            inner = outer;
        }
        for (int i : touched_nodes) removed_mass_[static_cast<std::size_t>(i)] = 0;
        std::ranges::fill(shift_, 0);
        return is_found ? std::min(mass, 1.0) : 1;
    }

private:
    struct Piece {
        int node;
        double claim, mass;
    };
    const Evidence& e_;
    const std::vector<NodeSums>& sums_;
    std::vector<int> parent_;
    std::vector<double> removed_mass_, least_difference_;  // by node: removed mass of h p; least detectable difference
    std::vector<double> variance_;                         // by node, for nodes that enter the sum of a depth
    std::vector<double> shift_, least_shift_;              // by depth: shift of chi^2, and the least detectable one
    std::vector<Piece> leaves_;
    std::vector<double> x_, y_, z_, cosine_;  // centres of the leaves; their cosines to the centre of the cap

    /// A cap of a line is an interval.
    Vec3d without_azimuth(Vec3d w) const { return e_.source.is_line() ? from_chart({to_chart(w).t, 0}) : w; }

    double difference(std::size_t i) const {
        const int child = e_.plan.tree.nodes()[i].child;
        if (child < 0) return 0;
        const auto a = static_cast<std::size_t>(child);
        return std::fabs(removed_mass_[a] - sums_[a].claim / sums_[i].claim * removed_mass_[i]);
    }
    /// Whether node i, whose squared difference was `last_square`, detects the cap. The remaining draws have less
    /// variance.
    bool shows(std::size_t i, double last_square) {
        const double node_difference = difference(i),
                     remaining_share = std::max(1 - removed_mass_[i] / sums_[i].claim, 1e-3);
        if (variance_[i] > 0) {
            double& shift = shift_[static_cast<std::size_t>(e_.plan.tree.nodes()[i].depth)];
            shift += (sqr(node_difference) - last_square) / variance_[i];
            if (shift >= least_shift_[static_cast<std::size_t>(e_.plan.tree.nodes()[i].depth)]) return true;
        }
        return least_difference_[i] < 1 && node_difference >= least_difference_[i] * std::sqrt(remaining_share);
    }
};

/// The mass of a cap that is detected half of the time at nine of ten centres. About some centres a fifth of that mass
/// is detected, so that nine of ten caps over all centres are found.
std::optional<double> least_cap(const Evidence& e, const std::vector<NodeSums>& sums,
    const std::vector<NodeTest>& nodes, const Sample& sample, double level) {
    constexpr std::size_t centres = 256;
    if (sample.w.empty()) return {};
    Caps caps(e, sums, nodes, level);
    std::vector<double> sizes;
    for (std::size_t i = 0; i < std::min(centres, sample.w.size()); ++i)
        sizes.push_back(caps.mass_about(sample.w[i], sample.p[i]));
    const auto rank = static_cast<std::ptrdiff_t>(stated_power * static_cast<double>(sizes.size()));
    std::nth_element(sizes.begin(), sizes.begin() + rank, sizes.end());
    return sizes[static_cast<std::size_t>(rank)];
}

FaultSize cap_of(const SizeTests& tests) {
    FaultSize out{least_cap(tests.e, tests.sums, tests.nodes, tests.sample, tests.level)};
    // A gap is a box of the domain: it has longer edges than a cap of the same mass, so that it cuts more leaves.
    constexpr double box_over_cap = 4.0 / 3;
    if (out.size && tests.source.traits.domain && !tests.source.is_line())
        out.size = std::min(*out.size * box_over_cap, 1.0);
    return out;
}

/// A place on the chart with the values of h.
struct Place {
    ChartPoint point;
    Values values{};
};
Place place_of(const Evidence& e, Vec3d w, double p) {
    Place out{to_chart(w)};
    // The estimator ignores draws where p is 0.
    if (p > 0) out.values = e.plan.values(e.plan.tree.leaves()[e.plan.tree.find(out.point)], w, p);
    return out;
}

struct Estimated {
    double mean = 0, variance = 0;  // variance of the mean
};

/// The change of each test by a rotation of the draws by `angle` about one axis; in another domain, by a shift. It is
/// computed twice: from the moved draws, and from the ratio of p at the moved and the original directions, which gives
/// the same except for the sign. The first is exact at edges of p, the second has less noise where p is smooth. Each
/// effect is the larger of the lower bounds of both.
class Turn {
public:
    /// `axis` is one of two; `axis_direction`: it, for directions.
    Turn(Source& source, const Evidence& e, const Sample& sample, const std::vector<Place>& places, std::size_t axis,
        Vec3d axis_direction, double angle)
        : e_(e),
          draw_count_(sample.draw_count),
          moved_change_(e.plan.tree.nodes().size()),
          weighted_change_(moved_change_) {
        std::vector<Vec3d> turned_directions;
        const double c = math::cos(angle), s = math::sin(angle);
        for (Vec3d w : sample.w)
            turned_directions.push_back(source.traits.domain
                    ? source.traits.domain->shifted(w, axis, angle)
                    : normalize(
                          w * c + cross(axis_direction, w) * s + axis_direction * (dot(axis_direction, w) * (1 - c))));
        std::vector<double> p(turned_directions.size());
        source.density(turned_directions, p);
        const double n = static_cast<double>(sample.w.size());
        for (std::size_t i = 0; i < turned_directions.size(); ++i) {
            const Place origin = places[i], target = place_of(e, turned_directions[i], p[i]);
            add(moved_change_, target, origin);
            if (!(sample.p[i] > 0)) continue;
            const double change = p[i] / sample.p[i] - 1;
            Place weighted_place = origin;
            for (double& v : weighted_place.values) v *= change;
            // At the end of a domain the ratio has no bound, and a few draws would decide.
            if (!source.traits.domain) add(weighted_change_, weighted_place, {origin.point, {}});
            distance += std::min(1.0, std::fabs(change)) / n / 2;
        }
    }

    /// Total variation between p and the rotated p.
    double distance = 0;

    /// The change of the mean of a test, with its standard error, by both methods.
    struct Effect {
        Estimated moved_mean, weighted_mean;
    };
    /// The effects on all whole sums, then on all nodes.
    std::vector<Effect> effects(const std::vector<SumTest>& sum_tests, const std::vector<NodeTest>& nodes) const {
        std::vector<Effect> out;
        for (const SumTest& t : sum_tests)
            out.push_back({mean_of(moved_change_.sums[t.sum]), mean_of(weighted_change_.sums[t.sum])});
        for (const NodeTest& t : nodes) {
            const TreeNode& x = e_.plan.tree.nodes()[t.node];
            if (x.depth >= depth) continue;
            const auto split = [&](const Change& change) {
                const Sums &half_sums = change.nodes[static_cast<std::size_t>(x.child)],
                           &parent_sums = change.nodes[t.node];
                return mean_of({half_sums.sum - t.share * parent_sums.sum,
                    half_sums.square + t.share * t.share * parent_sums.square});
            };
            out.push_back({split(moved_change_), split(weighted_change_)});
        }
        return out;
    }
    /// The differences that these tests need, in the same order.
    static std::vector<double> requirements(
        const Tree& tree, const std::vector<SumTest>& sum_tests, const std::vector<NodeTest>& nodes) {
        std::vector<double> out;
        for (const SumTest& t : sum_tests) out.push_back(t.requirement.difference());
        for (const NodeTest& t : nodes)
            if (tree.nodes()[t.node].depth < depth) out.push_back(t.requirement.difference());
        return out;
    }

private:
    static constexpr int depth = 8;
    struct Change {
        std::vector<Sums> nodes;  // of h by node
        std::array<Sums, integrands> sums{};
        explicit Change(std::size_t count) : nodes(count) {}
    };
    const Evidence& e_;
    double draw_count_;
    Change moved_change_, weighted_change_;

    /// Adds the gain at one place and the loss at another, as one difference in each node that contains both.
    void add(Change& to, const Place& gain, const Place& loss) const {
        for (std::size_t q = 0; q < integrands; ++q) to.sums[q].add(gain.values[q] - loss.values[q]);
        std::size_t i = 0, j = 0;
        for (bool has_gain = true, has_loss = true; has_gain || has_loss;) {
            if (i == j) {
                to.nodes[i].add(gain.values[bridge] - loss.values[bridge]);
            } else {
                if (has_gain) to.nodes[i].add(gain.values[bridge]);
                if (has_loss) to.nodes[j].add(-loss.values[bridge]);
            }
            has_gain = has_gain && step(i, gain.point);
            has_loss = has_loss && step(j, loss.point);
        }
    }
    /// Descends to the half that contains the place; false at the end.
    bool step(std::size_t& i, ChartPoint point) const {
        const TreeNode& x = e_.plan.tree.nodes()[i];
        if (x.child < 0 || x.depth == depth) return false;
        i = static_cast<std::size_t>(x.child) + ((x.along_phi ? point.phi : point.t) >= x.rect.middle(x.along_phi));
        return true;
    }
    Estimated mean_of(const Sums& change) const {
        const double mean = change.sum / draw_count_;
        return {mean, std::max(change.square / draw_count_ - mean * mean, 0.0) / draw_count_};
    }
};

/// Ratios of the effects to the required differences for a rotation about c times one axis plus s times another: to
/// first order in the angle, the sum of both rotations.
std::vector<double> ratios_about(const std::vector<Turn::Effect>& first_effects,
    const std::vector<Turn::Effect>& second_effects, double c, double s, const std::vector<double>& requirements,
    std::size_t sum_count) {
    // The largest error among hundreds of nodes; that of a sum is one-sided 90 %.
    constexpr double largest_errors = 3.0;
    const auto low_end = [&](const Estimated& a, const Estimated& b, double errors) {
        return std::fabs(c * a.mean + s * b.mean) - errors * std::sqrt(c * c * a.variance + s * s * b.variance);
    };
    std::vector<double> out;
    for (std::size_t t = 0; t < first_effects.size(); ++t) {
        const double errors = t < sum_count ? power_quantile : largest_errors;
        const double largest = std::max(low_end(first_effects[t].moved_mean, second_effects[t].moved_mean, errors),
            low_end(first_effects[t].weighted_mean, second_effects[t].weighted_mean, errors));
        out.push_back(std::max(largest, 0.0) / requirements[t]);
    }
    return out;
}

/// The least angle at which one test detects the rotation; 1 if none does. `ratios` are given at angles from `first` on
/// that grow by the factor `growth`. Between two angles, and below the first, an effect is interpolated as a power of
/// the angle with an exponent of at least one.
constexpr double growth = 4;
double least_angle(double first, const std::vector<std::vector<double>>& ratios) {
    double out = 1;
    for (std::size_t t = 0; t < ratios[0].size(); ++t) {
        double angle = first;
        for (std::size_t k = 0; k < ratios.size(); ++k, angle *= growth) {
            const double ratio = ratios[k][t];
            if (ratio < 1) continue;
            const std::size_t low = std::max<std::size_t>(k, 1) - 1;
            const double exponent = math::log(ratios[low + 1][t] / std::max(ratios[low][t], 1e-3)) / math::log(growth);
            out = std::min(out, angle * math::exp(-math::log(ratio) / std::max(1.0, exponent)));
            break;
        }
    }
    return out;
}

/// The detectable rotation: of eight axes across the mean direction, those about which a rotation changes the density
/// are used.
FaultSize rotation_of(const SizeTests& tests) {
    const Evidence& e = tests.e;
    const Sample& sample = tests.sample;
    const DomainChart* domain = tests.source.traits.domain.get();
    if (sample.w.size() < 64 || (domain && domain->is_discrete())) return {};
    constexpr int axes = 8;
    const Vec3d axis_of_lobe = dot(e.plan.middle, e.plan.middle) > 1e-4 ? normalize(e.plan.middle) : Vec3d{0, 0, 1};
    const Frame<double> frame = frame_about(axis_of_lobe);
    const std::vector<double> requirements = Turn::requirements(e.plan.tree, tests.whole, tests.nodes);
    std::vector<Place> places;
    for (std::size_t i = 0; i < sample.w.size(); ++i) places.push_back(place_of(e, sample.w[i], sample.p[i]));
    std::array<std::vector<std::vector<double>>, axes> ratios;
    std::array<double, axes> changes{};
    for (double multiple : {1.0, growth, growth * growth, growth * growth * growth}) {
        const auto is_detected = [](const std::vector<std::vector<double>>& axis_ratios) {
            return axis_ratios.empty() || std::ranges::any_of(axis_ratios, [](const std::vector<double>& r) {
                return std::ranges::any_of(r, [](double x) { return x >= 1; });
            });
        };
        if (multiple > growth && std::ranges::all_of(ratios, is_detected)) break;
        const Turn first_turn(tests.source, e, sample, places, 0, frame.t, multiple * target_rotation),
            second_turn(tests.source, e, sample, places, 1, frame.b, multiple * target_rotation);
        const auto first_effects = first_turn.effects(tests.whole, tests.nodes),
                   second_effects = second_turn.effects(tests.whole, tests.nodes);
        // Shifts are along one axis or the other.
        const int step = domain ? axes / 2 : 1;
        for (int k = 0; k < (tests.source.is_line() ? 1 : axes); k += step) {
            const double angle = k * two_pi / 2 / axes, c = math::cos(angle), s = math::sin(angle);
            const auto index = static_cast<std::size_t>(k);
            ratios[index].push_back(
                ratios_about(first_effects, second_effects, c, s, requirements, tests.whole.size()));
            if (multiple == 1) changes[index] = math::hypot(c * first_turn.distance, s * second_turn.distance);
        }
    }
    // About an axis of symmetry, or near it, a rotation changes nothing.
    const double least_change = std::max(detection_floor, 0.1 * *std::ranges::max_element(changes));
    struct Size {
        double angle, change;
    };
    std::vector<Size> sizes;
    for (std::size_t k = 0; k < axes; ++k)
        if (!ratios[k].empty() && changes[k] >= least_change)
            sizes.push_back({least_angle(target_rotation, ratios[k]), changes[k]});
    if (sizes.empty()) return {};
    // The effect of a rotation on a single test vanishes about some axis, so the stated size covers about seven of
    // eight axes.
    std::ranges::sort(sizes, std::greater<>(), &Size::angle);
    const Size& stated_size = sizes[sizes.size() > axes / 2 ? 1 : 0];
    return {stated_size.angle, stated_size.change / target_rotation};
}

/// Variance of ln p over the draws.
double spread_of_log_p(const Observations& o) {
    const double n = o.independent;
    return o.log_p.square / n - o.log_p.sum / n * o.log_p.sum / n;
}

/// Draws by p^(1 + e) in place of p move E[h] by e times the covariance of h and ln p. They are modelled as draws of p
/// that are kept with probability (p / c)^e: about 3 e standard deviations of ln p are drawn again.
FaultSize parameter_of(const SizeTests& tests) {
    constexpr double least_spread_of_log_p = 1e-4;
    FaultSize out;
    if (tests.whole.empty() || tests.is_infinite()) return out;
    const Observations& o = tests.e.observations;
    const double n = o.independent, spread = spread_of_log_p(o);
    if (!(spread > least_spread_of_log_p)) return out;
    out.change = std::sqrt(spread) / 2;
    const double covariance = o.slope_log_p / n - o.sums[slope].sum / n * o.log_p.sum / n;
    if (!(covariance > 0)) return out;
    const double redrawn_share = 3 * std::sqrt(spread), square = 2 * o.sums[slope].square / n;
    const auto change_of_sum = [&](const SumTest& t) {
        return t.sum == slope ? FaultChange{covariance, redrawn_share * square} : FaultChange{};
    };
    take_detected(tests.whole, n, change_of_sum, out.size);
    return out;
}

/// The relative bias of all weights that is found, where they are all there is; a node has more noise.
FaultSize bias_of(const SizeTests& tests) {
    if (!tests.source.traits.reciprocal_weight) return {};
    const Evidence& e = tests.e;
    const Sums& s = e.observations.mean[0];
    const Estimate& expected = e.integrals.light.mean[0];
    const double n = e.observations.weighted_draws;
    if (!(n > 1) || !(expected.value > 0)) return {};
    const double mean = s.sum / n, v = std::max(s.square / n - mean * mean, 0.0) / n + expected.variance;
    const double errors = student_two_sided_quantile(1e6, tests.level) + power_of_each;
    return {errors * std::sqrt(v) / expected.value + detection_floor};
}

/// Of an integral that points resolve up to `unresolved`; none if it is 0.
std::optional<double> relative_error(const Estimate& resolved, double unresolved) {
    if (!(resolved.value > 0)) return {};
    return (half_interval(resolved) + unresolved) / resolved.value;
}

}  // namespace

std::span<const FaultKind> fault_kinds() {
    using Words = FaultKind::Words;
    static constexpr Words constant{"constant", "a constant factor of {:.2g} %", "relative constant factor of p"},
        leak{"leak", "{:.2g} % of the draws uniform", "share of draws spread evenly"},
        parameter{"parameter", "an exponent off by {:.2g} %", "relative change of an exponent"},
        bias{"bias", "a bias of {:.2g} %", "relative bias of the weights"};
    static constexpr Words cap{
        "cap", "a cap with {:.2g} % of p never drawn", "share of p in a cap that is never drawn"},
        gap{"gap", "a gap with {:.2g} % of p never drawn", "share of p in a gap that is never drawn"},
        rotation{"rotation", "a rotation by {:.2g} rad", "rotation in radians", 1},
        shift{"shift", "a shift by {:.2g} % of the range", "shift as a share of the range"};
    static constexpr FaultKind kinds[] = {
        {.verdict = "normalised",
            .of_directions = constant,
            .of_points = constant,
            .target = target_constant,
            .size = constant_of},
        {.verdict = "density", .of_directions = leak, .of_points = leak, .target = target_leak, .size = leak_of},
        {.verdict = "density", .of_directions = cap, .of_points = gap, .target = target_cap, .size = cap_of},
        {.verdict = "mean",
            .of_directions = bias,
            .of_points = bias,
            .target = target_bias_of_weights,
            .size = bias_of},
        {.verdict = "density",
            .of_directions = rotation,
            .of_points = shift,
            .target = target_rotation,
            .size = rotation_of},
        {.verdict = "density",
            .of_directions = parameter,
            .of_points = parameter,
            .target = target_parameter,
            .size = parameter_of},
    };
    return kinds;
}

Sizes sizes_of(Source& source, const Evidence& e, double level, std::uint32_t draws, const StreamKey& key) {
    Sizes out;
    SizeTests tests(source, e, level);
    if (e.source.has_density()) {
        out.integral = error_of_integral(e.integrals, e.observations);
        tests.sample = draw_sample(source, draws, key);
    }
    for (const FaultKind& kind : fault_kinds()) out.faults.push_back(kind.size(tests));
    return out;
}

std::optional<double> Sizes::of(std::string_view name) const {
    const auto kind = std::ranges::find(fault_kinds(), name, [](const FaultKind& k) { return k.of_directions.name; });
    const auto index = static_cast<std::size_t>(kind - fault_kinds().begin());
    return index < faults.size() ? faults[index].size : std::nullopt;
}

DifferenceSizes sizes_between(const Evidence& e, double level, std::span<const Vec3d> centres) {
    DifferenceSizes out;
    const double h = e.plan.largest_h();
    std::array<std::optional<double>, 3> along;  // each axis
    for (const SumTest& t : whole_sums(e, level))
        if (t.sum >= centre_x) take_less(along[t.sum - centre_x], t.requirement.difference() / (t.visible * h));
    out.distance = *std::ranges::max_element(along);
    const std::vector<NodeSums> sums = node_sums(e);
    Sample sample;
    for (Vec3d w : centres) {
        sample.w.push_back(w);
        sample.p.push_back(e.plan.tree.leaves()[e.plan.tree.find(to_chart(w))].q);
    }
    out.part = least_cap(e, sums, node_tests(e, sums, level), sample, level);
    return out;
}

std::optional<double> error_of_integral(const Integrals& integrals, const Observations& o) {
    const double draw_share = o.share_unresolved(), point_share = integrals.unresolved.value;
    return relative_error(integrals.sums[mass],
        std::min(std::max(draw_share, point_share),
            std::fabs(draw_share - point_share) + half_interval(integrals.unresolved)));
}

std::optional<double> error_in_reach(const Integrals& integrals, const Observations& o) {
    return relative_error(integrals.sums[mass], o.share_unresolved());
}

double half_interval(const Estimate& integral) {
    const double nu = freedom(integral.variance, integral.doubt);
    if (!(nu >= 1) || !std::isfinite(integral.variance)) return std::numeric_limits<double>::infinity();
    return student_two_sided_quantile(std::min(nu, 1e6), 0.05) * std::sqrt(integral.variance);
}

double ratio_of(const FaultSize& s, const FaultKind& kind) {
    return s.size ? std::min(*s.size / kind.target, *s.size * s.change / target_leak) : 0;
}

double worst_ratio(const Sizes& sizes, std::string_view verdict) {
    const auto is_asked = [&](std::string_view name) { return verdict.empty() || verdict == name; };
    double worst = is_asked("normalised") ? sizes.integral.value_or(0) / target_constant : 0;
    for (std::size_t k = 0; k < sizes.faults.size(); ++k)
        if (is_asked(fault_kinds()[k].verdict)) worst = std::max(worst, ratio_of(sizes.faults[k], fault_kinds()[k]));
    return worst;
}

}  // namespace crescent::check
