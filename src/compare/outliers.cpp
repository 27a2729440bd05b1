// A pixel with one outlier among K values has a sum of squared deviations of (K - 1) / K times its square, so the means
// and sums of the first pass find the few pixels whose values are then read.
#include "compare/outliers.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <set>
#include <tuple>

#include "compare/file_warnings.h"
#include "compare/renders.h"
#include "math/statistics.h"

namespace crescent {

namespace {

/// Outliers are rare: at most this share of the pixels of a region may have some.
constexpr double most_with_outliers = 0.1;
/// A deviation below 10 standard deviations of a pixel is noise also in a region of a few pixels.
constexpr double least_deviations = 10;

double renders_of_both(const RenderStats& stats) {
    return static_cast<double>(stats.arms[0].film.count + stats.arms[1].film.count);
}

/// Returns the sum of the squared deviations of one pixel from its mean over the renders of both sides.
double pooled_squares(const RenderStats& stats, std::size_t q, std::uint32_t i) {
    const MeanFilm &a = stats.arms[0].film, &b = stats.arms[1].film;
    const double na = static_cast<double>(a.count), nb = static_cast<double>(b.count),
                 difference = a.of(q).mean[i] - b.of(q).mean[i];
    return a.of(q).m2[i] + b.of(q).m2[i] + difference * difference * na * nb / (na + nb);
}

/// The pixels of a region and a quantity with the largest sums of squares, and the sum of all others.
struct Bulk {
    std::size_t region = 0, quantity = 0;
    std::vector<std::uint32_t> large;  // descending
    double remainder = 0;

    /// Returns the squared deviation above which a value is an outlier: the variance of the sum of a render.
    double limit(const RenderStats& stats, double renders) const {
        const double variance = remainder / (renders - 1),
                     pixels = static_cast<double>(stats.regions[region].pixels.size());
        return std::max(variance, least_deviations * least_deviations * variance / pixels);
    }
};

/// Starts with the pixels of the smallest sums of squares, so that many outliers do not hide each other, and adds those
/// that are no larger than an outlier.
Bulk bulk_of(const RenderStats& stats, std::size_t region, std::size_t quantity) {
    Bulk out;
    out.region = region;
    out.quantity = quantity;
    std::vector<std::pair<double, std::uint32_t>> squares;
    for (const std::uint32_t i : stats.regions[region].pixels)
        squares.emplace_back(pooled_squares(stats, quantity, i), i);
    const auto count = static_cast<std::ptrdiff_t>(most_with_outliers * static_cast<double>(squares.size()));
    if (count == 0) return out;
    std::nth_element(squares.begin(), squares.begin() + count, squares.end(), std::greater<>());
    out.remainder = std::accumulate(
        squares.begin() + count, squares.end(), 0.0, [](double sum, const auto& pixel) { return sum + pixel.first; });
    squares.resize(static_cast<std::size_t>(count));
    std::sort(squares.begin(), squares.end(), std::greater<>());
    const double renders = renders_of_both(stats), of_one = renders / (renders - 1);
    while (!squares.empty() && squares.back().first * of_one <= out.limit(stats, renders)) {
        out.remainder += squares.back().first;
        squares.pop_back();
    }
    for (const auto& [square, pixel] : squares) out.large.push_back(pixel);
    return out;
}

/// The values of some pixels in every render.
class PixelValues {
public:
    PixelValues(const RenderStats& stats, std::vector<std::uint32_t> pixels, const std::array<std::string, 2>& layers,
        ProgressMonitor& monitor)
        : pixels_(std::move(pixels)) {
        for (std::size_t side = 0; side < 2; ++side) {
            for (std::size_t k = 0; k < stats.arms[side].files.size(); ++k) {
                monitor.check();
                const Render render = stats.source.read(stats.arms[side].files[k].path, layers[side]);
                std::array<std::vector<double>, most_quantities> values;
                for (const std::uint32_t i : pixels_) {
                    values[0].push_back(static_cast<double>(render.y(i)));
                    values[1].push_back(static_cast<double>(render.r[i]));
                    values[2].push_back(static_cast<double>(render.g[i]));
                    values[3].push_back(static_cast<double>(render.b[i]));
                    if (!render.alpha.empty()) values[4].push_back(static_cast<double>(render.alpha[i]));
                }
                renders_.push_back({side, k, std::move(values)});
            }
        }
    }

    /// Returns the value with the largest deviation if it is an outlier among those of its pixel.
    std::optional<OutlierPixel> outlier(std::uint32_t pixel, std::size_t quantity) const {
        const auto index =
            static_cast<std::size_t>(std::lower_bound(pixels_.begin(), pixels_.end(), pixel) - pixels_.begin());
        const double n = static_cast<double>(renders_.size());
        double sum = 0;
        for (const Values& r : renders_) sum += r.values[quantity][index] / n;
        double squares = 0, largest = -1;
        OutlierPixel out;
        for (const Values& r : renders_) {
            const double value = r.values[quantity][index], deviation = value - sum;
            squares += deviation * deviation;
            if (deviation * deviation <= largest) continue;
            largest = deviation * deviation;
            out = {r.side, r.render, pixel, quantity, value, sum - deviation / (n - 1)};
        }
        const double lone = lone_share(renders_.size());
        return lone > 0 && largest > lone * squares ? std::optional(out) : std::nullopt;
    }

private:
    struct Values {
        std::size_t side, render;
        std::array<std::vector<double>, most_quantities> values;
    };
    std::vector<std::uint32_t> pixels_;  // ascending
    std::vector<Values> renders_;
};

/// Adds the outliers of one region and quantity. Pixels whose large squares are no single outlier are ordinary noise,
/// which increases the limit for the others.
void add_outliers(const RenderStats& stats, Bulk bulk, const PixelValues& values, std::vector<OutlierPixel>& out) {
    std::vector<OutlierPixel> single;
    for (const std::uint32_t i : bulk.large) {
        const auto outlier = values.outlier(i, bulk.quantity);
        if (outlier) single.push_back(*outlier);
        else bulk.remainder += pooled_squares(stats, bulk.quantity, i);
    }
    const double renders = renders_of_both(stats), of_one = renders / (renders - 1);
    while (!single.empty()) {  // smallest last
        const double square = pooled_squares(stats, bulk.quantity, single.back().pixel);
        if (square * of_one > bulk.limit(stats, renders)) break;
        bulk.remainder += square;
        single.pop_back();
    }
    out.insert(out.end(), single.begin(), single.end());
}

void count_outlier_groups(const RenderStats& stats, OutlierPixels& out) {
    for (std::size_t s = 0; s < 2; ++s) out.by_render[s].assign(stats.arms[s].files.size(), 0);
    for (std::size_t begin = 0; begin < out.pixels.size();) {
        const OutlierPixel& first = out.pixels[begin];
        std::vector<std::uint32_t> pixels;
        for (; begin < out.pixels.size(); ++begin) {
            const OutlierPixel& p = out.pixels[begin];
            if (p.side != first.side || p.render != first.render) break;
            pixels.push_back(p.pixel);
        }
        const std::uint64_t groups = touching_groups(pixels, stats.width);
        out.groups[first.side] += groups;
        out.by_render[first.side][first.render] = groups;
    }
}

void set_outliers_apart(RenderStats& stats, const OutlierPixels& outliers) {
    for (const OutlierPixel& p : outliers.pixels) stats.bad[p.pixel] = true;
    for (PixelSet& set : stats.regions) std::erase_if(set.pixels, [&](std::uint32_t i) { return stats.bad[i]; });
}

/// A few bright pixels are in fewer tiles than this.
constexpr std::size_t least_tiles = 4;

/// Returns the value that a quarter of the tiles, and `least_tiles` of them, reach.
double reached_by_quarter(std::vector<double> values) {
    const std::size_t index = std::min(3 * values.size() / 4, values.size() - least_tiles);
    const auto value = values.begin() + static_cast<std::ptrdiff_t>(index);
    std::nth_element(values.begin(), value, values.end());
    return *value;
}

/// Returns the root mean square over tiles of the standard deviation over renders, without one of them.
double tile_noise(const ArmStats& side, const std::vector<std::size_t>& tiles, std::size_t left_out_render) {
    double variance = 0;
    for (const std::size_t t : tiles) {
        std::vector<double> means;
        for (std::size_t k = 0; k < side.quantities[0].tiles.size(); ++k)
            if (k != left_out_render) means.push_back(side.quantities[0].tiles[k][t].mean);
        const double n = static_cast<double>(means.size());
        const double mean = std::accumulate(means.begin(), means.end(), 0.0) / n;
        double squares = 0;
        for (const double m : means) squares += (m - mean) * (m - mean);
        variance += squares / (n - 1) / static_cast<double>(tiles.size());
    }
    return std::sqrt(variance);
}

/// Returns the tiles with finite pixels that are not black in every render of a side. Tiles without noise belong to
/// them: where events are rare, a few tiles with one say little about a render.
std::vector<std::size_t> lit_tiles(const ArmStats& side) {
    std::vector<std::size_t> out;
    const auto& renders = side.quantities[0].tiles;
    for (std::size_t t = 0; t < renders[0].size(); ++t) {
        const bool is_lit =
            std::any_of(renders.begin(), renders.end(), [&](const auto& render) { return render[t].mean != 0; });
        if (is_lit && std::isfinite(renders[0][t].mean)) out.push_back(t);
    }
    return out;
}

}  // namespace

OutlierPixels find_outliers(RenderStats& stats, const std::array<std::string, 2>& layers, ProgressMonitor& monitor) {
    OutlierPixels out;
    std::vector<Bulk> bulks;
    std::set<std::uint32_t> large;
    for (std::size_t r = 0; r < stats.regions.size(); ++r) {
        for (std::size_t q = 0; q < stats.quantities; ++q) {
            const Bulk& bulk = bulks.emplace_back(bulk_of(stats, r, q));
            large.insert(bulk.large.begin(), bulk.large.end());
        }
    }
    if (large.empty()) return out;
    const PixelValues values(stats, {large.begin(), large.end()}, layers, monitor);
    for (Bulk& bulk : bulks) add_outliers(stats, std::move(bulk), values, out.pixels);
    const auto place_of = [](const OutlierPixel& p) { return std::tuple(p.side, p.render, p.pixel); };
    std::sort(out.pixels.begin(), out.pixels.end(), [&](const OutlierPixel& a, const OutlierPixel& b) {
        return place_of(a) != place_of(b) ? place_of(a) < place_of(b) : a.quantity < b.quantity;
    });
    const auto last = std::unique(out.pixels.begin(), out.pixels.end(),
        [&](const OutlierPixel& a, const OutlierPixel& b) { return place_of(a) == place_of(b); });
    out.pixels.erase(last, out.pixels.end());
    count_outlier_groups(stats, out);
    out.set_apart = out.total() > 0 && 2 * static_cast<double>(out.total()) <= renders_of_both(stats);
    if (out.set_apart) set_outliers_apart(stats, out);
    return out;
}

std::optional<OutlierRender> outlier_render(const RenderStats& stats) {
    std::optional<OutlierRender> out;
    std::size_t renders = 0;
    for (std::size_t s = 0; s < 2; ++s) {
        const ArmStats &side = stats.arms[s], &other = stats.arms[1 - s];
        const std::size_t n = side.files.size();
        if (n < 3) continue;
        renders += n;
        const std::vector<std::size_t> tiles = lit_tiles(side);
        if (tiles.size() < least_tiles) continue;
        const double other_noise = other.files.size() > 1 ? tile_noise(other, tiles, other.files.size()) : 0;
        const double degrees = static_cast<double>(n - 2 + other.files.size() - 1);
        for (std::size_t k = 0; k < n; ++k) {
            std::vector<double> deviations;
            double render_sum = 0, other_sum = 0;
            for (const std::size_t t : tiles) {
                double sum = 0;
                for (const auto& render : side.quantities[0].tiles) sum += render[t].mean;
                const double value = side.quantities[0].tiles[k][t].mean;
                const double mean_of_others = (sum - value) / static_cast<double>(n - 1);
                render_sum += value;
                other_sum += mean_of_others;
                deviations.push_back(std::fabs(value - mean_of_others));
            }
            const double noise = std::max(other_noise, tile_noise(side, tiles, k));
            const double deviation =
                reached_by_quarter(std::move(deviations)) / (noise * std::sqrt(1 + 1 / static_cast<double>(n - 1)));
            if (std::isnan(deviation) || (out && deviation <= out->deviation)) continue;
            out = OutlierRender{s, k, 0, render_sum / other_sum, deviation, student_p(deviation, degrees)};
        }
    }
    if (!out) return out;
    const double places = 2 * static_cast<double>(renders);
    out->p = std::min(1.0, out->p * places);
    const std::uint64_t total = stats.outliers.total();
    for (std::size_t s = 0; s < 2 && total > 0; ++s) {
        for (std::size_t k = 0; k < stats.arms[s].files.size(); ++k) {
            const std::uint64_t own_count = stats.outliers.by_render[s][k];
            const double share = 1 / renders_of_both(stats);
            if (static_cast<double>(own_count) <= static_cast<double>(total) * share) continue;
            const double p = std::min(1.0, binomial_exact(own_count, total, share) * places);
            if (p < out->p)
                out = OutlierRender{
                    .side = s, .render = k, .pixels = own_count, .ratio = std::nan(""), .deviation = 0, .p = p};
        }
    }
    return out;
}

}  // namespace crescent
