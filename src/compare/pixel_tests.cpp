// Welch's t-test at each pixel over the renders (Student's of the differences where they are paired), in chunks side by
// side, of Y and of each channel. Two p: the histogram's is plain and of Y; the one that names pixels takes a spread
// for no less than its tile's, since a pixel may give one value in every render by chance. Named pixels are those of a
// false discovery rate of alpha.
#include "compare/pixel_tests.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "compare/quantities.h"

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
double scaled(const QuantityReadings& read, std::size_t tile, double variance, double value) {
    double mean = 0;
    for (const auto& render : read.tiles) mean += render[tile].mean / static_cast<double>(read.tiles.size());
    const double share = mean > 0 ? std::min(1.0, std::fabs(value) / mean) : 1;
    return variance * share * share;
}

/// A pixel may give the same value in every render by chance (so many hits of so many samples): where `floored`, its
/// spread is never taken for less than that of its tile, at the pixel's own brightness.
Moments moments(const Sides& s, std::size_t i, bool floored) {
    const auto x = static_cast<int>(i % static_cast<std::size_t>(s.all.width)),
               y = static_cast<int>(i / static_cast<std::size_t>(s.all.width));
    const std::size_t t = s.all.tiles.of(x, y), q = s.quantity;
    const auto over_renders = [&](const ArmReadings& side, const std::vector<double>& tiles,
                                  const ArmReadings& bright) {
        double v = side.film.variance(i, q);
        if (floored) v = std::max(v, scaled(bright.quantities[q], t, tiles[t], bright.film.of(q).mean[i]));
        return v / static_cast<double>(side.files.size());
    };
    Moments m;
    m.difference = s.mean_a(i) - s.mean_b(i);
    double sum = 0, below = 0;
    const auto add = [&](double v, std::size_t renders) {
        sum += v, below += renders > 1 ? v * v / static_cast<double>(renders - 1) : 0;
    };
    if (s.in_pairs()) {
        m.difference = s.differences->film.of(q).mean[i];
        add(over_renders(*s.differences, s.tile_paired, s.a), s.differences->files.size());
    } else {
        add(over_renders(s.a, s.tile_a, s.a), s.a.files.size());
        add(over_renders(s.b, s.tile_b, s.b), s.b.files.size());
    }
    m.known = std::isfinite(sum) && (sum > 0 || m.difference != 0 || s.in_pairs());
    if (!m.known) return m;
    m.se = std::sqrt(sum);
    m.df = below > 0 ? sum * sum / below : 1;
    return m;
}

/// p of one pixel; NaN where it has no noise and no difference, or its noise is not known. 1 where rare events that no
/// render met could make up the difference (`level`, see Sides::unseen).
double pixel_p(const Sides& s, std::size_t i, double level) {
    const Moments m = moments(s, i, true);
    if (!m.known) return std::nan("");
    if (std::fabs(m.difference) < s.blind(s.mean_b(i) + m.difference, s.mean_b(i), 1, 0, level)) return 1;
    return m.se > 0 ? two_sided_p(m.difference / m.se, m.df) : m.difference == 0 ? 1 : 0;
}

/// A pixel that may differ.
struct Candidate {
    JointP p;
    std::uint32_t pixel = 0;
    bool operator<(const Candidate& other) const { return p.p != other.p.p ? p.p < other.p.p : pixel < other.pixel; }
};

/// Counts by chunk, so that threads need not meet.
struct Part {
    std::array<std::uint64_t, bins> histogram{};
    std::uint64_t tested = 0;
    std::vector<Candidate> small;  // p at most alpha
};

double most_degrees(const Sides& s) { return static_cast<double>(s.a.files.size() + s.b.files.size()); }

Part part_of(std::span<const Sides> sides, std::size_t begin, double alpha, double level, const Bins& table) {
    const auto& pixels = sides[0].all.regions.back().pixels;
    Part out;
    for (std::size_t k = begin; k < std::min(pixels.size(), begin + chunk); ++k) {
        bool known = false, small = alpha > 1.0 / bins;
        for (const Sides& s : sides) {
            const Moments m = moments(s, pixels[k], false);
            if (!m.known) continue;
            const std::size_t bin = m.se > 0 ? table.of(m.difference / m.se, m.df) : m.difference == 0 ? bins - 1 : 0;
            if (s.quantity == 0) ++out.histogram[bin];
            known = true, small |= bin == 0;
        }
        out.tested += known;
        if (!known || !small) continue;
        std::array<double, colour_quantities> p{};
        for (const Sides& s : sides)
            p[s.quantity] = pixel_p(s, pixels[k], level * level_share(s.quantity, sides.size()));
        const JointP joint = joint_p(std::span(p).first(sides.size()));
        if (joint.p <= alpha) out.small.push_back({joint, pixels[k]});
    }
    return out;
}

}  // namespace

double pixel_level(const Sides& s, double alpha) {
    return alpha / static_cast<double>(s.all.regions.back().pixels.size());
}

void test_pixels(std::span<const Sides> sides, double alpha, BiasResult& out) {
    const Sides& s = sides[0];
    if (s.lone_reference() && s.b.film.told_variance.empty()) return;
    const std::size_t count = s.all.regions.back().pixels.size();
    const double level = pixel_level(s, alpha);
    const Bins table(count > table_from ? most_degrees(s) : 0);
    std::vector<Part> parts((count + chunk - 1) / chunk);
    parallel_for(std::size_t{0}, parts.size(),
        [&](std::size_t c) { parts[c] = part_of(sides, c * chunk, alpha, level, table); });
    out.pixel_p.assign(bins, 0), out.pixels_by.assign(sides.size(), 0);
    std::vector<Candidate> small;
    for (const Part& part : parts) {
        for (std::size_t k = 0; k < bins; ++k) out.pixel_p[k] += part.histogram[k];
        out.pixels_tested += part.tested;
        small.insert(small.end(), part.small.begin(), part.small.end());
    }
    std::sort(small.begin(), small.end());
    std::vector<double> p;
    for (const Candidate& c : small) p.push_back(c.p.p);
    out.pixels_different = discovered(p, static_cast<double>(out.pixels_tested), alpha, s.dependent);
    small.resize(out.pixels_different);
    for (const Candidate& c : small) {
        ++out.pixels_by[c.p.quantity], out.different_pixels.push_back(c.pixel);
        if (out.pixels_found.size() == named_most) continue;
        const int x = static_cast<int>(c.pixel) % s.all.width, y = static_cast<int>(c.pixel) / s.all.width;
        const Sides& of = sides[c.p.quantity];
        const double b = of.mean_b(c.pixel);
        out.pixels_found.push_back({{x, y, x, y}, b + moments(of, c.pixel, false).difference, b, c.p.p, c.p.quantity});
    }
    std::sort(out.different_pixels.begin(), out.different_pixels.end());
}

}  // namespace crescent::inline comparing
