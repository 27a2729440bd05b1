// Tabulated densities: cells in cos theta x phi, texels of a map in theta x phi, and p bilinear between points.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "math/functions.h"
#include "math/simd/scalar.h"
#include "tests/known_samplers/correct/right.h"

namespace crescent {

namespace {

/// A discrete density over rows x columns, drawn by its sums: row by u.x, column by u.y, the remainders stretched for
/// reuse.
struct Table {
    int rows, columns;
    std::vector<double> mass;            // by row; sums to 1
    std::vector<double> row_sums, sums;  // running: of rows; within each row

    Table(int m, int n, std::vector<double> weights) : rows(m), columns(n), mass(std::move(weights)), row_sums{0} {
        double all = 0;
        for (double v : mass) all += v;
        for (double& v : mass) v /= all;
        for (int i = 0; i < rows; ++i) {
            sums.push_back(0);
            for (int j = 0; j < columns; ++j) sums.push_back(sums.back() + at(i, j));
            row_sums.push_back(row_sums.back() + sums.back());
        }
    }
    double at(int i, int j) const { return mass[static_cast<std::size_t>(i * columns + j)]; }
    struct Spot {
        int i, j;
        double x, y;  // within the cell, [0, 1)
    };
    static std::pair<int, double> find(const double* sum, int count, double u) {
        u *= sum[count];
        const int k = static_cast<int>(
            std::clamp<std::ptrdiff_t>(std::upper_bound(sum, sum + count + 1, u) - sum - 1, 0, count - 1));
        return {k, std::clamp((u - sum[k]) / (sum[k + 1] - sum[k]), 0.0, 1 - 0x1p-53)};
    }
    Spot draw(Vec2d u) const {
        const auto [i, x] = find(row_sums.data(), rows, u.x);
        const auto [j, y] = find(sums.data() + static_cast<std::size_t>(i * (columns + 1)), columns, u.y);
        return {i, j, x, y};
    }
};

Vec3d about_up(double cos, double turns) { return math::spherical(cos, 2 * pi * turns); }
int cell(double v, int count) { return std::clamp(static_cast<int>(v * count), 0, count - 1); }

/// Weights with a factor of `contrast` between cells, and sometimes a sun of a few cells.
std::vector<double> weights(Rng& d, int rows, int columns, double contrast, bool sun) {
    std::vector<double> out;
    for (int i = 0; i < rows * columns; ++i) out.push_back(d.log(1, contrast));
    if (sun) out[static_cast<std::size_t>(d.whole(0, rows * columns - 1))] *= rows * columns;
    return out;
}

/// p constant in cells of cos theta x phi, over the hemisphere or the sphere.
SyntheticSampler cells(Rng& d) {
    const int rows = d.whole(2, 32), columns = d.whole(3, 64);
    const double floor = d.whole(0, 1) ? 0 : -1;
    const bool sun = d.whole(0, 2) == 0;
    const auto t = std::make_shared<Table>(rows, columns, weights(d, rows, columns, d.log(1.5, 30), sun));
    SyntheticSampler r{"cells",
        fmt::format("{} x {}{}{}", rows, columns, floor < 0 ? ", sphere" : "", sun ? ", sun" : ""), {}, {}, {}};
    const double per_sr = rows * columns / (2 * pi * (1 - floor));
    r.pdf = [t, floor, per_sr](Vec3d, Vec3d w) {
        return w.z < floor ? 0.0
                           : t->at(cell((w.z - floor) / (1 - floor), t->rows), cell(turns_of(w), t->columns)) * per_sr;
    };
    r.sample = [t, floor, per_sr](Vec3d, Vec2d u) {
        const Table::Spot s = t->draw(u);
        return Draw{about_up(floor + (1 - floor) * (s.i + s.x) / t->rows, (s.j + s.y) / t->columns),
            t->at(s.i, s.j) * per_sr, {}, {}};
    };
    return r;
}

/// A map in theta x phi, each texel uniform in solid angle.
SyntheticSampler even_texels(Rng& d) {
    const int rows = d.whole(4, 64), columns = 2 * rows;
    std::vector<double> w = weights(d, rows, columns, d.log(1.5, 100), d.whole(0, 1) == 0);
    const auto edge = [rows](int i) { return math::cos(pi * i / rows); };
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) w[static_cast<std::size_t>(i * columns + j)] *= edge(i) - edge(i + 1);
    const auto t = std::make_shared<Table>(rows, columns, std::move(w));
    SyntheticSampler r{"even texels", fmt::format("{} x {}", rows, columns), {}, {}, {}};
    const auto value = [t, edge](
                           int i, int j) { return t->at(i, j) * t->columns / (2 * pi * (edge(i) - edge(i + 1))); };
    r.pdf = [t, value](Vec3d, Vec3d wi) {
        return value(cell(math::acos(std::clamp(wi.z, -1.0, 1.0)) / pi, t->rows), cell(turns_of(wi), t->columns));
    };
    r.sample = [t, edge, value](Vec3d, Vec2d u) {
        const Table::Spot s = t->draw(u);
        return Draw{
            about_up(edge(s.i) + (edge(s.i + 1) - edge(s.i)) * s.x, (s.j + s.y) / t->columns), value(s.i, s.j), {}, {}};
    };
    return r;
}

/// The same, uniform in theta and phi: p = T / (2 pi^2 sin theta), as pbrt-v3's InfiniteAreaLight; 0 at the poles
/// themselves.
SyntheticSampler texels(Rng& d) {
    const int rows = d.whole(4, 24), columns = 2 * rows;
    std::vector<double> w = weights(d, rows, columns, d.log(1.5, 30), d.whole(0, 3) == 0);
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j)
            w[static_cast<std::size_t>(i * columns + j)] *= math::sin(pi * (i + 0.5) / rows);
    const auto t = std::make_shared<Table>(rows, columns, std::move(w));
    SyntheticSampler r{"texels over sin theta", fmt::format("{} x {}", rows, columns), {}, {}, {}};
    const auto value = [t](int i, int j, double sin) {
        return sin > 0 ? t->at(i, j) * t->rows * t->columns / (2 * pi * pi * sin) : 0.0;
    };
    r.pdf = [t, value](Vec3d, Vec3d w2) {
        const double theta = math::atan2(math::hypot(w2.x, w2.y), w2.z);
        return value(cell(theta / pi, t->rows), cell(turns_of(w2), t->columns), math::sin(theta));
    };
    r.sample = [t, value](Vec3d, Vec2d u) {
        const Table::Spot s = t->draw(u);
        const double theta = pi * (s.i + s.x) / t->rows, phi = 2 * pi * (s.j + s.y) / t->columns,
                     sin = math::sin(theta);
        return Draw{math::spherical(sin, math::cos(theta), phi), value(s.i, s.j, sin), {}, {}};
    };
    return r;
}

/// Solves a x + (b - a) x^2 / 2 = u (a + b) / 2 for x.
double linear(double a, double b, double u) {
    const double t = u * (a + b);
    return std::clamp(t / (a + std::sqrt(std::max(a * a + (b - a) * t, 0.0))), 0.0, 1.0);
}

/// p bilinear in cos theta x phi between points, periodic in phi; a cell by its mass, then a linear density along each
/// side.
SyntheticSampler bilinear(Rng& d) {
    const int rows = d.whole(2, 16), columns = d.whole(4, 32);
    const double contrast = d.log(1.5, 20);
    auto point = std::make_shared<std::vector<double>>();
    for (int i = 0; i < (rows + 1) * columns; ++i) point->push_back(d.log(1, contrast));
    const auto p = [point, columns](
                       int i, int j) { return (*point)[static_cast<std::size_t>(i * columns + j % columns)]; };
    std::vector<double> w;
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) w.push_back((p(i, j) + p(i + 1, j) + p(i, j + 1) + p(i + 1, j + 1)) / 4);
    double all = 0;
    for (double v : w) all += v;
    const double per_sr = rows * columns / (2 * pi * all);
    const auto t = std::make_shared<Table>(rows, columns, std::move(w));
    SyntheticSampler r{"bilinear", fmt::format("{} x {}", rows, columns), {}, {}, {}};
    const auto value = [p, per_sr](int i, int j, double x, double y) {
        return per_sr *
            ((1 - x) * ((1 - y) * p(i, j) + y * p(i, j + 1)) + x * ((1 - y) * p(i + 1, j) + y * p(i + 1, j + 1)));
    };
    r.pdf = [t, value](Vec3d, Vec3d wi) {
        if (wi.z <= 0) return 0.0;
        const double a = wi.z * t->rows, b = turns_of(wi) * t->columns;
        const int i = cell(wi.z, t->rows), j = cell(turns_of(wi), t->columns);
        return value(i, j, a - i, b - j);
    };
    r.sample = [t, p, value](Vec3d, Vec2d u) {
        const Table::Spot s = t->draw(u);
        const double x = linear(p(s.i, s.j) + p(s.i, s.j + 1), p(s.i + 1, s.j) + p(s.i + 1, s.j + 1), s.x);
        const double y = linear(
            (1 - x) * p(s.i, s.j) + x * p(s.i + 1, s.j), (1 - x) * p(s.i, s.j + 1) + x * p(s.i + 1, s.j + 1), s.y);
        return Draw{about_up((s.i + x) / t->rows, (s.j + y) / t->columns), value(s.i, s.j, x, y), {}, {}};
    };
    return r;
}

}  // namespace

std::vector<SamplerFamily> table_families() { return {cells, even_texels, texels, bilinear}; }

}  // namespace crescent
