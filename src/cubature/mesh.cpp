// Lines at which p jumps are taken for a table's where all are multiples of 1/N, in cos theta, theta or cos^2 theta,
// and in azimuth. Each cell is then asked at two points; where they tell one value the sum is exact, and the rest goes
// to the cubature.
#include "cubature/mesh.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "math/functions.h"
#include "simd/random.h"
#include "simd/scalar.h"

namespace crescent::inline cubature {

namespace {

constexpr int most_lines = 8192;  // of one kind

/// The least N such that every position is a multiple of 1/N; 0: none.
int spacing(const std::vector<double>& positions) {
    if (positions.size() < 2) return positions.empty() ? 1 : 0;
    for (int n = 1; n <= most_lines; ++n) {
        bool fits = true;
        for (std::size_t i = 0; i < positions.size() && fits; ++i)
            fits = std::fabs(positions[i] * n - std::round(positions[i] * n)) < 2e-5;
        if (fits) return n;
    }
    return 0;
}

double theta_of(double a) { return 2 * math::asin(std::sqrt(std::clamp(a / 2, 0.0, 1.0))); }

/// Heights: in cos theta, or else in theta, or in cos^2 theta on either side.
std::vector<double> rows_of(const std::vector<double>& a) {
    std::vector<double> cos, theta, cos2, out;
    for (double v : a) cos.push_back(1 - v), theta.push_back(theta_of(v) / pi), cos2.push_back(sqr(1 - v));
    const int n = spacing(cos), m = spacing(theta), k = n == 0 && m == 0 ? spacing(cos2) : 0;
    if (n > 0 && (m == 0 || n <= m))
        for (int i = 0; i <= 2 * n; ++i) out.push_back(static_cast<double>(i) / n);
    else if (m > 0)
        for (int i = 0; i <= m; ++i) out.push_back(2 * sqr(math::sin(0.5 * pi * i / m)));
    else if (k > 0)
        for (int i = -k; i <= k; ++i)
            out.push_back(1 + std::copysign(std::sqrt(std::abs(i) / static_cast<double>(k)), i));
    return out;
}

/// Azimuths, from 0 to 1: even, from anywhere on. None where they are not.
std::vector<double> columns_of(const std::vector<double>& b) {
    if (b.empty()) return {};
    std::vector<double> from_first;
    for (double v : b) from_first.push_back(v - b[0]);
    std::vector<double> places = b;
    std::sort(places.begin(), places.end());
    places.erase(
        std::unique(places.begin(), places.end(), [](double x, double y) { return y - x < 1e-7; }), places.end());
    // Two places alone are the multiples of something, wherever they lie.
    const int even = spacing(b), turned = even == 0 && places.size() > 3 ? spacing(from_first) : 0,
              columns = even + turned;
    if (columns < 2) return {};
    const double first = turned > 0 ? b[0] - std::floor(b[0] * columns) / columns : 0;
    std::vector<double> out = {0};
    for (int k = 0; k < columns; ++k)
        if (const double edge = first + static_cast<double>(k) / columns; edge > 0) out.push_back(edge);
    out.push_back(1);
    return out;
}

/// What a cell holds: g alike all over, or g sin theta, or g / |cos theta|.
enum class Kind { plain, times_sin, over_cos };
struct Held {
    double per_turn = -1;  // its integral; -1 where it holds none of them
    Kind kind = Kind::plain;
};

/// Of a cell with values v and w of g at heights x and y. g sin theta, as texels in theta x phi have it, is alike to
/// what single precision knows, and near the poles to what directions of `resolution` tell of theta; g / |cos theta|,
/// as tables by projected solid angle have it, likewise at the horizon.
Held held_by(double v, double w, double a0, double a1, double x, double y, double resolution) {
    if (std::fabs(v - w) <= 1e-9 * std::fabs(v)) return {(a1 - a0) * v, Kind::plain};
    const double up = std::min(std::fabs(1 - x), std::fabs(1 - y)), by_x = v / std::fabs(1 - x),
                 by_y = w / std::fabs(1 - y);
    if (up > 0 && (1 - a0) * (1 - a1) >= 0 && std::fabs(by_x - by_y) <= (2e-6 + 2 * resolution / up) * by_x)
        return {0.5 * std::fabs(sqr(1 - a0) - sqr(1 - a1)) * by_x, Kind::over_cos};
    const double one = v * std::sqrt(x * (2 - x)), two = w * std::sqrt(y * (2 - y));
    const double to_pole = std::min({x, 2 - x, y, 2 - y});
    if (!(std::fabs(one - two) <= (2e-6 + 2 * resolution / to_pole) * std::fabs(one))) return {};
    const double value = x * (2 - x) > y * (2 - y) ? one : two;
    return {(theta_of(a1) - theta_of(a0)) * value, Kind::times_sin};
}

/// ln p and ln (p sin theta) of cells, weighed by their masses.
struct LogSums {
    struct Sum {
        double ln = 0, squares = 0;
        void add(double weight, double value) { ln += weight * value, squares += weight * value * value; }
    };
    double mass = 0, by_kind[3] = {0, 0, 0};
    Sum plain{}, times_sin{};

    /// A cell with this g at height x.
    void add(Kind kind, double cell_mass, double g, double x) {
        if (!(cell_mass > 0)) return;
        const double ln = math::log(g / (2 * pi));
        mass += cell_mass;
        by_kind[static_cast<int>(kind)] += cell_mass;
        plain.add(cell_mass, ln);
        times_sin.add(cell_mass, ln + 0.5 * math::log(x * (2 - x)));
    }

    /// None where cells hold unlike things, but for a few: where sin theta or cos theta is 1 to the last digits, one
    /// passes for another.
    std::optional<LogHeights> heights() const {
        constexpr double few = 1e-3;
        const bool sin = by_kind[static_cast<int>(Kind::times_sin)] > by_kind[static_cast<int>(Kind::plain)];
        if (!(mass > 0) || mass - by_kind[static_cast<int>(sin ? Kind::times_sin : Kind::plain)] > few * mass)
            return {};
        const Sum& of = sin ? times_sin : plain;
        const double mean = of.ln / mass;
        return LogHeights{sin, mean, std::max(of.squares / mass - mean * mean, 0.0)};
    }
};

std::vector<double> merged(std::vector<double> edges, std::span<const double> more) {
    edges.insert(edges.end(), more.begin(), more.end());
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end(), [](double x, double y) { return y - x < 1e-13; }), edges.end());
    return edges;
}

}  // namespace

std::optional<Mesh> find_mesh(const Batch& g) { return mesh_of(find_jumps(g)); }

std::optional<Mesh> mesh_of(const Jumps& jumps) {
    if (jumps.a.size() + jumps.b.size() < 4) return {};
    Mesh mesh{rows_of(jumps.a), columns_of(jumps.b)};
    if (mesh.a.empty() || mesh.b.empty()) return {};  // what jumps at heights alone needs no mesh
    return mesh;
}

namespace {

/// A mesh cut at the bins' edges too, of which one row after the other is summed.
struct MeshSum {
    std::vector<double> a, b;
    std::span<const double> rings;
    int sectors;
    double resolution;
    Integral out{};
    std::vector<Rect> rest{};  // cells with two unequal values
    LogSums logs{};

    int bin_of(double x, double y) const {
        const auto ring = std::upper_bound(rings.begin(), rings.end() - 1, x) - rings.begin() - 1;
        return static_cast<int>(ring) * sectors + std::min(static_cast<int>(y * sectors), sectors - 1);
    }

    /// Asks each cell of row i at its centre and at a point at random.
    void add_row(std::size_t i, const Batch& g) {
        std::vector<Vec2d> where(2 * (b.size() - 1));
        std::vector<double> v(where.size());
        for (std::size_t k = 0; k + 1 < b.size(); ++k) {
            const auto h =
                pcg4d<std::uint32_t>({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(k), 0x3e58u, 1});
            const double x = (h.x + 0.5) * 0x1p-32, y = (h.y + 0.5) * 0x1p-32;
            where[2 * k] = {0.5 * (a[i] + a[i + 1]), 0.5 * (b[k] + b[k + 1])};
            where[2 * k + 1] = {a[i] + x * (a[i + 1] - a[i]), b[k] + y * (b[k + 1] - b[k])};
        }
        g(where, v);
        out.evaluations += where.size();
        for (std::size_t k = 0; k + 1 < b.size(); ++k) {
            const int bin = bin_of(where[2 * k].x, where[2 * k].y);
            const Held cell =
                held_by(v[2 * k], v[2 * k + 1], a[i], a[i + 1], where[2 * k].x, where[2 * k + 1].x, resolution);
            if (!(cell.per_turn >= 0)) {
                rest.push_back({a[i], a[i + 1], b[k], b[k + 1], bin});
                continue;
            }
            const double mass = (b[k + 1] - b[k]) * cell.per_turn;
            out.bins[static_cast<std::size_t>(bin)] += mass;
            logs.add(cell.kind, mass, v[2 * k], where[2 * k].x);
        }
    }
};

}  // namespace

std::optional<Integral> integrate_mesh(const Mesh& mesh, std::span<const double> rings, int sectors, const Batch& g,
    const Effort& effort, double resolution, const Prepare& prepare, const SamplesPerBin* samples) {
    std::vector<double> sides;
    for (int k = 1; k < sectors; ++k) sides.push_back(static_cast<double>(k) / sectors);
    MeshSum sum{merged(mesh.a, rings), merged(mesh.b, sides), rings, sectors, resolution};
    Integral& out = sum.out;
    out.bins.assign((rings.size() - 1) * static_cast<std::size_t>(sectors), 0.0);
    out.bin_errors = out.bins;
    for (std::size_t i = 0; i + 1 < sum.a.size(); ++i) {
        sum.add_row(i, g);
        if (17 * sum.rest.size() > effort.most_evaluations) return {};
    }
    for (double m : out.bins) out.value += m;
    out.second = out.value;
    if (sum.rest.empty()) {
        out.heights = sum.logs.heights();
        return out;
    }
    if (prepare) sum.rest = prepare(std::move(sum.rest));
    const Integral other = integrate(std::move(sum.rest), static_cast<int>(out.bins.size()), g, effort, samples);
    for (std::size_t i = 0; i < out.bins.size(); ++i)
        out.bins[i] += other.bins[i], out.bin_errors[i] += other.bin_errors[i];
    out.value += other.value;
    out.error = other.error;
    out.second += other.second;
    out.second_se = other.second_se;
    out.settled = other.settled;
    out.evaluations += other.evaluations;
    return out;
}

}  // namespace crescent::inline cubature
