// Bins need not align with leaves: a leaf is divided by area, and leaves are small where mass is.
#include "check/report/pictures.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fmt/format.h>
#include <functional>

#include "check/decide/tail.h"
#include "math/functions.h"
#include "math/simd/scalar.h"

namespace crescent::check {

namespace {

constexpr int map_rings = 20, map_sectors = 24;

/// A share of the mass of a leaf, spread evenly over an interval.
struct Spread1d {
    double from, to, mass;
};

double mass_up_to(std::span<const Spread1d> parts, double x) {
    double sum = 0;
    for (const Spread1d& s : parts) sum += s.mass * std::clamp((x - s.from) / (s.to - s.from), 0.0, 1.0);
    return sum;
}

double quantile_of(std::span<const Spread1d> parts, double share, double low, double high) {
    const double total = mass_up_to(parts, high);
    for (int i = 0; i < 50; ++i) {
        const double middle = (low + high) / 2;
        (mass_up_to(parts, middle) < share * total ? low : high) = middle;
    }
    return (low + high) / 2;
}

/// Uniform bins over nearly all of the mass, and a few on either side of it.
std::vector<double> edges_of(std::span<const Spread1d> parts, double low, double high, int bins) {
    constexpr double tail_share = 1e-3;  // of the mass, on either side
    constexpr double zoom_share = 0.6;   // of the range
    constexpr int margin_bins = 2;       // bins
    double from = quantile_of(parts, tail_share, low, high), to = quantile_of(parts, 1 - tail_share, low, high);
    const double margin = 0.02 * (to - from);
    from = std::max(low, from - margin);
    to = std::min(high, to + margin);
    if (to - from > zoom_share * (high - low)) {
        from = low;
        to = high;
    }
    const int lower_bins = from > low ? margin_bins : 0, upper_bins = to < high ? margin_bins : 0,
              middle_bins = bins - lower_bins - upper_bins;
    std::vector<double> out;
    for (int i = 0; i < lower_bins; ++i) out.push_back(low + (from - low) * i / lower_bins);
    for (int i = 0; i < middle_bins; ++i) out.push_back(from + (to - from) * i / middle_bins);
    for (int i = 0; i < upper_bins; ++i) out.push_back(to + (high - to) * i / upper_bins);
    out.push_back(high);
    return out;
}

/// Calls `add(bin, share)` with the share of [from, to] in each bin.
void share_out(
    double from, double to, const std::vector<double>& edges, const std::function<void(std::size_t, double)>& add) {
    auto bin = static_cast<std::size_t>(std::ranges::upper_bound(edges, from) - edges.begin());
    bin = bin > 0 ? bin - 1 : 0;
    for (; bin + 1 < edges.size() && edges[bin] < to; ++bin) {
        const double width = std::min(to, edges[bin + 1]) - std::max(from, edges[bin]);
        if (width > 0) add(bin, width / (to - from));
    }
}

/// Six significant figures are more than a picture shows, and keep stored results short.
void round_values(std::vector<double>& values) {
    for (double& v : values) {
        if (v == 0 || !std::isfinite(v)) continue;
        const double places = 5 - std::floor(math::log10(std::fabs(v)));
        const double power = std::round(math::pow(10.0, std::fabs(places)));  // exact up to 1e22
        v = places > 0 ? std::round(v * power) / power : std::round(v / power) * power;
    }
}

/// One leaf in units of draws: observed, expected by p, and the variance of their difference.
struct LeafDraws {
    ChartRect rect;
    double observed = 0, expected = 0, variance = 0;
};

std::vector<LeafDraws> leaf_draws(const CheckAt& c, bool has_density) {
    const std::vector<Leaf>& leaves = c.plan->tree.leaves();
    const double n = c.observations.independent;
    std::vector<LeafDraws> out;
    for (std::size_t l = 0; l < leaves.size(); ++l) {
        const LeafIntegral& claim = c.integrals.leaves[l];
        LeafDraws d{c.plan->tree.rect(leaves[l])};
        // The weight of one draw, E[h^2] / E[h].
        const double unit = claim.bridge.value > 0 ? claim.second / claim.bridge.value : 1;
        if (!has_density) {
            d.observed = d.expected = static_cast<double>(c.observations.counts[l]);
        } else if (unit > 0) {
            d.observed = c.observations.leaves[l] / unit;
            d.expected = n * claim.bridge.value / unit;
            d.variance = d.expected + sqr(n / unit) * claim.bridge.variance;
        }
        if (d.observed > 0 || d.expected > 0) out.push_back(d);
    }
    return out;
}

/// The azimuths of a leaf from `start` on, in one or two intervals.
std::vector<std::pair<double, double>> turned_azimuths(const ChartRect& rect, double start) {
    const double from = rect.phi0 - start, to = rect.phi1 - start;
    if (from >= 0) return {{from, to}};
    if (to <= 0) return {{from + two_pi, to + two_pi}};
    return {{from + two_pi, two_pi}, {0, to}};
}

/// The azimuth at which the map is cut: opposite to the draws.
double seam_of(const Vec3d& middle) {
    if (math::hypot(middle.x, middle.y) < 0.05) return 0;
    const double phi = math::atan2(middle.y, middle.x) + two_pi / 2;
    return phi < 0 ? phi + two_pi : phi >= two_pi ? phi - two_pi : phi;
}

struct MapEdges {
    std::vector<double> theta, phi;  // radians; phi from the seam on
    double seam = 0;
};

MapEdges map_edges(const std::vector<LeafDraws>& leaves, const Vec3d& middle) {
    MapEdges out;
    out.seam = seam_of(middle);
    std::vector<Spread1d> theta, phi;
    bool extends_below = false;
    for (const LeafDraws& d : leaves) {
        const double mass = d.observed + d.expected;
        theta.push_back({angle_of(d.rect.t0), angle_of(d.rect.t1), mass});
        extends_below = extends_below || (d.rect.t1 > 1 && mass > 0.5);
        const auto pieces = turned_azimuths(d.rect, out.seam);
        for (const auto& [from, to] : pieces)
            phi.push_back({from, to, mass * (to - from) / (d.rect.phi1 - d.rect.phi0)});
    }
    out.theta = edges_of(theta, 0, extends_below ? two_pi / 2 : two_pi / 4, map_rings);
    out.phi = edges_of(phi, 0, two_pi, map_sectors);
    return out;
}

/// Of equal measure, for another domain than directions.
MapEdges even_edges() {
    MapEdges out;
    for (int i = 0; i <= map_rings; ++i) out.theta.push_back(angle_of(2.0 * i / map_rings));
    for (int i = 0; i <= map_sectors; ++i) out.phi.push_back(two_pi * i / map_sectors);
    return out;
}

/// Degrees in [0, 360]; the last edge is above the first.
double degrees_from(double seam, double azimuth) {
    const double d = (seam + azimuth) * 360 / two_pi;
    return d > 360 + 1e-9 ? d - 360 : d;
}

}  // namespace

std::optional<BinHistogram> bin_map(const CheckCase& check_case, const CheckAt& c) {
    if (!c.plan || c.observations.counts.empty()) return {};
    const bool has_density = check_case.adapter->traits().has_pdf;
    const std::vector<LeafDraws> leaves = leaf_draws(c, has_density);
    if (leaves.empty()) return {};
    const DomainChart* domain = c.traits.domain.get();
    if (domain && domain->domain().dimensions() != 2) return {};
    const MapEdges edges = domain ? even_edges() : map_edges(leaves, c.plan->middle);
    BinHistogram out;
    out.arm = check_case.arm;
    out.check_case = check_case.text();
    out.coordinates = domain ? domain->axis(0) + " and " + domain->axis(1) : "theta from n and phi about it";
    for (std::size_t k = 0; domain && k < out.ring_labels.size(); ++k) {
        out.ring_labels[k] = domain->label(0, static_cast<double>(k) / 4);
        out.sector_labels[k] = domain->label(1, static_cast<double>(k) / 4);
    }
    if (domain) {
        out.ring_axis = domain->axis(0);
        out.sector_axis = domain->axis(1);
    }
    if (check_case.adapter->techniques() > 1) out.coordinates += fmt::format(", technique {}", c.technique + 1);
    out.rings = static_cast<int>(edges.theta.size()) - 1;
    out.sectors = static_cast<int>(edges.phi.size()) - 1;
    const auto sectors = static_cast<std::size_t>(out.sectors), bins = static_cast<std::size_t>(out.rings) * sectors;
    out.observed.assign(bins, 0);
    out.expected.assign(bins, 0);
    out.sd.assign(bins, 0);
    for (double theta : edges.theta) out.edges.push_back(1 - math::cos(theta));
    for (double phi : edges.phi) out.sector_edges.push_back(degrees_from(edges.seam, phi));
    for (const LeafDraws& d : leaves)
        share_out(d.rect.t0, d.rect.t1, out.edges, [&](std::size_t ring, double ring_share) {
            for (const auto& [from, to] : turned_azimuths(d.rect, edges.seam))
                share_out(from, to, edges.phi, [&](std::size_t sector, double sector_share) {
                    const double share = ring_share * sector_share * (to - from) / (d.rect.phi1 - d.rect.phi0);
                    const std::size_t bin = ring * sectors + sector;
                    out.observed[bin] += share * d.observed;
                    out.expected[bin] += share * d.expected;
                    out.sd[bin] += share * d.variance;
                });
        });
    for (double& v : out.sd) v = std::sqrt(v);
    for (auto* values : {&out.observed, &out.expected, &out.sd}) round_values(*values);
    if (has_density) return out;
    for (std::size_t i = 0; i < bins; ++i) {
        const std::size_t ring = i / sectors, sector = i % sectors;
        const double area = (out.edges[ring + 1] - out.edges[ring]) * (edges.phi[sector + 1] - edges.phi[sector]);
        out.observed[i] /= area * c.observations.independent;
        out.full_scale = std::max(out.full_scale, out.observed[i]);
    }
    round_values(out.observed);
    out.expected.clear();
    out.sd.clear();
    return out;
}

std::optional<LineHistogram> line_picture(const CheckCase& check_case, const CheckAt& c) {
    constexpr int most_bins = 64;
    constexpr double tail_share = 2e-3;  // of the mass of an infinite line, at either end
    const DomainChart* domain = c.traits.domain.get();
    if (!domain || !domain->is_line() || !c.plan || c.observations.counts.empty()) return {};
    const bool has_density = check_case.adapter->traits().has_pdf;
    const std::vector<LeafDraws> leaves = leaf_draws(c, has_density);
    if (leaves.empty()) return {};
    LineHistogram out;
    out.arm = check_case.arm;
    out.check_case = check_case.text();
    out.axis = domain->axis(0);
    out.entries = domain->is_discrete();
    const DomainPart& part = domain->domain().parts()[0];
    std::vector<Spread1d> mass;
    for (const LeafDraws& d : leaves) mass.push_back({d.rect.t0, d.rect.t1, d.observed + d.expected});
    double low = 0, high = out.entries ? 2.0 * part.count / std::bit_ceil(part.count) : 2;
    if (part.is_infinite()) {
        const double from = quantile_of(mass, tail_share, 0, 2), to = quantile_of(mass, 1 - tail_share, 0, 2);
        if (!std::isfinite(part.from)) low = from;
        if (!std::isfinite(part.to)) high = to;
    }
    const double first = domain->value_at(low), last = domain->value_at(high);
    const int bins = out.entries ? static_cast<int>(std::min<std::uint32_t>(part.count, most_bins)) : most_bins;
    for (int i = 0; i <= bins; ++i) out.edges.push_back(first + (last - first) * i / bins);
    if (out.entries)
        for (double& e : out.edges) e = std::round(e);
    const auto count = static_cast<std::size_t>(bins);
    out.observed.assign(count, 0);
    out.expected.assign(count, 0);
    for (const LeafDraws& d : leaves)
        share_out(
            domain->value_at(d.rect.t0), domain->value_at(d.rect.t1), out.edges, [&](std::size_t bin, double share) {
                out.observed[bin] += share * d.observed;
                out.expected[bin] += share * d.expected;
            });
    for (auto* values : {&out.observed, &out.expected}) round_values(*values);
    if (!has_density) out.expected.clear();
    return out;
}

WeightHistogram weight_picture(const CheckCase& check_case, std::span<const double> x, const WeightTail& tail) {
    constexpr int bins = 48;
    WeightHistogram out;
    out.arm = check_case.arm;
    out.check_case = check_case.text();
    double low = 1e300, high = 0;
    for (double v : x) {
        if (v > 0) {
            low = std::min(low, v);
            high = std::max(high, v);
        } else ++out.zeros;
    }
    if (high > 0) {
        const double from = math::log10(low) - 0.05, to = math::log10(high) + 0.05;
        for (int i = 0; i <= bins; ++i) out.log10_edges.push_back(from + (to - from) * i / bins);
        out.counts.assign(bins, 0);
        for (double v : x)
            if (v > 0)
                ++out.counts[static_cast<std::size_t>(
                    std::clamp((math::log10(v) - from) / (to - from) * bins, 0.0, bins - 1.0))];
    }
    if (!tail.fit || tail.fit->exceedances + 1 >= x.size()) return out;
    out.k = tail.fit->k;
    out.exceedances = static_cast<double>(tail.fit->exceedances);
    std::vector<double> sorted_weights(x.begin(), x.end());
    std::ranges::sort(sorted_weights, std::greater<>());
    out.threshold = sorted_weights[tail.fit->exceedances];
    const double median =
        sorted_weights[tail.fit->exceedances / 2] - out.threshold;  // of the exceedances; it determines sigma
    out.sigma = std::fabs(out.k) < 1e-6 ? median / math::log(2.0) : out.k * median / (math::exp2(out.k) - 1);
    return out;
}

void add_rose(const CheckCase& check_case, WeightHistogram& to) {
    Source source(*check_case.adapter, 0, check_case.wo, check_case.light);
    if (!source.has_density() || !source.has_f()) return;
    std::vector<Vec3d> wi;
    const double azimuth = math::atan2(check_case.wo.y, check_case.wo.x) * 360 / two_pi;
    for (int i = -89; i <= 89; ++i) wi.push_back(tilt(i, azimuth));
    to.rose_p.assign(wi.size(), 0);
    std::vector<double> p(wi.size());
    for (int t = 0; t < check_case.adapter->techniques(); ++t) {
        Source technique(*check_case.adapter, t, check_case.wo, check_case.light);
        technique.density(wi, p);
        for (std::size_t i = 0; i < wi.size(); ++i) to.rose_p[i] = std::max(to.rose_p[i], p[i]);
    }
    std::vector<Vec3d> f(wi.size());
    source.f_cos(wi, f);
    for (std::size_t i = 0; i < wi.size(); ++i)
        to.rose_f.push_back((source.channels() == 3 ? luminance(f[i]) : f[i].x) * source.radiance(wi[i]));
    for (auto* values : {&to.rose_p, &to.rose_f}) round_values(*values);
}

}  // namespace crescent::check
