// Skies as renderers keep them: texels of the equal-area octahedral map (Clarberg 2008, "Fast Equal-Area Mapping of the
// (Hemi)Sphere using SIMD", as pbrt-v4 has it) or of a cube's faces (Greene 1986, "Environment Mapping and Other
// Applications of World Projections"), or bilinear between points in theta x phi or cos theta x phi. Where p,
// per area of the square, is straight along pieces of lines whose ends are evenly spaced, it is bilinear in each texel,
// and its integral is the sum of what it is at their centres.
#include <algorithm>
#include <array>
#include <cmath>

#include "cubature/mesh.h"
#include "math/functions.h"
#include "math/spherical.h"
#include "simd/random.h"
#include "simd/scalar.h"

namespace crescent::inline cubature {

namespace {

constexpr int lines = 5;           // of either kind
constexpr int halvings = 12;       // the finest texels are a sixteenth of 2^-12 wide
constexpr double straight = 2e-6;  // relative, what single precision knows

Vec3d octahedral(Vec2d at) {
    const double u = 2 * at.x - 1, v = 2 * at.y - 1, a = std::fabs(u), b = std::fabs(v), d = 1 - (a + b);
    const double r = 1 - std::fabs(d), phi = (r == 0 ? 1 : (b - a) / r + 1) * pi / 4, k = r * std::sqrt(2 - r * r);
    const auto [sin, cos] = math::sincos(phi);
    return {std::copysign(cos, u) * k, std::copysign(sin, v) * k, std::copysign(1 - r * r, d)};
}
Vec3d by_theta(Vec2d at) { return math::spherical(math::cos(pi * at.y), 2 * pi * at.x); }
Vec3d by_height(Vec2d at) { return math::spherical(1 - 2 * at.y, 2 * pi * at.x); }
/// The six faces side by side along x, each [-1, 1]^2 at distance 1.
struct OnCube {
    int axis;
    double side, s, t;
};
OnCube on_cube(Vec2d at) {
    const double x = 6 * at.x;
    const int face = std::clamp(static_cast<int>(x), 0, 5);
    return {face / 2, face % 2 ? -1.0 : 1.0, 2 * (x - face) - 1, 2 * at.y - 1};
}
Vec3d by_cube(Vec2d at) {
    const OnCube c = on_cube(at);
    const Vec3d v = c.axis == 0 ? Vec3d{c.side, c.s, c.t}
        : c.axis == 1           ? Vec3d{c.t, c.side, c.s}
                                : Vec3d{c.s, c.t, c.side};
    return normalize(v);
}
double area_by_cube(Vec2d at) {
    const OnCube c = on_cube(at);
    const double far2 = 1 + c.s * c.s + c.t * c.t;
    return 24 / (far2 * std::sqrt(far2));
}
double even_area(Vec2d) { return 4 * pi; }
double area_by_theta(Vec2d at) { return 2 * pi * pi * math::sin(pi * at.y); }

/// p per area of the unit square, by one way of mapping it onto the sphere.
struct Square {
    Vec3d (*direction)(Vec2d);
    double (*area)(Vec2d);
    int turned;  // how often x, y, z are moved on by one
    const DirectionBatch& p;

    std::vector<double> at(std::span<const Vec2d> where) const {
        std::vector<Vec3d> w;
        for (Vec2d v : where) {
            w.push_back(direction(v));
            for (int k = 0; k < turned; ++k) w.back() = {w.back().z, w.back().x, w.back().y};
        }
        std::vector<double> out(w.size());
        p(w, out);
        for (std::size_t i = 0; i < out.size(); ++i) out[i] *= area(where[i]);
        return out;
    }
};

/// A piece of a line that is straight: [t - h, t + h].
struct Piece {
    bool along_x;
    double across, t, h, low = 0, high = 0;
    bool found = false;
    Vec2d at(double s) const { return along_x ? Vec2d{s, across} : Vec2d{across, s}; }
    bool holds(double s, double v) const {
        const double due = low + (high - low) * (s - (t - h)) / (2 * h);
        return std::fabs(v - due) <= straight * std::max({low, high, v});
    }
};

/// The longest straight pieces about a few points, of lengths that are halved from an eighth.
std::vector<Piece> straight_pieces(const Square& g) {
    std::vector<Piece> all;
    for (int kind = 0; kind < 2; ++kind)
        for (int i = 0; i < lines; ++i) {
            const auto r =
                pcg4d<std::uint32_t>({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(kind), 7, 1});
            all.push_back({kind == 0, 0.1 + 0.8 * (r.x * 0x1p-32), 0.2 + 0.6 * (r.y * 0x1p-32), 0x1p-3});
        }
    for (int k = 0; k <= halvings; ++k) {
        std::vector<Vec2d> where;
        for (Piece& x : all) {
            if (!x.found) x.h /= 2;
            for (double s : {-1.0, -0.5, 0.1, 0.6, 1.0}) where.push_back(x.at(x.t + s * x.h));
        }
        const std::vector<double> v = g.at(where);
        for (std::size_t i = 0; i < all.size(); ++i) {
            Piece& x = all[i];
            x.low = v[5 * i], x.high = v[5 * i + 4];
            x.found = x.holds(x.t - 0.5 * x.h, v[5 * i + 1]) && x.holds(x.t + 0.1 * x.h, v[5 * i + 2]) &&
                x.holds(x.t + 0.6 * x.h, v[5 * i + 3]);
        }
    }
    std::erase_if(all, [](const Piece& x) { return !x.found || !(x.h < 0x1p-4); });
    return all;
}

/// Where straight pieces end, by bisection between once and twice their length, on whichever side one does.
std::vector<double> ends_of(const Square& g, const std::vector<Piece>& all, bool along_x) {
    struct End {
        const Piece* of;
        double inside, outside;
    };
    std::vector<End> ends;
    std::vector<Vec2d> where;
    for (const Piece& x : all)
        if (x.along_x == along_x)
            for (double side : {-1.0, 1.0}) {
                ends.push_back({&x, x.t + side * x.h, x.t + 2 * side * x.h});
                where.push_back(x.at(ends.back().outside));
            }
    std::vector<double> v = g.at(where);
    std::vector<End> real;
    for (std::size_t i = 0; i < ends.size(); ++i)
        if (!ends[i].of->holds(ends[i].outside, v[i])) real.push_back(ends[i]);
    for (int k = 0; k < 30 && !real.empty(); ++k) {
        where.clear();
        for (const End& e : real) where.push_back(e.of->at(0.5 * (e.inside + e.outside)));
        v = g.at(where);
        for (std::size_t i = 0; i < real.size(); ++i) {
            const double mid = 0.5 * (real[i].inside + real[i].outside);
            (real[i].of->holds(mid, v[i]) ? real[i].inside : real[i].outside) = mid;
        }
    }
    std::vector<double> out;
    for (const End& e : real) out.push_back(0.5 * (e.inside + e.outside));
    return out;
}

/// The least N of which all are multiples of 1/N, but for what a weak kink hides; 0: none, or too few to tell.
int even_spacing(const std::vector<double>& positions) {
    constexpr int most = 8192;
    constexpr double hidden = 4e-3;  // of a texel
    if (positions.size() < 3) return 0;
    for (int n = 8; n <= most; ++n)
        if (std::ranges::all_of(positions, [n](double x) { return std::fabs(x * n - std::round(x * n)) < hidden; }))
            return n;
    return 0;
}

/// The sum over columns x rows texels of what g is at their centres. Four more points in some of them tell whether it
/// is straight there; what they differ by is the error. None where it is not.
std::optional<Integral> sum_of(const Square& g, int columns, int rows) {
    constexpr std::size_t looked_at = 4096;
    const double size = 1.0 / columns / rows;
    Integral out;
    double off = 0;
    std::size_t crooked = 0, tried = 0;
    const std::size_t stride = 1 + static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows) / looked_at;
    for (int k = 0; k < rows; ++k) {
        std::vector<Vec2d> centres, around;
        std::vector<std::size_t> of;
        for (int i = 0; i < columns; ++i) {
            centres.push_back({(i + 0.5) / columns, (k + 0.5) / rows});
            const std::size_t cell =
                static_cast<std::size_t>(k) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(i);
            if (cell % stride != 0) continue;
            const auto r = pcg4d<std::uint32_t>({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(k), 3, 9});
            const double x = (0.1 + 0.35 * (r.x * 0x1p-32)) / columns, y = (0.1 + 0.35 * (r.y * 0x1p-32)) / rows;
            const Vec2d c = centres.back();
            of.push_back(static_cast<std::size_t>(i));
            for (Vec2d v : {Vec2d{c.x - x, c.y}, {c.x + x, c.y}, {c.x, c.y - y}, {c.x, c.y + y}}) around.push_back(v);
        }
        const std::vector<double> v = g.at(centres), beside = g.at(around);
        for (double x : v) out.value += size * x;
        for (std::size_t i = 0; i < of.size(); ++i, ++tried) {
            const double one = 0.5 * (beside[4 * i] + beside[4 * i + 1]) - v[of[i]],
                         two = 0.5 * (beside[4 * i + 2] + beside[4 * i + 3]) - v[of[i]];
            off += size * (one + two) / 2;
            crooked += std::max(std::fabs(one), std::fabs(two)) > 1e-4 * v[of[i]];
        }
        out.evaluations += centres.size() + around.size();
    }
    if (tried == 0 || 50 * crooked > tried) return {};
    out.error = 2 * std::fabs(off) * static_cast<double>(columns) * rows / static_cast<double>(tried);
    out.second = out.value;
    return out;
}

}  // namespace

std::optional<Integral> integrate_texels(const DirectionBatch& p, std::size_t most) {
    for (int turned = 0; turned < 3; ++turned)
        for (const auto& [direction, area] : {std::pair(&octahedral, &even_area), {&by_theta, &area_by_theta},
                 {&by_height, &even_area}, {&by_cube, &area_by_cube}}) {
            if (turned > 0 && direction == &by_cube) continue;  // a cube's faces lie about every axis
            const Square g{direction, area, turned, p};
            const std::vector<Piece> pieces = straight_pieces(g);
            if (pieces.size() < lines) continue;
            const int columns = even_spacing(ends_of(g, pieces, true)), rows = even_spacing(ends_of(g, pieces, false));
            if (columns == 0 || rows == 0) continue;
            const std::size_t cells = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
            if (cells + 20000 > most) return {};
            std::optional<Integral> sum = sum_of(g, columns, rows);
            if (sum && sum->error < 1e-4) return sum;
        }
    return {};
}

}  // namespace crescent::inline cubature
