// A pixel's value is drawn from the stream of its render, its index the pixel's: any pixel can be made by itself. All
// kinds of noise have the mean 1 before the bias; rare events carry a tenth of the light, whatever their rate.
#include "compare/made.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <numbers>

#include "color/rgb.h"
#include "math/functions.h"
#include "simd/random.h"

namespace crescent::inline comparing {

namespace {

/// Standard normal (Box & Muller 1958).
double normal(const Vec2<float>& u) {
    return std::sqrt(-2 * math::log(static_cast<double>(u.x))) *
        math::cos(2 * std::numbers::pi * static_cast<double>(u.y));
}

/// Gamma of mean 1 and this standard deviation, at most 1 (Marsaglia & Tsang 2000, "A Simple Method for Generating
/// Gamma Variables").
double gamma(double sd, std::uint32_t seed, std::uint32_t pixel) {
    const double shape = 1 / (sd * sd), d = shape - 1.0 / 3, c = 1 / std::sqrt(9 * d);
    for (std::uint32_t k = 0;; k += 2) {
        const double x = normal(draw(seed, pixel, k)), v = (1 + c * x) * (1 + c * x) * (1 + c * x);
        if (v <= 0) continue;
        const auto u = static_cast<double>(draw(seed, pixel, k + 1).x);
        if (math::log(u) < x * x / 2 + d - d * v + d * math::log(v)) return d * v / shape;
    }
}

/// The chance of NaN is drawn from a stream of its own.
bool fails(const MadeNoise& noise, std::uint32_t seed, std::uint32_t pixel) {
    return noise.failing > 0 && static_cast<double>(draw(seed_of(seed, 4), pixel, 0).x) < noise.failing;
}

/// Means over width x width pixels, across the edges of the picture.
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

Render made_render(const std::string& path, const MadeNoise& noise, std::uint32_t seed, const MadeWorld& world) {
    Render out(path, world.width, world.width);
    const double factors[] = {1 + noise.hue, 1, 1 - noise.hue * luminance_weights[0] / luminance_weights[2]};
    std::vector<float>* channels[] = {&out.r, &out.g, &out.b};
    for (std::uint32_t i = 0; i < out.size(); ++i) {
        const double shared = made_pixel(noise, seed, i, world.width);
        for (std::uint32_t c = 0; c < 3; ++c) {
            const double own = world.own > 0 ? made_pixel(noise, seed_of(seed, c + 1), i, world.width) : 0;
            (*channels[c])[i] = static_cast<float>(factors[c] * ((1 - world.own) * shared + world.own * own));
        }
        if (fails(noise, seed, i)) out.g[i] = std::nanf("");
    }
    for (std::vector<float>* channel : channels)
        if (noise.filter > 1) filter(*channel, world.width, noise.filter);
    return out;
}

/// Of the k-th render of arm a (0) or b (1).
std::uint32_t seed_of_render(const MadeWorld& world, std::uint32_t seed, std::uint32_t k, std::uint32_t arm) {
    const auto shared = static_cast<std::uint32_t>(world.shared);
    if (arm == 1 && k < shared) return seed_of(seed, 2 * (shared - 1 - k) + 1);
    return seed_of(seed, 2 * k + 1 + arm);
}

bool is_rare(const MadeNoise& noise) {
    return noise.kind == MadeNoise::Kind::events || noise.kind == MadeNoise::Kind::sparks;
}

/// The quarter of the width and of the height next to the origin.
bool sparks_there(std::uint32_t pixel, int width) {
    const auto w = static_cast<std::uint32_t>(width);
    return 4 * (pixel % w) < w && 4 * (pixel / w) < w;
}

bool met(const MadeNoise& noise, std::uint32_t seed, std::uint32_t pixel, int width) {
    if (noise.kind == MadeNoise::Kind::sparks && !sparks_there(pixel, width)) return false;
    return static_cast<double>(draw(seed, pixel, 1).x) < noise.size;
}

/// How many of 16 samples meet something that each meets with this chance.
int hits_of(std::uint32_t seed, std::uint32_t pixel, double chance) {
    int hits = 0;
    for (std::uint32_t k = 0; k < 8; ++k) {
        const Vec2<float> u = draw(seed, pixel, k);
        hits += (static_cast<double>(u.x) < chance) + (static_cast<double>(u.y) < chance);
    }
    return hits;
}

struct Made {
    std::mutex mutex;
    std::map<std::string, Render> renders;
};

RenderSource source_of(const MadeWorld& world, std::uint32_t seed) {
    RenderSource out;
    out.expand = [world](const std::vector<std::string>& patterns, const SourceLocation&) {
        std::vector<std::string> paths;
        const int count = patterns[0] == "reference" ? 1 : world.renders;
        for (int k = 0; k < count; ++k) paths.push_back(fmt::format("{}-{}", patterns[0], k));
        return paths;
    };
    const auto make = [world, seed](const std::string& path) {
        if (path.starts_with("reference")) return made_render(path, {}, seed, world);
        std::uint32_t k = 0;
        std::from_chars(path.data() + 2, path.data() + path.size(), k);
        const bool first = path.starts_with('a');
        return made_render(path, first ? world.a : world.b, seed_of_render(world, seed, k, first ? 0 : 1), world);
    };
    const auto made = std::make_shared<Made>();  // every render is read twice or more
    out.read = [make, made](const std::string& path, const std::string&) {
        {
            const std::lock_guard lock(made->mutex);
            if (const auto found = made->renders.find(path); found != made->renders.end()) return found->second;
        }
        Render render = make(path);
        const std::lock_guard lock(made->mutex);
        return made->renders.emplace(path, std::move(render)).first->second;
    };
    return out;
}

}  // namespace

std::string to_string(const MadeNoise& noise) {
    switch (noise.kind) {
        case MadeNoise::Kind::normal: return fmt::format("normal, {:g} %", 100 * noise.size);
        case MadeNoise::Kind::lognormal: return fmt::format("lognormal, sigma {:g}", noise.size);
        case MadeNoise::Kind::pareto: return fmt::format("Pareto, index {:g}", noise.size);
        case MadeNoise::Kind::hits: return fmt::format("hits of 16 samples, {:g} % each", 100 * noise.size);
        case MadeNoise::Kind::sparks: return fmt::format("sparks, 1 in {:g} pixels of a sixteenth", 1 / noise.size);
        case MadeNoise::Kind::gamma:
            return fmt::format("gamma, {:g} %", 100 * noise.size) +
                (noise.filter > 1 ? fmt::format(", filtered over {0} x {0}", noise.filter) : "");
        case MadeNoise::Kind::events: break;
    }
    return fmt::format("bright events, 1 in {:g} pixels", 1 / noise.size);
}

double made_pixel(const MadeNoise& noise, std::uint32_t seed, std::uint32_t pixel, int width) {
    using Kind = MadeNoise::Kind;
    const Vec2<float> u = draw(seed, pixel, 0);
    double y = 1;
    if (noise.kind == Kind::normal) y += noise.size > 0 ? noise.size * normal(u) : 0;
    if (noise.kind == Kind::lognormal) y = math::exp(noise.size * normal(u) - noise.size * noise.size / 2);
    if (noise.kind == Kind::pareto) {
        const double a = noise.size;
        y = (a - 1) / a * math::pow(static_cast<double>(u.x), -1 / a);
    }
    if (noise.kind == Kind::gamma) y = gamma(noise.size, seed, pixel);
    if (noise.kind == Kind::hits) y = hits_of(seed, pixel, noise.size) / (16 * noise.size);
    if (is_rare(noise)) {
        const bool local = noise.kind == Kind::sparks;
        const double size = local ? 1 : -math::log(static_cast<double>(draw(seed, pixel, 1).y));
        y = (local && !sparks_there(pixel, width) ? 1 : 0.9) + 0.02 * normal(u) +
            (met(noise, seed, pixel, width) ? event_size(noise) * size : 0);
    }
    return y * (1 + noise.bias);
}

double event_size(const MadeNoise& noise) { return is_rare(noise) ? 0.1 / noise.size : 0; }

bool met_events(const MadeWorld& world, std::uint32_t seed) {
    const auto some = [&](const MadeNoise& noise, std::uint32_t arm) {
        for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(world.renders); ++k)
            for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(world.width * world.width); ++i)
                if (met(noise, seed_of_render(world, seed, k, arm), i, world.width)) return true;
        return false;
    };
    return (!is_rare(world.a) || some(world.a, 0)) && (!is_rare(world.b) || some(world.b, 1));
}

CompareResult compare_made(const MadeWorld& world, std::uint32_t seed, const std::vector<CompareFlag>& more) {
    std::vector<CompareFlag> flags{{{"arms", "a", "files"}, "a", false, "a"}, {{"arms", "b", "files"}, "b", false, "b"},
        {{"alpha"}, "0.05", true, "alpha"}, {{"flip"}, "false", true, "flip"}};
    if (world.referred) flags.push_back({{"reference"}, "reference", false, "reference"});
    flags.insert(flags.end(), more.begin(), more.end());
    const ComparePlan plan = plan_of(flags);
    ProgressMonitor monitor;
    return judge(plan, read_all(plan, monitor, source_of(world, seed)), monitor);
}

}  // namespace crescent::inline comparing
