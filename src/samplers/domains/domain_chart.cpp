// Maps with a constant Jacobian, but for infinite lines, whose charts have the quantiles of pilot draws as knots, with
// gaps beyond them that grow as the last ones do.
#include "samplers/domains/domain_chart.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <fmt/format.h>

#include "base/vec.h"
#include "math/functions.h"

namespace crescent {

namespace {

using Kind = DomainPart::Kind;
constexpr double two_pi = check::two_pi;
constexpr double below_one = 1 - 0x1p-53;

/// Cells of a set in [0, 1): a power of two, so that no cut of a tree divides an entry before all are apart.
double cells_of(const DomainPart& set) { return std::bit_ceil(set.count); }

double azimuth_of(double x, double y) {
    const double phi = math::atan2(y, x);
    return (phi < 0 ? phi + two_pi : phi) / two_pi;
}

/// Bits that a cube of three or four dimensions and the square of polar and azimuthal coordinates exchange: nearly all
/// of the 53 of each coordinate of the square, and a multiple of two, three and four.
int exchanged_bits(std::size_t dimensions) { return dimensions == 3 ? 102 : 104; }

/// Deals so many bits of `from` to `to` in turn, the first bits first.
void deal(std::span<const double> from, std::span<double> to, int bits) {
    const int bits_from = bits / static_cast<int>(from.size()), bits_to = bits / static_cast<int>(to.size());
    std::array<std::uint64_t, Domain::most_dimensions> in{}, out{};
    for (std::size_t k = 0; k < from.size(); ++k)
        in[k] = static_cast<std::uint64_t>(std::clamp(from[k], 0.0, below_one) * std::ldexp(1.0, bits_from));
    for (int n = 0; n < bits; ++n) {
        const auto source = static_cast<std::size_t>(n) % from.size(), target = static_cast<std::size_t>(n) % to.size();
        const int bit = bits_from - 1 - n / static_cast<int>(from.size());
        out[target] = out[target] << 1 | (in[source] >> bit & 1);
    }
    for (std::size_t k = 0; k < to.size(); ++k) to[k] = (static_cast<double>(out[k]) + 0.5) * std::ldexp(1.0, -bits_to);
}

}  // namespace

// ---- Infinite lines.

namespace {

constexpr int body = 32;          // quantiles in equal steps
constexpr int last_halving = 40;  // of the mass of a tail
constexpr std::size_t fewest_in_tail = 16, fewest_values = 256;

/// Quantiles of one tail, beginning at the median: levels k / 32, then 1 - 2^-j. `values` increase away from the
/// median.
struct Tail {
    std::vector<double> level, x;

    explicit Tail(std::span<const double> values) {
        const auto n = static_cast<double>(values.size());
        const auto quantile = [&](double tail_mass) {  // the value beyond which this mass lies
            const double rank = std::clamp(n * (1 - tail_mass) - 0.5, 0.0, n - 1), lower_rank = std::floor(rank);
            const auto i = static_cast<std::size_t>(lower_rank);
            return values[i] + (rank - lower_rank) * (values[std::min(i + 1, values.size() - 1)] - values[i]);
        };
        for (int k = body / 2; k < body; ++k) add(k / static_cast<double>(body), quantile(1 - k / (body + 0.0)));
        int j = 6;
        for (; j <= last_halving && n * std::ldexp(1.0, -j) >= fewest_in_tail; ++j)
            add(1 - std::ldexp(1.0, -j), quantile(std::ldexp(1.0, -j)));
        constexpr int halvings = 3;
        const double last = quantile(std::ldexp(1.0, -(j - 1))) - quantile(std::ldexp(1.0, -(j - 2)));
        const double previous =
            quantile(std::ldexp(1.0, -(j - 1 - halvings))) - quantile(std::ldexp(1.0, -(j - 2 - halvings)));
        // Twice for each halving of the mass at least, as of a density of 1 / x^2: a light tail may hide a wide
        // component of the density that few pilot draws are of.
        const double growth = previous > 0 ? std::clamp(math::pow(last / previous, 1.0 / 3), 2.0, 16.0) : 2;
        double gap = std::max(last, 1e-12 * std::max(std::fabs(x.back()), 1e-300));
        for (; j <= last_halving + 1; ++j) {
            gap *= growth;
            add(j > last_halving ? 1 : 1 - std::ldexp(1.0, -j), x.back() + gap);
        }
    }
    /// Levels with equal quantiles, as of atoms, are kept apart.
    void add(double y, double value) {
        if (!x.empty()) value = std::max(value, x.back() + 1e-12 * std::max(std::fabs(x.back()), 1e-300));
        level.push_back(y);
        x.push_back(value);
    }
};

}  // namespace

DomainChart::Knots DomainChart::Knots::fitted(std::vector<double> values, double from, double to) {
    std::ranges::sort(values);
    if (values.size() < fewest_values) {  // no draws to go by: of scale 1
        const double origin = std::isfinite(from) ? from : std::isfinite(to) ? to : 0;
        values.clear();
        for (std::size_t i = 0; i < fewest_values; ++i) {
            const double u = (static_cast<double>(i) + 0.5) / fewest_values, e = -math::log(1 - u);
            values.push_back(std::isfinite(from) ? origin + e
                    : std::isfinite(to)          ? origin - e
                                                 : math::log(u / (1 - u)));
        }
        std::ranges::sort(values);
    }
    Knots out;
    const auto n = values.size();
    if (std::isfinite(from)) {
        out.y.push_back(0);
        out.x.push_back(from);
        for (int k = 1; k < body / 2; ++k) {
            out.y.push_back(k / static_cast<double>(body));
            out.x.push_back(values[n * static_cast<std::size_t>(k) / body]);
        }
    } else {
        std::vector<double> mirrored;
        for (double v : values) mirrored.push_back(-v);
        std::ranges::sort(mirrored);
        const Tail tail(mirrored);
        for (std::size_t k = tail.x.size(); k-- > 1;) {
            out.y.push_back(1 - tail.level[k]);
            out.x.push_back(-tail.x[k]);
        }
    }
    if (std::isfinite(to)) {
        for (int k = body / 2; k < body; ++k) {
            out.y.push_back(k / static_cast<double>(body));
            out.x.push_back(values[n * static_cast<std::size_t>(k) / body]);
        }
        out.y.push_back(1);
        out.x.push_back(to);
    } else {
        const Tail tail(values);
        out.y.insert(out.y.end(), tail.level.begin(), tail.level.end());
        out.x.insert(out.x.end(), tail.x.begin(), tail.x.end());
    }
    for (std::size_t k = 1; k < out.x.size(); ++k) {
        const double minimum = out.x[k - 1] + 1e-13 * std::max(std::fabs(out.x[k - 1]), 1e-300);
        if (!(out.x[k] > minimum)) out.x[k] = std::max(minimum, std::nextafter(out.x[k - 1], 1e308));
    }
    return out;
}

double DomainChart::Knots::to_unit(double value) const {
    if (!(value > x.front())) return 0;
    if (!(value < x.back())) return below_one;
    const auto k = static_cast<std::size_t>(std::ranges::upper_bound(x, value) - x.begin());
    return y[k - 1] + (y[k] - y[k - 1]) * ((value - x[k - 1]) / (x[k] - x[k - 1]));
}

double DomainChart::Knots::from_unit(double unit, double& value) const {
    const auto next_knot = static_cast<std::size_t>(std::ranges::upper_bound(y, unit) - y.begin());
    const std::size_t k = std::clamp<std::size_t>(next_knot, 1, y.size() - 1);
    const double slope = (x[k] - x[k - 1]) / (y[k] - y[k - 1]);
    value = x[k - 1] + (unit - y[k - 1]) * slope;
    return slope;
}

// ---- Parts and the unit cube.

DomainChart::DomainChart(Domain domain) : domain_(std::move(domain)) { fit({}); }

std::size_t DomainChart::spreads() const {
    std::size_t out = is_line();
    for (const DomainPart& part : domain_.parts()) out += part.kind == Kind::set;
    return out;
}

void DomainChart::fit(std::span<const double> rows) {
    const std::size_t columns = domain_.coordinates();
    knots_.assign(domain_.parts().size(), {});
    std::size_t column = 0;
    for (std::size_t k = 0; k < knots_.size(); ++k) {
        const DomainPart& part = domain_.parts()[k];
        if (part.is_infinite()) {
            std::vector<double> values;
            for (std::size_t i = column; i < rows.size(); i += columns)
                if (part.fault(rows.subspan(i, 1)).empty()) values.push_back(rows[i]);
            knots_[k] = Knots::fitted(std::move(values), part.from, part.to);
        }
        column += part.coordinates();
    }
}

void DomainChart::to_cube(std::span<const double> point, std::span<const double> spread, std::span<double> y) const {
    std::size_t c = 0, d = 0, s = 0;
    for (std::size_t k = 0; k < knots_.size(); ++k) {
        const DomainPart& part = domain_.parts()[k];
        const std::span<const double> x = point.subspan(c, part.coordinates());
        switch (part.kind) {
            case Kind::hemisphere:
            case Kind::sphere: {
                const check::ChartPoint place = check::to_chart({x[0], x[1], x[2]});
                y[d] = part.kind == Kind::sphere ? place.t / 2 : place.t;
                y[d + 1] = place.phi / two_pi;
                break;
            }
            case Kind::disk:
                y[d] = x[0] * x[0] + x[1] * x[1];
                y[d + 1] = azimuth_of(x[0], x[1]);
                break;
            case Kind::triangle: {  // Turk 1990, "Generating random points in triangles"
                const double remainder = 1 - x[0];
                y[d] = remainder * remainder;
                y[d + 1] = remainder > 0 ? x[1] / remainder : 0;
                break;
            }
            case Kind::line:
                y[d] = part.is_infinite() ? knots_[k].to_unit(x[0]) : (x[0] - part.from) / (part.to - part.from);
                break;
            case Kind::set: y[d] = (x[0] + spread[s++]) / cells_of(part); break;
            default:
                for (std::size_t i = 0; i < x.size(); ++i) y[d + i] = x[i];
        }
        c += part.coordinates();
        d += part.dimensions();
    }
    for (double& v : y) v = std::clamp(v, 0.0, below_one);
}

double DomainChart::from_cube(std::span<const double> y, std::span<double> point) const {
    std::size_t c = 0, d = 0;
    double measure = 1;  // of the domain per unit of the cube
    for (std::size_t k = 0; k < knots_.size(); ++k) {
        const DomainPart& part = domain_.parts()[k];
        const std::span<double> x = point.subspan(c, part.coordinates());
        switch (part.kind) {
            case Kind::hemisphere:
            case Kind::sphere: {
                const double height = part.kind == Kind::sphere ? 2 : 1;
                const Vec3d w = check::from_chart({height * y[d], two_pi * y[d + 1]});
                x[0] = w.x;
                x[1] = w.y;
                x[2] = w.z;
                measure *= height * two_pi;
                break;
            }
            case Kind::disk: {
                const double r = std::sqrt(y[d]);
                const math::SinCos azimuth = math::sincos(two_pi * y[d + 1]);
                x[0] = r * azimuth.cos;
                x[1] = r * azimuth.sin;
                measure *= two_pi / 2;
                break;
            }
            case Kind::triangle: {
                const double remainder = std::sqrt(y[d]);
                x[0] = 1 - remainder;
                x[1] = remainder * y[d + 1];
                measure *= 0.5;
                break;
            }
            case Kind::line:
                if (part.is_infinite()) {
                    measure *= knots_[k].from_unit(y[d], x[0]);
                } else {
                    x[0] = part.from + (part.to - part.from) * y[d];
                    measure *= part.to - part.from;
                }
                break;
            case Kind::set:
                x[0] = std::floor(y[d] * cells_of(part));
                measure *= x[0] < part.count ? cells_of(part) : 0;
                break;
            default:
                for (std::size_t i = 0; i < x.size(); ++i) x[i] = y[d + i];
        }
        c += part.coordinates();
        d += part.dimensions();
    }
    return measure;
}

// ---- The cube and the sphere.

Vec3d DomainChart::from_cube_to_direction(std::span<const double> y, double azimuth) const {
    std::array<double, 2> square = {y[0], y.size() == 1 ? azimuth : y[1]};
    if (y.size() > 2) deal(y, square, exchanged_bits(y.size()));
    return check::from_chart({2 * square[0], two_pi * square[1]});
}

DomainChart::Cube DomainChart::cube_of(Vec3d w) const {
    const check::ChartPoint place = check::to_chart(w);
    const std::array<double, 2> square = {
        std::clamp(place.t / 2, 0.0, below_one), std::clamp(place.phi / two_pi, 0.0, below_one)};
    Cube y = {square[0], square[1]};
    const std::size_t dimensions = domain_.dimensions();
    if (dimensions > 2) deal(square, std::span(y).first(dimensions), exchanged_bits(dimensions));
    return y;
}

Vec3d DomainChart::direction(std::span<const double> point, std::span<const double> spread) const {
    Cube cube{};
    const std::span<double> y = std::span(cube).first(domain_.dimensions());
    to_cube(point, spread, y);
    return from_cube_to_direction(y, is_line() ? spread.back() : 0);
}

double DomainChart::point(Vec3d w, std::span<double> out) const { return from_cube(cube_of(w), out) / (2 * two_pi); }

double DomainChart::density(Vec3d w, double per_sr) const {
    std::array<double, Domain::most_coordinates> x{};
    const double factor = point(w, std::span(x).first(domain_.coordinates()));
    return factor > 0 ? per_sr / factor : per_sr;
}

bool DomainChart::is_discrete() const {
    return std::ranges::all_of(domain_.parts(), [](const DomainPart& part) { return part.kind == Kind::set; });
}

bool DomainChart::has_set() const {
    return std::ranges::any_of(domain_.parts(), [](const DomainPart& part) { return part.kind == Kind::set; });
}

bool DomainChart::has_point(Vec3d w) const {
    const bool everywhere = std::ranges::all_of(
        domain_.parts(), [](const DomainPart& part) { return part.kind != Kind::set || cells_of(part) == part.count; });
    std::array<double, Domain::most_coordinates> x{};
    return everywhere || point(w, std::span(x).first(domain_.coordinates())) > 0;
}

Vec3d DomainChart::in_chart(const DomainChart& other, Vec3d w) const {
    Cube y = cube_of(w);
    std::size_t d = 0;
    for (std::size_t k = 0; k < knots_.size(); ++k) {
        const DomainPart& part = domain_.parts()[k];
        double x = 0;
        if (part.is_infinite()) {
            knots_[k].from_unit(y[d], x);
            y[d] = std::clamp(other.knots_[k].to_unit(x), 0.0, below_one);
        }
        d += part.dimensions();
    }
    return other.from_cube_to_direction(std::span(y).first(d), check::to_chart(w).phi / two_pi);
}

Vec3d DomainChart::shifted(Vec3d w, std::size_t axis, double distance) const {
    Cube cube = cube_of(w);
    const std::span<double> y = std::span(cube).first(domain_.dimensions());
    for (std::size_t d = axis; d < y.size(); d += 2) y[d] = 1 - std::fabs(1 - y[d] - distance);
    return from_cube_to_direction(y, check::to_chart(w).phi / two_pi);
}

// ---- Words.

void DomainChart::note_outside(std::span<const double> point) const {
    const Guard one_at_a_time(outside_point_->lock);
    if (outside_point_->first.empty())
        outside_point_->first = fmt::format("{}, which {}", domain_.text(point), domain_.fault(point));
}

std::string DomainChart::first_outside() const {
    const Guard one_at_a_time(outside_point_->lock);
    return outside_point_->first;
}

std::string DomainChart::text(Vec3d w) const {
    std::array<double, Domain::most_coordinates> x{};
    const std::span<double> coordinates = std::span(x).first(domain_.coordinates());
    point(w, coordinates);
    return domain_.text(coordinates);
}

namespace {

/// "x from 0.2 to 0.3"; "" if it is all of [0, 1].
std::string range(const char* what, double from, double to) {
    return fmt::format("{} from {:.3g} to {:.3g}", what, from, to);
}

/// Halvings after which a cut interval has this length.
int halvings(double length) { return static_cast<int>(std::lround(-math::log(length) / math::log(2.0))); }

}  // namespace

std::string DomainChart::text(const check::ChartRect& rect) const {
    const std::size_t dimensions = domain_.dimensions();
    Cube low = cube_of(check::from_chart(rect.at(0.5, 0.5))), high = low;
    if (dimensions > 2) {
        // Of the bits of a dimension those above the first that is not cut are the same over the box.
        const int cut[] = {halvings((rect.t1 - rect.t0) / 2), halvings((rect.phi1 - rect.phi0) / two_pi)};
        for (std::size_t d = 0; d < dimensions; ++d) {
            int common_bits = 0;
            for (std::size_t n = d; static_cast<int>(n / 2) < cut[n % 2]; n += dimensions) ++common_bits;
            low[d] = std::ldexp(std::floor(std::ldexp(low[d], common_bits)), -common_bits);
            high[d] = low[d] + std::ldexp(1.0, -common_bits);
        }
    } else {
        low[0] = rect.t0 / 2;
        high[0] = rect.t1 / 2;
        if (dimensions == 2) {
            low[1] = rect.phi0 / two_pi;
            high[1] = rect.phi1 / two_pi;
        }
    }
    std::array<double, Domain::most_coordinates> from{}, to{};
    from_cube(low, from);
    from_cube(high, to);
    std::vector<std::string> ranges;
    std::size_t c = 0, d = 0;
    for (const DomainPart& part : domain_.parts()) {
        const auto cut = [&](std::size_t k) { return low[d + k] > 0 || high[d + k] < 1; };
        const auto add = [&](std::size_t k, std::string words) {
            if (cut(k)) ranges.push_back(std::move(words));
        };
        switch (part.kind) {
            case Kind::hemisphere:
            case Kind::sphere:
                add(0, range("cos theta", from[c + 2], to[c + 2]));
                add(1, range("phi", 360 * low[d + 1], 360 * high[d + 1]) + " deg");
                break;
            case Kind::disk:
                add(0, range("radius", std::sqrt(low[d]), std::sqrt(high[d])));
                add(1, range("angle", 360 * low[d + 1], 360 * high[d + 1]) + " deg");
                break;
            case Kind::triangle:
                add(0, range("b0", 1 - std::sqrt(high[d]), 1 - std::sqrt(low[d])));
                add(1, range("b1 / (1 - b0)", low[d + 1], high[d + 1]));
                break;
            case Kind::line: add(0, range("x", from[c], to[c])); break;
            case Kind::set: {
                const double last = std::min(std::ceil(high[d] * cells_of(part)) - 1, part.count - 1.0);
                add(0,
                    last > from[c] ? fmt::format("entries {:.0f} to {:.0f}", from[c], last)
                                   : fmt::format("entry {:.0f}", from[c]));
                break;
            }
            default:
                for (std::size_t k = 0; k < part.dimensions(); ++k)
                    add(k, range(std::array{"x", "y", "z"}[k], from[c + k], to[c + k]));
        }
        c += part.coordinates();
        d += part.dimensions();
    }
    return ranges.empty() ? "everywhere" : fmt::format("at {}", fmt::join(ranges, ", "));
}

double DomainChart::value_at(double t) const {
    const DomainPart& part = domain_.parts()[0];
    if (part.kind == Kind::set) return std::min(t / 2 * cells_of(part), static_cast<double>(part.count));
    std::array<double, Domain::most_coordinates> x{};
    const double y = std::clamp(t / 2, 0.0, below_one);
    from_cube({&y, 1}, x);
    return x[0];
}

std::string DomainChart::axis(std::size_t dimension) const {
    for (const DomainPart& part : domain_.parts()) {
        if (dimension >= part.dimensions()) {
            dimension -= part.dimensions();
            continue;
        }
        switch (part.kind) {
            case Kind::sphere:
            case Kind::hemisphere: return dimension == 0 ? "cos theta" : "phi in degrees";
            case Kind::disk: return dimension == 0 ? "radius" : "angle in degrees";
            case Kind::triangle: return dimension == 0 ? "b0" : "b1 / (1 - b0)";
            case Kind::set: return "entry";
            default: return std::array{"x", "y", "z"}[dimension];
        }
    }
    return "";
}

std::string DomainChart::label(std::size_t dimension, double share) const {
    std::vector<double> y(domain_.dimensions(), 0.5);
    y[dimension] = std::min(share, below_one);
    std::array<double, Domain::most_coordinates> x{};
    from_cube(y, x);
    std::size_t c = 0, d = dimension;
    for (const DomainPart& part : domain_.parts()) {
        if (d >= part.dimensions()) {
            d -= part.dimensions();
            c += part.coordinates();
            continue;
        }
        const bool turns =
            d == 1 && (part.kind == Kind::disk || part.kind == Kind::sphere || part.kind == Kind::hemisphere);
        const double value = turns                                         ? 360 * share
            : part.kind == Kind::disk                                      ? std::sqrt(share)
            : part.kind == Kind::triangle                                  ? (d == 0 ? 1 - std::sqrt(share) : share)
            : part.coordinates() == 3 && d == 0 && part.kind != Kind::cube ? x[c + 2]
                                                                           : x[c + d];
        return fmt::format("{:.3g}", value);
    }
    return "";
}

std::optional<std::uint32_t> DomainChart::entry(const check::ChartRect& rect) const {
    const DomainPart& part = domain_.parts()[0];
    if (!is_line() || part.kind != Kind::set) return {};
    const double cells = cells_of(part) / 2, first = std::floor(rect.t0 * cells);
    if (std::ceil(rect.t1 * cells) > first + 1 || first >= part.count) return {};
    return static_cast<std::uint32_t>(first);
}

}  // namespace crescent
