// Tables of more cells than can be asked: stratified sampling with Neyman's allocation (Neyman 1934). A first round of
// jittered points tells how much the integrand varies in each stratum; the second is spread by that, and its mean alone
// counts where it has enough points.
#include <algorithm>
#include <cmath>

#include "cubature/mesh.h"
#include "simd/random.h"
#include "simd/scalar.h"

namespace crescent::inline cubature {

namespace {

/// n points of one cell, one in each of n parts by their order along a lattice.
void add_points(const Rect& r, std::size_t n, std::uint32_t index, std::uint32_t round, std::vector<Vec2d>& out) {
    const auto h = pcg4d<std::uint32_t>({index, static_cast<std::uint32_t>(n), round, 0x6d35u});
    for (std::size_t k = 0; k < n;
        ++k) {  // every point is drawn anew: a lattice that is moved would fall in step with a table
        const auto g = pcg4d<std::uint32_t>({h.x, static_cast<std::uint32_t>(k), h.y, round});
        const double x = (static_cast<double>(k) + (g.x + 0.5) * 0x1p-32) / static_cast<double>(n),
                     y = (g.y + 0.5) * 0x1p-32;
        out.push_back({r.a0 + x * (r.a1 - r.a0), r.b0 + y * (r.b1 - r.b0)});
    }
}

struct Stratum {
    double mean = 0, variance = 0;  // of g
    std::size_t n = 0;
};

std::vector<Stratum> look(
    const std::vector<Rect>& cells, const std::vector<std::size_t>& counts, std::uint32_t round, const Batch& g) {
    std::vector<Vec2d> where;
    for (std::size_t i = 0; i < cells.size(); ++i)
        add_points(cells[i], counts[i], static_cast<std::uint32_t>(i), round, where);
    std::vector<double> v(where.size());
    g(where, v);
    std::vector<Stratum> out(cells.size());
    std::size_t next = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        Stratum& s = out[i];
        s.n = counts[i];
        double sum = 0, squares = 0;
        for (std::size_t k = 0; k < s.n; ++k, ++next) sum += v[next], squares += sqr(v[next]);
        if (s.n == 0) continue;
        s.mean = sum / static_cast<double>(s.n);
        if (s.n > 1) s.variance = std::max(squares - sum * s.mean, 0.0) / static_cast<double>(s.n - 1);
    }
    return out;
}

}  // namespace

Integral integrate_by_points(
    std::vector<Rect> cells, int bins, const Batch& g, std::size_t evaluations, bool estimates) {
    const auto area = [&](std::size_t i) { return (cells[i].a1 - cells[i].a0) * (cells[i].b1 - cells[i].b0); };
    const std::size_t few = std::clamp<std::size_t>(evaluations / (4 * cells.size()), 4, 64);
    const std::vector<Stratum> first = look(cells, std::vector<std::size_t>(cells.size(), few), 1, g);
    double all = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) all += area(i) * std::sqrt(first[i].variance);
    std::vector<std::size_t> counts(cells.size());
    const double left = static_cast<double>(evaluations) - static_cast<double>(few * cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i)
        counts[i] = 8 +
            (all > 0 && left > 0 ? static_cast<std::size_t>(left * area(i) * std::sqrt(first[i].variance) / all) : 0);
    const std::vector<Stratum> second = look(cells, counts, 2, g);
    Integral out;
    out.bins.assign(static_cast<std::size_t>(bins), 0.0);
    std::vector<double> squares(out.bins.size());
    double square = 0, spread = 0, size = 0;
    for (std::size_t i = 0; estimates && i < cells.size(); ++i)
        spread += area(i) * second[i].variance, size += area(i) * sqr(second[i].mean);
    const double common = size > 0 ? spread / size : 0;  // variance over the mean's square
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const double variance = std::max({first[i].variance, second[i].variance, common * sqr(second[i].mean)}) /
            static_cast<double>(counts[i]);
        out.bins[static_cast<std::size_t>(cells[i].bin)] += area(i) * second[i].mean;
        squares[static_cast<std::size_t>(cells[i].bin)] += sqr(area(i)) * variance;
        square += sqr(area(i)) * variance;
        out.evaluations += few + counts[i];
    }
    for (std::size_t b = 0; b < out.bins.size(); ++b) {
        out.value += out.bins[b];
        out.bin_errors.push_back(3 * std::sqrt(squares[b]));
    }
    out.error = 3 * std::sqrt(square);
    out.second = out.value;
    out.second_se = std::sqrt(square);
    out.settled = false;
    out.sampled = true;
    return out;
}

}  // namespace crescent::inline cubature
