// Named frames are tested with a few hundred draws. Rotations are searched first with the densities of the tree, which
// costs no evaluations, and then with p itself.
#include "check/explain/frames.h"

#include <algorithm>
#include <cmath>

#include "check/explain/constants.h"
#include "check/explain/domain_causes.h"
#include "math/simd/frame.h"

namespace crescent::check {

namespace {

constexpr std::size_t draws_to_climb = 512;
constexpr std::size_t most_frames = 4;  // that are tested further

/// A frame used in place of another: p in that frame times the ratio of areas is the density of the draws.
struct NamedFrame {
    const char* name;
    Vec3d (*apply)(Vec3d);
    double (*area)(Vec3d) = nullptr;    // null: areas do not change
    bool is_for_lights = false;         // only if no normal is distinguished
    bool exchanges_parameters = false;  // of x and y, if it is applied to both directions
};

/// theta and phi / 2 exchanged, as in a table with rows and columns exchanged.
Vec3d transposed(Vec3d w) {
    const double theta = math::atan2(std::sqrt(w.x * w.x + w.y * w.y), w.z);
    double phi = math::atan2(w.y, w.x);
    if (phi < 0) phi += two_pi;
    const math::SinCos theta_image = math::sincos(phi / 2), phi_image = math::sincos(2 * theta);
    return {theta_image.sin * phi_image.cos, theta_image.sin * phi_image.sin, theta_image.cos};
}
double transposed_area(Vec3d w) {
    const Vec3d t = transposed(w);
    return std::sqrt((t.x * t.x + t.y * t.y + 1e-30) / (w.x * w.x + w.y * w.y + 1e-30));
}

constexpr NamedFrame named_frames[] = {{"the frame mirrored in y", [](Vec3d w) { return Vec3d{w.x, -w.y, w.z}; }},
    {"the frame mirrored in x", [](Vec3d w) { return Vec3d{-w.x, w.y, w.z}; }},
    {"the azimuth turned by 180 deg", [](Vec3d w) { return Vec3d{-w.x, -w.y, w.z}; }},
    {"x and y exchanged (transposed)", [](Vec3d w) { return Vec3d{w.y, w.x, w.z}; }, nullptr, false, true},
    {"the azimuth turned by 90 deg", [](Vec3d w) { return Vec3d{-w.y, w.x, w.z}; }},
    {"the azimuth turned by -90 deg", [](Vec3d w) { return Vec3d{w.y, -w.x, w.z}; }},
    {"above and below exchanged", [](Vec3d w) { return Vec3d{w.x, w.y, -w.z}; }},
    {"forward and back exchanged", [](Vec3d w) { return -w; }},
    {"rows and columns exchanged (theta and phi / 2)", transposed, transposed_area, true},
    {"y and z exchanged", [](Vec3d w) { return Vec3d{w.x, w.z, w.y}; }, nullptr, true},
    {"x and z exchanged", [](Vec3d w) { return Vec3d{w.z, w.y, w.x}; }, nullptr, true},
    {"a turn by 90 deg about x", [](Vec3d w) { return Vec3d{w.x, -w.z, w.y}; }, nullptr, true},
    {"a turn by -90 deg about x", [](Vec3d w) { return Vec3d{w.x, w.z, -w.y}; }, nullptr, true},
    {"a turn by 90 deg about y", [](Vec3d w) { return Vec3d{w.z, w.y, -w.x}; }, nullptr, true},
    {"a turn by -90 deg about y", [](Vec3d w) { return Vec3d{-w.z, w.y, w.x}; }, nullptr, true},
    {"x, y, z taken for y, z, x", [](Vec3d w) { return Vec3d{w.y, w.z, w.x}; }, nullptr, true},
    {"x, y, z taken for z, x, y", [](Vec3d w) { return Vec3d{w.z, w.x, w.y}; }, nullptr, true}};

enum Which { of_wo = 1, of_wi = 2, of_both = 3 };

/// Sets the density to 0 where p is 0: the pdf of a draw there is 0, so it counts as no sample.
void clear_where_zero(const SamplerAdapter& s, int technique, std::span<const Pair> pairs, std::span<double> density) {
    std::vector<double> p(pairs.size());
    s.exact_pdf(technique, pairs, p);
    for (std::size_t i = 0; i < p.size(); ++i)
        if (!(p[i] > 0)) density[i] = 0;
}

Hypothesis in_frame(const NamedFrame& frame, int directions, bool counts_zero) {
    Hypothesis h;
    const char* suffix[] = {"", " for w_o", " for w_i", ""};
    h.name = std::string(frame.name) + suffix[frame.is_for_lights ? 0 : directions];
    h.exchanges_parameters = frame.exchanges_parameters && directions == of_both;
    h.density = [frame, directions, counts_zero](
                    const SamplerAdapter& s, int technique, std::span<const Pair> pairs, std::span<double> out) {
        std::vector<Pair> images(pairs.begin(), pairs.end());
        for (Pair& pair : images) {
            if (directions & of_wo) pair.wo = frame.apply(pair.wo);
            if (directions & of_wi) pair.wi = frame.apply(pair.wi);
        }
        s.exact_pdf(technique, images, out);
        for (std::size_t i = 0; frame.area && i < pairs.size(); ++i) out[i] *= frame.area(pairs[i].wi);
        if (!counts_zero) clear_where_zero(s, technique, pairs, out);
    };
    return h;
}

/// A w_o below the surface, or a transformed w_o of a sampler without w_o, cannot be evaluated.
bool can_be_tested(const NamedFrame& frame, int directions, const Traits& traits) {
    if (traits.wo == Traits::WoDomain::none) return directions == of_wi;
    if (frame.is_for_lights) return false;
    return !(directions & of_wo) || traits.wo == Traits::WoDomain::both || frame.apply({0, 0, 1}).z > 0;
}

/// Uses the densities of the leaves and all draws of the check.
void score_by_tree(const NamedFrame& frame, std::span<const Place> places, Hypothesis& h) {
    Sums gain;
    double draws = 0;
    for (const Place& place : places) {
        const Tree& tree = place.check->plan->tree;
        for (std::size_t l = 0; l < tree.leaves().size(); ++l) {
            const double count = place.check->observations.counts[l];
            if (!(count > 0)) continue;
            const Vec3d w = from_chart(tree.rect(tree.leaves()[l]).at(0.5, 0.5));
            const double density =
                tree.leaves()[tree.find(to_chart(frame.apply(w)))].q * (frame.area ? frame.area(w) : 1);
            const double log_ratio = place.log_of(density) - place.log_of(tree.leaves()[l].q);
            gain.sum += count * log_ratio;
            gain.square += count * log_ratio * log_ratio;
            draws += count;
        }
    }
    if (draws == 0) return;
    h.gain = gain.sum / draws;
    h.draws = draws;
    h.error = std::sqrt(std::max(gain.square / draws - h.gain * h.gain, 0.0) / draws);
}

Vec3d rotated(Vec3d w, Vec3d rotation) {
    const double angle = std::sqrt(dot(rotation, rotation));
    if (!(angle > 0)) return w;
    const Vec3d axis = rotation * (1 / angle);
    const math::SinCos r = math::sincos(angle);
    return w * r.cos + cross(axis, w) * r.sin + axis * (dot(axis, w) * (1 - r.cos));
}

/// Mean log likelihood of the draws if they are those of p rotated by `rotation`.
class Likelihood {
public:
    Likelihood(const Place& place, std::size_t largest_count)
        : place_(place), count_(std::min(largest_count, place.w.size())) {}
    double by_tree(Vec3d rotation) const {
        const Tree& tree = place_.check->plan->tree;
        std::vector<double> q(count_);
        for (std::size_t i = 0; i < count_; ++i)
            q[i] = tree.leaves()[tree.find(to_chart(rotated(place_.w[i], -rotation)))].q;
        return place_.mean_log(q);
    }
    /// rotates_wo: w_o is rotated too, as if the frame of the surface is.
    double by_p(Vec3d rotation, bool rotates_wo = false) const {
        const Vec3d wo = rotates_wo ? rotated(place_.check_case->wo, -rotation) : place_.check_case->wo;
        std::vector<Pair> pairs;
        for (std::size_t i = 0; i < count_; ++i) pairs.push_back({wo, rotated(place_.w[i], -rotation)});
        std::vector<double> p(count_);
        place_.adapter().exact_pdf(place_.technique(), pairs, p);
        for (double& v : p)
            if (!std::isfinite(v)) v = 0;
        return place_.mean_log(p);
    }
    /// Standard error of the angle, from the curvature of the likelihood.
    double error_of(Vec3d rotation, double step, bool rotates_wo = false) const {
        const double angle = std::sqrt(dot(rotation, rotation));
        const Vec3d axis = angle > 0 ? rotation * (1 / angle) : Vec3d{0, 0, 1};
        const double middle = by_p(rotation, rotates_wo), previous = by_p(rotation - axis * step, rotates_wo),
                     next = by_p(rotation + axis * step, rotates_wo);
        const double bend = (2 * middle - previous - next) / (step * step);
        return bend > 0 ? 1 / std::sqrt(bend * static_cast<double>(count_)) : step;
    }

    double count() const { return static_cast<double>(count_); }

private:
    const Place& place_;
    std::size_t count_;
};

/// Coordinate search along the given axes; halves the step if no step improves the likelihood.
template <class L>
Vec3d climb(Vec3d from, std::span<const Vec3d> axes, double step, double least_step, const L& likelihood) {
    double best_likelihood = likelihood(from);
    while (step > least_step) {
        bool has_improved = false;
        for (Vec3d axis : axes)
            for (double sign : {1.0, -1.0}) {
                const Vec3d to = from + axis * (sign * step);
                if (const double l = likelihood(to); l > best_likelihood) {
                    best_likelihood = l;
                    from = to;
                    has_improved = true;
                }
            }
        if (!has_improved) step /= 2;
    }
    return from;
}

/// An angle over which p varies within a lobe: 1 / sqrt(p) for a lobe of density p.
double width_of(const Place& place) { return std::min(1.0, 0.3 * math::exp(-place.check->plan->median_log_p / 2)); }

/// Any rotation of a symmetric lobe about its own axis has the same likelihood. The twist is removed and the rest is
/// searched again, unless the likelihood of all draws is higher with the twist by two units of log likelihood.
Vec3d without_twist(Vec3d rotation, std::span<const Vec3d, 3> axes, double width, const Likelihood& fine_likelihood,
    const Likelihood& full_likelihood) {
    const std::span<const Vec3d> tilt_axes = axes.first(2);
    Vec3d level = rotation - axes[2] * dot(rotation, axes[2]);
    level = climb(level, tilt_axes, width / 8, width / 256, [&](Vec3d v) { return fine_likelihood.by_p(v); });
    level = climb(level, tilt_axes, width / 256, width / 1024, [&](Vec3d v) { return full_likelihood.by_p(v); });
    return full_likelihood.by_p(level) + 2 / full_likelihood.count() >= full_likelihood.by_p(rotation) ? level
                                                                                                       : rotation;
}

/// A nearby whole part of a turn, 2 pi / n, that is as likely: a column of a table.
template <class L> double whole_columns(double angle, const L& likelihood) {
    constexpr int neighbours = 3;
    const double n = std::round(two_pi / std::fabs(angle));
    double best_angle = angle, greatest_likelihood = likelihood(angle, false);
    for (int k = -neighbours; k <= neighbours; ++k) {
        const double column = std::copysign(two_pi / std::max(n + k, 2.0), angle);
        if (std::fabs(column - angle) > column_tolerance * std::fabs(angle)) continue;
        if (const double l = likelihood(column, false); l >= greatest_likelihood) {
            best_angle = column;
            greatest_likelihood = l;
        }
    }
    return best_angle;
}

Hypothesis turned_by(std::span<const Place> places, const std::vector<Turn>& turns, bool rotates_wo = false) {
    Hypothesis h;
    h.name = "turned";
    std::vector<std::pair<Vec3d, Vec3d>> rotations;  // w_o and its rotation
    for (std::size_t k = 0; k < places.size(); ++k) rotations.push_back({places[k].check_case->wo, turns[k].rotation});
    h.density = [rotations, rotates_wo, counts_zero = places[0].draws_at_zero()](
                    const SamplerAdapter& s, int technique, std::span<const Pair> pairs, std::span<double> out) {
        std::vector<Pair> images(pairs.begin(), pairs.end());
        for (Pair& pair : images) {
            const auto nearest =
                std::ranges::max_element(rotations, {}, [&](const auto& one) { return dot(one.first, pair.wo); });
            pair.wi = rotated(pair.wi, -nearest->second);
            if (rotates_wo) pair.wo = rotated(pair.wo, -nearest->second);
        }
        s.exact_pdf(technique, images, out);
        if (!counts_zero) clear_where_zero(s, technique, pairs, out);
    };
    return h;
}

}  // namespace

std::vector<Hypothesis> frame_hypotheses(std::span<const Place> places) {
    if (places[0].traits.domain) return domain_frames(places);
    std::vector<Hypothesis> out;
    for (const NamedFrame& frame : named_frames)
        for (int directions : {of_wi, of_wo, of_both}) {
            if (!can_be_tested(frame, directions, places[0].traits)) continue;
            Hypothesis h = in_frame(frame, directions, places[0].draws_at_zero());
            h.place = static_cast<int>(&frame - named_frames);
            if (directions == of_wi) score_by_tree(frame, places, h);
            else score(h, places);
            if (h.helps()) out.push_back(std::move(h));
        }
    std::ranges::sort(out, std::greater<>(), &Hypothesis::gain);
    if (out.size() > most_frames) out.resize(most_frames);
    return out;
}

std::optional<FoundTurn> turn_hypothesis(std::span<const Place> places) {
    FoundTurn out;
    for (const Place& place : places) {
        Vec3d middle{};
        for (Vec3d w : place.w) middle = middle + w;
        const double length = std::sqrt(dot(middle, middle));
        const Frame<double> frame = frame_about(length > 0 ? middle * (1 / length) : Vec3d{0, 0, 1});
        const Vec3d axes[] = {frame.t, frame.b, frame.n};
        const double width = width_of(place);
        const Likelihood coarse_likelihood(place, 1024), fine_likelihood(place, draws_to_climb),
            full_likelihood(place, place.w.size());
        Vec3d rotation = climb({}, axes, width, width / 16, [&](Vec3d v) { return coarse_likelihood.by_tree(v); });
        rotation = climb(rotation, axes, width / 8, width / 256, [&](Vec3d v) { return fine_likelihood.by_p(v); });
        rotation = climb(rotation, axes, width / 256, width / 1024, [&](Vec3d v) { return full_likelihood.by_p(v); });
        rotation = without_twist(rotation, axes, width, fine_likelihood, full_likelihood);
        out.turns.push_back({rotation, full_likelihood.error_of(rotation, width / 16)});
    }
    out.hypothesis = turned_by(places, out.turns);
    score(out.hypothesis, places);
    return out.hypothesis.helps() ? std::optional(out) : std::nullopt;
}

std::optional<FoundTurn> azimuth_hypothesis(std::span<const Place> places) {
    constexpr int angles = 720;
    double best_likelihood = -1e300, best_angle = 0;
    std::vector<Likelihood> coarse_likelihoods, fine_likelihoods;
    for (const Place& place : places) {
        coarse_likelihoods.emplace_back(place, 1024);
        fine_likelihoods.emplace_back(place, place.w.size());
    }
    const auto sum = [&](double angle, bool uses_tree) {
        double out = 0;
        for (const Likelihood& l : uses_tree ? coarse_likelihoods : fine_likelihoods)
            out += uses_tree ? l.by_tree({0, 0, angle}) : l.by_p({0, 0, angle});
        return out;
    };
    for (int k = 1; k < angles; ++k)
        if (const double l = sum(k * two_pi / angles, true); l > best_likelihood) {
            best_likelihood = l;
            best_angle = k * two_pi / angles;
        }
    const Vec3d axis[] = {{0, 0, 1}};
    best_angle = climb({0, 0, best_angle}, axis, two_pi / angles / 2, two_pi / angles / 64, [&](Vec3d v) {
        return sum(v.z, false);
    }).z;
    if (best_angle > two_pi / 2) best_angle -= two_pi;
    best_angle = whole_columns(best_angle, sum);
    FoundTurn out;
    for (const Likelihood& l : fine_likelihoods)
        out.turns.push_back({{0, 0, best_angle}, l.error_of({0, 0, best_angle}, two_pi / angles)});
    out.hypothesis = turned_by(places, out.turns);
    score(out.hypothesis, places);
    return out.hypothesis.helps() ? std::optional(out) : std::nullopt;
}

std::optional<FoundTurn> frame_turn_hypothesis(std::span<const Place> places) {
    constexpr int angles = 72;
    std::vector<Likelihood> coarse_likelihoods, fine_likelihoods;
    for (const Place& place : places) {
        coarse_likelihoods.emplace_back(place, draws_to_climb);
        fine_likelihoods.emplace_back(place, place.w.size());
    }
    const auto sum = [](const std::vector<Likelihood>& likelihoods, double angle) {
        double out = 0;
        for (const Likelihood& l : likelihoods) out += l.by_p({0, 0, angle}, true);
        return out;
    };
    double best_likelihood = -1e300, angle = 0;
    for (int k = 1; k < angles; ++k)
        if (const double l = sum(coarse_likelihoods, k * two_pi / angles); l > best_likelihood) {
            best_likelihood = l;
            angle = k * two_pi / angles;
        }
    const Vec3d axis[] = {{0, 0, 1}};
    constexpr double step = two_pi / angles / 2;
    angle = climb({0, 0, angle}, axis, step, step / 8, [&](Vec3d v) { return sum(coarse_likelihoods, v.z); }).z;
    angle = climb({0, 0, angle}, axis, step / 8, step / 128, [&](Vec3d v) { return sum(fine_likelihoods, v.z); }).z;
    // Two axes of one surface are the same after half a turn: of equal likelihoods the smaller angle is named.
    const double opposite_angle = angle > two_pi / 2 ? angle - two_pi / 2 : angle + two_pi / 2;
    const auto distance_from_zero = [](double a) { return std::min(a, two_pi - a); };
    if (distance_from_zero(opposite_angle) < distance_from_zero(angle) &&
        sum(fine_likelihoods, opposite_angle) > sum(fine_likelihoods, angle) - equal_likelihoods)
        angle = opposite_angle;
    if (angle > two_pi / 2) angle -= two_pi;
    FoundTurn out;
    for (const Likelihood& l : fine_likelihoods)
        out.turns.push_back({{0, 0, angle}, l.error_of({0, 0, angle}, step / 8, true)});
    out.hypothesis = turned_by(places, out.turns, true);
    out.hypothesis.name = "turned about n";
    score(out.hypothesis, places);
    return out.hypothesis.helps() ? std::optional(out) : std::nullopt;
}

}  // namespace crescent::check
