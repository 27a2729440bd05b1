// Shares have Clopper-Pearson intervals, means those of the normal distribution, quantiles those of order statistics.
// The support is measured on cells that other draws have shaped and ordered, so that no choice biases it.
#include "check/report/describe.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>

#include "base/parallel.h"
#include "check/constants.h"
#include "check/estimate/budget.h"
#include "samplers/domains/sphere_chart.h"
#include "check/estimate/source.h"
#include "check/estimate/stream.h"
#include "math/statistics.h"

namespace crescent::check {

namespace {

constexpr double normal_95 = 1.959964, one_tail = 0.025;
constexpr double support_share = 0.95;
constexpr std::array<double, 3> shares_within = {0.5, 0.9, 0.99};

Interval share_interval(double hits, double trials) {
    if (!(trials > 0)) return {};
    const ShareInterval i = binomial_interval(trials, hits, one_tail);
    return {hits / trials, i.low, i.high};
}

/// Interval of the mean of n values with this sum and sum of squares.
Interval mean_interval(double sum, double square, double n) {
    const double mean = sum / n, half_width = normal_95 * std::sqrt(std::max(square / n - mean * mean, 0.0) / n);
    return {mean, mean - half_width, mean + half_width};
}

/// Interval of the value below which a share of the draws lies; `values` are ascending.
Interval quantile_interval(const std::vector<double>& values, double share) {
    const double n = static_cast<double>(values.size()), half_width = normal_95 * std::sqrt(n * share * (1 - share));
    const auto value_of = [&](double rank) { return values[static_cast<std::size_t>(std::clamp(rank, 0.0, n - 1))]; };
    return {value_of(n * share), value_of(n * share - half_width), value_of(n * share + half_width)};
}

double angle_between(Vec3d a, Vec3d b) {
    const Vec3d normal = cross(a, b);
    return math::atan2(length(normal), dot(a, b));
}

void describe_moments(const std::vector<Vec3d>& w, Description& d) {
    const double n = static_cast<double>(w.size());
    std::array<double, 3> sum{};
    std::array<double, 6> product{}, product_square{};
    for (Vec3d v : w) {
        const double x[3] = {v.x, v.y, v.z}, xx[6] = {v.x * v.x, v.y * v.y, v.z * v.z, v.x * v.y, v.x * v.z, v.y * v.z};
        for (std::size_t k = 0; k < 3; ++k) sum[k] += x[k];
        for (std::size_t k = 0; k < 6; ++k) {
            product[k] += xx[k];
            product_square[k] += xx[k] * xx[k];
        }
    }
    for (std::size_t k = 0; k < 3; ++k) d.mean[k] = mean_interval(sum[k], product[k], n);
    for (std::size_t k = 0; k < 6; ++k) d.second_moments[k] = mean_interval(product[k], product_square[k], n);
    const Vec3d mean{d.mean[0].value, d.mean[1].value, d.mean[2].value};
    const double size = length(mean);
    if (!(size > 0)) return;
    const Vec3d axis = mean * (1 / size);
    d.theta = math::atan2(math::hypot(axis.x, axis.y), axis.z);
    d.phi = math::atan2(axis.y, axis.x);
    if (d.phi < 0) d.phi += two_pi;
    double cosine_sum = 0, square_sum = 0, sine_square_sum = 0;
    std::vector<double> angles;
    for (Vec3d v : w) {
        const double c = dot(v, axis);
        cosine_sum += c;
        square_sum += c * c;
        sine_square_sum += 1 - c * c;
        angles.push_back(angle_between(v, axis));
    }
    d.length = mean_interval(cosine_sum, square_sum, n);
    // Perpendicular to the mean direction the mean has two components, each with half of this variance: 2.4477 =
    // sqrt(chi-square of two degrees at 95 %).
    const double radius = 2.4477 * std::sqrt(std::max(sine_square_sum, 0.0) / 2) / n;
    d.direction_error = radius < size ? math::asin(radius / size) : two_pi / 2;
    std::ranges::sort(angles);
    for (std::size_t k = 0; k < shares_within.size(); ++k) d.angles[k] = quantile_interval(angles, shares_within[k]);
}

/// Dyadic cells of the chart that contain at most `leaf_points` of the draws that shape them.
class Cells {
public:
    explicit Cells(std::vector<ChartPoint> shape) { cut({}, std::move(shape), 0); }
    std::size_t find(ChartPoint point) const {
        std::size_t i = 0;
        while (nodes_[i].child != 0)
            i = nodes_[i].child + ((nodes_[i].splits_phi ? point.phi : point.t) >= nodes_[i].middle);
        return nodes_[i].cell;
    }
    const std::vector<double>& areas() const { return areas_; }

private:
    static constexpr std::size_t leaf_points = 16;
    struct Node {
        std::size_t child = 0, cell = 0;
        bool splits_phi = false;
        double middle = 0;
    };
    std::vector<Node> nodes_ = {{}};
    std::vector<double> areas_;

    void cut(const ChartRect& rect, std::vector<ChartPoint> points, std::size_t node) {
        const bool splits_phi = rect.phi_width() > rect.theta_width();
        if (points.size() <= leaf_points || rect.width(splits_phi) < least_width) {
            nodes_[node].cell = areas_.size();
            areas_.push_back(rect.area());
            return;
        }
        const double middle = rect.middle(splits_phi);
        const std::size_t child = nodes_.size();
        nodes_[node] = {.child = child, .cell = 0, .splits_phi = splits_phi, .middle = middle};
        nodes_.resize(child + 2);
        std::vector<ChartPoint> halves[2];
        for (const ChartPoint& p : points) halves[(splits_phi ? p.phi : p.t) >= middle].push_back(p);
        points = {};
        for (std::size_t k = 0; k < 2; ++k) {
            ChartRect part = rect;
            if (splits_phi) (k == 0 ? part.phi1 : part.phi0) = middle;
            else (k == 0 ? part.t1 : part.t0) = middle;
            cut(part, std::move(halves[k]), child + k);
        }
    }
};

/// A third of the draws shapes the cells, a third gives each cell a density, and a third measures.
void describe_support(const std::vector<Vec3d>& w, Description& d) {
    const std::size_t third = w.size() / 3;
    const auto part = [&](std::size_t k) {
        std::vector<ChartPoint> out;
        for (std::size_t i = k; i < 3 * third; i += 3) out.push_back(to_chart(w[i]));
        return out;
    };
    const Cells cells(part(0));
    const std::size_t count = cells.areas().size();
    const double n = static_cast<double>(third);
    std::vector<double> density(count, 0), counts(count, 0);
    for (const ChartPoint& p : part(1)) density[cells.find(p)] += 1 / n;
    for (std::size_t c = 0; c < count; ++c) density[c] /= cells.areas()[c];
    double sum = 0, square = 0;
    for (const ChartPoint& p : part(2)) {
        const std::size_t c = cells.find(p);
        ++counts[c];
        sum += density[c];
        square += density[c] * density[c];
    }
    const Interval density_mean = mean_interval(sum, square, n);
    const auto invert = [](double v) { return v > 0 ? std::min(1 / v, 2 * two_pi) : 2 * two_pi; };
    d.effective_solid_angle = {invert(density_mean.value), invert(density_mean.high), invert(density_mean.low)};
    std::vector<std::size_t> order(count);
    for (std::size_t c = 0; c < count; ++c) order[c] = c;
    std::ranges::sort(order,
        [&](std::size_t a, std::size_t b) { return density[a] > density[b] || (density[a] == density[b] && a < b); });
    const double half_width = normal_95 * std::sqrt(n * support_share * (1 - support_share));
    double draw_sum = 0, area = 0;
    bool has_low = false, has_middle = false, has_high = false;
    for (std::size_t c : order) {
        draw_sum += counts[c];
        area += cells.areas()[c];
        const auto take = [&](bool& is_set, double from, double& to) {
            if (!is_set && draw_sum >= from) {
                is_set = true;
                to = area;
            }
        };
        take(has_low, n * support_share - half_width, d.solid_angle.low);
        take(has_middle, n * support_share, d.solid_angle.value);
        take(has_high, std::min(n * support_share + half_width, n), d.solid_angle.high);
    }
}

void describe_map(const std::vector<Vec3d>& w, Description& d) {
    constexpr int rings_above = 9;
    d.sectors = 24;
    const int rings = d.below_share.value > 0 ? 2 * rings_above : rings_above;
    for (int i = 0; i <= rings; ++i) d.theta_edges.push_back(two_pi / 4 * i / rings_above);
    std::vector<double> hits(static_cast<std::size_t>(rings * d.sectors), 0);
    for (Vec3d v : w) {
        const ChartPoint point = to_chart(v);
        const int ring = std::min(static_cast<int>(angle_of(point.t) / (two_pi / 4) * rings_above), rings - 1);
        const int sector = std::min(static_cast<int>(point.phi / two_pi * d.sectors), d.sectors - 1);
        ++hits[static_cast<std::size_t>(ring * d.sectors + sector)];
    }
    for (double h : hits) d.map.push_back(share_interval(h, static_cast<double>(d.draws)));
}

Description describe_one(
    const CheckCase& check_case, int technique, const DescribeSettings& settings, std::uint16_t place) {
    Description d;
    d.arm = check_case.arm;
    d.check_case = check_case.text();
    d.technique = technique;
    d.techniques = check_case.adapter->techniques();
    Source source(*check_case.adapter, technique, check_case.wo, check_case.light);
    const StreamKey key{.seed = settings.seed,
        .place = place,
        .technique = static_cast<std::uint8_t>(technique),
        .stage = 1,
        .purpose = Purpose::draws,
        .part = 0xffff};
    const std::uint32_t n =
        source.available(key, check_case.adapter->limited() ? settings.limited_draws : settings.draws);
    std::vector<Vec3d> w;
    std::vector<PrimarySample> u;
    std::vector<Draw> draws;
    double above_count = 0, delta_count = 0, empty_count = 0;
    for (std::uint32_t from = 0; from < n; from += batch_size) {
        u.resize(std::min(batch_size, n - from));
        draws.assign(u.size(), {});
        source.draw(key, from, u, draws);
        for (const Draw& x : draws) {
            const double size = length(x.wi);
            const bool is_sample = x.delta != 0 || x.pdf > 0;
            if (std::isnan(x.pdf) || (is_sample && !(std::isfinite(size) && size > 0))) ++d.invalid;
            else if (x.delta != 0) ++delta_count;
            else if (!is_sample) ++empty_count;
            else {
                w.push_back(x.wi * (1 / size));
                above_count += x.wi.z > 0;
            }
        }
    }
    d.draws = n;
    d.directions = w.size();
    const double total = static_cast<double>(n);
    d.above_share = share_interval(above_count, total);
    d.below_share = share_interval(static_cast<double>(w.size()) - above_count, total);
    d.delta_share = share_interval(delta_count, total);
    d.empty_share = share_interval(empty_count, total);
    if (w.size() < 64) return d;
    describe_moments(w, d);
    describe_support(w, d);
    describe_map(w, d);
    return d;
}

}  // namespace

std::vector<Description> describe(
    std::span<const CheckCase> check_cases, const DescribeSettings& settings, ProgressMonitor& monitor) {
    std::vector<std::pair<std::size_t, int>> jobs;
    for (std::size_t i = 0; i < check_cases.size(); ++i)
        for (int t = 0; !check_cases[i].baseline && t < check_cases[i].adapter->techniques(); ++t)
            jobs.emplace_back(i, t);
    monitor.begin("describe", static_cast<double>(jobs.size()));
    std::vector<Description> out(jobs.size());
    const auto run = [&](std::size_t j) {
        monitor.check();
        const auto& [check_case, technique] = jobs[j];
        out[j] = describe_one(check_cases[check_case], technique, settings, static_cast<std::uint16_t>(check_case));
        monitor.advance(1);
    };
    const bool is_serial = std::ranges::any_of(check_cases, [](const CheckCase& t) { return t.adapter->serial(); });
    for_each_index(is_serial, jobs.size(), run);
    return out;
}

namespace {

std::string interval_text(const Interval& i, double scale = 1, const char* unit = "") {
    return fmt::format("{:.4g}{} ({:.4g} to {:.4g})", scale * i.value, unit, scale * i.low, scale * i.high);
}

/// The density as characters, with theta downwards and phi to the right.
std::string map_text(const Description& d) {
    constexpr std::string_view shades = " .:-=+*#%@";
    const auto sectors = static_cast<std::size_t>(d.sectors);
    std::vector<double> density;
    for (std::size_t i = 0; i < d.map.size(); ++i) {
        const std::size_t ring = i / sectors;
        const double band = math::cos(d.theta_edges[ring]) - math::cos(d.theta_edges[ring + 1]);
        density.push_back(d.map[i].value / (band * two_pi / d.sectors));
    }
    const double top = std::max(*std::ranges::max_element(density), 1e-300);
    std::string out = fmt::format("  map, by density: \"{}\" from 0 to {:.4g} 1/sr\n", shades, top);
    const std::string_view label = "phi:", columns = "0           90          180         270         360";
    out += fmt::format("  {:>11} {}\n", label, columns);
    for (std::size_t ring = 0; ring + 1 < d.theta_edges.size(); ++ring) {
        out += fmt::format(
            "  {:>4.0f} to {:>3.0f} ", d.theta_edges[ring] * 360 / two_pi, d.theta_edges[ring + 1] * 360 / two_pi);
        for (std::size_t k = 0; k < sectors; ++k) {
            const double v = density[ring * sectors + k] / top;
            const std::size_t shade = v > 0 ? 1 + std::min<std::size_t>(static_cast<std::size_t>(v * 9), 8) : 0;
            out += std::string(2, shades[shade]);
        }
        out += '\n';
    }
    return out;
}

}  // namespace

std::string description_text(const Description& d) {
    constexpr double degrees = 360 / two_pi;
    std::string out = d.arm + ", " + d.check_case;
    if (d.techniques > 1) out += fmt::format(", technique {} of {}", d.technique + 1, d.techniques);
    out += fmt::format(": {} draws, 95 % intervals in parentheses\n", d.draws);
    out += "  above the horizon    " + interval_text(d.above_share, 100, " %") + "\n";
    out += "  below the horizon    " + interval_text(d.below_share, 100, " %") + "\n";
    if (d.delta_share.value > 0) out += "  delta parts          " + interval_text(d.delta_share, 100, " %") + "\n";
    if (d.empty_share.value > 0) out += "  nothing (pdf 0)      " + interval_text(d.empty_share, 100, " %") + "\n";
    if (d.invalid > 0) out += fmt::format("  no direction (NaN)   {} draws\n", d.invalid);
    if (d.map.empty()) return out + "  too few directions for more\n";
    out += fmt::format("  mean direction       theta {:.4g} deg, phi {:.4g} deg, within {:.2g} deg\n",
        d.theta * degrees, d.phi * degrees, d.direction_error * degrees);
    out += fmt::format("  mean vector          x {}, y {}, z {}\n", interval_text(d.mean[0]), interval_text(d.mean[1]),
        interval_text(d.mean[2]));
    out += "    its length         " + interval_text(d.length) + "\n";
    out += "  angle to the mean    50 % within " + interval_text(d.angles[0], degrees, " deg") + "\n";
    out += "                       90 % within " + interval_text(d.angles[1], degrees, " deg") + "\n";
    out += "                       99 % within " + interval_text(d.angles[2], degrees, " deg") + "\n";
    out += "  second moments       ";
    const char* names[] = {"xx", "yy", "zz", "xy", "xz", "yz"};
    for (std::size_t k = 0; k < 6; ++k)
        out += fmt::format("{}{} {:.4f} +- {:.4f}",
            k == 0       ? ""
                : k == 3 ? "\n                       "
                         : ", ",
            names[k], d.second_moments[k].value, (d.second_moments[k].high - d.second_moments[k].low) / 2);
    out += "\n  effective support    95 % of the draws in " + interval_text(d.solid_angle, 1, " sr") + "\n";
    out += "                       1 / integral of p^2: " + interval_text(d.effective_solid_angle, 1, " sr") + "\n";
    return out + map_text(d);
}

nlohmann::ordered_json description_json(std::span<const Description> descriptions) {
    using Json = nlohmann::ordered_json;
    constexpr double degrees = 360 / two_pi;
    const auto json_of = [](const Interval& i, double scale = 1) {
        return Json{{"value", scale * i.value}, {"low", scale * i.low}, {"high", scale * i.high}};
    };
    Json out = Json::array();
    for (const Description& d : descriptions) {
        Json j = {{"arm", d.arm}, {"case", d.check_case}, {"technique", d.technique + 1}, {"draws", d.draws},
            {"invalid", d.invalid}, {"share_above", json_of(d.above_share)}, {"share_below", json_of(d.below_share)},
            {"share_of_delta_parts", json_of(d.delta_share)}, {"share_of_nothing", json_of(d.empty_share)}};
        if (!d.map.empty()) {
            j["mean"] = {json_of(d.mean[0]), json_of(d.mean[1]), json_of(d.mean[2])};
            j["length_of_mean"] = json_of(d.length);
            j["mean_direction"] = {{"theta_deg", d.theta * degrees}, {"phi_deg", d.phi * degrees},
                {"within_deg", d.direction_error * degrees}};
            j["angle_to_mean_deg"] = {{"50", json_of(d.angles[0], degrees)}, {"90", json_of(d.angles[1], degrees)},
                {"99", json_of(d.angles[2], degrees)}};
            const char* names[] = {"xx", "yy", "zz", "xy", "xz", "yz"};
            for (std::size_t k = 0; k < 6; ++k) j["second_moments"][names[k]] = json_of(d.second_moments[k]);
            j["solid_angle_of_95_percent_sr"] = json_of(d.solid_angle);
            j["effective_solid_angle_sr"] = json_of(d.effective_solid_angle);
            Json edges = Json::array(), rows = Json::array();
            for (double e : d.theta_edges) edges.push_back(e * degrees);
            for (const Interval& i : d.map) rows.push_back({i.value, i.low, i.high});
            j["map"] = {{"theta_edges_deg", edges}, {"sectors", d.sectors}, {"columns", {"share", "low", "high"}},
                {"rows", rows}};
        }
        out.push_back(std::move(j));
    }
    return out;
}

}  // namespace crescent::check
