// Second pass: with means known, what each render says of each region and tile. Sums run over chunks of pixels and
// rows of tiles, which are merged in their order: equal on any number of threads.
#include "compare/second_pass.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>

#include "base/parallel.h"
#include "compare/non_finite.h"
#include "compare/shared_seeds.h"
#include "compare/spectrum.h"
#include "stats/hypotheses.h"
#include "stats/tail.h"

namespace crescent::inline comparing {

namespace {

constexpr double epsilon = 0.01;         // of relMSE and MAPE, as Rousselle et al. 2011 have it
constexpr std::size_t chunk = 1u << 15;  // pixels

/// The largest values of many, falling.
class Largest {
public:
    explicit Largest(std::size_t keep) : keep_(keep) {}
    /// What is not above this would not be kept.
    float least() const { return heap_.size() < keep_ ? -1 : keep_ ? heap_.front() : HUGE_VALF; }
    void add(float x) {
        if (!(x > least())) return;
        heap_.push_back(x);
        std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
        if (heap_.size() > keep_) std::pop_heap(heap_.begin(), heap_.end(), std::greater<>()), heap_.pop_back();
    }
    std::vector<float> falling() const {
        std::vector<float> out = heap_;
        std::sort(out.begin(), out.end(), std::greater<>());
        return out;
    }

private:
    std::size_t keep_;
    std::vector<float> heap_;
};

/// Mean of all but the largest `trim` of the values.
double trimmed_mean(std::vector<float>& values, double trim) {
    const auto keep = values.size() - static_cast<std::size_t>(trim * static_cast<double>(values.size()));
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(keep), values.end());
    double sum = 0;
    for (std::size_t i = 0; i < keep; ++i) sum += static_cast<double>(values[i]);
    return sum / static_cast<double>(keep);
}

/// Sums over one chunk of a region; errors above `least` are kept for the tail.
struct Part {
    RegionReading sum;
    std::vector<float> large;
};

/// The same of one quantity; squared deviations from the mean are kept.
struct QuantityPart {
    double sum = 0;
    std::vector<float> large;
};

/// A pixel's deviations from its mean over renders, the largest of either sign.
struct Outliers {
    double rise = 0, fall = 0;
};

class SecondPass {
public:
    SecondPass(const ComparePlan& plan, const Readings& all, const MeanFilm* reference)
        : plan_(plan), all_(all), reference_(reference), samples_(seed_samples(all)) {}

    void render(const Render& render, ArmReadings& arm, std::vector<Largest>& largest,
        std::vector<std::vector<Largest>>& deviations) {
        y_.resize(render.size());
        parallel_for(std::size_t{0}, (y_.size() + chunk - 1) / chunk, [&](std::size_t c) {
            for (std::size_t i = c * chunk; i < std::min(y_.size(), (c + 1) * chunk); ++i) y_[i] = render.y(i);
        });
        std::vector<RegionReading> regions;
        for (std::size_t r = 0; r < all_.regions.size(); ++r) {
            regions.push_back(region(all_.regions[r], arm.film, largest[r]));
            spectrum(all_.regions[r], arm, arm.power[r]);
        }
        arm.regions.push_back(std::move(regions));
        const std::span<const float> values[] = {y_, render.r, render.g, render.b};
        for (std::size_t q = 0; q < all_.quantities; ++q) quantity(values[q], arm, q, deviations[q]);
        if (!arm.not_finite.empty()) arm.failed_groups.push_back(failed_groups(render, all_));
        arm.sampled.push_back(residuals(y_, arm.film, samples_));
    }

private:
    double y(std::size_t i) const { return static_cast<double>(y_[i]); }

    Part part(const PixelSet& set, std::size_t begin, const MeanFilm& film, float least) const {
        Part out;
        RegionReading& sum = out.sum;
        const std::size_t end = std::min(set.pixels.size(), begin + chunk);
        for (std::size_t k = begin; k < end; ++k) {
            const std::size_t i = set.pixels[k];
            const double spread = (y(i) - film.y()[i]) * (y(i) - film.y()[i]);
            sum.y += y(i), sum.spread += spread;
            double squared = spread;
            if (reference_) {
                const double ref = reference_->y()[i], e = y(i) - ref;
                squared = e * e;
                sum.mse += squared, sum.with_sum += e * static_cast<double>(film.count) * (film.y()[i] - ref);
                sum.fireflies += std::fabs(e) > plan_.firefly_k * ref;
                sum.relmse += squared / (ref * ref + epsilon);
                sum.mape += std::fabs(e) / (std::fabs(ref) + epsilon);
            }
            if (const auto x = static_cast<float>(squared); x > least) out.large.push_back(x);
        }
        return out;
    }

    RegionReading region(const PixelSet& set, const MeanFilm& film, Largest& largest) const {
        std::vector<Part> parts((set.pixels.size() + chunk - 1) / chunk);
        const float least = largest.least();
        parallel_for(
            std::size_t{0}, parts.size(), [&](std::size_t c) { parts[c] = part(set, c * chunk, film, least); });
        RegionReading out;
        for (const Part& p : parts) {
            out.y += p.sum.y, out.spread += p.sum.spread, out.mse += p.sum.mse, out.with_sum += p.sum.with_sum;
            out.relmse += p.sum.relmse, out.mape += p.sum.mape, out.fireflies += p.sum.fireflies;
            for (const float x : p.large) largest.add(x);
        }
        const double count = static_cast<double>(set.pixels.size());
        if (count == 0) return out;
        out.y /= count, out.spread /= count, out.mse /= count, out.with_sum /= count;
        out.relmse /= count, out.mape /= count;
        if (reference_ && plan_.trim > 0) trim(set, out);
        return out;
    }

    void trim(const PixelSet& set, RegionReading& out) const {
        std::vector<float> relative, absolute;
        for (const std::uint32_t i : set.pixels) {
            const double ref = reference_->y()[i], e = y(i) - ref;
            relative.push_back(static_cast<float>(e * e / (ref * ref + epsilon)));
            absolute.push_back(static_cast<float>(std::fabs(e) / (std::fabs(ref) + epsilon)));
        }
        out.relmse = trimmed_mean(relative, plan_.trim), out.mape = trimmed_mean(absolute, plan_.trim);
    }

    /// The error's spectrum: about the mean of the renders, which leaves (K - 1)/K of it, or about the reference.
    void spectrum(const PixelSet& set, const ArmReadings& arm, std::vector<double>& power) const {
        const MeanFilm* about = arm.film.count > 1 ? &arm.film : reference_;
        if (!set.box || !about) return;
        const double renders = static_cast<double>(arm.film.count);
        const double scale = arm.film.count > 1 ? std::sqrt(renders / (renders - 1)) : 1;
        add_spectrum(power, *set.box, [&](int x, int row) {
            const auto i =
                static_cast<std::size_t>(row) * static_cast<std::size_t>(all_.width) + static_cast<std::size_t>(x);
            return all_.bad[i] ? 0.0 : scale * (y(i) - about->y()[i]);
        });
    }

    /// Mean and largest squared deviations of one quantity in a region.
    double region(std::span<const float> values, const PixelSet& set, const MeanPlane& plane, Largest& largest) const {
        std::vector<QuantityPart> parts((set.pixels.size() + chunk - 1) / chunk);
        const float least = largest.least();
        parallel_for(std::size_t{0}, parts.size(), [&](std::size_t c) {
            for (std::size_t k = c * chunk; k < std::min(set.pixels.size(), (c + 1) * chunk); ++k) {
                const double value = static_cast<double>(values[set.pixels[k]]),
                             off = value - plane.mean[set.pixels[k]];
                parts[c].sum += value;
                if (const auto x = static_cast<float>(off * off); x > least) parts[c].large.push_back(x);
            }
        });
        double sum = 0;
        for (const QuantityPart& p : parts) {
            sum += p.sum;
            for (const float x : p.large) largest.add(x);
        }
        return sum / static_cast<double>(set.pixels.size());
    }

    /// A pixel's deviation that would be an outlier among its K (Grubbs 1950) is a rare event: noise that one sample in
    /// many brings. The largest of them bounds what renders that met none may have missed.
    TileReading tile(
        std::span<const float> values, const Box& box, const MeanPlane& plane, double lone, Outliers& rare) const {
        TileReading out;
        double pixels = 0;
        for (int j = box.y0; j <= box.y1; ++j) {
            for (int x = box.x0; x <= box.x1; ++x) {
                const auto i =
                    static_cast<std::size_t>(j) * static_cast<std::size_t>(all_.width) + static_cast<std::size_t>(x);
                if (all_.bad[i]) continue;
                const double value = static_cast<double>(values[i]), off = value - plane.mean[i], spread = off * off;
                out.mean += value, out.spread += spread, pixels += 1;
                out.largest = std::max(out.largest, spread);
                if (spread < lone * plane.m2[i]) continue;
                rare.rise = std::max(rare.rise, off), rare.fall = std::max(rare.fall, -off);
            }
        }
        out.mean /= pixels, out.spread /= pixels, out.largest /= pixels;
        return out;
    }

    void quantity(std::span<const float> values, ArmReadings& arm, std::size_t q, std::vector<Largest>& largest) const {
        const MeanPlane& plane = arm.film.of(q);
        QuantityReadings& to = arm.quantities[q];
        std::vector<double> means;
        for (std::size_t r = 0; r < all_.regions.size(); ++r)
            means.push_back(region(values, all_.regions[r], plane, largest[r]));
        to.regions.push_back(std::move(means));
        std::vector<TileReading> tiles(all_.tiles.count());
        std::vector<Outliers> rare(tiles.size());
        const double lone = lone_share(arm.film.count);
        parallel_for(std::size_t{0}, tiles.size(), [&](std::size_t t) {
            tiles[t] = tile(values, all_.tiles.box(t, all_.width, all_.height), plane, lone, rare[t]);
        });
        to.tiles.push_back(std::move(tiles));
        for (const Outliers& o : rare) to.rise = std::max(to.rise, o.rise), to.fall = std::max(to.fall, o.fall);
    }

    const ComparePlan& plan_;
    const Readings& all_;
    const MeanFilm* reference_;
    const SeedSamples samples_;
    std::vector<float> y_;
};

}  // namespace

void second_pass(const ComparePlan& plan, const Readings& all, const RenderSource& source, ArmReadings& arm,
    const std::string& layer, const MeanFilm* reference, ProgressMonitor& monitor) {
    SecondPass pass(plan, all, reference);
    std::vector<Largest> largest;
    for (const PixelSet& set : all.regions) largest.emplace_back(tail_length(set.pixels.size() * arm.files.size()) + 1);
    std::vector<std::vector<Largest>> deviations(all.quantities, largest);
    arm.power.assign(all.regions.size(), {});
    arm.quantities.assign(all.quantities, {});
    std::vector<std::string> paths;
    for (const RenderFile& file : arm.files) paths.push_back(file.path);
    each_render(
        source, paths, layer, monitor, [&](const Render& render) { pass.render(render, arm, largest, deviations); });
    for (const Largest& values : largest) arm.largest.push_back(values.falling());
    for (std::size_t q = 0; q < all.quantities; ++q)
        for (const Largest& values : deviations[q]) arm.quantities[q].largest.push_back(values.falling());
}

}  // namespace crescent::inline comparing
