// Cells are leaves of a dyadic tree over (1 - cos, phi) about the mean of a first set of draws, cut at the median of
// these or in an empty region; a second set is counted in them. p is integrated by stratified points, 2^20 in total.
#include "tests/calibration/measures.h"

#include "tests/calibration/geometry.h"
#include "tests/calibration/streams.h"

namespace crescent::calibration {

namespace {

struct Place {
    double t, turns, p = 0;  // p: the density there
};
struct Cell {
    double t0 = 0, t1 = 2, f0 = 0, f1 = 1;
    std::vector<Place> inside;
    double area() const { return 2 * pi_of<double> * (t1 - t0) * (f1 - f0); }
};

Place place_of(Vec3d w, double p) { return {w.z > 0 ? (w.x * w.x + w.y * w.y) / (1 + w.z) : 1 - w.z, turns_of(w), p}; }
Vec3d direction_of(Place p) {
    const double s = std::sqrt(std::max(p.t * (2 - p.t), 0.0)), phi = 2 * pi_of<double> * p.turns;
    return {s * std::cos(phi), s * std::sin(phi), 1 - p.t};
}

/// The cut of a cell: next to the largest empty margin, if it is at least a quarter of the cell; otherwise at the
/// median draw.
struct Cut {
    bool along_t;
    double at;
};
Cut cut_of(const Cell& c, bool along_t) {
    Cut best{along_t, 0};
    double widest = 0.25;
    for (const bool t : {true, false}) {
        const auto coordinate = [t](const Place& p) { return t ? p.t : p.turns; };
        const auto [least, most] = std::ranges::minmax(c.inside, {}, coordinate);
        const double low = t ? c.t0 : c.f0, high = t ? c.t1 : c.f1;
        const double below = coordinate(least) - low, above = high - coordinate(most);
        if (below > widest * (high - low)) {
            widest = below / (high - low);
            best = {t, coordinate(least) - 0.02 * below};
        }
        if (above > widest * (high - low)) {
            widest = above / (high - low);
            best = {t, coordinate(most) + 0.02 * above};
        }
    }
    if (widest > 0.25) return best;
    std::vector<double> v;
    for (const Place& p : c.inside) v.push_back(along_t ? p.t : p.turns);
    std::ranges::nth_element(v, v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2));
    return {along_t, v[v.size() / 2]};
}

/// Cuts the cell with the most draws until there are `count` cells.
std::vector<Cell> cells_about(const std::vector<Place>& draws, std::size_t count) {
    std::vector<Cell> all(1);
    all[0].inside = draws;
    while (all.size() < count) {
        Cell& c = *std::ranges::max_element(all, {}, [](const Cell& x) { return x.inside.size(); });
        if (c.inside.size() < 40) break;
        const Cut cut = cut_of(c, (all.size() + c.inside.size()) % 2 == 0);
        Cell high = c;
        (cut.along_t ? high.t0 : high.f0) = cut.at;
        (cut.along_t ? c.t1 : c.f1) = cut.at;
        high.inside.clear();
        std::vector<Place> low;
        for (const Place& p : c.inside) ((cut.along_t ? p.t : p.turns) < cut.at ? low : high.inside).push_back(p);
        c.inside = std::move(low);
        all.push_back(std::move(high));
    }
    return all;
}

/// Integral of p over a cell by n x n strata with two points in each, and its variance: that of the pairs, plus one
/// point with the largest p of the points and the first draws, for an edge of p that no pair shows.
std::pair<double, double> integral_of(const Sampler& s, Vec3d wo, const Cell& c, int n, Rng& rng) {
    double sum = 0, variance = 0, largest = 0;
    for (const Place& draw : c.inside) largest = std::max(largest, draw.p);
    for (int k = 0; k < n * n; ++k) {
        double v[2];
        for (double& p : v) {
            const double x = (k % n + rng.uniform(0, 1)) / n, y = (k / n + rng.uniform(0, 1)) / n;
            p = pdf_at(s, wo, direction_of({c.t0 + (c.t1 - c.t0) * x, c.f0 + (c.f1 - c.f0) * y}));
            sum += p;
            largest = std::max(largest, p);
        }
        variance += sqr(v[0] - v[1]);
    }
    const double each = c.area() / (2 * n * n);
    return {sum * each, (variance + sqr(largest)) * each * each};
}

}  // namespace

double pdf_at(const Sampler& s, Vec3d wo, Vec3d wi) {
    return std::visit(
        [&]<class F>(const Functions<F>& f) { return double(f.pdf(cast<F>(wo), cast<F>(wi))); }, s.functions);
}

Draws draws_of(const Sampler& s, Vec3d wo, int count, std::uint64_t seed) {
    Rng rng = rng_of({"measures", seed, 0, "draws"});
    Draws out;
    for (int k = 0; k < count; ++k)
        std::visit(
            [&]<class F>(const Functions<F>& f) {
                F u[PrimarySample::most_numbers];
                for (F& v : u) v = F(std::floor(rng.uniform(0, 0x1p24)) * 0x1p-24);
                const Drawn<F> d = f.sample(cast<F>(wo), u);
                out.wi.push_back(d.pdf > 0 ? widened(d.wi) : Vec3d{0, 0, 0});
                out.pdf.push_back(double(d.pdf));
            },
            s.functions);
    return out;
}

double share_of_other_pdf(const Sampler& s, Vec3d wo, int count, std::uint64_t seed) {
    const Draws d = draws_of(s, wo, count, seed);
    const double tolerance = s.real() == Real::f32 ? 1e-4 : 1e-9;
    int other = 0;
    for (std::size_t k = 0; k < d.wi.size(); ++k)
        other += d.pdf[k] > 0 && !(std::fabs(pdf_at(s, wo, d.wi[k]) / d.pdf[k] - 1) < tolerance);
    return static_cast<double>(other) / count;
}

Fit fit_of(const Sampler& s, Vec3d wo, int count, std::uint64_t seed) {
    std::vector<Place> pilot;
    const Draws first = draws_of(s, wo, count / 4, seed + 1000);
    for (std::size_t k = 0; k < first.wi.size(); ++k)
        if (first.pdf[k] > 0) pilot.push_back(place_of(first.wi[k], first.pdf[k]));
    const std::vector<Cell> cells = cells_about(pilot, 400);
    std::vector<double> seen(cells.size());
    double something = 0;
    for (const Vec3d w : draws_of(s, wo, count, seed).wi) {
        if (!(dot(w, w) > 0)) continue;
        ++something;
        const Place p = place_of(w, 0);
        for (std::size_t k = 0; k < cells.size(); ++k)
            if (p.t >= cells[k].t0 && p.t < cells[k].t1 && p.turns >= cells[k].f0 && p.turns < cells[k].f1) ++seen[k];
    }
    Rng rng = rng_of({"measures", seed, 0, "points"});
    Fit fit;
    double variance = 0;
    const int n = static_cast<int>(std::sqrt(double(1 << 19) / static_cast<double>(cells.size())));
    for (std::size_t k = 0; k < cells.size(); ++k) {
        const auto [mass, error] = integral_of(s, wo, cells[k], n, rng);
        fit.integral += mass;
        variance += error;
        const double expected = mass * count, spread = expected + error * sqr(double(count));
        if (expected < 10) continue;  // draws in cells with almost no expected draws show in the integral
        fit.chi2 += sqr(seen[k] - expected) / spread;
        ++fit.degrees;
    }
    fit.drawn = something / count;
    fit.sigmas = (fit.drawn - fit.integral) / std::sqrt(variance + fit.drawn * (1 - fit.drawn) / count + 1e-10);
    return fit;
}

}  // namespace crescent::calibration
