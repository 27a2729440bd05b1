// Second pass: with means known, what each render says of each region and tile. Sums run over chunks of pixels and
// rows of tiles, which are merged in their order: equal on any number of threads.
#include "compare/second_pass.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/parallel.h"
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

class SecondPass {
public:
    SecondPass(const ComparePlan& plan, const Readings& all, const MeanFilm* reference)
        : plan_(plan), all_(all), reference_(reference) {}

    void render(const Render& render, ArmReadings& arm, std::vector<Largest>& largest) {
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
        arm.tiles.push_back(tiles(arm));
    }

private:
    double y(std::size_t i) const { return static_cast<double>(y_[i]); }

    Part part(const PixelSet& set, std::size_t begin, const MeanFilm& film, float least) const {
        Part out;
        RegionReading& sum = out.sum;
        const std::size_t end = std::min(set.pixels.size(), begin + chunk);
        for (std::size_t k = begin; k < end; ++k) {
            const std::size_t i = set.pixels[k];
            const double spread = (y(i) - film.y[i]) * (y(i) - film.y[i]);
            sum.y += y(i), sum.spread += spread;
            double squared = spread;
            if (reference_) {
                const double ref = reference_->y[i], e = y(i) - ref;
                squared = e * e;
                sum.mse += squared, sum.with_sum += e * static_cast<double>(film.count) * (film.y[i] - ref);
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
        out.y /= count, out.spread /= count, out.mse /= count, out.with_sum /= count;
        out.relmse /= count, out.mape /= count;
        if (reference_ && plan_.trim > 0) trim(set, out);
        return out;
    }

    void trim(const PixelSet& set, RegionReading& out) const {
        std::vector<float> relative, absolute;
        for (const std::uint32_t i : set.pixels) {
            const double ref = reference_->y[i], e = y(i) - ref;
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
            return all_.bad[i] ? 0.0 : scale * (y(i) - about->y[i]);
        });
    }

    /// A pixel's deviation that would be an outlier among its K (Grubbs 1950) is a rare event: noise that one sample in
    /// many brings. The largest of them bounds what renders that met none may have missed.
    TileReading tile(const Box& box, const MeanFilm& film, double lone, double& rare) const {
        TileReading out;
        double pixels = 0;
        for (int j = box.y0; j <= box.y1; ++j) {
            for (int x = box.x0; x <= box.x1; ++x) {
                const auto i =
                    static_cast<std::size_t>(j) * static_cast<std::size_t>(all_.width) + static_cast<std::size_t>(x);
                if (all_.bad[i]) continue;
                const double off = y(i) - film.y[i], spread = off * off;
                out.y += y(i), out.spread += spread, pixels += 1;
                out.largest = std::max(out.largest, spread);
                if (off > 0 && spread >= lone * film.m2[i]) rare = std::max(rare, off);
            }
        }
        out.y /= pixels, out.spread /= pixels, out.largest /= pixels;
        return out;
    }

    std::vector<TileReading> tiles(ArmReadings& arm) const {
        std::vector<TileReading> out(all_.tiles.count());
        std::vector<double> rare(out.size());
        const double lone = lone_share(arm.film.count);
        parallel_for(std::size_t{0}, out.size(),
            [&](std::size_t t) { out[t] = tile(all_.tiles.box(t, all_.width, all_.height), arm.film, lone, rare[t]); });
        arm.rare_event = std::max(arm.rare_event, *std::max_element(rare.begin(), rare.end()));
        return out;
    }

    const ComparePlan& plan_;
    const Readings& all_;
    const MeanFilm* reference_;
    std::vector<float> y_;
};

}  // namespace

void second_pass(
    const ComparePlan& plan, Readings& all, ArmReadings& arm, const std::string& layer, ProgressMonitor& monitor) {
    const MeanFilm* reference = all.reference && &*all.reference != &arm ? &all.reference->film : nullptr;
    SecondPass pass(plan, all, reference);
    std::vector<Largest> largest;
    for (const PixelSet& set : all.regions) largest.emplace_back(tail_length(set.pixels.size() * arm.files.size()) + 1);
    arm.power.assign(all.regions.size(), {});
    std::vector<std::string> paths;
    for (const RenderFile& file : arm.files) paths.push_back(file.path);
    each_render(all.source, paths, layer, monitor, [&](const Render& render) { pass.render(render, arm, largest); });
    for (const Largest& values : largest) arm.largest.push_back(values.falling());
}

}  // namespace crescent::inline comparing
