// Skies of texels in theta x phi in single and double precision, drawn by cumulative sums of rows and columns or by an
// alias table; uniform in theta and phi within a texel, p = mass * rows * columns / (2 pi^2 sin theta).
#pragma once

#include "tests/calibration/geometry.h"
#include "tests/calibration/sampler.h"
#include "tests/known_samplers/correct/renderers.h"

namespace crescent::calibration {

/// pdf of a sky in F, and the direction at a place of the table.
template <class F> struct SkyMap {
    int rows, columns;
    std::vector<F> mass;
    Broken broken;
    SkyMap(const Sky& s, Broken b) : rows(s.rows), columns(s.columns), mass(s.mass.begin(), s.mass.end()), broken(b) {}
    F pdf(Vec3<F> w) const {
        const F sin = std::hypot(w.x, w.y);
        if (!(sin > 0)) return 0;
        int i = std::clamp(static_cast<int>(std::atan2(sin, w.z) / pi_of<F> * F(rows)), 0, rows - 1),
            j = std::clamp(static_cast<int>(turns_of(w) * F(columns)), 0, columns - 1);
        if (broken == Broken::shifted_table) j = (j + 1) % columns;
        if (broken == Broken::mirrored_table) j = columns - 1 - j;
        if (broken == Broken::transposed_table) {
            const int row = j * rows / columns;
            j = i * columns / rows;
            i = row;
        }
        return mass[std::size_t(i * columns + j)] * F(rows) * F(columns) / (2 * sqr(pi_of<F>) * sin);
    }
    Vec3<F> direction(F row, F column) const {
        const F theta = pi_of<F> * row / F(rows), phi = 2 * pi_of<F> * column / F(columns), sin = std::sin(theta);
        return {sin * std::cos(phi), sin * std::sin(phi), std::cos(theta)};
    }
};

/// u[0] selects the row, u[1] the column.
template <class F>
Functions<F> sky_by_cdf(int row_count, int column_count, const std::vector<double>& radiance, Broken b) {
    const Sky s(row_count, column_count, radiance, false);
    const auto map = std::make_shared<const SkyMap<F>>(s, b);
    // Cumulative sums, normalised for each row, rounded to F.
    std::vector<F> rows(s.row_sums.begin(), s.row_sums.end()), columns;
    for (std::size_t i = 0; i < std::size_t(s.rows); ++i)
        for (std::size_t j = 0; j <= std::size_t(s.columns); ++j) {
            const double* row = &s.sums[i * std::size_t(s.columns + 1)];
            columns.push_back(F(row[j] / row[s.columns]));
        }
    for (F& v : rows) v /= rows.back();
    Functions<F> out;
    out.pdf = [map](Vec3<F>, Vec3<F> w) { return map->pdf(w); };
    out.sample = [map, rows = std::move(rows), columns = std::move(columns)](Vec3<F>, const F* u) {
        const auto place = [](const F* sum, int count, F v) {
            const auto k =
                std::clamp<std::ptrdiff_t>(std::upper_bound(sum, sum + count + 1, v) - sum - 1, 0, count - 1);
            return F(k) + std::clamp((v - sum[k]) / (sum[k + 1] - sum[k]), F(0), 1 - slack<F> / 2);
        };
        const F row = place(rows.data(), map->rows, u[0]);
        const F* of_row = &columns[std::size_t(row) * std::size_t(map->columns + 1)];
        const Vec3<F> w = map->direction(row, place(of_row, map->columns, u[1]));
        return Drawn<F>{w, map->pdf(w)};
    };
    return out;
}

/// u[2] selects a texel, u[3] decides whether it is kept.
template <class F>
Functions<F> sky_by_alias(int row_count, int column_count, const std::vector<double>& radiance, Broken b) {
    const auto s = std::make_shared<const Sky>(row_count, column_count, radiance, true);
    const auto map = std::make_shared<const SkyMap<F>>(*s, b);
    Functions<F> out;
    out.pdf = [map](Vec3<F>, Vec3<F> w) { return map->pdf(w); };
    out.sample = [map, s](Vec3<F>, const F* u) {
        std::size_t k = std::min(std::size_t(u[2] * F(s->mass.size())), s->mass.size() - 1);
        if (!(u[3] < F(s->keep[k]))) k = std::size_t(s->other[k]);
        const int row = int(k) / s->columns, column = int(k) % s->columns;
        const Vec3<F> w = map->direction(F(row) + u[0], F(column) + u[1]);
        return Drawn<F>{w, map->pdf(w)};
    };
    return out;
}

/// A sky as a sampler.
inline Sampler sky_sampler(
    std::string name, int rows, int columns, const std::vector<double>& radiance, bool alias, Real real) {
    Sampler s;
    s.family = std::move(name);
    s.parameters = std::to_string(columns) + " x " + std::to_string(rows);
    s.numbers = alias ? 4 : 2;
    s.wo = Traits::WoDomain::none;
    const auto make = [&]<class F>(F) {
        return alias ? sky_by_alias<F>(rows, columns, radiance, Broken::none)
                     : sky_by_cdf<F>(rows, columns, radiance, Broken::none);
    };
    if (real == Real::f32) s.functions = make(0.0f);
    else s.functions = make(0.0);
    return s;
}

}  // namespace crescent::calibration
