// Second pass: with means known, what each render says of each region and tile.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "compare/first_pass.h"
#include "compare/schema.h"
#include "compare/spectrum.h"
#include "meters/tail.h"

namespace crescent {

namespace {

constexpr double epsilon = 0.01;  // of relMSE and MAPE, as Rousselle et al. 2011 have it

/// The largest values of many, falling.
class Largest {
public:
    explicit Largest(std::size_t keep) : keep_(keep) {}
    void add(float x) {
        if (keep_ == 0 || (heap_.size() == keep_ && x <= heap_.front())) return;
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
double trimmed_mean(std::vector<double>& values, double trim) {
    const auto keep = values.size() - static_cast<std::size_t>(trim * static_cast<double>(values.size()));
    if (keep < values.size())
        std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(keep), values.end());
    double sum = 0;
    for (std::size_t i = 0; i < keep; ++i) sum += values[i];
    return sum / static_cast<double>(keep);
}

class SecondPass {
public:
    SecondPass(const ComparePlan& plan, const Readings& all, const MeanFilm* reference)
        : plan_(plan), all_(all), reference_(reference) {}

    void render(const Render& render, ArmReadings& arm, std::vector<Largest>& largest) const {
        y_.resize(render.size());
        for (std::size_t i = 0; i < y_.size(); ++i) y_[i] = static_cast<double>(render.y(i));
        std::vector<RegionReading> regions;
        for (std::size_t r = 0; r < all_.regions.size(); ++r) {
            regions.push_back(region(all_.regions[r], arm.film, largest[r]));
            spectrum(all_.regions[r], arm, arm.power[r]);
        }
        arm.regions.push_back(std::move(regions));
        arm.tiles.push_back(tiles(arm.film));
    }

private:
    RegionReading region(const PixelSet& set, const MeanFilm& film, Largest& largest) const {
        RegionReading out;
        std::vector<double> relative, absolute;
        const double count = static_cast<double>(set.pixels.size()), renders = static_cast<double>(film.count);
        for (const std::uint32_t i : set.pixels) {
            const double spread = (y_[i] - film.y[i]) * (y_[i] - film.y[i]);
            out.y += y_[i], out.spread += spread;
            if (!reference_) {
                largest.add(static_cast<float>(spread));
                continue;
            }
            const double ref = reference_->y[i], e = y_[i] - ref;
            out.mse += e * e;
            out.with_sum += e * renders * (film.y[i] - ref);
            out.fireflies += std::fabs(e) > plan_.firefly_k * ref;
            relative.push_back(e * e / (ref * ref + epsilon));
            absolute.push_back(std::fabs(e) / (std::fabs(ref) + epsilon));
            largest.add(static_cast<float>(e * e));
        }
        out.y /= count, out.spread /= count, out.mse /= count, out.with_sum /= count;
        if (reference_) out.relmse = trimmed_mean(relative, plan_.trim), out.mape = trimmed_mean(absolute, plan_.trim);
        return out;
    }

    /// The error's spectrum: about the mean of the renders, which leaves (K - 1)/K of it, or about the reference.
    void spectrum(const PixelSet& set, const ArmReadings& arm, std::vector<double>& power) const {
        const MeanFilm* about = arm.film.count > 1 ? &arm.film : reference_;
        if (!set.box || !about) return;
        const double renders = static_cast<double>(arm.film.count);
        const double scale = arm.film.count > 1 ? std::sqrt(renders / (renders - 1)) : 1;
        add_spectrum(power, *set.box, [&](int x, int y) {
            const auto i =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(all_.width) + static_cast<std::size_t>(x);
            return all_.bad[i] ? 0.0 : scale * (y_[i] - about->y[i]);
        });
    }

    std::vector<TileReading> tiles(const MeanFilm& film) const {
        std::vector<TileReading> out(all_.tiles.count());
        std::vector<double> pixels(out.size());
        for (int j = 0; j < all_.height; ++j) {
            for (int x = 0; x < all_.width; ++x) {
                const auto i =
                    static_cast<std::size_t>(j) * static_cast<std::size_t>(all_.width) + static_cast<std::size_t>(x);
                if (all_.bad[i]) continue;
                const std::size_t t = all_.tiles.of(x, j);
                const double spread = (y_[i] - film.y[i]) * (y_[i] - film.y[i]);
                out[t].y += y_[i], out[t].spread += spread, pixels[t] += 1;
                out[t].largest = std::max(out[t].largest, spread);
            }
        }
        for (std::size_t t = 0; t < out.size(); ++t)
            out[t].y /= pixels[t], out[t].spread /= pixels[t], out[t].largest /= pixels[t];
        return out;
    }

    const ComparePlan& plan_;
    const Readings& all_;
    const MeanFilm* reference_;
    mutable std::vector<double> y_;
};

void second_pass(const ComparePlan& plan, Readings& all, ArmReadings& arm, const std::string& layer, Watch& watch) {
    const MeanFilm* reference = all.reference && &*all.reference != &arm ? &all.reference->film : nullptr;
    const SecondPass pass(plan, all, reference);
    std::vector<Largest> largest;
    for (const PixelSet& set : all.regions) largest.emplace_back(tail_length(set.pixels.size() * arm.files.size()) + 1);
    arm.power.assign(all.regions.size(), {});
    for (const RenderFile& file : arm.files) {
        watch.check();
        pass.render(read_render(file.path, layer), arm, largest);
        watch.advance(1);
    }
    for (const Largest& values : largest) arm.largest.push_back(values.falling());
}

void add_set(Readings& all, PixelSet set, const Place& at) {
    std::erase_if(set.pixels, [&](std::uint32_t i) { return all.bad[i]; });
    if (set.pixels.empty()) throw InputError(at, fmt::format("the region '{}' has no finite pixel", set.name));
    all.regions.push_back(std::move(set));
}

PixelSet boxed(const std::string& name, const Box& box, int width) {
    PixelSet set{name, box, {}};
    for (int j = box.y0; j <= box.y1; ++j)
        for (int i = box.x0; i <= box.x1; ++i) set.pixels.push_back(static_cast<std::uint32_t>(j * width + i));
    return set;
}

void regions(const ComparePlan& plan, Readings& all) {
    for (const Region& r : plan.regions) {
        if (r.box.x1 >= all.width || r.box.y1 >= all.height)
            throw InputError(r.at,
                fmt::format("regions.{}.box: expected a box on the image, x from 0 to {} and y from 0 to {}, found "
                            "[{}, {}, {}, {}]",
                    r.name, all.width - 1, all.height - 1, r.box.x0, r.box.y0, r.box.x1, r.box.y1));
        add_set(all, boxed(r.name, r.box, all.width), r.at);
    }
    for (const MaskPlan& m : plan.masks) {
        const Render mask = read_render(m.file);
        if (mask.width != all.width || mask.height != all.height)
            throw InputError({m.file, 0, 0},
                fmt::format("expected {} x {} pixels as the renders have, found {} x {}", all.width, all.height,
                    mask.width, mask.height));
        PixelSet set{m.name, {}, {}};
        for (std::size_t i = 0; i < mask.size(); ++i)
            if (mask.y(i) > 0) set.pixels.push_back(static_cast<std::uint32_t>(i));
        add_set(all, std::move(set), m.at);
    }
    add_set(all, boxed(whole_frame, {0, 0, all.width - 1, all.height - 1}, all.width), {plan.file, 0, 0});
}

}  // namespace

Readings read_all(const ComparePlan& plan, Watch& watch) {
    Readings all;
    std::vector<std::vector<std::string>> files;
    std::size_t total = 0;
    for (const RenderArm& arm : plan.arms) files.push_back(expand(arm.files, arm.at)), total += files.back().size();
    const std::vector<std::string> reference =
        plan.reference.empty() ? std::vector<std::string>{} : expand(plan.reference, {plan.file, 0, 0});
    total += reference.size();
    watch.begin("first pass: means", static_cast<double>(total));
    FirstPass first(all, watch);
    all.arms.resize(plan.arms.size());
    for (std::size_t a = 0; a < plan.arms.size(); ++a)
        first.arm(all.arms[a], files[a], plan.arms[a].layer, plan.arms[a].name);
    if (!reference.empty()) first.arm(all.reference.emplace(), reference, plan.reference_layer, "the reference");
    all.tiles = Tiles(all.width, all.height);
    all.bad_pixels = static_cast<std::uint64_t>(std::count(all.bad.begin(), all.bad.end(), true));
    regions(plan, all);
    watch.begin("second pass: what each render says", static_cast<double>(total));
    for (std::size_t a = 0; a < plan.arms.size(); ++a) second_pass(plan, all, all.arms[a], plan.arms[a].layer, watch);
    if (all.reference) second_pass(plan, all, *all.reference, plan.reference_layer, watch);
    return all;
}

}  // namespace crescent
