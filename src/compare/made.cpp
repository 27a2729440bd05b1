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
        out.r[i] = out.g[i] = out.b[i] = static_cast<float>(made_pixel(noise, seed, static_cast<std::uint32_t>(i)));
    return out;
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
        return made_render(path, first ? world.a : world.b, seed_of(seed, 2 * k + (first ? 1 : 2)), world.width);
    };
    return out;
}

}  // namespace

std::string to_string(const MadeNoise& noise) {
    switch (noise.kind) {
        case MadeNoise::Kind::normal: return fmt::format("normal, {:g} %", 100 * noise.size);
        case MadeNoise::Kind::lognormal: return fmt::format("lognormal, sigma {:g}", noise.size);
        case MadeNoise::Kind::events: break;
    }
    return fmt::format("bright events, 1 in {:g} pixels", 1 / noise.size);
}

double made_pixel(const MadeNoise& noise, std::uint32_t seed, std::uint32_t pixel) {
    const Vec2<float> u = draw(seed, pixel, 0), v = draw(seed, pixel, 1);
    double y = 1;
    if (noise.kind == MadeNoise::Kind::normal) y += noise.size > 0 ? noise.size * normal(u) : 0;
    if (noise.kind == MadeNoise::Kind::lognormal) y = math::exp(noise.size * normal(u) - noise.size * noise.size / 2);
    if (noise.kind == MadeNoise::Kind::events) {
        const double event = static_cast<double>(v.x) < noise.size ? -math::log(static_cast<double>(v.y)) : 0;
        y = 0.9 + 0.02 * normal(u) + 0.1 / noise.size * event;
    }
    return y * (1 + noise.bias);
}

CompareResult compare_made(const MadeWorld& world, std::uint32_t seed, const std::vector<CompareFlag>& more) {
    std::vector<CompareFlag> flags{{{"arms", "a", "files"}, "a", false, "a"}, {{"arms", "b", "files"}, "b", false, "b"},
        {{"reference"}, "reference", false, "reference"}, {{"alpha"}, "0.05", true, "alpha"},
        {{"flip"}, "false", true, "flip"}};
    flags.insert(flags.end(), more.begin(), more.end());
    const ComparePlan plan = plan_of(flags);
    ProgressMonitor watch;
    return judge(plan, read_all(plan, watch, source_of(world, seed)), watch);
}

}  // namespace crescent::inline comparing
