// The value of a pixel is drawn from the stream of its render at the pixel's index, so each pixel can be computed
// alone. All kinds of noise have the mean 1 before the bias; rare events contribute a tenth of the radiance for any
// rate.
#include "tests/support/synthetic_renders.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <numbers>

#include "base/parallel.h"
#include "base/progress.h"
#include "base/vec.h"
#include "compare/compare.h"
#include "compare/plan.h"
#include "math/functions.h"
#include "math/simd/random.h"
#include "math/statistics.h"

namespace crescent {

namespace {

/// Standard normal (Box & Muller 1958).
double standard_normal(const Vec2<float>& u) {
    return std::sqrt(-2 * math::log(static_cast<double>(u.x))) *
        math::cos(2 * std::numbers::pi * static_cast<double>(u.y));
}

/// Gamma of mean 1 and this standard deviation, at most 1 (Marsaglia & Tsang 2000, "A Simple Method for Generating
/// Gamma Variables").
double gamma(double sd, std::uint32_t seed, std::uint32_t pixel) {
    const double shape = 1 / (sd * sd), d = shape - 1.0 / 3, c = 1 / std::sqrt(9 * d);
    for (std::uint32_t k = 0;; k += 2) {
        const double x = standard_normal(draw(seed, pixel, k)), v = (1 + c * x) * (1 + c * x) * (1 + c * x);
        if (v <= 0) continue;
        const auto u = static_cast<double>(draw(seed, pixel, k + 1).x);
        if (math::log(u) < x * x / 2 + d - d * v + d * math::log(v)) return d * v / shape;
    }
}

/// Returns whether a pixel is NaN, drawn from its own stream.
bool fails(const SyntheticNoise& noise, std::uint32_t seed, std::uint32_t pixel) {
    return noise.failing > 0 && static_cast<double>(draw(seed_of(seed, 4), pixel, 0).x) < noise.failing;
}

/// Averages over width x width pixels, periodic at the edges of the picture.
void filter(std::vector<float>& plane, int side, int width) {
    const auto at = [&](int x, int y) {
        return static_cast<std::size_t>((y + side) % side) * static_cast<std::size_t>(side) +
            static_cast<std::size_t>((x + side) % side);
    };
    const std::vector<float> from = plane;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            double sum = 0;
            for (int j = 0; j < width; ++j)
                for (int i = 0; i < width; ++i) sum += static_cast<double>(from[at(x - i, y - j)]);
            plane[at(x, y)] = static_cast<float>(sum / (width * width));
        }
}

}  // namespace

Render synthetic_render(
    const std::string& path, const SyntheticNoise& noise, std::uint32_t seed, const SyntheticScene& scene) {
    Render out(path, scene.width, scene.width);
    const double factors[] = {1 + noise.hue, 1, 1 - noise.hue * luminance_weights[0] / luminance_weights[2]};
    std::vector<float>* channels[] = {&out.r, &out.g, &out.b};
    for (std::uint32_t i = 0; i < out.size(); ++i) {
        const double shared = synthetic_pixel(noise, seed, i, scene.width);
        for (std::uint32_t c = 0; c < 3; ++c) {
            const double own = scene.own > 0 ? synthetic_pixel(noise, seed_of(seed, c + 1), i, scene.width) : 0;
            (*channels[c])[i] = static_cast<float>(factors[c] * ((1 - scene.own) * shared + scene.own * own));
        }
        if (fails(noise, seed, i)) out.g[i] = std::nanf("");
    }
    for (std::vector<float>* channel : channels)
        if (noise.filter > 1) filter(*channel, scene.width, noise.filter);
    return out;
}

namespace {

/// Returns the seed of the k-th render of arm a (0) or b (1).
std::uint32_t seed_of_render(const SyntheticScene& scene, std::uint32_t seed, std::uint32_t k, std::uint32_t arm) {
    const auto shared = static_cast<std::uint32_t>(scene.shared);
    if (arm == 1 && k < shared) return seed_of(seed, 2 * (shared - 1 - k) + 1);
    return seed_of(seed, 2 * k + 1 + arm);
}

bool is_rare(const SyntheticNoise& noise) {
    return noise.kind == SyntheticNoise::Kind::events || noise.kind == SyntheticNoise::Kind::sparks;
}

/// The lowest quarter of the columns and of the rows.
bool sparks_there(std::uint32_t pixel, int width) {
    const auto w = static_cast<std::uint32_t>(width);
    return 4 * (pixel % w) < w && 4 * (pixel / w) < w;
}

bool has_event(const SyntheticNoise& noise, std::uint32_t seed, std::uint32_t pixel, int width) {
    if (noise.kind == SyntheticNoise::Kind::sparks && !sparks_there(pixel, width)) return false;
    return static_cast<double>(draw(seed, pixel, 1).x) < noise.size;
}

/// Returns how many of 16 samples hit, each with this probability.
int hits_of(std::uint32_t seed, std::uint32_t pixel, double chance) {
    int hits = 0;
    for (std::uint32_t k = 0; k < 8; ++k) {
        const Vec2<float> u = draw(seed, pixel, k);
        hits += (static_cast<double>(u.x) < chance) + (static_cast<double>(u.y) < chance);
    }
    return hits;
}

struct RenderCache {
    std::mutex mutex;
    std::map<std::string, Render> renders;
};

RenderSource source_of(const SyntheticScene& scene, std::uint32_t seed) {
    RenderSource out;
    out.expand = [scene](const std::vector<std::string>& patterns, const SourceLocation&) {
        std::vector<std::string> paths;
        const int count = patterns[0] == "reference" ? 1 : scene.renders;
        for (int k = 0; k < count; ++k) paths.push_back(fmt::format("{}-{}", patterns[0], k));
        return paths;
    };
    const auto make = [scene, seed](const std::string& path) {
        if (path.starts_with("reference")) return synthetic_render(path, {}, seed, scene);
        std::uint32_t k = 0;
        std::from_chars(path.data() + 2, path.data() + path.size(), k);
        const bool first = path.starts_with('a');
        return synthetic_render(path, first ? scene.a : scene.b, seed_of_render(scene, seed, k, first ? 0 : 1), scene);
    };
    const auto cache = std::make_shared<RenderCache>();  // each render is read at least twice
    out.read = [make, cache](const std::string& path, const std::string&) {
        {
            const std::lock_guard lock(cache->mutex);
            if (const auto found = cache->renders.find(path); found != cache->renders.end()) return found->second;
        }
        Render render = make(path);
        const std::lock_guard lock(cache->mutex);
        return cache->renders.emplace(path, std::move(render)).first->second;
    };
    return out;
}

}  // namespace

std::string to_string(const SyntheticNoise& noise) {
    switch (noise.kind) {
        case SyntheticNoise::Kind::normal: return fmt::format("normal, {:g} %", 100 * noise.size);
        case SyntheticNoise::Kind::lognormal: return fmt::format("lognormal, sigma {:g}", noise.size);
        case SyntheticNoise::Kind::pareto: return fmt::format("Pareto, index {:g}", noise.size);
        case SyntheticNoise::Kind::hits: return fmt::format("hits of 16 samples, {:g} % each", 100 * noise.size);
        case SyntheticNoise::Kind::sparks:
            return fmt::format("sparks, 1 in {:g} pixels of a sixteenth", 1 / noise.size);
        case SyntheticNoise::Kind::gamma:
            return fmt::format("gamma, {:g} %", 100 * noise.size) +
                (noise.filter > 1 ? fmt::format(", filtered over {0} x {0}", noise.filter) : "");
        case SyntheticNoise::Kind::events: break;
    }
    return fmt::format("bright events, 1 in {:g} pixels", 1 / noise.size);
}

double synthetic_pixel(const SyntheticNoise& noise, std::uint32_t seed, std::uint32_t pixel, int width) {
    using NoiseKind = SyntheticNoise::Kind;
    const Vec2<float> u = draw(seed, pixel, 0);
    double y = 1;
    if (noise.kind == NoiseKind::normal) y += noise.size > 0 ? noise.size * standard_normal(u) : 0;
    if (noise.kind == NoiseKind::lognormal)
        y = math::exp(noise.size * standard_normal(u) - noise.size * noise.size / 2);
    if (noise.kind == NoiseKind::pareto) {
        const double a = noise.size;
        y = (a - 1) / a * math::pow(static_cast<double>(u.x), -1 / a);
    }
    if (noise.kind == NoiseKind::gamma) y = gamma(noise.size, seed, pixel);
    if (noise.kind == NoiseKind::hits) y = hits_of(seed, pixel, noise.size) / (16 * noise.size);
    if (is_rare(noise)) {
        const bool local = noise.kind == NoiseKind::sparks;
        const double size = local ? 1 : -math::log(static_cast<double>(draw(seed, pixel, 1).y));
        y = (local && !sparks_there(pixel, width) ? 1 : 0.9) + 0.02 * standard_normal(u) +
            (has_event(noise, seed, pixel, width) ? event_size(noise) * size : 0);
    }
    return y * (1 + noise.bias);
}

double event_size(const SyntheticNoise& noise) { return is_rare(noise) ? 0.1 / noise.size : 0; }

bool have_events(const SyntheticScene& scene, std::uint32_t seed) {
    const auto some = [&](const SyntheticNoise& noise, std::uint32_t arm) {
        for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(scene.renders); ++k)
            for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(scene.width * scene.width); ++i)
                if (has_event(noise, seed_of_render(scene, seed, k, arm), i, scene.width)) return true;
        return false;
    };
    return (!is_rare(scene.a) || some(scene.a, 0)) && (!is_rare(scene.b) || some(scene.b, 1));
}

CompareResult compare_synthetic(const SyntheticScene& scene, std::uint32_t seed, const std::vector<CompareFlag>& more) {
    std::vector<CompareFlag> flags{{{"arms", "a", "files"}, "a", false, "a"}, {{"arms", "b", "files"}, "b", false, "b"},
        {{"alpha"}, "0.05", true, "alpha"}, {{"flip"}, "false", true, "flip"}};
    if (scene.referred) flags.push_back({{"reference"}, "reference", false, "reference"});
    flags.insert(flags.end(), more.begin(), more.end());
    const ComparePlan plan = plan_of(flags);
    ProgressMonitor monitor;
    return test_differences(plan, read_all(plan, monitor, source_of(scene, seed)), monitor);
}

}  // namespace crescent
