// A kernel returns sums over a tile's shading points for each sample count; this file turns them into pixels. Threads
// take tiles in any order and write to separate pixels, so the bits do not depend on the number of threads.
#include "render/estimator.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <vector>

#include "base/errors.h"
#include "base/parallel.h"
#include "base/vec.h"
#include "render/combination.h"
#include "render/technique.h"

namespace crescent {

namespace {

void run_kernel(const std::string& isa, const SamplerRef& arm, KernelCall call) {
    std::vector<std::byte> memory(call.shading_points->kernel_memory());
    call.memory = memory.data();
    if (const Combination* combination = combination_of(arm.outside))
        return estimate_combination(*combination, call, isa);
    if (arm.outside) return estimate_external(*arm.outside, call);
    const int index = arm_index(arm.sampler);
    ensure(index >= 0, "the parser lets only known samplers through");
    kernels_for(isa).kernel(index, *call.shading_points)(call);
}

/// The mean radiance of shading points over n samples.
class MeanRadiance {
public:
    static constexpr std::size_t longest = 64;  // points of a call: a row of a tile
    using Means = std::array<std::array<double, longest>, 3>;

    MeanRadiance(const Scene& scene, const ShadingPoints& shading_points, const Moments& m, std::uint64_t n)
        : scene_(scene),
          shading_points_(shading_points),
          m_(m),
          n_(static_cast<double>(n)),
          is_power_of_2_(std::has_single_bit(n)) {}

    /// Divides `count` sums by n, by the faster product if that has the same bits.
    void over_n(double* __restrict sums, std::size_t count) const {
        if (is_power_of_2_)
            for (std::size_t i = 0; i < count; ++i) sums[i] *= inverse_n_;
        else
            for (std::size_t i = 0; i < count; ++i) sums[i] /= n_;
    }

    /// Of points first to first + count, by colour channel.
    void operator()(std::size_t first, std::size_t count, Means& out) const {
        Means diffuse{}, lobe{};
        add_lights(first, count, m_.g, m_.light_g, m_.around_g, m_.around_rgb, diffuse);
        add_lights(first, count, m_.g_lobe, m_.light_g_lobe, m_.around_g_lobe, m_.around_rgb_lobe, lobe);
        for (std::size_t c = 0; c < 3; ++c) {
            for (std::size_t i = 0; i < count; ++i) {
                const std::size_t index = first + i;
                const double lobes = shading_points_.rho_s_exact[index] * (shading_points_.tint[index][c] * lobe[c][i]);
                out[c][i] = shading_points_.lambert[index][c] * diffuse[c][i] + lobes;
            }
            over_n(out[c].data(), count);
        }
    }

private:
    using Sums = std::vector<double>;

    /// Adds the light of each emitter, and of the fill where no other is met.
    void add_lights(std::size_t first, std::size_t count, const Sums& g, const std::vector<Sums>& light_g,
        const Sums& around_g, const std::array<Sums, 3>& around_rgb, Means& out) const {
        std::array<double, longest> fill_g;
        std::copy_n(g.data() + first, count, fill_g.data());
        const auto subtract = [&](const double* __restrict from) {
            for (std::size_t i = 0; i < count; ++i) fill_g[i] -= from[i];
        };
        const auto add = [&](std::size_t c, double radiance, const double* __restrict from) {
            for (std::size_t i = 0; i < count; ++i) out[c][i] += radiance * from[i];
        };
        for (std::size_t k = 0; k < light_g.size(); ++k) {
            subtract(light_g[k].data() + first);
            for (std::size_t c = 0; c < 3; ++c) add(c, scene_.lights()[k].radiance[c], light_g[k].data() + first);
        }
        if (shading_points_.around) {
            subtract(around_g.data() + first);
            for (std::size_t c = 0; c < 3; ++c) add(c, 1, around_rgb[c].data() + first);
        }
        for (std::size_t i = 0; i < count; ++i) fill_g[i] = fill_g[i] < 0 ? 0 : fill_g[i];
        for (std::size_t c = 0; c < 3; ++c) add(c, scene_.fill()[c], fill_g.data());
    }

    const Scene& scene_;
    const ShadingPoints& shading_points_;
    const Moments& m_;
    double n_, inverse_n_ = 1 / n_;
    bool is_power_of_2_;
};

/// Returns how many points from `first` on are next to each other in the image, at most `limit`.
std::size_t run_length(const ShadingPoints& points, std::size_t first, std::size_t limit) {
    const std::size_t last = std::min(points.count, first + limit);
    std::size_t end = first + 1;
    while (end < last && points.pixel[end] == points.pixel[end - 1] + 1) ++end;
    return end - first;
}

}  // namespace

SampleCost cost_of_sample(const SamplerRef& arm) {
    const Combination* combination = combination_of(arm.outside);
    if (combination) return combination->cost();
    const std::uint64_t directions = directions_per_sample(arm.sampler);
    return {directions, directions, directions - 1};
}

void resolve_film(const Scene& scene, const ShadingPoints& shading_points, const Moments& m, Film& film) {
    const MeanRadiance mean_of(scene, shading_points, m, film.n);
    const double n = static_cast<double>(film.n);
    MeanRadiance::Means mean;
    std::array<double, MeanRadiance::longest> squares, y;
    for (std::size_t first = 0, count; first < shading_points.count; first += count) {
        count = run_length(shading_points, first, MeanRadiance::longest);
        const std::size_t pixel = shading_points.pixel[first];
        mean_of(first, count, mean);
        std::copy_n(m.spread.data() + first, count, squares.data());
        mean_of.over_n(squares.data(), count);
        for (std::size_t i = 0; i < count; ++i) y[i] = luminance(Rgb{mean[0][i], mean[1][i], mean[2][i]});
        const auto store = [&](std::vector<float>& plane, const auto& value) {
            float* const to = plane.data() + pixel;
            for (std::size_t i = 0; i < count; ++i) to[i] = static_cast<float>(value(i));
        };
        store(film.r, [&](std::size_t i) { return mean[0][i]; });
        store(film.g, [&](std::size_t i) { return mean[1][i]; });
        store(film.b, [&](std::size_t i) { return mean[2][i]; });
        store(film.y, [&](std::size_t i) { return y[i]; });
        store(film.second_moment, [&](std::size_t i) { return squares[i] + y[i] * y[i]; });
        store(film.var, [&](std::size_t i) { return film.n > 1 ? m.spread[first + i] / (n * (n - 1)) : 0; });
        std::copy_n(m.largest.data() + first, count, film.largest.data() + pixel);
        std::copy_n(m.horizon.data() + first, count, film.horizon.data() + pixel);
        std::copy_n(m.hits.data() + first, count, film.light_hits.data() + pixel);
    }
}

void store_background(Film& film, std::size_t index, const Rgb& radiance) {
    const double y = luminance(radiance);
    film.r[index] = static_cast<float>(radiance[0]);
    film.g[index] = static_cast<float>(radiance[1]);
    film.b[index] = static_cast<float>(radiance[2]);
    film.y[index] = static_cast<float>(y);
    film.second_moment[index] = static_cast<float>(y * y);
}

Rgb mean_radiance(
    const Scene& scene, const ShadingPoints& shading_points, const Moments& moments, std::uint64_t n, std::size_t i) {
    MeanRadiance::Means mean;
    MeanRadiance(scene, shading_points, moments, n)(i, 1, mean);
    return {mean[0][0], mean[1][0], mean[2][0]};
}

void for_each_tile(
    const std::vector<TileBox>& tiles, ProgressMonitor& monitor, const std::function<double(std::size_t)>& work) {
    parallel_for(std::size_t{0}, tiles.size(), [&](std::size_t k) {
        if (monitor.stop.load(std::memory_order_relaxed)) return;
        const double units = work(k);
        if (monitor.stop.load(std::memory_order_relaxed)) return;  // the tile may be incomplete
        monitor.advance(units);
    });
    monitor.check();
}

std::vector<Film> estimate_films(const TiledScene& view, const SamplerRef& arm, const std::vector<std::uint64_t>& n,
    std::uint32_t seed, const std::string& isa, ProgressMonitor& monitor) {
    const Image& image = view.scene().image();
    const std::vector<TileBox>& tiles = view.tiles();
    std::vector<Film> films(n.size());
    parallel_for(std::size_t{0}, n.size(), [&](std::size_t r) {
        films[r] = Film(image.width, image.height, n[r]);
        films[r].directions = cost_of_sample(arm).directions;
        films[r].evaluations = cost_of_sample(arm).f;
    });
    std::vector<std::vector<std::uint64_t>> bad(n.size(), std::vector<std::uint64_t>(tiles.size()));
    PerThread<std::vector<Moments>> scratch(
        [&] { return std::vector<Moments>(n.size()); });  // reused by all tiles of a thread
    for_each_tile(tiles, monitor, [&](std::size_t k) {
        std::vector<Moments>& moments = scratch.local();
        double samples = 0;
        const std::shared_ptr<const TiledScene::Points> groups = view.points(k);
        for (const ShadingPoints& shading_points : *groups) {
            for (Moments& m : moments) m.resize(shading_points);
            run_kernel(isa, arm,
                {.shading_points = &shading_points,
                    .sample_counts = n,
                    .seed = seed,
                    .out = moments,
                    .stop = &monitor.stop,
                    .samples = nullptr});
            for (std::size_t r = 0; r < n.size(); ++r) {
                resolve_film(view.scene(), shading_points, moments[r], films[r]);
                bad[r][k] += std::accumulate(moments[r].bad.begin(),
                    moments[r].bad.begin() + static_cast<std::ptrdiff_t>(shading_points.count), std::uint64_t{0});
            }
            samples += static_cast<double>(shading_points.count) * static_cast<double>(n.back());
        }
        for_each_background(view.scene(), tiles[k], [&](std::uint32_t pixel, const Rgb& radiance) {
            for (Film& film : films) store_background(film, pixel, radiance);
        });
        return samples;
    });
    for (std::size_t r = 0; r < n.size(); ++r)
        films[r].invalid = std::accumulate(bad[r].begin(), bad[r].end(), std::uint64_t{0});
    return films;
}

ShapeMap shape_map(const Scene& scene) {
    const Image& image = scene.image();
    ShapeMap map{image.width, image.height, {}};
    map.shape.assign(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height), -1);
    parallel_for(0, image.height, [&](int j) {
        for (int i = 0; i < image.width; ++i)
            if (const auto hit = scene.primary(i, j))
                map.shape[static_cast<std::size_t>(j) * static_cast<std::size_t>(image.width) +
                    static_cast<std::size_t>(i)] = static_cast<std::int16_t>(hit->shape);
    });
    return map;
}

std::vector<Moments> estimate_points(const ShadingPoints& shading_points, const SamplerRef& arm,
    std::span<const std::uint64_t> n, std::uint32_t seed, const std::string& isa, const std::atomic<bool>* stop,
    float* samples) {
    std::vector<Moments> moments(n.size());
    for (Moments& m : moments) m.resize(shading_points);
    run_kernel(isa, arm,
        {.shading_points = &shading_points,
            .sample_counts = n,
            .seed = seed,
            .out = moments,
            .stop = stop,
            .samples = samples});
    return moments;
}

Moments estimate_points(const ShadingPoints& shading_points, const SamplerRef& arm, std::uint64_t n, std::uint32_t seed,
    const std::string& isa, const std::atomic<bool>* stop, float* samples) {
    const std::array<std::uint64_t, 1> counts = {n};
    return std::move(estimate_points(shading_points, arm, counts, seed, isa, stop, samples)[0]);
}

namespace {

/// Keeps the largest `count` values of all threads; the result does not depend on their order.
class Largest {
public:
    explicit Largest(std::size_t count) : count_(count) {}

    /// Changes `samples`. Drops NaN, which the kernels count.
    void add(std::vector<float>& samples) {
        const float threshold = threshold_.load(std::memory_order_relaxed);
        const std::size_t count = samples.size();
        std::erase_if(samples, [threshold](float x) { return !(x > threshold); });
        const Guard guard(lock_);
        sample_count_ += count;
        values_.insert(values_.end(), samples.begin(), samples.end());
        if (values_.size() <= count_) return;
        const auto last = values_.begin() + static_cast<std::ptrdiff_t>(count_) - 1;
        std::nth_element(values_.begin(), last, values_.end(), std::greater<>());
        values_.resize(count_);
        threshold_.store(values_.back(), std::memory_order_relaxed);
    }

    std::uint64_t sample_count() const { return sample_count_; }
    std::vector<float> in_order() && {
        std::sort(values_.begin(), values_.end(), std::greater<>());
        return std::move(values_);
    }

private:
    std::size_t count_;
    Mutex lock_;
    // Values up to this one are no longer among the largest.
    std::atomic<float> threshold_ = -std::numeric_limits<float>::infinity();
    std::vector<float> values_;
    std::uint64_t sample_count_ = 0;
};

/// Keeps the samples of points on one surface, n for each point.
void keep_surface(const ShadingPoints& points, int surface, std::uint64_t n, std::vector<float>& samples) {
    auto end = samples.begin();
    for (std::size_t i = 0; i < points.count; ++i)
        if (static_cast<int>(points.shape[i]) == surface)
            end = std::copy_n(samples.begin() + static_cast<std::ptrdiff_t>(i * n), n, end);
    samples.erase(end, samples.end());
}

}  // namespace

std::vector<float> largest_samples(const Scene& scene, const SamplerRef& arm, std::uint64_t n, std::uint32_t seed,
    const Area& area, std::size_t count, const std::string& isa, ProgressMonitor& monitor,
    std::uint64_t& sample_count) {
    const Box& box = area.box;
    std::vector<TileBox> tiles;
    for (const TileBox& t : tiles_of(box.width(), box.height()))
        tiles.push_back({box.x0 + t.x0, box.y0 + t.y0, box.x0 + t.x1, box.y0 + t.y1});
    Largest largest(count);
    parallel_for(std::size_t{0}, tiles.size(), [&](std::size_t k) {
        for (const ShadingPoints& shading_points : shading_points_of(scene, tiles[k], nullptr)) {
            if (monitor.stop.load(std::memory_order_relaxed)) return;
            std::vector<float> samples(shading_points.count * n);
            estimate_points(shading_points, arm, n, seed, isa, &monitor.stop, samples.data());
            if (area.surface != any_surface) keep_surface(shading_points, area.surface, n, samples);
            largest.add(samples);
        }
    });
    monitor.check();
    sample_count = largest.sample_count();
    return std::move(largest).in_order();
}

}  // namespace crescent

// ---- Fetches the draws of many shading points in one batch and passes them to the scalar kernel one by one; an
// unusable draw becomes a NaN pdf, which kernels count as bad.

#include "render/point_kernel.h"

namespace crescent {

namespace {

/// The arm of the kernels: hands out what was drawn, sample after sample.
template <class F> struct Prefetched {
    mutable const Drawn<F>* next;
    explicit Prefetched(const Drawn<F>* first) : next(first) {}
    Drawn<F> sample(Vec3<F> /*wo*/, Vec2<F> /*u*/) const { return *next++; }
};

Drawn<float> usable(const Draw& draw) {
    if (draw.pdf == 0) return {{0, 0, 1}, {0}};
    if (!is_usable(draw.wi, draw.pdf)) return {{0, 0, 1}, {std::numeric_limits<float>::quiet_NaN()}};
    return {as<float>(draw.wi), {static_cast<float>(draw.pdf)}};
}

/// Appends the random numbers of `n` samples of a pixel from `first` on, `count` per sample. The first two are those of
/// every built-in sampler; the rest come from blocks that no built-in sampler uses.
void add_numbers(std::uint32_t pixel, std::uint32_t seed, std::uint64_t first, std::uint64_t n, std::size_t count,
    std::vector<double>& u) {
    const std::size_t from = u.size();
    u.resize(from + n * count);
    for (std::size_t k = 0; k < count; k += 2) {
        const auto block = static_cast<std::uint32_t>(k == 0 ? 0 : k / 2 + 1);
        double* row = &u[from + k];
        const auto put = [&](std::uint32_t x, std::uint32_t y) {
            row[0] = static_cast<double>(unit_float<float>(x));
            if (k + 1 < count) row[1] = static_cast<double>(unit_float<float>(y));
            row += count;
        };
        for (std::uint64_t j = first; j < first + n;) {  // like crescent::draw(): two samples from one hash
            const auto h = draws<std::uint32_t>(pixel, static_cast<std::uint32_t>(j >> 1), block, seed);
            if (!(j & 1)) {
                put(h.x, h.y);
                ++j;
            }
            if (j < first + n) {
                put(h.z, h.w);
                ++j;
            }
        }
    }
}

}  // namespace

void estimate_external(const SamplerAdapter& sampler, const KernelCall& call) {
    const SamplerDeclaration declaration = sampler.declaration();
    const ShadingPoints& shading_points = *call.shading_points;
    const std::uint64_t n = call.sample_counts.back();
    const auto numbers = static_cast<std::size_t>(declaration.traits.own_numbers());
    const PointKernel<Prefetched<float>> kernel = point_kernel<Prefetched<float>>(shading_points);
    // The same batches for any number of threads; a shading point of more samples is fetched in parts.
    const std::uint64_t longest_batch = declaration.batch_rows;
    const std::uint64_t points_a_batch = std::max<std::uint64_t>(1, longest_batch / n);
    const std::vector<SceneLight> lights =
        declaration.uses_lights() ? lights_of(shading_points) : std::vector<SceneLight>{};
    std::vector<SurfaceRun> runs;
    std::vector<LightAtPoint> lights_at;
    std::vector<double> u;
    std::vector<Draw> draws;
    std::vector<Drawn<float>> directions;
    for (std::size_t i = 0; i < shading_points.count; i += points_a_batch) {
        const std::size_t end = std::min<std::size_t>(shading_points.count, i + points_a_batch);
        directions.clear();
        for (std::uint64_t first = 0; first < n; first += longest_batch) {
            if (call.stop && call.stop->load(std::memory_order_relaxed)) return;
            const std::uint64_t count = std::min(longest_batch, n - first);
            runs.clear();
            u.clear();
            lights_at.clear();
            for (std::size_t index = i; index < end; ++index) {
                const Vec3<double> wo{double(shading_points.wox[index]), double(shading_points.woy[index]),
                    double(shading_points.woz[index])};
                runs.push_back(run_at(shading_points, index, wo, static_cast<std::size_t>(count)));
                if (!lights.empty()) add_lights_at(shading_points, index, lights_at);
                add_numbers(shading_points.pixel[index], call.seed, first, count, numbers, u);
            }
            draws.resize(runs.size() * count);
            const SceneRows scene{.runs = runs, .lights = lights, .lights_at = lights_at};
            sampler.evaluate(
                {.kind = SamplerQuery::Kind::sample, .u = {u, numbers}, .scene = &scene}, {.draws = draws});
            for (const Draw& draw : draws) directions.push_back(usable(draw));
        }
        for (std::size_t index = i; index < end; ++index)
            kernel(call, index, Prefetched<float>(directions.data() + (index - i) * n));
    }
}

}  // namespace crescent
