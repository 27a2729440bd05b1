// First pass: reads every render, checks it against the others and adds it to its arm's mean.
#include "compare/passes.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <functional>
#include <span>

#include "base/parallel.h"
#include "compare/file_pattern.h"
#include "compare/file_warnings.h"
#include "compare/moments_reading.h"
#include "compare/noise.h"
#include "compare/renders.h"
#include "compare/shared_seeds.h"
#include "math/statistics.h"
#include "output/format.h"

namespace crescent {

Tiles::Tiles(int width, int height) {
    const double side = std::sqrt(static_cast<double>(width) * height / 512);
    size = std::max(8, static_cast<int>(std::ceil(side)));
    across = (width + size - 1) / size;
    down = (height + size - 1) / size;
}

Box Tiles::box(std::size_t tile, int width, int height) const {
    const int i = static_cast<int>(tile) % across * size, j = static_cast<int>(tile) / across * size;
    return {i, j, std::min(width, i + size) - 1, std::min(height, j + size) - 1};
}

namespace {

constexpr const char* not_finite = "not finite: left out of every metric";

std::vector<std::string> matching(const std::string& pattern, const SourceLocation& place) {
    std::error_code ignored;
    if (std::filesystem::exists(pattern, ignored)) return {pattern};  // "render[1].exr" may be a name
    std::vector<std::string> paths;
    for (MatchedFile& file : FilePattern(pattern, place, false).find()) paths.push_back(std::move(file.path));
    return paths;
}

}  // namespace

std::vector<std::string> expand(const std::vector<std::string>& patterns, const SourceLocation& place) {
    std::vector<std::string> out;
    for (const std::string& pattern : patterns) {
        const std::vector<std::string> paths = matching(pattern, place);
        if (paths.empty()) throw InputError(place, fmt::format("expected files that match '{}', found none", pattern));
        out.insert(out.end(), paths.begin(), paths.end());
    }
    std::sort(out.begin(), out.end());
    for (std::size_t i = 1; i < out.size(); ++i)
        if (out[i] == out[i - 1]) throw InputError(place, fmt::format("the file '{}' is named twice", out[i]));
    return out;
}

namespace {

std::vector<std::uint64_t> numbers_in(const std::string& path) {
    // With the folders, whose names may contain seeds.
    const std::string name = std::filesystem::path(path).replace_extension().string();
    std::vector<std::uint64_t> out;
    for (std::size_t i = 0; i < name.size();) {
        if (name[i] < '0' || name[i] > '9') {
            ++i;
            continue;
        }
        std::uint64_t value = 0;
        for (; i < name.size() && name[i] >= '0' && name[i] <= '9'; ++i)
            value = value * 10 + static_cast<std::uint64_t>(name[i] - '0');
        out.push_back(value);
    }
    return out;
}

}  // namespace

void FirstPass::arm(ArmStats& to, const std::vector<std::string>& files, const std::string& layer,
    const std::string& name, const std::optional<double>& spp) {
    each_render(stats_.source, files, layer, monitor_, [&](const Render& render) {
        fit(render);
        check_pixels(render, to);
        count_clipped(render);
        RenderFile file{render.file, fmt::format("{:016x}", render.hash), render.layer, render.variance_channels,
            render.sample_channel, render.spp, render.seconds, numbers_in(render.file)};
        check_copy(file, name);
        const std::optional<double>& samples = spp ? spp : render.spp;
        if (render.per_sample && !samples)
            warnings_.add(render.file,
                fmt::format("{} is the variance of one sample, and their number is not stated: give --spp",
                    render.variance_channels));
        to.film.add(render, !render.per_sample ? 1 : samples ? 1 / *samples : 0);
        to.files.push_back(std::move(file));
    });
}

void FirstPass::moments(ArmStats& to, const std::string& path) {
    const Render picture = stats_.source.read(path, "");
    fit(picture);
    read_moments_film(path, picture.weights, stats_, to);
    monitor_.advance(1);
}

void FirstPass::fit(const Render& render) {
    if (stats_.bad.empty()) {
        stats_.width = render.width;
        stats_.height = render.height;
        stats_.bad.assign(render.size(), false);
    }
    ensure(render.width == stats_.width && render.height == stats_.height, "renders of a view have one size");
}

void FirstPass::check_pixels(const Render& render, ArmStats& to) {
    std::uint64_t bad = 0, negative = 0;
    for (std::size_t i = 0; i < render.size(); ++i) {
        const bool finite = render.is_finite(i);
        if (!finite) {
            if (to.not_finite.empty()) to.not_finite.assign(render.size(), 0);
            ++bad;
            stats_.bad[i] = true;
            ++to.not_finite[i];
        }
        negative += finite && (render.r[i] < 0 || render.g[i] < 0 || render.b[i] < 0);
    }
    for (const std::string& note : render.notes) warnings_.add(render.file, note);
    if (bad) warnings_.add(render.file, not_finite, bad);
    if (negative) warnings_.add(render.file, "with a negative channel", negative);
    if (render.size() > 1 && bad < render.size() && render.is_uniform())
        warnings_.add(render.file, "all pixels are equal");
}

/// A channel at the largest number of its file represents any larger value.
void FirstPass::count_clipped(const Render& render) {
    stats_.displayed |= render.displayed;
    stats_.display_referred |= render.display_referred;
    if (!render.display_referred) {  // a float file is not clipped
        stats_.clipped.assign(render.size(), false);
        return;
    }
    const bool is_first = stats_.clipped.empty();
    if (is_first) stats_.clipped.assign(render.size(), true);
    for (std::size_t i = 0; i < render.size(); ++i)
        if (!(render.r[i] >= 1 || render.g[i] >= 1 || render.b[i] >= 1)) stats_.clipped[i] = false;
}

void FirstPass::report_warnings() {
    stats_.warnings = warnings_.lines();
    stats_.bad_files = warnings_.line(not_finite);
    if (!stats_.display_referred) return;
    stats_.warnings.push_back(
        "The files are pictures for display: their tone curve may hide a change of radiance, or make it smaller.");
    const auto clipped = std::count(stats_.clipped.begin(), stats_.clipped.end(), true);
    if (clipped > 0)
        stats_.warnings.push_back(
            fmt::format("{} of the pixels are clipped in all renders: a change there cannot be seen.",
                percent(static_cast<double>(clipped) / static_cast<double>(stats_.clipped.size()), 2)));
}

void FirstPass::check_copy(const RenderFile& file, const std::string& arm) {
    const auto [entry, is_new] = paths_by_hash_.emplace(file.hash, std::pair{file.path, arm});
    if (is_new) return;
    const auto& [path, other_arm] = entry->second;
    if (other_arm == arm)
        throw InputError(
            {file.path, 0, 0}, fmt::format("the same pixels as {}: renders of an arm must be independent", path));
    warnings_.add(fmt::format("{} of {}", file.path, arm), fmt::format("the same pixels as {} of {}", path, other_arm),
        0, fmt::format("the same pixels as {}", other_arm));
}

// ---- Second pass: with the means known, the statistics of each render in each region and tile. Sums run over chunks
// of pixels and rows of tiles, which are merged in their order: equal results on any number of threads.

namespace {

constexpr double epsilon = 0.01;         // of relMSE and MAPE, as in Rousselle et al. 2011
constexpr std::size_t chunk = 1u << 15;  // pixels

/// Keeps the largest of many values.
class Largest {
public:
    explicit Largest(std::size_t keep) : keep_(keep) {}
    /// A value that is not larger is not kept.
    float limit() const { return heap_.size() < keep_ ? -1 : keep_ ? heap_.front() : HUGE_VALF; }
    void add(float x) {
        if (!(x > limit())) return;
        heap_.push_back(x);
        std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
        if (heap_.size() > keep_) {
            std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
            heap_.pop_back();
        }
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

/// Returns the mean of all but the largest `trim` of the values.
double trimmed_mean(std::vector<float>& values, double trim) {
    const auto keep = values.size() - static_cast<std::size_t>(trim * static_cast<double>(values.size()));
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(keep), values.end());
    double sum = 0;
    for (std::size_t i = 0; i < keep; ++i) sum += static_cast<double>(values[i]);
    return sum / static_cast<double>(keep);
}

/// Sums over one chunk of a region; errors above `limit` are kept for the tail.
struct Part {
    RegionStats sum;
    std::vector<float> large;
};

/// The same for one quantity; squared deviations from the mean are kept.
struct QuantityPart {
    double sum = 0;
    std::vector<float> large;
};

/// The largest deviation of a pixel from its mean over renders, of either sign.
struct Outliers {
    double rise = 0, fall = 0;
};

class SecondPass {
public:
    SecondPass(const ComparePlan& plan, const RenderStats& stats, const MeanFilm* reference)
        : plan_(plan), stats_(stats), reference_(reference), samples_(seed_samples(stats)) {}

    void render(const Render& render, ArmStats& arm, std::vector<Largest>& largest,
        std::vector<std::vector<Largest>>& deviations) {
        y_.resize(render.size());
        parallel_for(std::size_t{0}, (y_.size() + chunk - 1) / chunk, [&](std::size_t c) {
            for (std::size_t i = c * chunk; i < std::min(y_.size(), (c + 1) * chunk); ++i) y_[i] = render.y(i);
        });
        std::vector<RegionStats> regions;
        for (std::size_t r = 0; r < stats_.regions.size(); ++r) {
            regions.push_back(region(stats_.regions[r], arm.film, largest[r]));
            spectrum(stats_.regions[r], arm, arm.power[r]);
        }
        arm.regions.push_back(std::move(regions));
        const std::span<const float> values[] = {y_, render.r, render.g, render.b, render.alpha};
        if (stats_.quantities == 1) region_means<1>({values[0]}, arm, deviations);
        else if (stats_.quantities == most_quantities)
            region_means<most_quantities>({values[0], values[1], values[2], values[3], values[4]}, arm, deviations);
        else region_means<colour_quantities>({values[0], values[1], values[2], values[3]}, arm, deviations);
        for (std::size_t q = 0; q < stats_.quantities; ++q) tiles(values[q], arm, q);
        if (!arm.not_finite.empty()) arm.failed_groups.push_back(failed_groups(render, stats_));
        arm.sampled.push_back(residuals(y_, arm.film, samples_));
    }

private:
    double y(std::size_t i) const { return static_cast<double>(y_[i]); }

    Part part(const PixelSet& set, std::size_t begin, const MeanFilm& film, float limit) const {
        Part out;
        RegionStats& sum = out.sum;
        const std::size_t end = std::min(set.pixels.size(), begin + chunk);
        for (std::size_t k = begin; k < end; ++k) {
            const std::size_t i = set.pixels[k];
            const double spread = (y(i) - film.y()[i]) * (y(i) - film.y()[i]);
            sum.y += y(i);
            sum.spread += spread;
            double squared = spread;
            if (reference_) {
                const double ref = reference_->y()[i], e = y(i) - ref;
                squared = e * e;
                sum.mse += squared;
                sum.with_sum += e * static_cast<double>(film.count) * (film.y()[i] - ref);
                sum.fireflies += std::fabs(e) > plan_.firefly_k * ref;
                sum.relmse += squared / (ref * ref + epsilon);
                sum.mape += std::fabs(e) / (std::fabs(ref) + epsilon);
            }
            if (const auto x = static_cast<float>(squared); x > limit) out.large.push_back(x);
        }
        return out;
    }

    RegionStats region(const PixelSet& set, const MeanFilm& film, Largest& largest) const {
        std::vector<Part> parts((set.pixels.size() + chunk - 1) / chunk);
        const float limit = largest.limit();
        parallel_for(
            std::size_t{0}, parts.size(), [&](std::size_t c) { parts[c] = part(set, c * chunk, film, limit); });
        RegionStats out;
        for (const Part& p : parts) {
            out.y += p.sum.y;
            out.spread += p.sum.spread;
            out.mse += p.sum.mse;
            out.with_sum += p.sum.with_sum;
            out.relmse += p.sum.relmse;
            out.mape += p.sum.mape;
            out.fireflies += p.sum.fireflies;
            for (const float x : p.large) largest.add(x);
        }
        const double count = static_cast<double>(set.pixels.size());
        if (count == 0) return out;
        out.y /= count;
        out.spread /= count;
        out.mse /= count;
        out.with_sum /= count;
        out.relmse /= count;
        out.mape /= count;
        if (reference_ && plan_.trim > 0) trim(set, out);
        return out;
    }

    void trim(const PixelSet& set, RegionStats& out) const {
        std::vector<float> relative, absolute;
        for (const std::uint32_t i : set.pixels) {
            const double ref = reference_->y()[i], e = y(i) - ref;
            relative.push_back(static_cast<float>(e * e / (ref * ref + epsilon)));
            absolute.push_back(static_cast<float>(std::fabs(e) / (std::fabs(ref) + epsilon)));
        }
        out.relmse = trimmed_mean(relative, plan_.trim);
        out.mape = trimmed_mean(absolute, plan_.trim);
    }

    /// The spectrum of the error: about the mean of the renders, rescaled because this mean removes 1/K of it, or about
    /// the reference.
    void spectrum(const PixelSet& set, const ArmStats& arm, std::vector<double>& power) const {
        const MeanFilm* centre = arm.film.count > 1 ? &arm.film : reference_;
        if (!set.box || !centre) return;
        const double renders = static_cast<double>(arm.film.count);
        const double scale = arm.film.count > 1 ? std::sqrt(renders / (renders - 1)) : 1;
        add_spectrum(
            power, *set.box,
            [&](int x, int row) {
                const auto i = static_cast<std::size_t>(row) * static_cast<std::size_t>(stats_.width) +
                    static_cast<std::size_t>(x);
                return stats_.bad[i] ? 0.0 : scale * (y(i) - centre->y()[i]);
            },
            plan_.spectrum_blocks);
    }

    /// Returns the means of all quantities in a region and collects their largest squared deviations; all quantities
    /// are summed in one loop over the pixels, which hides the latency of the additions.
    template <std::size_t count>
    std::array<double, count> region(const std::array<std::span<const float>, count>& values, const PixelSet& set,
        const MeanFilm& film, const std::array<Largest*, count>& largest) const {
        std::vector<std::array<QuantityPart, count>> parts((set.pixels.size() + chunk - 1) / chunk);
        std::array<float, count> limits{};
        std::array<const double*, count> mean{};
        for (std::size_t q = 0; q < count; ++q) {
            limits[q] = largest[q]->limit();
            mean[q] = film.of(q).mean.data();
        }
        parallel_for(std::size_t{0}, parts.size(), [&](std::size_t c) {
            std::array<double, count> sum{};
            for (std::size_t k = c * chunk; k < std::min(set.pixels.size(), (c + 1) * chunk); ++k) {
                const std::size_t i = set.pixels[k];
                for (std::size_t q = 0; q < count; ++q) {
                    const double value = static_cast<double>(values[q][i]), deviation = value - mean[q][i];
                    sum[q] += value;
                    if (const auto x = static_cast<float>(deviation * deviation); x > limits[q])
                        parts[c][q].large.push_back(x);
                }
            }
            for (std::size_t q = 0; q < count; ++q) parts[c][q].sum = sum[q];
        });
        std::array<double, count> out{};
        for (const auto& part : parts)
            for (std::size_t q = 0; q < count; ++q) {
                out[q] += part[q].sum;
                for (const float x : part[q].large) largest[q]->add(x);
            }
        for (double& sum : out) sum /= static_cast<double>(set.pixels.size());
        return out;
    }

    /// A deviation of a pixel that is an outlier among its K values (Grubbs 1950) counts as a rare event: noise from
    /// one sample in many. The largest of them bounds the events that other renders may have missed.
    TileReading tile(
        std::span<const float> values, const Box& box, const MeanPlane& plane, double lone, Outliers& rare) const {
        TileReading out;
        double pixels = 0;
        for (int j = box.y0; j <= box.y1; ++j) {
            for (int x = box.x0; x <= box.x1; ++x) {
                const auto i =
                    static_cast<std::size_t>(j) * static_cast<std::size_t>(stats_.width) + static_cast<std::size_t>(x);
                if (stats_.bad[i]) continue;
                const double value = static_cast<double>(values[i]), deviation = value - plane.mean[i],
                             spread = deviation * deviation;
                out.mean += value;
                out.spread += spread;
                pixels += 1;
                out.largest = std::max(out.largest, spread);
                if (spread < lone * plane.m2[i]) continue;
                rare.rise = std::max(rare.rise, deviation);
                rare.fall = std::max(rare.fall, -deviation);
            }
        }
        out.mean /= pixels;
        out.spread /= pixels;
        out.largest /= pixels;
        return out;
    }

    template <std::size_t count> void region_means(const std::array<std::span<const float>, count>& values,
        ArmStats& arm, std::vector<std::vector<Largest>>& largest) const {
        for (std::size_t q = 0; q < count; ++q) arm.quantities[q].regions.emplace_back();
        for (std::size_t r = 0; r < stats_.regions.size(); ++r) {
            std::array<Largest*, count> of_region{};
            for (std::size_t q = 0; q < count; ++q) of_region[q] = &largest[q][r];
            const auto means = region<count>(values, stats_.regions[r], arm.film, of_region);
            for (std::size_t q = 0; q < count; ++q) arm.quantities[q].regions.back().push_back(means[q]);
        }
    }

    void tiles(std::span<const float> values, ArmStats& arm, std::size_t q) const {
        const MeanPlane& plane = arm.film.of(q);
        QuantityReadings& to = arm.quantities[q];
        std::vector<TileReading> readings(stats_.tiles.count());
        std::vector<Outliers> rare(readings.size());
        const double lone = lone_share(arm.film.count);
        parallel_for(std::size_t{0}, readings.size(), [&](std::size_t t) {
            readings[t] = tile(values, stats_.tiles.box(t, stats_.width, stats_.height), plane, lone, rare[t]);
        });
        to.tiles.push_back(std::move(readings));
        for (const Outliers& o : rare) {
            to.rise = std::max(to.rise, o.rise);
            to.fall = std::max(to.fall, o.fall);
        }
    }

    const ComparePlan& plan_;
    const RenderStats& stats_;
    const MeanFilm* reference_;
    const SeedSamples samples_;
    std::vector<float> y_;
};

}  // namespace

void second_pass(const ComparePlan& plan, const RenderStats& stats, const RenderSource& source, ArmStats& arm,
    const std::string& layer, const MeanFilm* reference, ProgressMonitor& monitor) {
    SecondPass pass(plan, stats, reference);
    std::vector<Largest> largest;
    for (const PixelSet& set : stats.regions)
        largest.emplace_back(tail_length(set.pixels.size() * arm.files.size()) + 1);
    std::vector<std::vector<Largest>> deviations(stats.quantities, largest);
    arm.power.assign(stats.regions.size(), {});
    arm.quantities.assign(stats.quantities, {});
    std::vector<std::string> paths;
    for (const RenderFile& file : arm.files) paths.push_back(file.path);
    each_render(
        source, paths, layer, monitor, [&](const Render& render) { pass.render(render, arm, largest, deviations); });
    for (const Largest& values : largest) arm.largest.push_back(values.falling());
    for (std::size_t q = 0; q < stats.quantities; ++q)
        for (const Largest& values : deviations[q]) arm.quantities[q].largest.push_back(values.falling());
}

}  // namespace crescent
