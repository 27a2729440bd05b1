// The value of a pixel is drawn from the stream of its render at the pixel's index, so each pixel can be computed
// alone. All kinds of noise have the mean 1 before the bias; rare events contribute a tenth of the radiance for any
// rate.
#include "compare/synthetic.h"

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
#include "base/vec.h"
#include "compare/plan.h"
#include "math/functions.h"
#include "math/simd/random.h"
#include "math/statistics.h"

namespace crescent::inline comparison {

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

// ---- Compares synthetic renders, `repeats` times per kind of noise, each call with its own seed, and counts the
// results. The true value of a metric is its mean over all calls of the kind. Rates have exact binomial intervals.

namespace {

using NoiseKind = SyntheticNoise::Kind;

const std::vector<CompareFlag> noise_costs{
    {{"arms", "a", "seconds"}, "2", true, "seconds"}, {{"arms", "a", "spp"}, "16", true, "spp"}};

/// Calls of one kind: their results, and which of them have a rare event in some render of each arm.
struct Calls {
    SyntheticScene scene;
    std::vector<CompareResult> results;
    std::vector<bool> have_events;
    std::vector<CompareFlag> more;
};

void call(Calls& to, std::uint32_t repeats, std::uint32_t seed, ProgressMonitor& monitor) {
    std::vector<CompareFlag> flags = noise_costs;
    flags.insert(flags.end(), to.more.begin(), to.more.end());
    to.results.resize(repeats);
    parallel_for(std::uint32_t{0}, repeats, [&](std::uint32_t k) {
        monitor.check();
        to.results[k] = compare_synthetic(to.scene, seed_of(seed, k), flags);
        monitor.advance(1);
    });
    for (std::uint32_t k = 0; k < repeats; ++k) to.have_events.push_back(have_events(to.scene, seed_of(seed, k)));
}

template <class Is> std::uint64_t count(const std::vector<CompareResult>& all, Is is) {
    return static_cast<std::uint64_t>(std::count_if(all.begin(), all.end(), is));
}

bool differs(const CompareResult& r) { return r.differs(); }
/// Some mean was not tested, or its difference not reported, because of a heavy tail.
bool heavy(const CompareResult& r) {
    const auto message = [](const MeanTest& t) {
        return t.why.starts_with("heavy tail") || t.caveat.starts_with("heavy tail");
    };
    return std::any_of(r.bias.begin(), r.bias.end(),
        [&](const BiasResult& b) { return std::any_of(b.regions.begin(), b.regions.end(), message); });
}

/// The coverage of one metric's intervals for the noisy arm: how many contain the true value, which is the average of
/// the metric over all calls (of its square for a root, of its inverse for an inverse).
std::string coverage(const std::vector<CompareResult>& all, const std::string& metric) {
    const bool root = metric == "rmse", inverse = metric == "efficiency";
    double sum = 0;
    std::uint64_t values = 0, stated = 0, containing = 0;
    for (const CompareResult& r : all) {
        const MetricValue& m = r.arms[0].region(whole_frame).metric(metric);
        if (!m.value) continue;
        sum += root ? *m.value * *m.value : inverse ? 1 / *m.value : *m.value, ++values;
    }
    if (!values) return "–";
    const double mean = sum / static_cast<double>(values), truth = root ? std::sqrt(mean) : inverse ? 1 / mean : mean;
    for (const CompareResult& r : all) {
        const MetricValue& m = r.arms[0].region(whole_frame).metric(metric);
        if (!m.interval) continue;
        ++stated, containing += m.interval->first <= truth && truth <= m.interval->second;
    }
    if (!stated) return "none stated";
    const std::string share = fmt::format("{:.3f}", static_cast<double>(containing) / static_cast<double>(stated));
    return stated == values ? share : fmt::format("{} of {} stated", share, stated);
}

std::string false_alarms(const std::vector<Calls>& scenes) {
    std::string out =
        "| noise of A | of B | renders | calls with a difference found | of calls in which each arm contains its "
        "rare events | of the others | heavy tail reported |\n|---|---|---|---|---|---|---|\n";
    for (const Calls& c : scenes) {
        std::uint64_t with_events = 0, alarms = 0;
        for (std::size_t k = 0; k < c.have_events.size(); ++k)
            if (c.have_events[k]) ++with_events, alarms += c.results[k].differs();
        const std::uint64_t of = c.results.size(), found_differences = count(c.results, differs);
        out += fmt::format("| {} | {} | {} | {} | {} | {} | {} of {} |\n", to_string(c.scene.a), to_string(c.scene.b),
            c.scene.renders, rate_text(found_differences, of),
            with_events == of ? "all"
                : with_events ? rate_text(alarms, with_events)
                              : "–",
            with_events == of ? "–" : fmt::format("{} of {}", found_differences - alarms, of - with_events),
            count(c.results, heavy), of);
    }
    return out;
}

std::string covered(const std::vector<Calls>& scenes) {
    const std::vector<std::string> metrics{
        "y_mean", "var", "rmse", "bias2", "relmse", "mape", "fireflies", "efficiency", "unit_time", "sample_var"};
    std::string out = "| noise | renders |";
    for (const std::string& m : metrics) out += fmt::format(" {} |", m);
    out += "\n|---|---|";
    for (std::size_t k = 0; k < metrics.size(); ++k) out += "---|";
    out += "\n";
    for (const Calls& c : scenes) {
        out += fmt::format("| {} | {} |", to_string(c.scene.a), c.scene.renders);
        for (const std::string& m : metrics) out += fmt::format(" {} |", coverage(c.results, m));
        out += "\n";
    }
    return out;
}

constexpr SyntheticNoise moderate{NoiseKind::normal, 0.2}, coarse{NoiseKind::normal, 0.5};

/// Why one column of the table may exceed alpha.
const std::string indistinguishable_text =
    "If the light of an arm comes from bright events that none of its renders contains, its renders equal those of a "
    "darker arm, and no test can distinguish the two. (Their renders agree with at least the probability q that no "
    "event occurs, so a test that is wrong about one arm in at most alpha of all calls is right about the other in at "
    "most alpha + 1 - q.) Such calls are counted separately. Only knowledge from elsewhere helps, such as `brightest`, "
    "a bound on a pixel of one render.\n\n";

std::vector<Calls> scenes_of(const std::vector<SyntheticNoise>& noises, bool both, const std::vector<int>& renders,
    const std::vector<CompareFlag>& more = {}) {
    std::vector<Calls> out;
    for (const SyntheticNoise& noise : noises)
        for (const int k : renders) out.push_back({{noise, both ? noise : moderate, k, 32, !both, 0, 0}, {}, {}, more});
    return out;
}

/// Each channel has a quarter of its noise of its own; the noise of two channels has a correlation of 0.9.
constexpr double own_share = 0.25;

/// The rate of calls that satisfy a condition, one line each; `first` has the columns that describe the scene.
struct Counted {
    std::string first;
    const Calls* calls;
    std::function<bool(const CompareResult&)> condition;
};
std::string counts(const std::string& head, const std::vector<Counted>& lines) {
    std::string out = head;
    for (const Counted& l : lines)
        out += fmt::format("| {} | {} | {} |\n", l.first, l.calls->scene.renders,
            rate_text(count(l.calls->results, l.condition), l.calls->results.size()));
    return out;
}

/// Returns the result for the two arms.
const BiasResult& arms_of(const CompareResult& r) {
    return *std::find_if(r.bias.begin(), r.bias.end(), [](const BiasResult& b) { return b.b != the_reference; });
}
bool arms_differ(const CompareResult& r) { return arms_of(r).differs(); }
bool some_seeds_found(const CompareResult& r) { return !arms_of(r).shared.empty(); }
bool all_seeds_found(const CompareResult& r) { return arms_of(r).all_shared; }

std::vector<Counted> lines_of(
    const std::vector<Calls>& scenes, auto first, std::function<bool(const CompareResult&)> condition) {
    std::vector<Counted> out;
    for (const Calls& c : scenes) out.push_back({first(c.scene), &c, condition});
    return out;
}

/// Scenes with gamma noise in colour, equal in both arms except for `change`.
std::vector<Calls> gamma_scenes(const std::vector<double>& sizes, const std::vector<int>& renders, auto change) {
    std::vector<Calls> out;
    for (const double size : sizes)
        for (const int k : renders) {
            SyntheticScene scene{{NoiseKind::gamma, 0.2}, {NoiseKind::gamma, 0.2}, k, 32, false, own_share, 0};
            change(scene, size);
            out.push_back({scene, {}, {}, {}});
        }
    return out;
}

/// The measurements besides those of grey renders with independent seeds.
struct ColourRates {
    std::vector<Calls> alike, bias, hue, failing_alike, failing, same_seeds, some_seeds, other_noise;

    ColourRates() {
        const std::vector<SyntheticNoise> kinds{{NoiseKind::gamma, 0.2}, {NoiseKind::lognormal, 1},
            {NoiseKind::pareto, 2.5}, {NoiseKind::hits, 0.02}, {.kind = NoiseKind::gamma, .size = 0.2, .filter = 4}};
        alike = scenes_of(kinds, true, {4, 16});
        for (Calls& c : alike) c.scene.own = own_share;
        bias = gamma_scenes({0.01, 0.02}, {4, 8, 16}, [](SyntheticScene& w, double size) { w.b.bias = size; });
        hue = gamma_scenes({0.0025, 0.005, 0.01}, {4, 8, 16}, [](SyntheticScene& w, double size) { w.b.hue = size; });
        failing_alike = gamma_scenes(
            {1e-4, 1e-2}, {4, 16}, [](SyntheticScene& w, double size) { w.a.failing = w.b.failing = size; });
        failing = gamma_scenes({1e-3, 1e-2}, {4, 16}, [](SyntheticScene& w, double size) { w.b.failing = size; });
        const auto shared = [](SyntheticScene& w, double size) { w.b.bias = size, w.shared = w.renders; };
        same_seeds = gamma_scenes({0.001, 0.002}, {4, 8}, shared);
        some_seeds = gamma_scenes({0}, {4, 8}, [](SyntheticScene& w, double) { w.shared = w.renders / 2; });
        for (const auto& [a, b] :
            {std::pair(SyntheticNoise{NoiseKind::normal, 0.2}, SyntheticNoise{NoiseKind::normal, 0.3}),
                {SyntheticNoise{NoiseKind::lognormal, 0.5}, SyntheticNoise{NoiseKind::lognormal, 1}}})
            for (const int k : {4, 8, 16}) other_noise.push_back({{a, b, k, 32, false, own_share, k}, {}, {}, {}});
    }
    std::vector<std::vector<Calls>*> all() {
        return {&alike, &bias, &hue, &failing_alike, &failing, &same_seeds, &some_seeds, &other_noise};
    }
    std::string text() const;
};

std::string ColourRates::text() const {
    const auto kind = [](const SyntheticScene& w) { return to_string(w.a); };
    const auto percent_of = [](double SyntheticNoise::* of) {
        return [of](const SyntheticScene& w) { return fmt::format("{:g} %", 100 * (w.b.*of)); };
    };
    const auto chance = [](const SyntheticScene& w) { return fmt::format("{:g}", w.b.failing); };
    std::string out =
        "### In colour\n\nTwo arms, no reference. Three quarters of a channel's noise are common to all three, a "
        "quarter "
        "is its own: the correlation of two channels is 0.9.\n\nEqual arms:\n\n";
    out += counts("| noise of both | renders | calls with a difference found |\n|---|---|---|\n",
        lines_of(alike, kind, arms_differ));
    out += "\nB is brighter by this share, gamma noise of 20 %:\n\n" +
        counts("| bias | renders | found |\n|---|---|---|\n",
            lines_of(bias, percent_of(&SyntheticNoise::bias), arms_differ));
    out += "\nRed of B is brighter by this share and blue darker by 2.94 times as much, so Y is equal:\n\n" +
        counts(
            "| red | renders | found |\n|---|---|---|\n", lines_of(hue, percent_of(&SyntheticNoise::hue), arms_differ));
    out += "\n### Values that are not finite\n\nA pixel of a render is NaN with this probability in both arms:\n\n" +
        counts("| probability | renders | calls with a difference found |\n|---|---|---|\n",
            lines_of(failing_alike, chance, arms_differ));
    out += "\nIn B only:\n\n" +
        counts("| probability | renders | found |\n|---|---|---|\n", lines_of(failing, chance, arms_differ));
    out +=
        "\n### Renders with shared seeds\n\nRenders with independent seeds that are taken for renders with shared "
        "seeds:\n\n" +
        counts("| noise of both | renders | calls that take any two renders for such |\n|---|---|---|\n",
            lines_of(alike, kind, some_seeds_found));
    const std::string head = "| | renders | calls |\n|---|---|---|\n";
    std::vector<Counted> seen = lines_of(
        same_seeds, [](const SyntheticScene& w) { return fmt::format("bias {:g} %, all recognised", 100 * w.b.bias); },
        all_seeds_found);
    const auto more = [&](const std::vector<Counted>& lines) { seen.insert(seen.end(), lines.begin(), lines.end()); };
    more(lines_of(
        same_seeds,
        [](const SyntheticScene& w) { return fmt::format("bias {:g} %, a difference is found", 100 * w.b.bias); },
        arms_differ));
    more(lines_of(some_seeds, [](auto&) { return "half of the seeds are shared, some recognised"; }, some_seeds_found));
    more(lines_of(
        some_seeds, [](auto&) { return "half of the seeds are shared, all taken for shared"; }, all_seeds_found));
    more(
        lines_of(some_seeds, [](auto&) { return "half of the seeds are shared, a difference is found"; }, arms_differ));
    const auto pair = [](const char* what) {
        return [what](const SyntheticScene& w) {
            return fmt::format("{} and {}, equal means, {}", to_string(w.a), to_string(w.b), what);
        };
    };
    more(lines_of(other_noise, pair("all recognised"), all_seeds_found));
    more(lines_of(other_noise, pair("a difference is found"), arms_differ));
    return out + "\nThe same seeds in another order; gamma noise of 20 % unless stated otherwise:\n\n" +
        counts(head, seen);
}

std::string powers(const std::vector<Calls>& biased) {
    std::string out =
        "| bias | renders | found | smallest difference that would be found, as stated without bias "
        "|\n|---|---|---|---|\n";
    for (const Calls& c : biased) {
        double smallest = 0;
        for (const CompareResult& r : c.results)
            smallest += r.bias[1].regions.back().smallest / static_cast<double>(c.results.size());
        out += fmt::format("| {:g} % | {} | {} | {:.2g} % |\n", 100 * c.scene.b.bias, c.scene.renders,
            rate_text(count(c.results, [](const CompareResult& r) { return r.bias[1].differs(); }), c.results.size()),
            100 * smallest);
    }
    return out;
}

}  // namespace

std::string compare_error_rates(std::uint32_t repeats, std::uint32_t seed, ProgressMonitor& monitor) {
    const std::vector<int> few_and_many{4, 16};
    const std::vector<SyntheticNoise> chosen{coarse, {NoiseKind::lognormal, 1}, {NoiseKind::events, 0.01},
        {NoiseKind::events, 1e-3}, {NoiseKind::events, 1e-4}};
    const std::vector<SyntheticNoise> held_out{{NoiseKind::pareto, 2.5}, {NoiseKind::pareto, 1.5},
        {NoiseKind::hits, 0.02}, {NoiseKind::sparks, 0.02}, {NoiseKind::sparks, 2e-3}};
    std::vector<Calls> right = scenes_of(chosen, false, few_and_many), other = scenes_of(held_out, false, few_and_many),
                       alike =
                           scenes_of({{NoiseKind::lognormal, 1}, {NoiseKind::events, 1e-3}, {NoiseKind::events, 1e-4},
                                         {NoiseKind::pareto, 1.5}, {NoiseKind::hits, 0.02}, {NoiseKind::sparks, 2e-3}},
                               true, few_and_many),
                       bounded = scenes_of({{NoiseKind::events, 1e-4}, {NoiseKind::sparks, 2e-3}}, false, few_and_many,
                           {{{"brightest"}, "10000", true, ""}});
    std::vector<Calls> biased;
    for (const double bias : {0.01, 0.02, 0.05})
        for (const int renders : {4, 8, 16})
            biased.push_back({{coarse, {NoiseKind::normal, 0.2, bias}, renders, 32, true, 0, 0}, {}, {}, {}});
    ColourRates colour;
    std::vector<std::vector<Calls>*> all{&right, &other, &alike, &bounded, &biased};
    for (std::vector<Calls>* scenes : colour.all()) all.push_back(scenes);
    std::size_t kinds = 0;
    for (const auto* scenes : all) kinds += scenes->size();
    monitor.begin("comparisons", static_cast<double>(repeats) * static_cast<double>(kinds));
    for (auto* scenes : all)
        for (Calls& c : *scenes) call(c, repeats, seed, monitor);
    std::string out = fmt::format(
        "{} calls each, with two arms of 32 x 32 pixels and mean 1 and a reference without error: three comparisons "
        "per call, which share alpha = 0.05.\n\n",
        repeats);
    out += "### False alarms\n\n" + indistinguishable_text;
    out += "Kinds of noise with which the rules were chosen:\n\n" + false_alarms(right);
    out += "\nOther kinds of noise:\n\n" + false_alarms(other);
    out += "\nTwo arms with the same noise, as in two versions of a renderer, without a reference:\n\n" +
        false_alarms(alike);
    out += "\nWith `brightest = 10000`, a bound on a pixel of one render:\n\n" + false_alarms(bounded);
    out +=
        "\n### Power\n\nB is brighter by this share everywhere; the noise of a pixel is 20 % in B "
        "and 50 % in A.\n\n" +
        powers(biased) + "\n" + colour.text();
    out +=
        "\n### Coverage of 95 % intervals\n\nStudent's t over renders, bias2 by the jackknife; for arm A, over the "
        "frame. If a heavy tail is reported there is no interval.\n\n";
    right.insert(right.end(), other.begin(), other.end());
    return out + covered(right);
}

}  // namespace crescent::inline comparison
