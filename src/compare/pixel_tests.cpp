// Welch's t-test at each pixel over the renders, in chunks side by side. Two p: the histogram's is plain; the one that
// names pixels takes a spread for no less than its tile's, since a pixel may give one value in every render by chance.
// Named pixels are those of a false discovery rate of alpha.
#include "compare/pixel_tests.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"

namespace crescent::inline comparing {

namespace {

constexpr std::size_t bins = 20;         // of the histogram of p
constexpr std::size_t named_most = 5;    // pixels that are named
constexpr std::size_t chunk = 1u << 14;  // pixels
constexpr std::size_t table_from = 1u << 17;

/// Which twentieth a p is in, by t and degrees of freedom (rounded to an eighth): a search instead of a beta function.
class Bins {
public:
    /// A table is worth its while for many pixels only: without one (most = 0) each p is computed.
    explicit Bins(double most) {
        for (double df = 1; most > 0 && df <= most + 1; df += 1.0 / 8) {
            std::array<double, bins> limits{};  // |t| that p = (k + 1)/bins has
            for (std::size_t k = 0; k + 1 < bins; ++k)
                limits[k] = student_quantile(1 - static_cast<double>(k + 1) / (2.0 * bins), df);
            table_.push_back(limits);
        }
    }
    std::size_t of(double t, double df) const {
        if (table_.empty()) return std::min(bins - 1, static_cast<std::size_t>(two_sided_p(t, df) * bins));
        const auto row = std::min(table_.size() - 1, static_cast<std::size_t>(std::max(0.0, std::round((df - 1) * 8))));
        std::size_t k = 0;
        while (k + 1 < bins && std::fabs(t) < table_[row][k]) ++k;
        return k;
    }

private:
    std::vector<std::array<double, bins>> table_;
};

struct Moments {
    double difference = 0, se = 0, df = 1;
    bool known = false;
};

/// A tile's variance at a pixel's brightness, where that is below the tile's.
double scaled(const ArmReadings& arm, std::size_t tile, double variance, double y) {
    double mean = 0;
    for (const auto& render : arm.tiles) mean += render[tile].y / static_cast<double>(arm.tiles.size());
    const double share = mean > 0 ? std::min(1.0, std::fabs(y) / mean) : 1;
    return variance * share * share;
}

/// `floored`: a pixel may give the same value in every render by chance (so many hits of so many samples), and its
/// spread is never taken for less than that of its tile, at the pixel's own brightness.
Moments moments(const Sides& s, std::size_t i, bool floored) {
    const double ka = static_cast<double>(s.a.files.size()), kb = static_cast<double>(s.b.files.size());
    double va = s.a.film.variance(i), vb = s.b.film.variance(i);
    if (floored) {
        const int w = s.all.width;
        const std::size_t t = s.all.tiles.of(static_cast<int>(i) % w, static_cast<int>(i) / w);
        va = std::max(va, scaled(s.a, t, s.tile_a[t], s.a.film.y[i]));
        vb = std::max(vb, scaled(s.b, t, s.tile_b[t], s.b.film.y[i]));
    }
    va /= ka, vb /= kb;
    Moments m;
    m.difference = s.a.film.y[i] - s.b.film.y[i];
    m.known = !std::isnan(va) && !std::isnan(vb) && (va + vb > 0 || m.difference != 0);
    if (!m.known) return m;
    m.se = std::sqrt(va + vb);
    const double below = va * va / (ka - 1) + (kb > 1 ? vb * vb / (kb - 1) : 0);
    m.df = below > 0 ? (va + vb) * (va + vb) / below : 1;
    return m;
}

/// Counts by chunk, so that threads need not meet.
struct Part {
    std::array<std::uint64_t, bins> histogram{};
    std::uint64_t tested = 0;
    std::vector<std::pair<double, std::uint32_t>> small;  // p at most alpha, and whose
};

double most_degrees(const Sides& s) { return static_cast<double>(s.a.files.size() + s.b.files.size()); }

Part part_of(const Sides& s, std::size_t begin, double alpha, double level, const Bins& table) {
    const auto& pixels = s.all.regions.back().pixels;
    Part out;
    for (std::size_t k = begin; k < std::min(pixels.size(), begin + chunk); ++k) {
        const Moments m = moments(s, pixels[k], false);
        if (!m.known) continue;
        const std::size_t bin = m.se > 0 ? table.of(m.difference / m.se, m.df) : 0;
        ++out.histogram[bin], ++out.tested;
        if (bin > 0 && alpha <= 1.0 / bins) continue;
        const double p = pixel_p(s, pixels[k], level);
        if (p <= alpha) out.small.emplace_back(p, pixels[k]);
    }
    return out;
}

}  // namespace

double pixel_p(const Sides& s, std::size_t i, double level) {
    const Moments m = moments(s, i, true);
    if (!m.known) return std::nan("");
    if (std::fabs(m.difference) < s.blind(s.a.film.y[i], s.b.film.y[i], 1, 0, level)) return 1;
    return m.se > 0 ? two_sided_p(m.difference / m.se, m.df) : 0;
}

double pixel_level(const Sides& s, double alpha) {
    return alpha / static_cast<double>(s.all.regions.back().pixels.size());
}

void test_pixels(const Sides& s, double alpha, BiasResult& out) {
    if (s.lone_reference() && s.b.film.told_variance.empty()) return;
    const std::size_t count = s.all.regions.back().pixels.size();
    const double level = pixel_level(s, alpha);
    const Bins table(count > table_from ? most_degrees(s) : 0);
    std::vector<Part> parts((count + chunk - 1) / chunk);
    parallel_for(
        std::size_t{0}, parts.size(), [&](std::size_t c) { parts[c] = part_of(s, c * chunk, alpha, level, table); });
    out.pixel_p.assign(bins, 0);
    std::vector<std::pair<double, std::uint32_t>> small;
    for (const Part& part : parts) {
        for (std::size_t k = 0; k < bins; ++k) out.pixel_p[k] += part.histogram[k];
        out.pixels_tested += part.tested;
        small.insert(small.end(), part.small.begin(), part.small.end());
    }
    std::sort(small.begin(), small.end());
    std::vector<double> p;
    for (const auto& [value, pixel] : small) p.push_back(value);
    out.pixels_different = discovered(p, static_cast<double>(out.pixels_tested), alpha, s.dependent);
    if (out.pixels_different) out.pixel_level = small[out.pixels_different - 1].first;
    for (std::size_t k = 0; k < std::min<std::size_t>(named_most, out.pixels_different); ++k) {
        const int x = static_cast<int>(small[k].second) % s.all.width,
                  y = static_cast<int>(small[k].second) / s.all.width;
        out.pixels_found.push_back(
            {{x, y, x, y}, s.a.film.y[small[k].second], s.b.film.y[small[k].second], small[k].first});
    }
}

}  // namespace crescent::inline comparing
