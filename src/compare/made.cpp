// A pixel's value is drawn from the stream of its render, its index the pixel's: any pixel can be made by itself. All
// kinds of noise have the mean 1 before the bias; rare events carry a tenth of the light, whatever their rate.
#include "compare/made.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <numbers>

#include "math/functions.h"
#include "simd/random.h"

namespace crescent::inline comparing {

namespace {

/// Standard normal (Box & Muller 1958).
double normal(const Vec2<float>& u) {
    return std::sqrt(-2 * math::log(static_cast<double>(u.x))) *
        math::cos(2 * std::numbers::pi * static_cast<double>(u.y));
}

Render made_render(const std::string& path, const MadeNoise& noise, std::uint32_t seed, int width) {
    Render out(path, width, width);
    for (std::size_t i = 0; i < out.size(); ++i)
        out.r[i] = out.g[i] = out.b[i] =
            static_cast<float>(made_pixel(noise, seed, static_cast<std::uint32_t>(i), width));
    return out;
}

/// Of the k-th render of arm a (0) or b (1).
std::uint32_t seed_of_render(std::uint32_t seed, std::uint32_t k, std::uint32_t arm) {
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

RenderSource source_of(const MadeWorld& world, std::uint32_t seed) {
    RenderSource out;
    out.expand = [world](const std::vector<std::string>& patterns, const SourceLocation&) {
        std::vector<std::string> paths;
        const int count = patterns[0] == "reference" ? 1 : world.renders;
        for (int k = 0; k < count; ++k) paths.push_back(fmt::format("{}-{}", patterns[0], k));
        return paths;
    };
    out.read = [world, seed](const std::string& path, const std::string&) {
        if (path.starts_with("reference")) return made_render(path, {}, seed, world.width);
        std::uint32_t k = 0;
        std::from_chars(path.data() + 2, path.data() + path.size(), k);
        const bool first = path.starts_with('a');
        return made_render(path, first ? world.a : world.b, seed_of_render(seed, k, first ? 0 : 1), world.width);
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
                if (met(noise, seed_of_render(seed, k, arm), i, world.width)) return true;
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
