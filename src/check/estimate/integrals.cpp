// The points are evaluated in batches of whole cells.
#include "check/estimate/integrals.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

#include "check/constants.h"
#include "math/simd/frame.h"

namespace crescent::check {

void LightIntegrals::scale(double factor) {
    for (auto* by_channel : {&integral, &mean, &albedo})
        for (Estimate& e : *by_channel) e.scale(factor);
    lost.scale(factor);
    separate_lost.scale(factor);
    lit.scale(factor);
    largest_lost *= factor;
    for (auto& by_channel : leaves)
        for (Estimate& e : by_channel) e.scale(factor);
    for (WeightedPoint& w : weighted_points) {
        w.light *= factor;
        w.chance *= factor;
    }
}

void LightIntegrals::add(const LightIntegrals& o) {
    for (std::size_t c = 0; c < 3; ++c) {
        integral[c].add(o.integral[c]);
        mean[c].add(o.mean[c]);
        albedo[c].add(o.albedo[c]);
    }
    lost.add(o.lost);
    separate_lost.add(o.separate_lost);
    lit.add(o.lit);
    largest_lost = std::max(largest_lost, o.largest_lost);
    for (std::size_t l = 0; l < leaves.size(); ++l)
        for (std::size_t c = 0; c < 3; ++c) leaves[l][c].add(o.leaves[l][c]);
    weighted_points.insert(weighted_points.end(), o.weighted_points.begin(), o.weighted_points.end());
}

double flux_factor(const Source& source, Vec3d wi, int channel) {
    if (source.wo.z * wi.z >= 0 || source.traits.importance) return 1;
    if (!source.traits.eta)
        return source.unscaled ? 1 : 0;  // 0: unknown, so only the reflected part is compared with 1
    const double eta = channel_of(*source.traits.eta, channel);
    return source.wo.z > 0 ? eta * eta : 1 / (eta * eta);
}

namespace {

/// The grid of one leaf: rows x columns cells with two points each.
struct Grid {
    std::uint32_t leaf = 0;
    int rows = 1, columns = 1;
    double per_point = 0;
    int cells() const { return rows * columns; }
    std::size_t points() const { return 2 * static_cast<std::size_t>(cells()); }
};

/// Distributes the points of a pass: two or four to each leaf, and the rest by their shares. At most `points` in all if
/// that is at least two for each leaf.
std::vector<Grid> grids_of(const Plan& plan, std::uint32_t points) {
    const std::vector<Leaf>& leaves = plan.tree.leaves();
    const std::vector<double> shares = plan.tree.shares_of_points();
    const int least_pairs = points < 8 * leaves.size() ? 1 : 2;  // pairs in each leaf
    const double further_pairs = std::max(points / 2.0 - least_pairs * static_cast<double>(leaves.size()), 0.0);
    std::vector<Grid> out(leaves.size());
    double carry = 0;  // accumulated fractions of a pair
    for (std::size_t l = 0; l < leaves.size(); ++l) {
        const ChartRect& rect = plan.tree.rect(leaves[l]);
        carry += further_pairs * shares[l];
        const int pairs = least_pairs + static_cast<int>(carry);
        carry -= static_cast<int>(carry);
        Grid& g = out[l];
        g.leaf = static_cast<std::uint32_t>(l);
        const double square = std::sqrt(pairs * rect.theta_width() / (rect.phi_width() + 1e-300));
        g.rows = static_cast<int>(std::clamp(square + 0.5, 1.0, static_cast<double>(pairs)));
        g.columns = std::max(1, pairs / g.rows);
        g.rows = pairs / g.columns;
        g.per_point = rect.area() / static_cast<double>(g.points());
    }
    return out;
}

class Pass {
public:
    /// lost_leaves: leaves in which lost light was found before.
    Pass(Source& source, const Plan& plan, bool uses_f, const StreamKey& key, std::vector<std::size_t> lost_leaves)
        : source_(source), plan_(plan), uses_f_(uses_f && source.has_f()), stream_(key) {
        out_.light.lost_leaves = std::move(lost_leaves);
        out_.leaves.resize(plan.tree.leaves().size());
        if (uses_f_ && !source.has_density()) out_.light.leaves.resize(plan.tree.leaves().size());
    }

    Integrals run(const std::vector<Grid>& grids) {
        std::size_t first = 0;
        while (first < grids.size()) {
            w_.clear();
            chart_.clear();
            std::size_t last = first;
            for (; last < grids.size() && (last == first || w_.size() < source_.batch_rows()); ++last)
                place_points(grids[last]);
            p_.resize(w_.size());
            f_.assign(w_.size(), {});
            source_.density(w_, p_);
            if (uses_f_) source_.f_cos(w_, f_, source_.declaration.has_true_f);
            mis_.assign(w_.size(), 1);
            if (uses_f_ && source_.adapter.techniques() > 1) source_.mis_weights(w_, mis_);
            measure_rounding(std::span(grids).subspan(first, last - first));
            std::size_t index = 0;
            for (std::size_t g = first; g < last; ++g) add_points(grids[g], rounding_[g - first], index);
            first = last;
        }
        if (uses_f_) measure_lost();
        return std::move(out_);
    }

private:
    Source& source_;
    const Plan& plan_;
    bool uses_f_, is_tabulated_ = !source_.declaration.can_draw;
    Stream stream_;
    Integrals out_;
    std::vector<ChartPoint> chart_;  // of w_
    std::vector<Vec3d> w_, f_;
    std::vector<double> p_, mis_;
    std::vector<double> rounding_;  // by grid of the batch: relative error of p by the sampler's arithmetic

    /// The rounding error of p in single precision, at the first point of each leaf, and at all points of a leaf in
    /// which that shows one. Reflection about a half vector is an example: opposite to w_o the half vector is a
    /// difference of nearly equal numbers.
    void measure_rounding(std::span<const Grid> grids) {
        rounding_.assign(grids.size(), 0);
        if (is_tabulated_ || !source_.has_density() || source_.estimates || !plan_.in_single(source_)) return;
        std::vector<std::size_t> first;  // point of each grid
        std::size_t offset = 0;
        for (const Grid& g : grids) {
            first.push_back(offset);
            offset += g.points();
        }
        const std::vector<double> first_rounding = rounding_at(first);
        for (std::size_t g = 0; g < grids.size(); ++g) {
            if (!(first_rounding[g] > same_number)) continue;
            std::vector<std::size_t> points(grids[g].points());
            std::iota(points.begin(), points.end(), first[g]);
            const std::vector<double> rounding = rounding_at(points);
            rounding_[g] =
                std::accumulate(rounding.begin(), rounding.end(), 0.0) / static_cast<double>(rounding.size());
        }
    }

    /// The relative error of p at some points: its change if the length of w_o or w_i is off by two ulp, divided by 4.
    /// A pdf depends on directions alone, so that only rounding makes it depend on lengths; the components of a
    /// direction in single precision give it a length that is off by up to half an ulp.
    std::vector<double> rounding_at(std::span<const std::size_t> points) {
        constexpr double longer = 1 + 2 * ulp;
        std::vector<Vec3d> w;
        for (std::size_t index : points) w.push_back(w_[index]);
        std::vector<double> wo_density(w.size()), wi_density(w.size()), out;
        source_.density_from(source_.wo * longer, w, wo_density);
        for (Vec3d& v : w) v = v * longer;
        source_.density_from(source_.wo, w, wi_density);
        for (std::size_t i = 0; i < points.size(); ++i) {
            double smallest = p_[points[i]], greatest = smallest;
            for (const double p : {wo_density[i], wi_density[i]})
                if (p >= 0 && std::isfinite(p)) {
                    smallest = std::min(smallest, p);
                    greatest = std::max(greatest, p);
                }
            out.push_back(greatest > 0 ? std::min(1.0, (greatest / smallest - 1) / 4) : 0);
        }
        return out;
    }

    /// f |cos| L at a point, summed over three channels.
    double light_at(std::size_t index) const {
        const Vec3d f = f_[index];
        const double y = source_.channels() == 3 ? f.x + f.y + f.z : f.x;
        return y > 0 ? y * source_.radiance(w_[index]) : 0;
    }
    double lost_at(std::size_t index) {
        if (p_[index] > 0) return 0;
        const double lit = light_at(index);
        return lit > 0 && source_.reached_otherwise(w_[index]) ? 0 : lit;
    }

    /// A thin region where p is 0 contains only a few points, too few for a test. Separate points measure the lost
    /// light in the leaves that have a point with p = 0.
    void measure_lost() {
        std::vector<std::size_t>& leaves = out_.light.lost_leaves;
        std::sort(leaves.begin(), leaves.end());
        leaves.erase(std::unique(leaves.begin(), leaves.end()), leaves.end());
        const auto pairs = static_cast<int>(std::max(points_of_lost / 2 / static_cast<double>(leaves.size() + 1), 1.0));
        std::vector<double> per_point;
        w_.clear();
        for (std::size_t l : leaves) {
            const ChartRect& rect = plan_.tree.rect(plan_.tree.leaves()[l]);
            for (int j = 0; j < 2 * pairs; ++j) {
                const double x = stream_.number(), y = stream_.number();
                w_.push_back(from_chart(rect.at(x, y)));
            }
            per_point.insert(per_point.end(), static_cast<std::size_t>(pairs), rect.area() / (2 * pairs));
        }
        if (w_.empty()) return;
        p_.resize(w_.size());
        f_.assign(w_.size(), {});
        source_.density(w_, p_);
        source_.f_cos(w_, f_, source_.declaration.has_true_f);
        LightIntegrals& l = out_.light;
        for (std::size_t j = 0; j < per_point.size(); ++j) {
            const double a = lost_at(2 * j), b = lost_at(2 * j + 1), k = per_point[j];
            l.separate_lost.add_pair(a, b, k);
            l.largest_lost = std::max(l.largest_lost, k * std::max(a, b));
        }
    }

    void place_points(const Grid& g) {
        const ChartRect& rect = plan_.tree.rect(plan_.tree.leaves()[g.leaf]);
        for (int column = 0; column < g.columns; ++column)
            for (int row = 0; row < g.rows; ++row)
                for (int pair = 0; pair < 2; ++pair) {
                    const double x = (row + stream_.number()) / g.rows, y = (column + stream_.number()) / g.columns;
                    chart_.push_back(rect.at(x, y));
                    w_.push_back(from_chart(chart_.back()));
                }
    }

    void add_points(const Grid& g, double rounding, std::size_t& index) {
        const Leaf& leaf = plan_.tree.leaves()[g.leaf];
        LeafIntegral& to = out_.leaves[g.leaf];
        const double k = to.per_point = g.per_point;
        double smallest = 1e300, greatest = 0;
        bool is_lit = false;
        for (int j = 0; j < g.cells(); ++j, index += 2) {
            Values h[2];
            double second[2], unresolved[2];
            for (std::size_t a = 0; a < 2; ++a) {
                const double p = p_[index + a];
                h[a] = plan_.values(leaf, w_[index + a], p);
                smallest = std::min(smallest, p);
                greatest = std::max(greatest, p);
                is_lit = is_lit || (uses_f_ && light_at(index + a) > 0);
                if (k * p > heavy_point) out_.heavy.push_back({chart_[index + a], p});
                second[a] = k * h[a][bridge] * h[a][bridge] * p;
                to.second += second[a];
                if (source_.may_draw(w_[index + a], p)) out_.domain += k;
                if (p > 0) {
                    to.solid_angle += k * h[a][bridge];
                    for (std::size_t q = 0; q < integrands; ++q) {
                        out_.uniform_sums[q] += k * h[a][q];
                        out_.uniform_squares[q] += k * h[a][q] * h[a][q];
                    }
                }
                if (is_tabulated_) allow_tabulation(h[a], w_[index + a], k, to);
                for (double& v : h[a]) v *= p;
                unresolved[a] = plan_.resolves(leaf, p) ? 0 : std::exchange(h[a][mass], 0);
            }
            out_.unresolved.add_pair(unresolved[0], unresolved[1], k);
            for (std::size_t q = 0; q < integrands; ++q) out_.sums[q].add_pair(h[0][q], h[1][q], k);
            to.mass.add_pair(h[0][mass], h[1][mass], k);
            to.bridge.add_pair(h[0][bridge], h[1][bridge], k);
            if (source_.has_density()) add_to_bands(index, {h[0][bridge], h[1][bridge]}, second, k);
            if (uses_f_) take_light(g.leaf, index, k);
        }
        if (uses_f_ && smallest == 0 && is_lit) out_.light.lost_leaves.push_back(g.leaf);
        to.top = greatest;
        out_.points += static_cast<double>(g.points());
        to.rounding = rounding;
        if (leaf.edge && greatest <= alike * smallest) allow_strip(leaf, to);
    }

    /// For a pair of points: values of h p, and of h^2 p times k.
    void add_to_bands(std::size_t index, std::array<double, 2> value, const double (&second)[2], double k) {
        for (std::size_t axis = 0; axis < chart_axes; ++axis) {
            const std::size_t i = band_of(chart_[index], axis), j = band_of(chart_[index + 1], axis);
            out_.second_by_band[i] += second[0];
            out_.second_by_band[j] += second[1];
            if (i == j) {
                out_.bridge_by_band[i].add_pair(value[0], value[1], k);
            } else {
                out_.bridge_by_band[i].add_pair(value[0], 0, k);
                out_.bridge_by_band[j].add_pair(0, value[1], k);
            }
        }
    }

    void allow_tabulation(const Values& h, Vec3d w, double k, LeafIntegral& to) {
        const double unknown = k * source_.adapter.tabulation_error(w);
        to.tabulation_error += unknown * h[bridge];
        for (std::size_t q = 0; q < integrands; ++q) out_.tabulation_error[q] += unknown * std::fabs(h[q]);
    }

    /// If the points of a leaf have similar values and the leaf is next to another density, their pairs cannot show a
    /// strip of that density; one of K_l points may lie in such a strip (the rule of succession).
    void allow_strip(const Leaf& leaf, LeafIntegral& to) {
        const double k = to.per_point, v = k * k * leaf.q * leaf.q / 2;
        const Vec3d middle = from_chart(plan_.tree.rect(leaf).at(0.5, 0.5)), offset = middle - plan_.middle;
        const double log_q = Plan::log_of(leaf.q) - plan_.median_log_p;
        to.bridge.variance += v;
        const double factors[integrands] = {
            4, 1, log_q * log_q, offset.x * offset.x, offset.y * offset.y, offset.z * offset.z};
        for (std::size_t q = 0; q < integrands; ++q) out_.sums[q].variance += v * factors[q];
    }

    void take_light(std::size_t leaf, std::size_t index, double k) {
        LightIntegrals& l = out_.light;
        for (int c = 0; c < source_.channels(); ++c) {
            const auto channel = static_cast<std::size_t>(c);
            double f[2], mean[2], flux[2];
            for (std::size_t a = 0; a < 2; ++a) {
                f[a] = channel_of(f_[index + a], c);
                mean[a] = f[a] * mean_bridge(f[a], p_[index + a], plan_.mean_weight[channel], is_bridged(source_));
                flux[a] = f[a] * flux_factor(source_, w_[index + a], c);
            }
            l.integral[channel].add_pair(f[0], f[1], k);
            l.mean[channel].add_pair(mean[0], mean[1], k);
            l.albedo[channel].add_pair(flux[0], flux[1], k);
            if (!l.leaves.empty()) l.leaves[leaf][channel].add_pair(f[0], f[1], k);
        }
        const double lost[2] = {lost_at(index), lost_at(index + 1)};
        l.lit.add_pair(light_at(index), light_at(index + 1), k);
        l.lost.add_pair(lost[0], lost[1], k);
        l.points += 2;
        for (std::size_t a = 0; a < 2; ++a) note_weight(index + a, k);
    }

    void note_weight(std::size_t index, double k) {
        const double p = p_[index], f = source_.channels() == 3 ? luminance(f_[index]) : f_[index].x;
        const double share = mis_[index] * f * source_.radiance(w_[index]);
        if (source_.has_density() && p > 0 && share > 0)
            out_.light.weighted_points.push_back({share / p, k * share, k * p});
    }
};

void scale(Integrals& x, double factor) {
    for (Estimate& e : x.sums) e.scale(factor);
    x.unresolved.scale(factor);
    for (Estimate& e : x.bridge_by_band) e.scale(factor);
    for (double& v : x.second_by_band) v *= factor;
    x.domain *= factor;
    for (double& v : x.tabulation_error) v *= factor;
    for (double& v : x.uniform_sums) v *= factor;
    for (double& v : x.uniform_squares) v *= factor;
    for (LeafIntegral& leaf : x.leaves) {
        leaf.mass.scale(factor);
        leaf.bridge.scale(factor);
        leaf.second *= factor;
        leaf.solid_angle *= factor;
        leaf.per_point *= factor;
        leaf.tabulation_error *= factor;
        leaf.rounding *= factor;
    }
}

}  // namespace

void integrate(
    Source& source, const Plan& plan, std::uint32_t points, bool uses_f, const StreamKey& key, Integrals& to) {
    Integrals pass = Pass(source, plan, uses_f, key, to.light.lost_leaves).run(grids_of(plan, points));
    if (to.points == 0) {
        to = std::move(pass);
        return;
    }
    const double total = to.points + pass.points;
    if (pass.light.points > 0) {
        const double light_points = to.light.points + pass.light.points;
        to.light.scale(to.light.points / light_points);
        pass.light.scale(pass.light.points / light_points);
        to.light.add(pass.light);
        to.light.points = light_points;
    }
    scale(to, to.points / total);
    scale(pass, pass.points / total);
    to.unresolved.add(pass.unresolved);
    for (std::size_t q = 0; q < integrands; ++q) {
        to.sums[q].add(pass.sums[q]);
        to.tabulation_error[q] += pass.tabulation_error[q];
        to.uniform_sums[q] += pass.uniform_sums[q];
        to.uniform_squares[q] += pass.uniform_squares[q];
    }
    for (std::size_t l = 0; l < to.leaves.size(); ++l) {
        LeafIntegral &a = to.leaves[l], &b = pass.leaves[l];
        a.mass.add(b.mass);
        a.bridge.add(b.bridge);
        a.second += b.second;
        a.solid_angle += b.solid_angle;
        a.tabulation_error += b.tabulation_error;
        a.rounding += b.rounding;
        a.top = std::max(a.top, b.top);
        a.per_point = std::max(a.per_point, b.per_point);
    }
    for (std::size_t k = 0; k < to.bridge_by_band.size(); ++k) {
        to.bridge_by_band[k].add(pass.bridge_by_band[k]);
        to.second_by_band[k] += pass.second_by_band[k];
    }
    to.heavy.insert(to.heavy.end(), pass.heavy.begin(), pass.heavy.end());
    to.domain += pass.domain;
    to.points = total;
}

}  // namespace crescent::check
